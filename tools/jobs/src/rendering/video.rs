//! Frames → a video file, by ffmpeg: a program of its own, which must be installed.
//!
//! Frames go to ffmpeg's standard input as raw pixels, in order. It writes H.264 in 4:2:0, which every player shows:
//! sides are even (an odd side repeats its last column or row), colours are tagged as BT.709. It writes a temporary file
//! beside the target, which is renamed when ffmpeg has ended well.

use std::ffi::OsString;
use std::io::{self, BufWriter, Read, Write};
use std::path::PathBuf;
use std::process::{Child, ChildStdin, Command, Stdio};
use std::thread::JoinHandle;

use fbcrowd_render::raster::RgbPicture;
use fbcrowd_sim::scenario::FrameRate;
use motiondb::files::atomic_file::AtomicFile;

use crate::error::JobError;

/// Greatest number of bytes of ffmpeg's messages that an error quotes: the last ones.
const QUOTED_BYTES: usize = 2_000;
/// Quality by default: visually lossless for H.264.
pub const CRF: u8 = 18;
/// Filter: full-range sRGB to the range and matrix of BT.709.
const FILTER: &str = "scale=in_range=full:out_range=tv:out_color_matrix=bt709,format=yuv420p,\
    setparams=color_primaries=bt709:color_trc=bt709:colorspace=bt709";

/// How a video is made.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct VideoOptions {
    /// The video: `.mp4`, `.mov` or `.mkv`.
    pub path: PathBuf,
    /// The program.
    pub ffmpeg: PathBuf,
    /// Constant rate factor of H.264, 0 to 51: less is better and larger.
    pub crf: u8,
}

impl VideoOptions {
    /// ffmpeg's name of the container.
    ///
    /// # Errors
    /// If the file's extension is not that of a container.
    pub fn container(&self) -> Result<&'static str, JobError> {
        let extension = self.path.extension().and_then(|extension| extension.to_str()).map(str::to_lowercase);
        match extension.as_deref() {
            Some("mp4") => Ok("mp4"),
            Some("mov") => Ok("mov"),
            Some("mkv") => Ok("matroska"),
            _ => Err(JobError::NoContainer { path: self.path.clone() }),
        }
    }
}

/// Checks that ffmpeg can be started, and that the file's extension names a container.
///
/// # Errors
/// [`JobError::NoFfmpeg`], [`JobError::NoContainer`].
pub fn check(options: &VideoOptions) -> Result<(), JobError> {
    options.container()?;
    let mut command = Command::new(&options.ffmpeg);
    command.arg("-version").stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    let started = command.status();
    started.map(drop).map_err(|source| JobError::NoFfmpeg { program: options.ffmpeg.clone(), source })
}

/// A video that is being written. Dropped without [`Video::finish`], it ends ffmpeg and leaves no file.
#[derive(Debug)]
pub struct Video {
    program: PathBuf,
    file: Option<AtomicFile>,
    size_px: [u32; 2],
    child: Child,
    input: Option<BufWriter<ChildStdin>>,
    messages: Option<JoinHandle<Vec<u8>>>,
}

impl Video {
    /// Starts ffmpeg for frames of one size.
    ///
    /// # Errors
    /// If the file cannot be written, or ffmpeg does not start.
    pub fn begin(options: &VideoOptions, size_px: [u32; 2], rate: FrameRate) -> Result<Self, JobError> {
        let container = options.container()?;
        let file = AtomicFile::create(&options.path).map_err(|error| JobError::unwritable(&options.path, error))?;
        let mut command = Command::new(&options.ffmpeg);
        command.args(arguments(size_px.map(even), rate, options.crf, container)).arg(file.temporary_path());
        command.stdin(Stdio::piped()).stdout(Stdio::null()).stderr(Stdio::piped());
        let missing = |source| JobError::NoFfmpeg { program: options.ffmpeg.clone(), source };
        let mut child = command.spawn().map_err(missing)?;
        let input = child.stdin.take().map(BufWriter::new);
        let messages = child.stderr.take().map(|mut pipe| {
            std::thread::spawn(move || {
                let mut text = Vec::new();
                // What cannot be read is not quoted.
                let _ = pipe.read_to_end(&mut text);
                text
            })
        });
        Ok(Self { program: options.ffmpeg.clone(), file: Some(file), size_px, child, input, messages })
    }

    /// Adds a frame.
    ///
    /// # Errors
    /// If ffmpeg has ended; the error quotes its messages.
    pub fn push(&mut self, picture: &RgbPicture) -> Result<(), JobError> {
        debug_assert_eq!(picture.size_px, self.size_px);
        let written = self.input.as_mut().map_or(Ok(()), |input| write_frame(input, picture));
        written.map_err(|error| self.failed(Some(error)))
    }

    /// Ends the video, and gives the file its name.
    ///
    /// # Errors
    /// If ffmpeg fails, or the file cannot be renamed.
    pub fn finish(mut self) -> Result<(), JobError> {
        if let Some(Err(error)) = self.input.take().map(|mut input| input.flush()) {
            return Err(self.failed(Some(error)));
        }
        let ended = self.child.wait();
        let file = self.file.take();
        let is_written =
            file.as_ref().is_some_and(|file| file.temporary_path().metadata().is_ok_and(|data| data.len() > 0));
        match (ended, file) {
            (Ok(status), Some(file)) if status.success() && is_written => {
                let path = file.target().to_owned();
                file.commit().map_err(|error| JobError::unwritable(&path, error))
            }
            (ended, _) => Err(self.failed(ended.err())),
        }
    }

    /// The error of a program that ended too early, with the end of its messages.
    fn failed(&mut self, error: Option<io::Error>) -> JobError {
        drop(self.input.take());
        let status = self.child.wait().map_or_else(|error| error.to_string(), |status| status.to_string());
        let text = self.messages.take().and_then(|messages| messages.join().ok()).unwrap_or_default();
        let from = text.len().saturating_sub(QUOTED_BYTES);
        let mut message = String::from_utf8_lossy(&text[from..]).trim().to_owned();
        if message.is_empty() {
            message = error.map_or_else(|| "it printed nothing".to_owned(), |error| error.to_string());
        }
        JobError::FfmpegFailed { program: self.program.clone(), status, message }
    }
}

impl Drop for Video {
    fn drop(&mut self) {
        drop(self.input.take());
        // A program that has ended cannot be stopped.
        if matches!(self.child.try_wait(), Ok(None)) {
            let _ = self.child.kill();
        }
        let _ = self.child.wait();
    }
}

/// The next even number.
fn even(side: u32) -> u32 {
    side.next_multiple_of(2)
}

fn arguments([width, height]: [u32; 2], rate: FrameRate, crf: u8, container: &str) -> Vec<OsString> {
    let (size, rate, crf) = (format!("{width}x{height}"), format!("{}/{}", rate.frames, rate.seconds), crf.to_string());
    let arguments = [
        ["-hide_banner", "-nostdin", "-loglevel", "error", "-y"].as_slice(),
        &["-f", "rawvideo", "-pix_fmt", "rgb24", "-s", &size, "-framerate", &rate, "-i", "pipe:0"],
        &["-vf", FILTER, "-c:v", "libx264", "-crf", &crf, "-bitexact"],
        &["-color_primaries", "bt709", "-color_trc", "bt709", "-colorspace", "bt709", "-color_range", "tv"],
        &["-f", container],
        if container == "matroska" { &[] } else { &["-movflags", "+faststart"] },
    ];
    arguments.concat().into_iter().map(OsString::from).collect()
}

/// Writes the rows of a frame; an odd side repeats its last column or row.
fn write_frame(out: &mut impl Write, picture: &RgbPicture) -> io::Result<()> {
    let [width, height] = picture.size_px.map(|side| side as usize);
    let [even_width, even_height] = picture.size_px.map(|side| even(side) as usize);
    for y in 0..even_height {
        let row = &picture.pixels[y.min(height - 1) * width..][..width];
        out.write_all(row.as_flattened())?;
        out.write_all(row[width - (even_width - width)..].as_flattened())?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn odd_sides_repeat_their_last_pixels() {
        let pixels = vec![[1; 3], [2; 3], [3; 3]];
        let mut out = Vec::new();
        write_frame(&mut out, &RgbPicture { size_px: [3, 1], pixels }).unwrap();
        let row = [[1; 3], [2; 3], [3; 3], [3; 3]].concat();
        assert_eq!(out, [row.clone(), row].concat());
    }

    #[test]
    fn the_extension_names_the_container() {
        let container = |path: &str| {
            VideoOptions { path: path.into(), ffmpeg: "ffmpeg".into(), crf: CRF }
                .container()
                .map_err(|error| error.to_string())
        };
        assert_eq!(container("a.MP4"), Ok("mp4"));
        assert!(container("a.avi").unwrap_err().contains(".mkv"));
    }
}

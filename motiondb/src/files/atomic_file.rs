//! Files that appear under their final name whole or not at all, though the process be killed at any time.
//!
//! Nothing is forced onto the disk: that would cost a frame as much as drawing it, and only a failing power supply
//! would tell.
//!
//! A link stays one: what it leads to is written.
//!
//! Who is killed leaves a temporary file. Each is locked as long as it is written, so that [`sweep`] knows those that
//! nobody writes any more.

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};

/// Files begun by this process: two of one name must not share a temporary one.
static BEGUN: AtomicU32 = AtomicU32::new(0);

/// Times that a file may be swept between being made and being locked: only by who begins to write the same name then.
const SWEPT_MAX: usize = 8;

/// Links that are followed one after the other, as many as Linux follows: a circle of them comes to an end.
const LINKS_MAX: usize = 40;

/// A file being written beside its final name; dropped without [`AtomicFile::commit`], it is removed.
#[derive(Debug)]
pub struct AtomicFile {
    writer: Option<BufWriter<File>>,
    temporary: PathBuf,
    target: PathBuf,
}

impl AtomicFile {
    /// Opens `.NAME.PID.N.tmp` beside `target`.
    ///
    /// # Errors
    /// Where the folder cannot be written, or `target` exists and is no file: a folder, or a device that renaming would
    /// replace.
    pub fn create(target: &Path) -> io::Result<Self> {
        let target = followed(target);
        let name =
            target.file_name().ok_or_else(|| io::Error::new(io::ErrorKind::InvalidInput, "the path names no file"))?;
        if fs::metadata(&target).is_ok_and(|found| !found.is_file()) {
            return Err(io::Error::new(io::ErrorKind::InvalidInput, "what is there is no regular file"));
        }
        for _ in 0..SWEPT_MAX {
            let (process, begun) = (std::process::id(), BEGUN.fetch_add(1, Ordering::Relaxed));
            let temporary = target.with_file_name(format!(".{}.{process}.{begun}.tmp", name.to_string_lossy()));
            let file = File::create(&temporary)?;
            // Where the system has no locks, nobody gets one and nothing is swept.
            let _ = file.lock();
            // Otherwise it was swept before it was locked; now it stays.
            if temporary.exists() {
                return Ok(Self { writer: Some(BufWriter::new(file)), temporary, target });
            }
        }
        Err(io::Error::other("temporary files vanish as soon as they are made"))
    }

    /// The buffered file.
    pub fn writer(&mut self) -> &mut BufWriter<File> {
        self.writer.as_mut().expect("taken only by commit, which consumes self")
    }

    /// Flushes and renames to the final name.
    ///
    /// # Errors
    /// Where flushing or renaming fails; the temporary file is removed.
    pub fn commit(mut self) -> io::Result<()> {
        let flushed = self.writer.take().map(BufWriter::into_inner).transpose();
        // Locked until it has its name.
        let _locked = flushed.map_err(io::IntoInnerError::into_error)?;
        fs::rename(&self.temporary, &self.target)
    }
}

impl Drop for AtomicFile {
    fn drop(&mut self) {
        self.writer = None;
        // After a commit the temporary name is gone and this does nothing.
        let _ = fs::remove_file(&self.temporary);
    }
}

/// Removes the temporary files of `target` that killed processes have left; none that is being written, by whomever.
/// For what takes long to write: the whole folder is looked through.
pub fn sweep(target: &Path) {
    let target = followed(target);
    let (Some(name), Some(folder)) = (target.file_name(), target.parent()) else { return };
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let head = format!(".{}.", name.to_string_lossy());
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let file = entry.file_name();
        let numbers = file.to_str().and_then(|file| file.strip_prefix(&head)?.strip_suffix(".tmp")?.split_once('.'));
        let is_temporary =
            numbers.is_some_and(|(process, begun)| [process, begun].iter().all(|n| n.parse::<u32>().is_ok()));
        let unlocked = || File::options().write(true).open(entry.path()).ok().filter(|file| file.try_lock().is_ok());
        if is_temporary && let Some(_locked) = unlocked() {
            // What cannot be removed does no harm.
            let _ = fs::remove_file(entry.path());
        }
    }
}

/// Where a link leads, though nothing be there yet; any other path as it is.
fn followed(path: &Path) -> PathBuf {
    let mut place = path.to_owned();
    for _ in 0..LINKS_MAX {
        let Ok(next) = fs::read_link(&place) else { break };
        place = place.parent().unwrap_or(Path::new("")).join(next);
    }
    place
}

/// Writes all bytes under the final name or none.
///
/// # Errors
/// As [`AtomicFile`].
pub fn write(target: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut file = AtomicFile::create(target)?;
    file.writer().write_all(bytes)?;
    file.commit()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[cfg(unix)]
    #[test]
    fn what_a_link_leads_to_is_written_whether_it_is_there_or_not() {
        let folder = std::env::temp_dir().join(format!("fbcrowd_links_{}", std::process::id()));
        fs::create_dir_all(folder.join("disk")).unwrap();
        let [link, far] = ["link", "far"].map(|name| folder.join(name));
        std::os::unix::fs::symlink("far", &link).unwrap();
        std::os::unix::fs::symlink("disk/a.fbdb", &far).unwrap();
        for text in ["first", "second"] {
            write(&link, text.as_bytes()).unwrap();
            assert_eq!(fs::read_to_string(folder.join("disk/a.fbdb")).unwrap(), text);
            assert!(link.is_symlink() && far.is_symlink());
        }
        fs::remove_dir_all(&folder).unwrap();
    }

    #[test]
    fn what_a_killed_process_left_is_swept_and_what_is_being_written_is_not() {
        let folder = std::env::temp_dir().join(format!("fbcrowd_sweep_{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        let target = folder.join("a.fbrec");
        let kept = ["a.fbrec", ".a.fbrec.1.tmp", ".a.fbrec.x.0.tmp", ".b.fbrec.1.0.tmp", ".a.fbrec.1.0.tmp.txt"];
        for name in kept.iter().chain(&[".a.fbrec.1.0.tmp", ".a.fbrec.4000000.12.tmp"]) {
            fs::write(folder.join(name), "half").unwrap();
        }
        let mut written = AtomicFile::create(&target).unwrap();
        sweep(&target);
        written.writer().write_all(b"whole").unwrap();
        written.commit().unwrap();
        assert_eq!(fs::read(&target).unwrap(), b"whole");
        let mut left: Vec<String> =
            fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        left.sort();
        let mut kept = kept.map(str::to_owned);
        kept.sort();
        assert_eq!(left, kept);
        fs::remove_dir_all(&folder).unwrap();
    }
}

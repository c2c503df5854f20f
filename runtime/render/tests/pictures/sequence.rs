//! Sequences are the same files however they are made, and say what is wrong where they cannot be made.

use std::collections::BTreeMap;
use std::fs;
use std::io::Cursor;
use std::path::Path;
use std::sync::Mutex;

use exr::prelude::{ReadChannels, ReadLayers, f16, read};
use fbcrowd_render::error::RenderError;
use fbcrowd_render::plots::crowd::agent_strip;
use fbcrowd_render::raster::decode_srgb;
use fbcrowd_render::top_view::{PictureFormat, SequenceOptions, TopView, read_tracks, render_sequence, sample};
use fbcrowd_sim::recording::Recording;
use fbcrowd_sim::scenario::View;

use crate::scene_ground::marked;
use crate::support::{self, Scratch};

pub(crate) fn options(folder: &Path, format: PictureFormat, frames: Option<&str>) -> SequenceOptions {
    let frames = frames.map(|frames| frames.parse().unwrap());
    SequenceOptions {
        folder: folder.to_owned(),
        name: "walkers".to_owned(),
        format,
        frames,
        shot: None,
        constraints_of: Vec::new(),
    }
}

fn recording(folder: &Path) -> Recording {
    let path = folder.join("walkers.fbrec");
    support::write_recording(&path);
    Recording::open(&path).unwrap()
}

/// Files by name, drawn with a number of threads.
fn files(
    recording: &Recording,
    format: PictureFormat,
    frames: &[Option<&str>],
    threads: usize,
) -> BTreeMap<String, Vec<u8>> {
    let scratch = Scratch::new(&format!("threads-{threads}-{}-{}", frames.len(), format.extension()));
    let folder = scratch.path();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    for frames in frames {
        pool.install(|| render_sequence(recording, &options(folder, format, *frames), &|_, _| ())).unwrap();
    }
    let names = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
    names.map(|name| (name.clone(), fs::read(folder.join(name)).unwrap())).collect()
}

#[test]
fn files_do_not_depend_on_threads_or_ranges() {
    let scratch = Scratch::new("identical");
    let recording = recording(scratch.path());
    for format in [PictureFormat::Png, PictureFormat::Exr] {
        let once = files(&recording, format, &[None], 1);
        assert_eq!(once.len(), 33, "1.6 s at 20 frames a second, the start included");
        assert_eq!(once.keys().next().unwrap(), &format!("walkers.1001.{}", format.extension()));
        assert_eq!(once, files(&recording, format, &[None], 4));
        assert_eq!(once, files(&recording, format, &[Some("1001-1033x2"), Some("1002-2000:2")], 2));
    }
}

/// Width of a picture, and red, green and blue of its pixels.
fn decoded(png: &[u8]) -> (usize, Vec<u8>) {
    let mut reader = png::Decoder::new(Cursor::new(png)).read_info().unwrap();
    let mut codes = vec![0; reader.output_buffer_size().unwrap()];
    let width = reader.next_frame(&mut codes).unwrap().width as usize;
    (width, codes)
}

#[test]
fn strips_of_a_large_picture_are_the_whole() {
    let scratch = Scratch::new("strips");
    let folder = scratch.path();
    // The first strip has 1360 rows.
    let view = View { width: 3072, height: 2051, frame_rate_hz: 20.0, trail_s: 1.0, labels: true, ..View::default() };
    let header = marked(support::circle(40, 3.4, view));
    let path = folder.join("walkers.fbrec");
    support::write_steps(&path, &header, 16);
    let recording = Recording::open(&path).unwrap();
    let tracks = read_tracks(&recording).unwrap();
    let top_view = TopView::new(recording.header(), &tracks).unwrap();
    let bodies = sample(&recording, 0.8).unwrap();
    let mut buffers = top_view.buffers();
    let whole = top_view.draw(&mut buffers, 0.8, &bodies);
    let files = [PictureFormat::Png, PictureFormat::Exr].map(|format| {
        let written = render_sequence(&recording, &options(folder, format, Some("1017")), &|_, _| ()).unwrap();
        fs::read(&written[0]).unwrap()
    });
    let (_, codes) = decoded(&files[0]);
    let pixels = whole.data().chunks(4).zip(codes.chunks(3));
    assert_eq!(pixels.filter(|(whole, strip)| whole[..3] != **strip).count(), 0);
    assert_linear(&files[1], 3072, &codes);
}

#[test]
fn exr_is_the_png_in_linear_light() {
    let scratch = Scratch::new("linear");
    let folder = scratch.path();
    let recording = recording(folder);
    let [png, exr] = [PictureFormat::Png, PictureFormat::Exr].map(|format| {
        let written = render_sequence(&recording, &options(folder, format, Some("1020")), &|_, _| ()).unwrap();
        fs::read(&written[0]).unwrap()
    });
    let (width, codes) = decoded(&png);
    assert_linear(&exr, width, &codes);
}

/// Fails unless an EXR holds these colours in linear light.
#[track_caller]
fn assert_linear(exr: &[u8], width: usize, codes: &[u8]) {
    let pixels = read()
        .no_deep_data()
        .largest_resolution_level()
        .rgba_channels(
            |size, _| (size.width(), vec![[0.0_f32; 4]; size.area()]),
            |(width, pixels), at, (r, g, b, a): (f32, f32, f32, f32)| pixels[at.y() * *width + at.x()] = [r, g, b, a],
        )
        .first_valid_layer()
        .all_attributes()
        .from_buffered(Cursor::new(exr))
        .unwrap();
    assert_eq!(pixels.layer_data.attributes.frames_per_second, Some((20, 1)));
    assert_eq!(pixels.layer_data.attributes.capture_date, None);
    let (exr_width, linear) = pixels.layer_data.channel_data.pixels;
    assert_eq!(exr_width, width);
    for (pixel, code) in linear.iter().zip(codes.chunks(3)) {
        let expected = [0, 1, 2].map(|channel| f16::from_f32(decode_srgb(f32::from(code[channel]) / 255.0)).to_f32());
        assert_eq!(pixel[..3], expected);
        assert_eq!(pixel[3], 1.0);
    }
}

#[test]
fn progress_counts_every_frame_once() {
    let scratch = Scratch::new("progress");
    let folder = scratch.path();
    let recording = recording(folder);
    let reports = Mutex::new(Vec::new());
    let progress = |done, all| reports.lock().unwrap().push((done, all));
    render_sequence(&recording, &options(folder, PictureFormat::Png, Some("1001-1010x3")), &progress).unwrap();
    let mut reports = reports.into_inner().unwrap();
    reports.sort_unstable();
    assert_eq!(reports, [(1, 4), (2, 4), (3, 4), (4, 4)]);
}

#[test]
fn unwritable_paths_are_named_and_leave_no_file() {
    let scratch = Scratch::new("unwritable");
    let folder = scratch.path();
    let recording = recording(folder);
    let blocked = folder.join("file/frames");
    fs::write(folder.join("file"), "not a folder").unwrap();
    let error = render_sequence(&recording, &options(&blocked, PictureFormat::Png, None), &|_, _| ()).unwrap_err();
    assert!(matches!(&error, RenderError::Folder { folder, .. } if *folder == blocked), "{error}");
    assert!(error.to_string().contains("file/frames"), "{error}");
    // A folder has the name of the frame: the error names the frame, and its temporary file is removed.
    fs::create_dir(folder.join("walkers.1001.png")).unwrap();
    let error =
        render_sequence(&recording, &options(folder, PictureFormat::Png, Some("1001")), &|_, _| ()).unwrap_err();
    assert!(matches!(&error, RenderError::Write { path, .. } if path.ends_with("walkers.1001.png")), "{error}");
    let left = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
    assert!(left.into_iter().all(|name| !name.ends_with(".tmp")));
}

#[test]
fn frames_outside_the_recording_are_rejected() {
    let scratch = Scratch::new("outside");
    let folder = scratch.path();
    let recording = recording(folder);
    let error =
        render_sequence(&recording, &options(folder, PictureFormat::Png, Some("1-100")), &|_, _| ()).unwrap_err();
    assert!(matches!(error, RenderError::NoFrames { first: 1001, last: 1033, .. }), "{error}");
}

/// Row at which the first view of a strip begins, below its title.
const VIEW_TOP_PX: u32 = 70;

#[test]
fn the_strip_of_a_tall_body_shows_its_head() {
    let scratch = Scratch::new("tall_strip");
    for stature in [0.6, 1.0, 1.3] {
        let mut header = support::golden_header();
        header.scenario.agents[1].stature = stature;
        let path = scratch.path().join(format!("{stature}.fbrec"));
        support::write_steps(&path, &header, 4);
        let strip = agent_strip(&Recording::open(&path).unwrap(), &[], 1, &[0.2]).unwrap();
        let is_empty = |y: u32| {
            let row = (strip.width() / 4..strip.width() * 3 / 4).map(|x| strip.pixel(x, y).unwrap());
            row.clone().all(|pixel| Some(pixel) == row.clone().next())
        };
        let crown_px = (VIEW_TOP_PX + 2..strip.height()).find(|y| !is_empty(*y)).unwrap();
        // The upper of two views.
        let view_px = (strip.height() - VIEW_TOP_PX) / 2;
        assert!((VIEW_TOP_PX + 6..VIEW_TOP_PX + view_px).contains(&crown_px), "{stature}: {crown_px} px");
    }
}

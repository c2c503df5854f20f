//! Frames of a camera are the same files however they are made, show the figure whole, and say what is wrong where they
//! cannot be made.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use fbcrowd_render::camera::{CameraOptions, CameraView, ColourBy, Quality, Shot, render_camera_sequence};
use fbcrowd_render::error::RenderError;
use fbcrowd_render::top_view::{PictureFormat, sample};
use fbcrowd_render::visibility::{Lens, Owner, SamplePattern};
use fbcrowd_sim::Population;
use fbcrowd_sim::recording::{ExtraFrame, Recording};
use fbcrowd_sim::scenario::{CameraFollow, CameraKey, CameraSpec, View};
use glam::Vec3;
use tiny_skia::Pixmap;

use crate::support::{self, Scratch};

fn recording(folder: &Path) -> Recording {
    let path = folder.join("walkers.fbrec");
    support::write_recording(&path);
    Recording::open(&path).unwrap()
}

fn cameras() -> Vec<CameraSpec> {
    let spec = |name: &str| CameraSpec { name: name.to_owned(), focal_mm: Some(30.0), ..CameraSpec::default() };
    let [eye_m, look_at_m] = [Vec3::new(-2.0, -6.0, 1.65), Vec3::new(0.0, 0.0, 1.0)];
    let key = |time_s: f32, x: f32| CameraKey { time_s, eye_m: eye_m + x * Vec3::X, look_at_m, up: None };
    let follow = |agent: u32| CameraFollow { agent, behind_m: 3.0, left_m: 0.5, height_m: 1.8 };
    vec![
        CameraSpec { eye_m: Some(eye_m), look_at_m: Some(look_at_m), ..spec("still") },
        CameraSpec { keys: vec![key(0.0, 0.0), key(1.0, 2.0)], ..spec("keyed") },
        CameraSpec { follow: Some(follow(1)), ..spec("behind") },
        CameraSpec { eyes_of: Some(0), ..spec("eyes") },
        CameraSpec { follow: Some(follow(999)), ..spec("absent") },
    ]
}

fn options(folder: &Path, camera: &str) -> CameraOptions {
    CameraOptions {
        folder: folder.to_owned(),
        name: "walkers".to_owned(),
        frames: Some("1001-1009x4".parse().unwrap()),
        cameras: Some(cameras()),
        size_px: Some([192, 108]),
        camera: Some(camera.to_owned()),
        ..CameraOptions::default()
    }
}

/// Files by name, drawn with a number of threads.
fn files(recording: &Recording, options: &CameraOptions, threads: usize) -> BTreeMap<PathBuf, Vec<u8>> {
    let scratch = Scratch::new(&format!("camera-{threads}-{}", options.camera.as_deref().unwrap_or_default()));
    let options = CameraOptions { folder: scratch.path().to_owned(), ..options.clone() };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    let written = pool.install(|| render_camera_sequence(recording, &options, &|_, _| ())).unwrap();
    let name = |path: &PathBuf| PathBuf::from(path.file_name().unwrap());
    written.iter().map(|path| (name(path), fs::read(path).unwrap())).collect()
}

#[test]
fn camera_files_do_not_depend_on_threads() {
    let scratch = Scratch::new("camera");
    let recording = recording(scratch.path());
    for camera in ["still", "keyed", "behind", "eyes", "default"] {
        let options = options(scratch.path(), camera);
        let once = files(&recording, &options, 1);
        assert_eq!(once.len(), 3);
        assert!(once == files(&recording, &options, 3), "{camera}");
    }
    let exr = CameraOptions { format: PictureFormat::Exr, ..options(scratch.path(), "still") };
    assert!(files(&recording, &exr, 1) == files(&recording, &exr, 3));
}

#[test]
fn frames_of_a_camera_that_cannot_be_drawn_say_why() {
    let scratch = Scratch::new("camera-errors");
    let recording = recording(scratch.path());
    let error = |options: &CameraOptions| render_camera_sequence(&recording, options, &|_, _| ()).unwrap_err();
    let unknown = error(&options(scratch.path(), "stil"));
    assert!(unknown.to_string().contains("still, keyed, behind, eyes, absent, default"), "{unknown}");
    let absent = error(&options(scratch.path(), "absent"));
    assert!(matches!(absent, RenderError::UnknownCameraAgent { agent: 999, .. }), "{absent}");
    assert!(absent.to_string().contains("no agent 999; the recording has agents 0 to "), "{absent}");
    let left: Vec<_> = fs::read_dir(scratch.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    assert_eq!(left.len(), 1, "no frame is left: {left:?}");
    let body_m = sample(&recording, 0.0).unwrap()[2].root.position_m;
    let inside = CameraSpec { eye_m: Some(body_m.extend(1.5)), look_at_m: Some(Vec3::Z), ..cameras()[0].clone() };
    let inside = error(&CameraOptions { cameras: Some(vec![inside]), ..options(scratch.path(), "still") });
    assert!(matches!(inside, RenderError::EyeInside { frame: 1001, .. }), "{inside}");
    assert!(inside.to_string().contains("inside agent 2 in frame"), "{inside}");
}

/// One agent at rest height in the picture, from a direction; sixteen samples.
pub(crate) fn portrait(recording: &Recording, turn_rad: f32, size_px: [u32; 2]) -> Pixmap {
    let quality = Quality { samples: SamplePattern::Sixteen, ..Quality::default() };
    let view = CameraView::new(recording.header(), recording.population(), quality, ColourBy::Agent);
    let bodies = sample(recording, 0.4).unwrap();
    let body = bodies[3];
    let middle_m = body.root.position_m.extend(0.9);
    let (sin, cos) = libm::sincosf(body.root.facing_rad + turn_rad);
    let eye_m = middle_m + Vec3::new(6.0 * cos, 6.0 * sin, 0.7);
    let lens = Lens::perspective(size_px, eye_m, middle_m, 2.1 / 6.0 * size_px[0] as f32 / size_px[1] as f32);
    view.draw(&Shot { lens, time_s: 0.4, eyes_of: None, fog_m: None }, &[body], &ExtraFrame::default()).to_display()
}

#[test]
fn figures_of_all_sizes_have_no_gap() {
    let scratch = Scratch::new("figure");
    let recording = recording(scratch.path());
    // From the front, a line through neck, trunk and pelvis shows the body alone, never the ground behind.
    for height in [40, 60, 140, 420] {
        let picture = portrait(&recording, 0.0, [height / 2, height]);
        let column = |y: u32| picture.pixel(height / 4, y).unwrap();
        let ground = column(height - 1);
        let differs = |y: u32| {
            let pixel = column(y);
            let distance = |one: u8, other: u8| u32::from(one.abs_diff(other));
            distance(pixel.red(), ground.red()) + distance(pixel.blue(), ground.blue()) > 24
        };
        let (neck, pelvis) = (height * 21 / 100, height * 48 / 100);
        assert!((neck..pelvis).all(differs), "{height} px");
    }
}

#[test]
fn agents_are_drawn_at_their_stature() {
    let header = support::circle(12, 4.0, View::default());
    let agents = support::frame(&header, 0.0);
    let top_m = |stature: f32, distance_m: f32| {
        let mut population = Population::of(&header.scenario);
        population.agents.iter_mut().for_each(|life| life.stature = stature);
        let view = CameraView::new(&header, &population, Quality::default(), ColourBy::Agent);
        let lens = Lens::perspective([640, 360], Vec3::new(0.0, -distance_m, 1.6), Vec3::Z, 1.0);
        let scene =
            view.scene(&Shot { lens, time_s: 0.0, eyes_of: None, fog_m: None }, &agents, &ExtraFrame::default());
        let of_cones = scene.cones.iter().flat_map(|cone| cone.ends_m.map(|end_m| end_m.z + cone.radii_m[0]));
        let meshes = &scene.meshes;
        let bodies = meshes.triangles.iter().enumerate();
        let bodies = bodies.filter(|(triangle, _)| meshes.owners.of(*triangle).agent != Owner::NO_AGENT);
        let corners = bodies.flat_map(|(_, corners)| corners.map(|corner| meshes.positions_m[corner as usize].z));
        corners.chain(of_cones).fold(0.0, f32::max)
    };
    // As surfaces, and far away as cones. The head of a child is large for its body.
    for distance_m in [6.0, 60.0] {
        let [adult_m, child_m] = [1.0, 0.6].map(|stature| top_m(stature, distance_m));
        assert!((1.6..2.0).contains(&adult_m), "{adult_m}");
        assert!((0.6 * adult_m..0.72 * adult_m).contains(&child_m), "{adult_m} {child_m}");
    }
}

//! Passes of a camera frame: the same bytes on any number of threads, and what they show.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use exr::prelude::{FlatSamples, ReadChannels, ReadLayers, read};
use fbcrowd_render::camera::{CameraOptions, render_camera_sequence};
use fbcrowd_render::passes::{ColourSpace, ExrCompression};
use fbcrowd_render::top_view::PictureFormat;
use fbcrowd_sim::recording::Recording;
use fbcrowd_sim::scenario::CameraSpec;
use glam::Vec3;

use crate::support::{self, Scratch};

/// Options of one frame with all passes.
fn options(folder: &Path) -> CameraOptions {
    let camera = CameraSpec {
        name: "still".to_owned(),
        focal_mm: Some(30.0),
        eye_m: Some(Vec3::new(-2.0, -6.0, 1.65)),
        look_at_m: Some(Vec3::new(0.0, 0.0, 1.0)),
        ..CameraSpec::default()
    };
    CameraOptions {
        folder: folder.to_owned(),
        name: "walkers".to_owned(),
        frames: Some("1005".parse().unwrap()),
        cameras: Some(vec![camera]),
        size_px: Some([192, 108]),
        format: PictureFormat::Exr,
        passes: "all".parse().unwrap(),
        ..CameraOptions::default()
    }
}

/// The bytes of the frame, drawn on a number of threads.
fn frame(scratch: &Scratch, options: &CameraOptions, threads: usize) -> Vec<u8> {
    let path = scratch.path().join("walkers.fbrec");
    support::write_recording(&path);
    let recording = Recording::open(&path).unwrap();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    let written = pool.install(|| render_camera_sequence(&recording, options, &|_, _| ())).unwrap();
    fs::read(&written[0]).unwrap()
}

/// The channels of a file by name, as f32; ids as bits.
fn channels(bytes: &[u8]) -> BTreeMap<String, Vec<f32>> {
    let image = read().no_deep_data().largest_resolution_level().all_channels().first_valid_layer();
    let image = image.all_attributes().from_buffered(std::io::Cursor::new(bytes)).unwrap();
    let values = |samples: &FlatSamples| match samples {
        FlatSamples::U32(ids) => ids.iter().map(|id| f32::from_bits(*id)).collect(),
        others => others.values_as_f32().collect(),
    };
    let channels = image.layer_data.channel_data.list.iter();
    channels.map(|channel| (channel.name.to_string(), values(&channel.sample_data))).collect()
}

/// The value of a channel, by its name, for each pixel.
fn pixels(channels: &BTreeMap<String, Vec<f32>>) -> impl Iterator<Item = impl Fn(&str) -> f32> {
    (0..192 * 108).map(move |pixel| move |name: &str| channels[name][pixel])
}

#[test]
fn passes_do_not_depend_on_threads() {
    let scratch = Scratch::new("passes-threads");
    let options = options(scratch.path());
    assert!(frame(&scratch, &options, 1) == frame(&scratch, &options, 3));
}

#[test]
fn compression_changes_no_value_and_colour_space_no_pass() {
    let scratch = Scratch::new("passes-compression");
    let own = options(scratch.path());
    let once = channels(&frame(&scratch, &own, 2));
    for compression in [ExrCompression::Zip1, ExrCompression::Rle, ExrCompression::Piz, ExrCompression::Uncompressed] {
        let options = CameraOptions { compression, ..own.clone() };
        assert!(once == channels(&frame(&scratch, &options, 2)), "{compression:?}");
    }
    let aces = channels(&frame(&scratch, &CameraOptions { colour_space: ColourSpace::AcesCg, ..own }, 2));
    let changed: Vec<&String> = once.keys().filter(|name| once[*name] != aces[*name]).collect();
    assert_eq!(changed, ["B", "G", "R"]);
}

#[test]
fn mattes_cover_what_ids_show() {
    let scratch = Scratch::new("passes-mattes");
    let channels = channels(&frame(&scratch, &options(scratch.path()), 2));
    let (mut id_of_agent, mut bodies) = (BTreeMap::new(), 0);
    for of in pixels(&channels) {
        let ranks = ["00.R", "00.B", "01.R", "01.B"].map(|side| of(&format!("CryptoAsset{side}")));
        let covered = ["00.G", "00.A", "01.G", "01.A"].map(|side| of(&format!("CryptoAsset{side}")));
        let sum: f32 = covered.iter().sum();
        assert!(covered.is_sorted_by(|a, b| a >= b) && (0.0..=1.0).contains(&sum), "{covered:?}");
        let agent = of("agent.id").to_bits();
        assert!(agent == 0 || sum > 0.0);
        if agent > 0 && covered[0] == 1.0 {
            // A pixel of one agent alone.
            bodies += 1;
            assert_eq!(*id_of_agent.entry(agent).or_insert(ranks[0].to_bits()), ranks[0].to_bits());
            assert!(of("Z") < 20.0 && Vec3::new(of("N.X"), of("N.Y"), of("N.Z")).length() > 0.99);
        }
    }
    let ids: std::collections::BTreeSet<u32> = id_of_agent.values().copied().collect();
    assert!(bodies > 200 && ids.len() > 1 && ids.len() == id_of_agent.len(), "{bodies} pixels, {id_of_agent:?}");
}

#[test]
fn motion_is_that_of_the_bodies_alone() {
    let scratch = Scratch::new("passes-motion");
    let channels = channels(&frame(&scratch, &options(scratch.path()), 2));
    let (mut forward, mut sum, mut count) = (0.0_f32, 0.0_f32, 0.0_f32);
    for of in pixels(&channels) {
        let [before, after] = ["backward", "forward"].map(|layer| of(&format!("{layer}.u")));
        if of("agent.id").to_bits() == 0 {
            assert!(before.abs() < 1e-2 && after.abs() < 1e-2, "the camera and the ground stand");
            continue;
        }
        (forward, sum, count) = (forward + after.abs(), sum + (before + after).abs(), count + 1.0);
    }
    assert!(forward / count > 0.3 && sum < 0.3 * forward, "{forward} {sum} {count}");
}

//! How much memory the frames of a sequence need, reckoned before they are drawn. Bytes.
//!
//! The meshes of a frame are the greatest part: those of a thousand bodies near the eye take some hundred megabytes. A few
//! frames of the sequence are read to find out how large they are.
//!
//! Measured with `/usr/bin/time` over 42 inputs: 0.4 to 33 megapixels, 4 and 16 samples, 1 to 1,000 bodies, characters, PNG
//! and EXR, passes, blur. The process took 0.5 to 1.04 times the estimate before its margin.

use crate::camera::take::{Moment, Take};
use crate::passes::multi_channel_exr::STRIP_PIXELS;
use crate::passes::pass::Pass;
use crate::passes::tile_passes::channels;
use crate::top_view::sequence::PictureFormat;
use crate::visibility::MeshSize;

/// Bytes of a PNG frame for each pixel while it is drawn: its light.
const PIXEL_BYTES: usize = 12;
/// Further bytes for each pixel while it is encoded; the meshes are gone then.
const ENCODED_BYTES: usize = 8;
/// Further bytes of a blurred frame for each pixel: the sum of light.
const BLUR_BYTES: usize = 16;
/// Bytes of each matte of a blurred frame, for each pixel.
const MATTE_BYTES: usize = 20;
/// Bytes of each pixel and channel of the strip of an EXR frame that is drawn and compressed: values, lines, file.
const STRIP_BYTES: usize = 6;
/// Bytes of a frame for its shadow map, its cones, and lists of parts.
const FRAME_BYTES: usize = 96 << 20;
/// Bytes of a vertex: position, normal, colour, texture coordinates, position in the picture.
const VERTEX_BYTES: usize = 52;
/// Bytes of a triangle: corners, paint, and what is drawn of it.
const TRIANGLE_BYTES: usize = 24;
/// Bytes of a vertex in the frames before and after, for the motion pass.
const MOTION_BYTES: usize = 24;
/// The estimate is raised by one part in this number, which covers all that was measured.
const MARGIN: usize = 12;
/// Greatest number of frames that are read, at even steps, beside the last one.
const READ_FRAMES: usize = 7;

/// Memory of the largest of some frames, bytes: an estimate, seldom too low.
pub(crate) fn frame_bytes(take: &Take<'_>, numbers: &[u32]) -> usize {
    let step = numbers.len().div_ceil(READ_FRAMES).max(1);
    let read = numbers.iter().step_by(step).chain(numbers.last());
    let meshes_bytes = read.map(|number| meshes_bytes(take, *number)).max().unwrap_or(0);
    let encoded_bytes = if take.options.format == PictureFormat::Png { ENCODED_BYTES * pixels(take) } else { 0 };
    let bytes = FRAME_BYTES + picture_bytes(take) + meshes_bytes.max(encoded_bytes);
    bytes + bytes / MARGIN
}

/// Memory of the meshes of a frame; 0 where it cannot be read: it fails when it is drawn.
fn meshes_bytes(take: &Take<'_>, number: u32) -> usize {
    let Ok(Moment { shot, agents, .. }) = take.moment(take.times.time_s(number), number) else { return 0 };
    let MeshSize { vertices, triangles } = take.view.mesh_size(&shot, &agents);
    let has_motion = take.options.format == PictureFormat::Exr && take.options.passes.holds(Pass::Motion);
    let motion_bytes = if has_motion { MOTION_BYTES } else { 0 };
    // A blurred EXR frame holds the meshes of its own time and those of a moment.
    let scenes = if take.is_blurred() && take.options.format == PictureFormat::Exr { 2 } else { 1 };
    scenes * (vertices * VERTEX_BYTES + triangles * TRIANGLE_BYTES) + vertices * motion_bytes
}

fn picture_bytes(take: &Take<'_>) -> usize {
    let options = take.options;
    let blur_bytes = if take.is_blurred() { BLUR_BYTES + MATTE_BYTES * options.passes.mattes().count() } else { 0 };
    let pixels = pixels(take);
    match options.format {
        PictureFormat::Png => (PIXEL_BYTES + blur_bytes) * pixels,
        PictureFormat::Exr => {
            let channels = 4 + channels(&options.passes, options.quality.samples.count()).len();
            blur_bytes * pixels + STRIP_BYTES * channels * STRIP_PIXELS.min(pixels)
        }
    }
}

fn pixels(take: &Take<'_>) -> usize {
    take.size_px.iter().map(|side| *side as usize).product()
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use fbcrowd_sim::recording::Recording;

    use super::*;
    use crate::camera::options::CameraOptions;

    #[test]
    fn meshes_are_as_large_as_reckoned() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden");
        let recording = Recording::open(&folder.join("walkers.fbrec")).unwrap();
        for size_px in [[64, 36], [640, 360], [3840, 2160]] {
            let options = CameraOptions { size_px: Some(size_px), ..CameraOptions::default() };
            let take = Take::new(&recording, &options).unwrap();
            let number = take.times.first_frame;
            let Moment { shot, agents, extra } = take.moment(take.times.time_s(number), number).unwrap();
            let size = take.view.scene(&shot, &agents, &extra).meshes.size();
            assert_eq!(take.view.mesh_size(&shot, &agents), size);
            let expected = size.vertices * VERTEX_BYTES + size.triangles * TRIANGLE_BYTES;
            assert_eq!(meshes_bytes(&take, number), expected);
        }
    }
}

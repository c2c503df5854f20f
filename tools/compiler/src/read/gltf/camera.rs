//! Cameras of a glTF file: lens, and position and axes over time. glTF's axes are y up; ours are z up: (x, −z, y). Metres.
//!
//! All animations play at once, since some programs export one for each object. A camera looks along −z of its node, y
//! is up.

use std::fs::File;
use std::path::Path;

use glam::{DMat4, DVec3};
use gltf::json::Root;

use crate::error::{Rejection, RejectionReason};
use crate::read::gltf::buffers::Outside;
use crate::read::gltf::document::Document;
use crate::read::gltf::key_track::KeyTrack;
use crate::read::gltf::node_transform::NodeTransform;
use crate::read::gltf::node_tree::NodeTree;
use crate::read::gltf::sampling::key_tracks;
use crate::read::malformed::malformed;

/// Keys a second: lines between them differ from any camera's path by less than a millimetre.
const KEYS_PER_S: f64 = 60.0;
/// Greatest number of keys of one camera: some minutes.
const KEYS_MAX: usize = 100_000;
/// Time before a step at which the former value ends, s.
const STEP_S: f64 = 5e-4;

/// The lens of a camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum GltfLens {
    /// Height over distance, and width over height where the file states it.
    Perspective {
        /// Height of the picture over its distance.
        height_tangent: f64,
        /// Width over height.
        aspect: Option<f64>,
    },
    /// Width of the picture, m.
    Orthographic {
        /// Width, m.
        width_m: f64,
    },
}

/// Where a camera is at a time. World, z up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GltfCameraKey {
    /// Time, s.
    pub time_s: f64,
    /// Position, m.
    pub eye_m: DVec3,
    /// Unit vector along the view.
    pub forward: DVec3,
    /// Unit vector up in the picture.
    pub up: DVec3,
}

/// A camera of a glTF file.
#[derive(Clone, Debug, PartialEq)]
pub struct GltfCamera {
    /// Name of its node; else of the camera.
    pub name: String,
    /// Its lens.
    pub lens: GltfLens,
    /// At least one; several by rising time of a camera that moves, between which it moves in straight lines.
    pub keys: Vec<GltfCameraKey>,
}

/// All cameras of a GLB or glTF file, in the order of its nodes.
///
/// # Errors
/// Where the file breaks the format, or a camera has no lens.
pub fn read_cameras(path: &Path, outside: Outside) -> Result<Vec<GltfCamera>, Rejection> {
    let rejected = |reason| Rejection { file: path.display().to_string(), clip: String::new(), reason };
    let unreadable = |error: std::io::Error| {
        rejected(RejectionReason::Malformed {
            position: "file".to_owned(),
            problem: error.to_string(),
            remedy: "name a GLB or glTF file that can be read",
        })
    };
    let mut file = File::open(path).map_err(unreadable)?;
    let document = Document::open(path, &mut file, outside).map_err(rejected)?;
    cameras(&document).map_err(rejected)
}

fn cameras(document: &Document) -> Result<Vec<GltfCamera>, RejectionReason> {
    let tree = NodeTree::new(&document.root)?;
    let rest = document.rest_transforms();
    let mut cameras = Vec::new();
    for (slot, &node) in tree.order.iter().enumerate() {
        let Some(camera) = document.root.nodes[node].camera else { continue };
        let chain = NodeChain::new(&tree, slot);
        let tracks = chain.tracks(document, tree.order.len())?;
        let name = name(&document.root, node, camera.value());
        let lens = lens(&document.root, camera.value(), &name)?;
        let keys = chain.keys(&tracks, &rest).map_or_else(|problem| out_of_range(&name, problem), Ok)?;
        cameras.push(GltfCamera { name, lens, keys });
    }
    Ok(cameras)
}

fn out_of_range<T>(name: &str, problem: &str) -> Result<T, RejectionReason> {
    malformed(format!("camera {name:?}"), problem, "export it again from a scene in metres")
}

fn name(root: &Root, node: usize, camera: usize) -> String {
    let of_camera = || root.cameras.get(camera).and_then(|camera| camera.name.clone());
    let name = root.nodes[node].name.clone().or_else(of_camera).filter(|name| !name.is_empty());
    name.unwrap_or_else(|| format!("camera_{camera}"))
}

fn lens(root: &Root, camera: usize, name: &str) -> Result<GltfLens, RejectionReason> {
    let Some(camera) = root.cameras.get(camera) else {
        return out_of_range(name, "its node names none of the cameras");
    };
    if let Some(perspective) = &camera.perspective {
        let (yfov, aspect) = (f64::from(perspective.yfov), perspective.aspect_ratio.map(f64::from));
        if !(1e-3..3.0).contains(&yfov) || aspect.is_some_and(|aspect| !(1e-2..=1e2).contains(&aspect)) {
            return out_of_range(name, "its field of view or aspect ratio is out of range");
        }
        return Ok(GltfLens::Perspective { height_tangent: 2.0 * libm::tan(0.5 * yfov), aspect });
    }
    match camera.orthographic.as_ref().map(|lens| 2.0 * f64::from(lens.xmag).abs()) {
        Some(width_m) if (0.05..=20_000.0).contains(&width_m) => Ok(GltfLens::Orthographic { width_m }),
        Some(_) => out_of_range(name, "its width is out of range"),
        None => out_of_range(name, "it has no lens"),
    }
}

/// The nodes from a root to a camera.
struct NodeChain {
    nodes: Vec<usize>,
}

impl NodeChain {
    fn new(tree: &NodeTree, slot: usize) -> Self {
        let slots = std::iter::successors(Some(slot), |slot| tree.parents[*slot]);
        let mut nodes: Vec<usize> = slots.map(|slot| tree.order[slot]).collect();
        nodes.reverse();
        Self { nodes }
    }

    /// The tracks of all animations that move these nodes.
    fn tracks(&self, document: &Document, nodes: usize) -> Result<Vec<KeyTrack>, RejectionReason> {
        let mut is_member = vec![false; nodes];
        self.nodes.iter().for_each(|node| is_member[*node] = true);
        let tracks = (0..document.root.animations.len()).map(|animation| key_tracks(document, animation, &is_member));
        Ok(tracks
            .collect::<Result<Vec<_>, _>>()?
            .into_iter()
            .flatten()
            .filter(|track| !track.times_s().is_empty())
            .collect())
    }

    /// Keys over the time of the tracks; one where nothing moves.
    fn keys(&self, tracks: &[KeyTrack], rest: &[NodeTransform]) -> Result<Vec<GltfCameraKey>, &'static str> {
        let ends = tracks.iter().flat_map(|track| [track.times_s()[0], track.times_s()[track.times_s().len() - 1]]);
        let [start_s, end_s] = ends
            .map(f64::from)
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], time_s| [low.min(time_s), high.max(time_s)]);
        if tracks.is_empty() {
            return Ok(vec![self.key(0.0, tracks, rest)?]);
        }
        let count = ((end_s - start_s) * KEYS_PER_S).ceil();
        if !count.is_finite() || count >= KEYS_MAX as f64 {
            return Err("it moves for more than 27 minutes");
        }
        let mut times_s: Vec<f64> =
            (0..=count as u32).map(|key| (start_s + f64::from(key) / KEYS_PER_S).min(end_s)).collect();
        let steps_s = tracks.iter().filter(|track| track.is_step()).flat_map(|track| track.times_s());
        times_s.extend(
            steps_s.flat_map(|time_s| [f64::from(*time_s) - STEP_S, f64::from(*time_s)]).filter(|at| *at >= start_s),
        );
        times_s.sort_by(f64::total_cmp);
        times_s.dedup_by(|next, kept| *next - *kept < 0.2 * STEP_S);
        if times_s.len() > KEYS_MAX {
            return Err("it has more than 100,000 keys");
        }
        times_s.into_iter().map(|time_s| self.key(time_s, tracks, rest)).collect()
    }

    fn key(&self, time_s: f64, tracks: &[KeyTrack], rest: &[NodeTransform]) -> Result<GltfCameraKey, &'static str> {
        let mut global = DMat4::IDENTITY;
        for node in &self.nodes {
            let mut local = rest[*node];
            tracks.iter().filter(|track| track.node == *node).for_each(|track| track.apply(time_s, &mut local));
            global *= DMat4::from_scale_rotation_translation(local.scale, local.rotation, local.translation);
        }
        let z_up = |vector: DVec3| DVec3::new(vector.x, -vector.z, vector.y);
        let eye_m = z_up(global.w_axis.truncate());
        let axis = |axis: DVec3| z_up(axis).try_normalize().ok_or("its node is scaled to nothing");
        let (forward, up) = (axis(-global.z_axis.truncate())?, axis(global.y_axis.truncate())?);
        if !eye_m.is_finite() || eye_m.abs().max_element() > 10_000.0 {
            return Err("it is farther than 10 km from the origin");
        }
        Ok(GltfCameraKey { time_s, eye_m, forward, up })
    }
}

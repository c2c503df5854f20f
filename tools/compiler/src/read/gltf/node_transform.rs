//! Transform of a node in its parent's frame.

use glam::{DMat4, DQuat, DVec3};
use gltf::json;

/// Least length of a quaternion that has a direction.
const MIN_QUATERNION: f64 = 1e-12;

/// A transform: scale first, then rotation, then translation.
#[derive(Clone, Copy, Debug)]
pub(crate) struct NodeTransform {
    pub translation: DVec3,
    pub rotation: DQuat,
    pub scale: DVec3,
}

impl NodeTransform {
    /// The transform that a node states. A matrix loses its shear, which glTF does not allow.
    pub(crate) fn of_node(node: &json::Node) -> Self {
        let vector =
            |value: Option<[f32; 3]>, default| value.map_or(default, |value| DVec3::from_array(value.map(f64::from)));
        if let Some(matrix) = node.matrix {
            let matrix = DMat4::from_cols_array(&matrix.map(f64::from));
            let (scale, rotation, translation) = matrix.to_scale_rotation_translation();
            return Self { translation, rotation: finite(rotation), scale };
        }
        let rotation = node.rotation.map_or(DQuat::IDENTITY, |turn| DQuat::from_array(turn.0.map(f64::from)));
        Self {
            translation: vector(node.translation, DVec3::ZERO),
            rotation: finite(rotation),
            scale: vector(node.scale, DVec3::ONE),
        }
    }
}

/// The unit quaternion along `rotation`; the identity where that has no length.
pub(crate) fn normalized(rotation: DQuat) -> DQuat {
    let length = rotation.length();
    if length > MIN_QUATERNION { rotation / length } else { DQuat::IDENTITY }
}

fn finite(rotation: DQuat) -> DQuat {
    if rotation.is_finite() { normalized(rotation) } else { DQuat::IDENTITY }
}

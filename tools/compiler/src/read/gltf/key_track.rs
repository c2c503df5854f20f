//! Keys of one property of one node, and its value at a time (glTF 2.0, Appendix C).

use glam::{DQuat, DVec3, DVec4};
use gltf::json::animation::Interpolation;

use crate::error::RejectionReason;
use crate::read::gltf::accessor::{self, AccessorNumbers};
use crate::read::gltf::document::Document;
use crate::read::gltf::node_channel::{NodeChannel, NodeProperty};
use crate::read::gltf::node_transform::{NodeTransform, normalized};
use crate::read::malformed::malformed;

/// A time at most this long before a key counts as the key's time, s: files round key times to f32, and stepped values
/// change at keys.
const KEY_ROUNDING_S: f64 = 1e-5;

/// Keys of one property of one node.
pub(crate) struct KeyTrack {
    pub node: usize,
    property: NodeProperty,
    interpolation: Interpolation,
    /// Key times in order, s. glTF forbids equal times, but tools write them: the value of the last such key holds.
    times_s: Vec<f32>,
    /// One vector or quaternion for each key; three (in-tangent, value, out-tangent) for cubic interpolation.
    values: Vec<f32>,
}

/// Reads the keys of a channel.
pub(crate) fn read(document: &Document, channel: &NodeChannel) -> Result<KeyTrack, RejectionReason> {
    let NodeChannel { node, property, interpolation, input, output } = *channel;
    let times = accessor::numbers(document, input, false)?;
    // Integers are always fractions where they are rotations.
    let AccessorNumbers { width, values } = accessor::numbers(document, output, property == NodeProperty::Rotation)?;
    let per_key = if interpolation == Interpolation::CubicSpline { 3 } else { 1 };
    let is_right_width = width == if property == NodeProperty::Rotation { 4 } else { 3 };
    let is_in_order = times.values.is_sorted();
    let is_finite = times.values.iter().chain(&values).all(|value| value.is_finite());
    let is_whole = values.len() == per_key * width * times.values.len();
    if times.width != 1 || !is_right_width || !is_in_order || !is_finite || !is_whole {
        let problem = "keys are not finite, in order and one value each (of a CUBICSPLINE three)";
        return malformed(format!("accessors {input} and {output}"), problem, "export the animation again");
    }
    Ok(KeyTrack { node, property, interpolation, times_s: times.values, values })
}

impl KeyTrack {
    /// Key times in order, s.
    pub(crate) fn times_s(&self) -> &[f32] {
        &self.times_s
    }

    /// Whether the value stays until the next key.
    pub(crate) fn is_step(&self) -> bool {
        self.interpolation == Interpolation::Step
    }

    /// Sets the track's property of its node's transform to the value at a time.
    pub(crate) fn apply(&self, time_s: f64, local: &mut NodeTransform) {
        match self.property {
            NodeProperty::Translation => local.translation = self.value(time_s).truncate(),
            NodeProperty::Scale => local.scale = self.value(time_s).truncate(),
            NodeProperty::Rotation => local.rotation = self.rotation(time_s),
        }
    }

    fn value(&self, time_s: f64) -> DVec4 {
        let interval = self.interval(time_s);
        match self.interpolation {
            Interpolation::Step => self.vector(interval.from),
            Interpolation::Linear => self.vector(interval.from).lerp(self.vector(interval.to), interval.share),
            Interpolation::CubicSpline => self.cubic(&interval),
        }
    }

    fn rotation(&self, time_s: f64) -> DQuat {
        let turn = |value: DVec4| normalized(DQuat::from_vec4(value));
        if self.interpolation != Interpolation::Linear {
            return turn(self.value(time_s));
        }
        let interval = self.interval(time_s);
        turn(self.vector(interval.from)).slerp(turn(self.vector(interval.to)), interval.share)
    }

    fn cubic(&self, interval: &KeyInterval) -> DVec4 {
        let [value, out_tangent, next, in_tangent] = interval.hermite_weights();
        value * self.vector(3 * interval.from + 1)
            + out_tangent * self.vector(3 * interval.from + 2)
            + next * self.vector(3 * interval.to + 1)
            + in_tangent * self.vector(3 * interval.to)
    }

    /// One vector of `values`; a fourth component that it lacks is 0.
    fn vector(&self, index: usize) -> DVec4 {
        match self.property {
            NodeProperty::Rotation => {
                let [x, y, z, w] = std::array::from_fn(|k| f64::from(self.values[4 * index + k]));
                DVec4::new(x, y, z, w)
            }
            _ => DVec3::from_array(std::array::from_fn(|k| f64::from(self.values[3 * index + k]))).extend(0.0),
        }
    }

    fn interval(&self, time_s: f64) -> KeyInterval {
        let next = self.times_s.partition_point(|&key_s| f64::from(key_s) <= time_s + KEY_ROUNDING_S);
        let last = self.times_s.len() - 1;
        let (from, to) = (next.saturating_sub(1).min(last), next.min(last));
        let [from_s, to_s] = [from, to].map(|key| f64::from(self.times_s[key]));
        let duration_s = to_s - from_s;
        let share = if duration_s > 0.0 { ((time_s - from_s) / duration_s).clamp(0.0, 1.0) } else { 0.0 };
        KeyInterval { from, to, share, duration_s }
    }
}

/// A time between two keys.
struct KeyInterval {
    from: usize,
    to: usize,
    /// Position between the keys: 0 at `from`, 1 at `to`.
    share: f64,
    duration_s: f64,
}

impl KeyInterval {
    /// Weights of the value, its out-tangent, the next value and its in-tangent.
    fn hermite_weights(&self) -> [f64; 4] {
        let (t, t2, t3) = (self.share, self.share * self.share, self.share * self.share * self.share);
        let duration = self.duration_s;
        [2.0 * t3 - 3.0 * t2 + 1.0, duration * (t3 - 2.0 * t2 + t), 3.0 * t2 - 2.0 * t3, duration * (t3 - t2)]
    }
}

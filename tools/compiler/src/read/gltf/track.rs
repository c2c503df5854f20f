//! One channel of a glTF animation: the keys of one property of one node, and its value at a time (glTF 2.0,
//! Appendix C).

use glam::{DQuat, DVec3, DVec4};
use gltf::json::animation::{Animation, Channel, Interpolation, Property};
use gltf::json::validation::Checked;

use crate::read::gltf::accessor::{self, Numbers};
use crate::read::gltf::document::{Document, Flaw, Transform, flaw};

/// Key times are rounded to f32 in the file; a sample this short before a key is at it (matters where values step).
const KEY_ROUNDING_S: f64 = 1e-5;

/// Keys of one property of one node.
pub(crate) struct Track {
    pub node: usize,
    property: Driven,
    interpolation: Interpolation,
    /// Seconds, in order. Of keys at one time, which glTF forbids and tools write all the same, the last begins what
    /// follows.
    times_s: Vec<f32>,
    /// A vector or quaternion a key; three (in-tangent, value, out-tangent) where the interpolation is cubic.
    values: Vec<f32>,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Driven {
    Translation,
    Rotation,
    Scale,
}

/// The accessors of a channel that moves a node; none for morph targets.
pub(crate) struct Source {
    pub node: usize,
    property: Driven,
    interpolation: Interpolation,
    pub input: usize,
    pub output: usize,
}

/// What a channel of an animation drives, and by which accessors.
pub(crate) fn source(animation: &Animation, channel: &Channel) -> Result<Option<Source>, Flaw> {
    let property = match channel.target.path {
        Checked::Valid(Property::Translation) => Driven::Translation,
        Checked::Valid(Property::Rotation) => Driven::Rotation,
        Checked::Valid(Property::Scale) => Driven::Scale,
        // Morph targets, and whatever extensions add, move no joint.
        _ => return Ok(None),
    };
    let remedy = "check the file with the glTF validator";
    let Some(sampler) = animation.samplers.get(channel.sampler.value()) else {
        return flaw("channel", "it has no sampler", remedy);
    };
    let Checked::Valid(interpolation) = sampler.interpolation else {
        return flaw("sampler", "its interpolation is none of glTF's", remedy);
    };
    let node = channel.target.node.value();
    Ok(Some(Source { node, property, interpolation, input: sampler.input.value(), output: sampler.output.value() }))
}

/// Reads a channel's keys.
pub(crate) fn read(document: &Document, source: &Source) -> Result<Track, Flaw> {
    let Source { node, property, interpolation, input, output } = *source;
    let times = accessor::numbers(document, input, false)?;
    // Rotations may be integers, and those are always fractions.
    let Numbers { width, values } = accessor::numbers(document, output, property == Driven::Rotation)?;
    let per_key = if interpolation == Interpolation::CubicSpline { 3 } else { 1 };
    let is_right_width = width == if property == Driven::Rotation { 4 } else { 3 };
    let is_in_order = times.values.is_sorted();
    let is_finite = times.values.iter().chain(&values).all(|value| value.is_finite());
    let is_whole = values.len() == per_key * width * times.values.len();
    if times.width != 1 || !is_right_width || !is_in_order || !is_finite || !is_whole {
        let problem = "keys are not finite, in order and one value each";
        return flaw(format!("accessors {input} and {output}"), problem, "export the animation again");
    }
    Ok(Track { node, property, interpolation, times_s: times.values, values })
}

impl Track {
    /// Sets what the track drives in its node's transform.
    pub(crate) fn apply(&self, time_s: f64, local: &mut Transform) {
        match self.property {
            Driven::Translation => local.translation = self.value(time_s).truncate(),
            Driven::Scale => local.scale = self.value(time_s).truncate(),
            Driven::Rotation => local.rotation = self.rotation(time_s),
        }
    }

    fn value(&self, time_s: f64) -> DVec4 {
        let key = self.key(time_s);
        match self.interpolation {
            Interpolation::Step => self.at(key.from),
            Interpolation::Linear => self.at(key.from).lerp(self.at(key.to), key.share),
            Interpolation::CubicSpline => self.spline(&key),
        }
    }

    fn rotation(&self, time_s: f64) -> DQuat {
        let turn = |value: DVec4| normal(DQuat::from_vec4(value));
        if self.interpolation != Interpolation::Linear {
            return turn(self.value(time_s));
        }
        let key = self.key(time_s);
        turn(self.at(key.from)).slerp(turn(self.at(key.to)), key.share)
    }

    fn spline(&self, key: &Key) -> DVec4 {
        let [value, out, next, into] = key.hermite();
        value * self.at(3 * key.from + 1)
            + out * self.at(3 * key.from + 2)
            + next * self.at(3 * key.to + 1)
            + into * self.at(3 * key.to)
    }

    /// One vector of the values; of three numbers the last is 0.
    fn at(&self, index: usize) -> DVec4 {
        match self.property {
            Driven::Rotation => {
                let [x, y, z, w] = std::array::from_fn(|k| f64::from(self.values[4 * index + k]));
                DVec4::new(x, y, z, w)
            }
            _ => DVec3::from_array(std::array::from_fn(|k| f64::from(self.values[3 * index + k]))).extend(0.0),
        }
    }

    fn key(&self, time_s: f64) -> Key {
        let next = self.times_s.partition_point(|&key_s| f64::from(key_s) <= time_s + KEY_ROUNDING_S);
        let last = self.times_s.len() - 1;
        let (from, to) = (next.saturating_sub(1).min(last), next.min(last));
        let [from_s, to_s] = [from, to].map(|key| f64::from(self.times_s[key]));
        let span_s = to_s - from_s;
        let share = if span_s > 0.0 { ((time_s - from_s) / span_s).clamp(0.0, 1.0) } else { 0.0 };
        Key { from, to, share, span_s }
    }
}

/// Where a time lies between two keys.
struct Key {
    from: usize,
    to: usize,
    share: f64,
    span_s: f64,
}

impl Key {
    /// Weights of value, out-tangent, next value, its in-tangent.
    fn hermite(&self) -> [f64; 4] {
        let (t, t2, t3) = (self.share, self.share * self.share, self.share * self.share * self.share);
        let span = self.span_s;
        [2.0 * t3 - 3.0 * t2 + 1.0, span * (t3 - 2.0 * t2 + t), 3.0 * t2 - 2.0 * t3, span * (t3 - t2)]
    }
}

pub(crate) fn normal(rotation: DQuat) -> DQuat {
    let length = rotation.length();
    if length > 1e-12 { rotation / length } else { DQuat::IDENTITY }
}

//! Channels of an animation that move nodes: the property that they drive, and the accessors of their keys.

use gltf::json::animation::{Animation, Channel, Interpolation, Property};
use gltf::json::validation::Checked;

use crate::error::RejectionReason;
use crate::read::malformed::malformed;

/// Remedy for a document that breaks its specification.
pub(crate) const VALIDATE: &str = "check the file with the glTF validator";

/// A channel that drives one property of one node.
pub(crate) struct NodeChannel {
    pub node: usize,
    pub property: NodeProperty,
    pub interpolation: Interpolation,
    /// Accessor of the key times.
    pub input: usize,
    /// Accessor of the keys' values.
    pub output: usize,
}

/// A property of a node that moves it.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum NodeProperty {
    Translation,
    Rotation,
    Scale,
}

/// The channel as one that moves a node; none for morph targets and for what extensions add.
pub(crate) fn moving_channel(animation: &Animation, channel: &Channel) -> Result<Option<NodeChannel>, RejectionReason> {
    let property = match channel.target.path {
        Checked::Valid(Property::Translation) => NodeProperty::Translation,
        Checked::Valid(Property::Rotation) => NodeProperty::Rotation,
        Checked::Valid(Property::Scale) => NodeProperty::Scale,
        _ => return Ok(None),
    };
    let Some(sampler) = animation.samplers.get(channel.sampler.value()) else {
        return malformed("channel", "it has no sampler", VALIDATE);
    };
    let Checked::Valid(interpolation) = sampler.interpolation else {
        return malformed("sampler", "its interpolation is none of glTF's", VALIDATE);
    };
    let node = channel.target.node.value();
    Ok(Some(NodeChannel {
        node,
        property,
        interpolation,
        input: sampler.input.value(),
        output: sampler.output.value(),
    }))
}

/// The channels that move the nodes that `is_member` marks.
pub(crate) fn moving_channels(animation: &Animation, is_member: &[bool]) -> Result<Vec<NodeChannel>, RejectionReason> {
    let mut channels = Vec::new();
    for channel in &animation.channels {
        let Some(channel) = moving_channel(animation, channel)? else { continue };
        match is_member.get(channel.node) {
            Some(true) => channels.push(channel),
            Some(false) => {}
            None => return malformed("channel", "its node does not exist", VALIDATE),
        }
    }
    Ok(channels)
}

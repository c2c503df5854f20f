//! The channels of a whole frame, gathered from its tiles.

use std::collections::{BTreeMap, BTreeSet};

use exr::prelude::{FlatSamples, f16};
use fbcrowd_sim::Population;

use crate::passes::cryptomatte::{layer_key, manifest};
use crate::passes::pass::{Pass, PassSet};
use crate::passes::tile_passes::{
    Channel, ChannelKind, GROUND_MATERIAL, agent_name, group_name, material_name, matte_layer,
};
use crate::visibility::{Owner, SceneParts, TILE_PX};

/// A channel of a frame, row by row.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ChannelPicture {
    pub(crate) name: String,
    pub(crate) samples: FlatSamples,
}

/// The channels of a picture from the values of its tiles, row by row.
pub(crate) fn gathered(size_px: [u32; 2], channels: &[Channel], tiles: &[Vec<f32>]) -> Vec<ChannelPicture> {
    let values = |channel: usize| values_of(size_px, channels.len(), channel, tiles);
    let gather = |(index, channel): (usize, &Channel)| {
        let samples = match channel.kind {
            ChannelKind::Half => FlatSamples::F16(values(index).map(f16::from_f32).collect()),
            ChannelKind::Float => FlatSamples::F32(values(index).collect()),
            ChannelKind::Uint => FlatSamples::U32(values(index).map(f32::to_bits).collect()),
        };
        ChannelPicture { name: channel.name.clone(), samples }
    };
    channels.iter().enumerate().map(gather).collect()
}

/// The values of one channel, row by row.
fn values_of(size_px: [u32; 2], count: usize, channel: usize, tiles: &[Vec<f32>]) -> impl Iterator<Item = f32> + '_ {
    let ([width, height], side) = (size_px.map(|side| side as usize), TILE_PX as usize);
    let columns = width.div_ceil(side);
    (0..height).flat_map(move |y| {
        (0..width).map(move |x| {
            let tile_width = side.min(width - x / side * side);
            let pixel = y % side * tile_width + x % side;
            tiles[y / side * columns + x / side][pixel * count + channel]
        })
    })
}

/// The metadata of the mattes: attributes of the header by name.
pub(crate) fn matte_metadata(passes: &PassSet, scene: &SceneParts, population: &Population) -> Vec<(String, String)> {
    let mut metadata = Vec::new();
    for pass in Pass::ALL.into_iter().filter(|pass| passes.holds(*pass)) {
        let Some(layer) = matte_layer(pass) else { continue };
        let prefix = format!("cryptomatte/{}", layer_key(layer));
        let values = [
            ("name", layer.to_owned()),
            ("hash", "MurmurHash3_32".to_owned()),
            ("conversion", "uint32_to_float32".to_owned()),
            ("manifest", manifest(&names(pass, scene, population))),
        ];
        metadata.extend(values.into_iter().map(|(key, value)| (format!("{prefix}/{key}"), value)));
    }
    metadata
}

/// Names of all that a matte may hold in a frame, by number.
fn names(pass: Pass, scene: &SceneParts, population: &Population) -> BTreeMap<u32, String> {
    let owners = scene.cones.iter().map(|cone| cone.owner).chain(scene.meshes.owners.iter().copied());
    if pass == Pass::Material {
        let materials: BTreeSet<u32> = owners.map(|owner| owner.material).chain([GROUND_MATERIAL]).collect();
        return materials.into_iter().map(|material| (material, material_name(material))).collect();
    }
    let agents: BTreeSet<u32> = owners.map(|owner| owner.agent).filter(|agent| *agent != Owner::NO_AGENT).collect();
    if pass == Pass::Agent {
        return agents.into_iter().map(|agent| (agent, agent_name(agent))).collect();
    }
    let group = |agent: u32| population.agents.get(agent as usize)?.group;
    agents.into_iter().filter_map(group).map(|group| (group, group_name(group))).collect()
}

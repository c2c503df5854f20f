//! Names and ids of all that the mattes of a frame hold, and their metadata.

use std::collections::BTreeSet;

use fbcrowd_sim::Population;

use crate::passes::cryptomatte::{id_bits, layer_key, manifest};
use crate::passes::pass::{Pass, PassSet};
use crate::visibility::{Owner, SceneParts};

/// Material of the ground, which has no part of its own.
pub(crate) const GROUND_MATERIAL: u32 = u32::MAX;

/// Numbers of what a frame shows.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Matted {
    agents: BTreeSet<u32>,
    groups: BTreeSet<u32>,
    materials: BTreeSet<u32>,
}

/// Bits of the ids of a frame's mattes.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct MatteIds {
    /// Of each agent of the frame, by number.
    agents: Vec<u32>,
    /// Of each group, by number.
    groups: Vec<u32>,
    /// Number and id of each material.
    materials: Vec<(u32, u32)>,
}

impl Matted {
    /// What a scene shows.
    pub(crate) fn new(scene: &SceneParts, population: &Population) -> Self {
        let mut owners: Vec<Owner> = scene.cones.iter().map(|cone| cone.owner).collect();
        owners.extend(scene.meshes.owners.distinct());
        // Parts of an agent follow each other.
        owners.dedup();
        let agents: BTreeSet<u32> =
            owners.iter().map(|owner| owner.agent).filter(|agent| *agent != Owner::NO_AGENT).collect();
        let group = |agent: &u32| population.agents.get(*agent as usize)?.group;
        let groups = agents.iter().filter_map(group).collect();
        let materials = owners.iter().map(|owner| owner.material).chain([GROUND_MATERIAL]).collect();
        Self { agents, groups, materials }
    }

    /// Adds what another scene shows.
    pub(crate) fn add(&mut self, other: &Self) {
        self.agents.extend(&other.agents);
        self.groups.extend(&other.groups);
        self.materials.extend(&other.materials);
    }

    /// The ids of all names.
    pub(crate) fn ids(&self) -> MatteIds {
        let table = |numbers: &BTreeSet<u32>, name: fn(u32) -> String| {
            let mut ids = vec![0; numbers.last().map_or(0, |last| *last as usize + 1)];
            numbers.iter().for_each(|number| ids[*number as usize] = id_bits(&name(*number)));
            ids
        };
        let material = |material: &u32| (*material, id_bits(&material_name(*material)));
        MatteIds {
            agents: table(&self.agents, agent_name),
            groups: table(&self.groups, group_name),
            materials: self.materials.iter().map(material).collect(),
        }
    }

    /// The metadata of the mattes: attributes of the header by name.
    pub(crate) fn metadata(&self, passes: &PassSet) -> Vec<(String, String)> {
        let mut metadata = Vec::new();
        for pass in passes.mattes() {
            let Some(layer) = matte_layer(pass) else { continue };
            let prefix = format!("cryptomatte/{}", layer_key(layer));
            let values = [
                ("name", layer.to_owned()),
                ("hash", "MurmurHash3_32".to_owned()),
                ("conversion", "uint32_to_float32".to_owned()),
                ("manifest", manifest(self.names(pass))),
            ];
            metadata.extend(values.into_iter().map(|(key, value)| (format!("{prefix}/{key}"), value)));
        }
        metadata
    }

    /// Names in a matte, by rising number.
    fn names(&self, pass: Pass) -> impl Iterator<Item = String> {
        let (numbers, name): (_, fn(u32) -> String) = match pass {
            Pass::Agent => (&self.agents, agent_name),
            Pass::Group => (&self.groups, group_name),
            _ => (&self.materials, material_name),
        };
        numbers.iter().map(move |number| name(*number))
    }
}

impl MatteIds {
    /// Id of an agent.
    pub(crate) fn agent(&self, agent: u32) -> Option<u32> {
        self.agents.get(agent as usize).copied()
    }

    /// Id of a group.
    pub(crate) fn group(&self, group: u32) -> Option<u32> {
        self.groups.get(group as usize).copied()
    }

    /// Id of a material.
    pub(crate) fn material(&self, material: u32) -> Option<u32> {
        self.materials.iter().find(|(known, _)| *known == material).map(|(_, id)| *id)
    }
}

/// Name of a Cryptomatte layer.
pub(crate) fn matte_layer(pass: Pass) -> Option<&'static str> {
    match pass {
        Pass::Agent => Some("CryptoAsset"),
        Pass::Group => Some("CryptoGroup"),
        Pass::Material => Some("CryptoMaterial"),
        _ => None,
    }
}

/// Name of an agent in mattes.
fn agent_name(agent: u32) -> String {
    format!("agent_{agent:04}")
}

/// Name of a group in mattes.
fn group_name(group: u32) -> String {
    format!("group_{group:04}")
}

/// Name of a material in mattes.
fn material_name(material: u32) -> String {
    match material {
        0 => "walls".to_owned(),
        1 => "bodies".to_owned(),
        GROUND_MATERIAL => "ground".to_owned(),
        other => format!("material_{other:04}"),
    }
}

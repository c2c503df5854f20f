//! Agents that wear a character: its skinned mesh, and rounded cones by which occlusion is computed. World, metres.

use fbcrowd_sim::recording::{AgentFrame, Header};
use glam::Vec3;
use motiondb::body::{JOINT_COUNT, Joint};
use motiondb::character::{Character, CharacterFit, JointTransform};

use crate::visibility::{Cone, Owner, SceneParts};

/// Material of characters.
const CHARACTER: u32 = 1;

/// The characters of a recording on its skeleton.
#[derive(Clone, Debug)]
pub(crate) struct Wardrobe<'a> {
    header: &'a Header,
    fits: Vec<CharacterFit<'a>>,
}

impl<'a> Wardrobe<'a> {
    /// Fits characters, in the recording's order, to its skeleton.
    pub(crate) fn new(header: &'a Header, characters: &'a [Character]) -> Self {
        let fits = characters.iter().map(|character| CharacterFit::new(character, header.skeleton())).collect();
        Self { header, fits }
    }

    /// Whether there is a character of this index.
    pub(crate) fn has(&self, character: u32) -> bool {
        (character as usize) < self.fits.len()
    }

    /// Appends the mesh of an agent that wears a character.
    pub(crate) fn append(&self, parts: &mut SceneParts, agent: &AgentFrame, character: u32) {
        let Some(fit) = self.fits.get(character as usize) else { return };
        let joints = agent.pose.forward_kinematics(self.header.skeleton());
        let mut transforms = Vec::new();
        fit.pose(self.header.skeleton(), &joints, agent.root.frame(), &mut transforms);
        let owner = Owner { agent: agent.id.0, material: CHARACTER };
        append_posed(parts, fit, &transforms, self.header.scenario.hue_turn_of(agent.id.0, character), owner);
    }
}

/// Appends the mesh and the capsules of a posed character.
pub(crate) fn append_posed(
    parts: &mut SceneParts,
    fit: &CharacterFit,
    transforms: &[JointTransform],
    hue_turn: f32,
    owner: Owner,
) {
    let (mut positions_m, mut normals, mut colours) = (Vec::new(), Vec::new(), Vec::new());
    let mesh = &fit.character.mesh;
    mesh.skin(transforms, &mut positions_m, &mut normals);
    mesh.tint(hue_turn, &mut colours);
    parts.meshes.append(&positions_m, &normals, &colours, &mesh.triangles, owner);
    append_capsules(parts, fit, transforms, owner);
}

/// The capsules of a character's segments; of a last segment a ball.
fn append_capsules(parts: &mut SceneParts, fit: &CharacterFit, transforms: &[JointTransform], owner: Owner) {
    let character = fit.character;
    let at_m: [Option<Vec3>; JOINT_COUNT] = Joint::ALL.map(|role| {
        let joint = character.joint(role)?;
        Some(transforms[joint].point_m(character.joints[joint].position_m))
    });
    for role in Joint::ALL {
        let radius_m = fit.scale * character.segment_radii_m[role.index()];
        let Some(start_m) = at_m[role.index()].filter(|_| radius_m > 0.0) else { continue };
        let below = Joint::ALL.into_iter().filter(|below| below.parent() == Some(role));
        let end_m = below.filter_map(|below| at_m[below.index()]).next();
        let ends_m = [start_m, end_m.unwrap_or(start_m + radius_m * Vec3::Z)];
        parts.occluders.push(Cone { ends_m, radii_m: [radius_m; 2], colour: Vec3::splat(0.5), owner });
    }
}

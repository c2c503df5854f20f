//! Agents that wear a character: its skinned mesh, and rounded cones by which occlusion is computed. World, metres.

use std::sync::Arc;

use fbcrowd_sim::recording::{AgentFrame, Header};
use glam::{Quat, Vec2, Vec3};
use motiondb::body::{ExtraJoint, JOINT_COUNT, Joint};
use motiondb::character::{Character, CharacterFit, CharacterTexture, Dye, JointTransform, Material};
use rayon::prelude::*;

use crate::detail::{Level, Levels};
use crate::visibility::{Cone, MeshSize, Owner, Paint, SceneParts, Texture};

/// Material of characters.
const CHARACTER: u32 = 1;

/// Greatest number of pixels of all textures; larger ones are halved: with their halves they take 700 MB.
const PIXELS_MAX: usize = 128 << 20;

/// The characters of a recording on its skeleton.
#[derive(Clone, Debug)]
pub(crate) struct Wardrobe<'a> {
    header: &'a Header,
    fits: Vec<CharacterFit<'a>>,
    /// Position of each extra joint in the recording's list; none where the recording lacks it.
    extra_positions: Vec<Option<usize>>,
    /// Of each character.
    levels: Vec<Levels>,
    textures: Textures,
}

/// An agent that wears a character.
pub(crate) struct Wearer<'a> {
    pub(crate) agent: &'a AgentFrame,
    /// Rotations of its extra joints, in the order of the recording's header.
    pub(crate) extra: &'a [Quat],
    /// Index of the character.
    pub(crate) character: u32,
    /// Width of a pixel on a body of the crowd's size, m.
    pub(crate) pixel_m: f32,
    /// A colour that shows a quantity, linear.
    pub(crate) shown: Option<Vec3>,
}

impl<'a> Wardrobe<'a> {
    /// Fits characters, in the recording's order, to its skeleton.
    pub(crate) fn new(header: &'a Header, characters: &'a [Character]) -> Self {
        let skeleton = header.skeleton();
        let fits: Vec<_> = characters.iter().map(|character| CharacterFit::new(character, skeleton)).collect();
        let levels = fits.par_iter().map(|fit| Levels::new(fit, skeleton)).collect();
        let is_named = |joint: ExtraJoint| {
            let name = joint.name();
            header.extra_joints.iter().position(|recorded| recorded.name == name)
        };
        let extra_positions = ExtraJoint::all().map(is_named).collect();
        Self { header, fits, extra_positions, levels, textures: Textures::new(characters) }
    }

    /// The textures of all characters.
    pub(crate) fn textures(&self) -> Arc<Vec<Texture>> {
        self.textures.all.clone()
    }

    /// Whether there is a character of this index.
    pub(crate) fn has(&self, character: u32) -> bool {
        (character as usize) < self.fits.len()
    }

    /// Size of the mesh that [`Self::append`] appends.
    pub(crate) fn mesh_size(&self, character: u32, pixel_m: f32) -> MeshSize {
        let mesh = self.levels.get(character as usize).map(|levels| &levels.of_pixel(pixel_m).mesh);
        mesh.map_or(MeshSize::default(), |mesh| MeshSize {
            vertices: mesh.positions_m.len(),
            triangles: mesh.triangles.len(),
        })
    }

    /// Appends the mesh of an agent, as fine as its pixels show.
    pub(crate) fn append(&self, parts: &mut SceneParts, wearer: &Wearer) {
        let Wearer { agent, extra, character, pixel_m, shown } = *wearer;
        let Some(fit) = self.fits.get(character as usize) else { return };
        let joints = agent.pose.forward_kinematics(self.header.skeleton());
        let mut transforms = Vec::new();
        fit.pose(self.header.skeleton(), &joints, agent.root.frame(), &mut transforms);
        let recorded = |joint: ExtraJoint| extra.get(self.extra_positions[joint.index()]?).copied();
        fit.pose_extra(|joint| recorded(joint).or_else(|| fit.resting(joint)), &mut transforms);
        let worn = Worn {
            fit,
            level: self.levels[character as usize].of_pixel(pixel_m),
            first_texture: self.textures.firsts[character as usize],
            dye: Dye::new(self.header.scenario.hue_turn_of(agent.id.0, character), shown),
            owner: Owner { agent: agent.id.0, material: CHARACTER },
        };
        worn.append(parts, &transforms);
    }
}

/// The textures of some characters.
#[derive(Clone, Debug)]
pub(crate) struct Textures {
    pub(crate) all: Arc<Vec<Texture>>,
    /// Index of the first texture of each character.
    firsts: Vec<u32>,
}

impl Textures {
    pub(crate) fn new(characters: &[Character]) -> Self {
        let textures: Vec<&CharacterTexture> = characters.iter().flat_map(|character| &character.textures).collect();
        let mut skipped = vec![0_u32; textures.len()];
        let pixels = |index: usize, skipped: &[u32]| textures[index].pixel_count() >> (2 * skipped[index]).min(63);
        while (0..textures.len()).map(|index| pixels(index, &skipped)).sum::<usize>() > PIXELS_MAX {
            let largest = (0..textures.len()).rev().max_by_key(|index| pixels(*index, &skipped));
            largest.into_iter().for_each(|index| skipped[index] += 1);
        }
        let all = textures.par_iter().zip(&skipped).map(|(texture, skipped)| Texture::new(texture, *skipped)).collect();
        let counts = characters.iter().scan(0, |count, character| {
            let first = *count;
            *count += character.textures.len() as u32;
            Some(first)
        });
        Self { all: Arc::new(all), firsts: counts.collect() }
    }
}

/// A character as one agent wears it.
pub(crate) struct Worn<'a> {
    pub(crate) fit: &'a CharacterFit<'a>,
    /// The character's mesh, or a reduced one.
    pub(crate) level: &'a Level,
    /// Index of the character's first texture in the scene.
    pub(crate) first_texture: u32,
    pub(crate) dye: Dye,
    pub(crate) owner: Owner,
}

impl Worn<'_> {
    /// Appends the mesh and the capsules of a posed character.
    pub(crate) fn append(&self, parts: &mut SceneParts, transforms: &[JointTransform]) {
        let (mut positions_m, mut normals, mut colours) = (Vec::new(), Vec::new(), Vec::new());
        let Level { mesh, closed } = self.level;
        mesh.skin(transforms, &mut positions_m, &mut normals);
        mesh.dyed(&self.dye, &mut colours);
        parts.meshes.append(&positions_m, &normals, &colours, &mesh.triangles, self.owner);
        parts.meshes.close(closed);
        if !mesh.uvs.is_empty() {
            let paint = |material: &Material| {
                let texture = self.first_texture + material.texture?;
                Some(Paint { texture, cut_out: material.cut_out, dye: self.dye, keeps_hue: material.keeps_hue })
            };
            let runs = mesh.materials.iter().map(|material| (material.triangle_count as usize, paint(material)));
            parts.meshes.texture(mesh.uvs.iter().map(|uv| Vec2::from(*uv)), runs);
        }
        append_capsules(parts, self.fit, transforms, self.owner);
    }
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

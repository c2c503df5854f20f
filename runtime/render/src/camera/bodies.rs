//! Agents of a frame as parts of the scene. World, metres.

use fbcrowd_sim::Population;
use fbcrowd_sim::recording::{AgentFrame, ExtraFrame};
use glam::Vec3;
use rayon::prelude::*;

use crate::camera::colour_by::dressed;
use crate::camera::worn::{Wardrobe, Wearer};
use crate::figure::{BodySize, Figures, Wanted};
use crate::passes::motion::PartPlaces;
use crate::raster::palette::{Rgb, decode_srgb};
use crate::visibility::lens::NEAR_M;
use crate::visibility::{Lens, MeshSize, SceneParts};

/// Middle of a body above the ground, and its reach from there, m.
const BODY_M: [f32; 2] = [0.9, 1.2];
/// Distance beside the picture up to which bodies are kept, m: they throw shadows into it.
const SHADOW_REACH_M: f32 = 2.5;
/// Height of a body, m.
const HEIGHT_M: f32 = 1.75;
/// Number of agents that are posed at once.
const AGENTS_AT_ONCE: usize = 32;
/// Number of such chunks of each thread that exist at once.
const CHUNKS_OF_THREAD: usize = 4;

/// What draws bodies.
pub(crate) struct Dresser<'a> {
    pub(crate) figures: &'a Figures,
    /// The characters; none where all bodies are plain.
    pub(crate) wardrobe: Option<&'a Wardrobe<'a>>,
    pub(crate) population: &'a Population,
    /// The extra joints of the posed agents.
    pub(crate) extra: &'a ExtraFrame,
}

/// Agents before a lens.
struct Seen<'a> {
    /// They decide which bodies are there and how fine they are.
    agents: &'a [AgentFrame],
    /// The same agents at the same time or another one: they decide where the parts are.
    posed: &'a [AgentFrame],
    lens: &'a Lens,
    /// Id of an agent that is left out.
    hidden: Option<u32>,
}

impl Dresser<'_> {
    /// The bodies that a lens sees, or that throw shadows into its picture, in the characters that they wear. `shown` are
    /// colours that replace the agents' own. `hidden` is the id of an agent that is left out.
    pub(crate) fn body_parts(
        &self,
        agents: &[AgentFrame],
        shown: &[Option<Rgb>],
        lens: &Lens,
        hidden: Option<u32>,
    ) -> SceneParts {
        let mut scene = SceneParts::default();
        let append = |parts: SceneParts| scene.extend(&parts);
        let seen = Seen { agents, posed: agents, lens, hidden };
        self.each_chunk(&seen, |at| shown[at], |parts| parts, append);
        scene.textures = self.wardrobe.map(Wardrobe::textures).unwrap_or_default();
        scene
    }

    /// Size of the meshes of [`Self::body_parts`].
    pub(crate) fn mesh_size(&self, agents: &[AgentFrame], lens: &Lens, hidden: Option<u32>) -> MeshSize {
        let seen = agents.iter().filter(|agent| Some(agent.id.0) != hidden && is_near_picture(lens, agent));
        let size = |agent: &AgentFrame| {
            let size = self.size(agent);
            let height_px = size.stature * height_px(lens, agent);
            match self.character_of(agent) {
                Some((wardrobe, character)) => wardrobe.mesh_size(character, HEIGHT_M / height_px),
                None => self.figures.mesh_size(&Wanted { agent, look: dressed(agent, None), size, height_px }),
            }
        };
        seen.map(size).sum()
    }

    /// Where the parts of [`Self::body_parts`] are at another time: `posed` holds the same agents then.
    pub(crate) fn body_places(
        &self,
        agents: &[AgentFrame],
        posed: &[AgentFrame],
        lens: &Lens,
        hidden: Option<u32>,
    ) -> PartPlaces {
        let mut places = PartPlaces::default();
        let seen = Seen { agents, posed, lens, hidden };
        self.each_chunk(&seen, |_| None, PartPlaces::of, |of_chunk| places.extend(&of_chunk));
        places
    }

    /// Makes the parts of bodies, some agents at once, and calls `append` in the order of the agents with what `keep` leaves
    /// of them. Few chunks exist at a time: the parts of a large crowd take hundreds of megabytes.
    fn each_chunk<T: Send>(
        &self,
        seen: &Seen,
        shown: impl Fn(usize) -> Option<Rgb> + Sync,
        keep: impl Fn(SceneParts) -> T + Sync,
        mut append: impl FnMut(T),
    ) {
        let parts_of = |first: usize| {
            let mut parts = SceneParts::default();
            for at in first..(first + AGENTS_AT_ONCE).min(seen.agents.len()) {
                let agent = &seen.agents[at];
                if Some(agent.id.0) != seen.hidden && is_near_picture(seen.lens, agent) {
                    let (size, first_triangle) = (self.size(agent), parts.meshes.triangles.len());
                    let height_px = size.stature * height_px(seen.lens, agent);
                    self.append_sized(&mut parts, &seen.posed[at], size, height_px, shown(at));
                    if is_near_eye(seen.lens, agent, size.stature) {
                        parts.meshes.open(first_triangle);
                    }
                }
            }
            keep(parts)
        };
        let firsts: Vec<usize> = (0..seen.agents.len()).step_by(AGENTS_AT_ONCE).collect();
        for firsts in firsts.chunks(CHUNKS_OF_THREAD * rayon::current_num_threads()) {
            let chunks: Vec<T> = firsts.par_iter().map(|first| parts_of(*first)).collect();
            chunks.into_iter().for_each(&mut append);
        }
    }

    /// Size of an agent's body.
    fn size(&self, agent: &AgentFrame) -> BodySize {
        let life = self.population.agents.get(agent.id.index());
        life.map_or(BodySize { stature: 1.0, deviation: 1.0 }, |life| BodySize {
            stature: life.stature,
            deviation: life.stature / life.spec.stature,
        })
    }

    /// Appends an agent, and scales it about its root on the ground.
    fn append_sized(
        &self,
        parts: &mut SceneParts,
        agent: &AgentFrame,
        size: BodySize,
        height_px: f32,
        shown: Option<Rgb>,
    ) {
        let [cones, occluders, vertices] = [parts.cones.len(), parts.occluders.len(), parts.meshes.positions_m.len()];
        self.append(parts, agent, size, height_px, shown);
        let stature = size.stature;
        if stature == 1.0 {
            return;
        }
        let root_m = agent.root.position_m.extend(0.0);
        let scaled = |point_m: Vec3| root_m + stature * (point_m - root_m);
        for cone in parts.cones[cones..].iter_mut().chain(&mut parts.occluders[occluders..]) {
            cone.ends_m = cone.ends_m.map(scaled);
            cone.radii_m = cone.radii_m.map(|radius_m| stature * radius_m);
        }
        parts.meshes.positions_m[vertices..].iter_mut().for_each(|point_m| *point_m = scaled(*point_m));
    }

    fn append(&self, parts: &mut SceneParts, agent: &AgentFrame, size: BodySize, height_px: f32, shown: Option<Rgb>) {
        match self.character_of(agent) {
            Some((wardrobe, character)) => {
                let shown = shown.map(|rgb| rgb.map(decode_srgb).clamp(Vec3::ZERO, Vec3::ONE));
                let (pixel_m, extra) = (HEIGHT_M / height_px, self.extra.of(agent.id));
                wardrobe.append(parts, &Wearer { agent, extra, character, pixel_m, shown });
            }
            None => {
                let look = dressed(agent, shown);
                self.figures.append(parts, &Wanted { agent, look, size, height_px });
            }
        }
    }

    /// The character that an agent wears.
    fn character_of(&self, agent: &AgentFrame) -> Option<(&Wardrobe<'_>, u32)> {
        let wardrobe = self.wardrobe?;
        let character = self.population.agents.get(agent.id.index())?.character?;
        wardrobe.has(character).then_some((wardrobe, character))
    }
}

fn middle_m(agent: &AgentFrame) -> Vec3 {
    agent.root.position_m.extend(BODY_M[0])
}

/// Height of a body in the picture, pixels.
fn height_px(lens: &Lens, agent: &AgentFrame) -> f32 {
    let depth_m = lens.to_camera(middle_m(agent)).z;
    HEIGHT_M / lens.pixel_m(depth_m.max(0.3))
}

/// Whether the near plane may cut a body: its inside is seen then.
fn is_near_eye(lens: &Lens, agent: &AgentFrame, stature: f32) -> bool {
    lens.to_camera(middle_m(agent)).z < NEAR_M + BODY_M[1] * stature.max(1.0)
}

/// Whether a body, or its shadow, can touch the picture.
fn is_near_picture(lens: &Lens, agent: &AgentFrame) -> bool {
    let at = lens.to_camera(middle_m(agent));
    let reach_m = BODY_M[1] + SHADOW_REACH_M;
    if at.z < -reach_m {
        return false;
    }
    let half = 0.5 * lens.size() * lens.pixel;
    (0..2).all(|axis| {
        let (edge, slope) = if lens.is_perspective { (half[axis] * at.z, half[axis]) } else { (half[axis], 0.0) };
        at[axis].abs() - edge < reach_m * (1.0 + slope * slope).sqrt()
    })
}

//! The feet of a character that wears the poses of a recording: planted slide at the soles, and soles under the ground.
//!
//! Slide as [`planted_slide`](crate::measures::planted_slide) measures the crowd's own, at the character's heel, ball
//! and toe tip. Depth at the skinned vertices of the soles. Roots' frames, metres; slides in cm/s, depths in cm.

use glam::{Vec2, Vec3};
use motiondb::body::{Joint, Joints, RootFrame, Skeleton};
use motiondb::character::{Character, CharacterFit, JointTransform};
use serde::{Deserialize, Serialize};

use crate::measures::frame_pairs::FramePairs;
use crate::measures::planted_slide::PlantedSlide;
use crate::measures::root_measures::RootMeasures;
use crate::recording::{AgentFrame, Recording, RecordingError};

/// Greatest number of vertices of each foot that are watched.
const VERTICES_MAX: usize = 256;
/// Height above the sole up to which a foot's vertices count as the sole, divided by the height of the hips.
const SOLE_HEIGHT: f32 = 0.03;

/// What the feet of a character do in a recording.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CharacterSoles {
    /// Number of agents.
    pub agents: usize,
    /// Number of frames.
    pub frames: usize,
    /// Mean speed of the character's planted contact points, cm/s; null where no foot is ever planted.
    pub planted_slide_cm_s: Option<f64>,
    /// The same of the recorded bodies themselves, cm/s.
    pub crowd_slide_cm_s: Option<f64>,
    /// Greatest depth of a sole under the ground, cm.
    pub sole_depth_cm: f64,
    /// Mean over frames and agents of the greatest depth of the soles under the ground, cm.
    pub mean_sole_depth_cm: f64,
    /// Greatest depth of the recorded bodies' own soles, cm.
    pub crowd_sole_depth_cm: f64,
    /// Mean height of the lowest point of planted feet over the ground, cm: feet that float.
    pub planted_height_cm: Option<f64>,
}

/// Measures a character on all agents of a recording, each up to its arrival.
///
/// # Errors
/// Where a frame is missing or damaged.
pub fn character_soles(recording: &Recording, character: &Character) -> Result<CharacterSoles, RecordingError> {
    let (header, population) = (recording.header(), recording.population());
    let mut agents: Vec<AgentFrame> = Vec::new();
    recording.read_frame(0, &mut agents)?;
    let mut roots = RootMeasures::new(&header.scenario, population, &agents);
    let mut feet = FeetOfCharacter::new(character, header.skeleton(), header.scenario.dt_s, agents.len());
    let mut before = Vec::new();
    for frame in 0..recording.frame_count() {
        if frame > 0 {
            recording.read_frame(frame, &mut agents)?;
            let mut pairs = FramePairs::new(&before, &agents);
            let life = |agent: &AgentFrame| &population.agents[agent.id.index()];
            pairs.common.retain(|(_, after)| !life(after).is_teleported(frame as u32));
            let teleported = agents.iter().filter(|agent| life(agent).is_teleported(frame as u32));
            teleported.for_each(|agent| feet.lift(agent.id.index()));
            roots.push(population, &pairs);
        }
        for agent in agents.iter().filter(|agent| !roots.has_arrived(agent.id)) {
            feet.push(agent, population.agents[agent.id.index()].stature);
        }
        before.clone_from(&agents);
    }
    Ok(feet.finish(population.agents.len(), recording.frame_count()))
}

/// The feet of one character, frame by frame.
struct FeetOfCharacter<'a> {
    fit: CharacterFit<'a>,
    skeleton: &'a Skeleton,
    /// Vertices of the soles.
    soles: Vec<usize>,
    transforms: Vec<JointTransform>,
    own: PlantedSlide,
    crowd: PlantedSlide,
    depth_m: f64,
    depth_sum_m: f64,
    crowd_depth_m: f64,
    poses: usize,
    height_sum_m: f64,
    planted: usize,
}

impl<'a> FeetOfCharacter<'a> {
    fn new(character: &'a Character, skeleton: &'a Skeleton, dt_s: f32, agents: usize) -> Self {
        Self {
            fit: CharacterFit::new(character, skeleton),
            skeleton,
            soles: sole_vertices(character),
            transforms: Vec::new(),
            own: PlantedSlide::new(agents, dt_s),
            crowd: PlantedSlide::new(agents, dt_s),
            depth_m: 0.0,
            depth_sum_m: 0.0,
            crowd_depth_m: 0.0,
            poses: 0,
            height_sum_m: 0.0,
            planted: 0,
        }
    }

    fn lift(&mut self, index: usize) {
        self.own.lift(index);
        self.crowd.lift(index);
    }

    fn push(&mut self, agent: &AgentFrame, stature: f32) {
        let joints = agent.pose.forward_kinematics(self.skeleton);
        let root_frame = RootFrame { position_m: Vec2::ZERO, forward: Vec2::X };
        self.fit.pose(self.skeleton, &joints, root_frame, &mut self.transforms);
        let feet_m = [0, 1].map(|side| self.foot_points_m(side).map(|point_m| stature * point_m));
        self.own.push_feet(agent.id.index(), agent, feet_m);
        self.crowd.push_one(agent.id.index(), agent, &self.skeleton.sized(stature), &joints.sized(stature));
        self.measure_depth(&joints, stature);
        for (foot_m, contact) in feet_m.iter().zip(agent.contacts) {
            if contact >= crate::planning::PLANTED_CONTACT {
                self.height_sum_m += f64::from(lowest_m(foot_m));
                self.planted += 1;
            }
        }
    }

    /// Heel, ball and toe tip of one foot.
    fn foot_points_m(&self, side: usize) -> [Vec3; 3] {
        let character = self.fit.character;
        let foot = character.feet[side];
        let ankle = character.joint(Joint::FEET[side]).unwrap_or(0);
        let toe = character.joint(Joint::TOES[side]).unwrap_or(ankle);
        [(ankle, foot.heel_m), (ankle, foot.ball_m), (toe, foot.toe_tip_m)]
            .map(|(joint, point_m)| self.transforms[joint].point_m(point_m))
    }

    fn measure_depth(&mut self, joints: &Joints, stature: f32) {
        let mesh = &self.fit.character.mesh;
        let depth_m = |&vertex: &usize| -f64::from(stature * mesh.position_m(vertex, &self.transforms).z);
        let depth_m = self.soles.iter().map(depth_m).fold(0.0, f64::max);
        self.depth_m = self.depth_m.max(depth_m);
        self.depth_sum_m += depth_m;
        self.poses += 1;
        for side in 0..2 {
            let crowd_m = -f64::from(stature * lowest_m(&joints.sole_points_m(self.skeleton, side)));
            self.crowd_depth_m = self.crowd_depth_m.max(crowd_m);
        }
    }

    fn finish(self, agents: usize, frames: usize) -> CharacterSoles {
        CharacterSoles {
            agents,
            frames,
            planted_slide_cm_s: self.own.finish().slide_cm_s,
            crowd_slide_cm_s: self.crowd.finish().slide_cm_s,
            sole_depth_cm: 100.0 * self.depth_m,
            mean_sole_depth_cm: 100.0 * self.depth_sum_m / self.poses.max(1) as f64,
            crowd_sole_depth_cm: 100.0 * self.crowd_depth_m,
            planted_height_cm: (self.planted > 0).then(|| 100.0 * self.height_sum_m / self.planted as f64),
        }
    }
}

fn lowest_m(points_m: &[Vec3; 3]) -> f32 {
    points_m.iter().map(|point_m| point_m.z).fold(f32::INFINITY, f32::min)
}

/// Vertices of the soles, at most [`VERTICES_MAX`] a foot, evenly chosen.
fn sole_vertices(character: &Character) -> Vec<usize> {
    let of_feet = |side: usize| {
        let joints = [Joint::FEET[side], Joint::TOES[side]].map(|role| character.joint(role));
        let sole_m = character.feet[side].ball_m.z + SOLE_HEIGHT * character.hips_over_soles_m;
        let (mesh, is_under) = (&character.mesh, is_under(character, joints.into_iter().flatten().collect()));
        let vertices = (0..mesh.positions_m.len()).filter(move |&vertex| {
            mesh.positions_m[vertex].z < sole_m && is_under[usize::from(mesh.joints[vertex][0])]
        });
        let vertices: Vec<usize> = vertices.collect();
        let step = vertices.len().div_ceil(VERTICES_MAX).max(1);
        vertices.into_iter().step_by(step).collect::<Vec<usize>>()
    };
    [of_feet(0), of_feet(1)].concat()
}

/// Whether each joint is one of `tops` or hangs from one.
fn is_under(character: &Character, tops: Vec<usize>) -> Vec<bool> {
    let mut is_under: Vec<bool> = (0..character.joints.len()).map(|joint| tops.contains(&joint)).collect();
    for joint in 0..is_under.len() {
        is_under[joint] |= character.joints[joint].parent.is_some_and(|parent| is_under[parent as usize]);
    }
    is_under
}

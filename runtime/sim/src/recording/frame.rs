//! What a recording keeps of each agent and frame, in at most 200 bytes before compression.

use glam::{Quat, Vec2, Vec3};
use motiondb::body::{JOINT_COUNT, Pose, Root};

use crate::planning::plan::VelocitySet;
use crate::population::AgentId;
use crate::synthesis::BodyOutput;
use crate::synthesis::Mode;

/// One agent in one frame, decoded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AgentFrame {
    /// The agent.
    pub id: AgentId,
    /// Behaviour state: index into the header's state names.
    pub state: u16,
    /// The synthesised root.
    pub root: Root,
    /// v_pref, world, m/s.
    pub preferred_mps: Vec2,
    /// Angle from v_pref to the direction of the route, which the agent faces, counter-clockwise, rad.
    pub facing_offset_rad: f32,
    /// Velocity planned for the step that led to this frame, world, m/s.
    pub planned_mps: Vec2,
    /// φ: phase of the body's cycle, 0 to 1.
    pub phase: f32,
    /// Active mode: blending or semi-procedural.
    pub mode: Mode,
    /// Blended contact Σ w·c of each foot, `[left, right]`; planted from
    /// [`PLANTED_CONTACT`](crate::planning::PLANTED_CONTACT) on.
    pub contacts: [f32; 2],
    /// Time until the swing foot lands, s, where a single foot stands; else 0.
    pub time_to_landing_s: f32,
    /// Active velocity set.
    pub set: VelocitySet,
    /// Contiguous time of strafing, s.
    pub strafing_s: f32,
    /// Contiguous time of stepping back, s.
    pub stepping_back_s: f32,
    /// Weight-averaged planted-foot slide of the examples of the active motion, cm/s.
    pub examples_slide_cm_s: f32,
    /// The final pose, after IK, in the root's frame.
    pub pose: Pose,
}

impl AgentFrame {
    /// Takes over the result of synthesis for a step.
    pub fn show(&mut self, synthesis: &BodyOutput) {
        self.contacts = synthesis.contacts;
        self.time_to_landing_s = synthesis.stance.foot.map_or(0.0, |foot| foot.time_to_landing_s);
        self.examples_slide_cm_s = synthesis.examples_slide_cm_s;
        self.pose = synthesis.pose;
    }
}

impl Default for AgentFrame {
    /// A body at the origin that stands on both feet, every joint at rest.
    fn default() -> Self {
        Self {
            id: AgentId::default(),
            state: 0,
            root: Root::default(),
            preferred_mps: Vec2::ZERO,
            facing_offset_rad: 0.0,
            planned_mps: Vec2::ZERO,
            phase: 0.0,
            mode: Mode::Blending,
            contacts: [1.0; 2],
            time_to_landing_s: 0.0,
            set: VelocitySet::Turning,
            strafing_s: 0.0,
            stepping_back_s: 0.0,
            examples_slide_cm_s: 0.0,
            pose: Pose { pelvis_m: Vec3::ZERO, rotations: [Quat::IDENTITY; JOINT_COUNT] },
        }
    }
}

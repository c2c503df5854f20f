//! What a recording keeps of each agent and frame, in at most 200 bytes before compression.

use glam::{Quat, Vec2, Vec3};
use motiondb::body::{JOINT_COUNT, Pose, Root};

use crate::planning::plan::VelocitySet;
use crate::synthesis::BodyOutput;
use crate::synthesis::Mode;

/// One agent in one frame, decoded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AgentFrame {
    /// The synthesised root.
    pub root: Root,
    /// v_pref, world, m/s.
    pub preferred_mps: Vec2,
    /// v, world, m/s: what was planned for the step that led here.
    pub planned_mps: Vec2,
    /// Phase of the body's cycle.
    pub phase: f32,
    /// Synthesis in force.
    pub mode: Mode,
    /// Blended contact Σ w·c of each foot, `[left, right]`; planted from
    /// [`PLANTED_CONTACT`](crate::planning::plan::PLANTED_CONTACT) on.
    pub contacts: [f32; 2],
    /// Seconds until the swing foot lands, where a single foot stands; else 0.
    pub time_to_landing_s: f32,
    /// Velocity set in force.
    pub set: VelocitySet,
    /// Contiguous time strafing, s.
    pub strafing_s: f32,
    /// Contiguous time stepping back, s.
    pub stepping_back_s: f32,
    /// Weight-averaged planted-foot slide of the source examples in use, cm/s.
    pub examples_slide_cm_s: f32,
    /// The final pose, after IK, in the root's frame.
    pub pose: Pose,
}

impl AgentFrame {
    /// Takes up what synthesis made of a step.
    pub fn show(&mut self, output: &BodyOutput) {
        self.contacts = output.contacts;
        self.time_to_landing_s = output.stance.foot.map_or(0.0, |foot| foot.time_to_landing_s);
        self.examples_slide_cm_s = output.examples_slide_cm_s;
        self.pose = output.pose;
    }
}

impl Default for AgentFrame {
    fn default() -> Self {
        Self {
            root: Root::default(),
            preferred_mps: Vec2::ZERO,
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

//! The exchange between planner and synthesis (`FbCrowd` §3, Fig. 2): a plan to synthesis, a stance foot to the
//! planner.
//!
//! MCN and HMS never see each other; only `simulation.rs` sees both. World axes, metres, seconds, radians.

use glam::{Vec2, Vec3};
use motiondb::quality::planted_feet;

use crate::planning::elbow_room::ElbowRoom;

/// Blended contact Σ w·c from which a foot is planted.
pub const PLANTED_CONTACT: f32 = planted_feet::PLANTED_CONTACT as f32;

/// How a body stands (`FbCrowd` §4.2): from synthesis to the planner.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stance {
    /// The foot that carries the body alone; none where both feet or no foot stand.
    pub foot: Option<StanceFoot>,
}

impl Stance {
    /// The stance of a body that faces `forward`, given heel, ball and toe tip of each sole in the root's frame (m),
    /// the contact of each foot, and the time until a swing foot lands (s), by its side.
    pub fn on_soles(
        soles_m: &[[Vec3; 3]; 2],
        forward: Vec2,
        contacts: [f32; 2],
        time_to_landing_s: impl FnOnce(usize) -> f32,
    ) -> Self {
        let planted = contacts.map(|contact| contact >= PLANTED_CONTACT);
        if planted[0] == planted[1] {
            return Self { foot: None };
        }
        let side = usize::from(planted[1]);
        let [heel_m, ball_m, toe_m] = soles_m[side].map(|point| forward.rotate(point.truncate()));
        let swing_m = forward.rotate(soles_m[1 - side][1].truncate());
        let time_to_landing_s = time_to_landing_s(1 - side);
        Self { foot: Some(StanceFoot { side, heel_m, ball_m, toe_m, swing_m, time_to_landing_s }) }
    }
}

/// The foot that carries the body alone, projected on the ground. Points are relative to the root's position, in world
/// axes, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StanceFoot {
    /// Side of the foot: 0 left, 1 right.
    pub side: usize,
    /// St_h: heel of the stance foot, m.
    pub heel_m: Vec2,
    /// St_b: ball of the stance foot, m.
    pub ball_m: Vec2,
    /// St_t: toe tip of the stance foot, m.
    pub toe_m: Vec2,
    /// Ball of the swing foot, m.
    pub swing_m: Vec2,
    /// Time until the swing foot lands at the present phase rate, s.
    pub time_to_landing_s: f32,
}

/// The velocity set that limits a plan ([`motiondb::velocity_sets::velocity_hull`]).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u8)]
pub enum VelocitySet {
    /// The facing follows the velocity.
    #[default]
    Turning = 0,
    /// The facing is held: the agent side-steps or steps back.
    Holding = 1,
}

/// The plan of one agent for one step: from the planner to synthesis, and in part to the recording.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Plan {
    /// v_i: planned velocity, world, m/s.
    pub velocity_mps: Vec2,
    /// Whether the body stands although v_i is not 0: its agent queues and v_i leads slowly backward, or the body rests
    /// where its agent wants to stand and v_i is slow. A disc without a body moves.
    pub waits: bool,
    /// f_d: facing to turn to, world, rad.
    pub facing_rad: f32,
    /// Least time to collision at the present velocities, s; infinite where nothing is met.
    pub time_to_collision_s: f32,
    /// ρ: density ahead as the density filter measures it, 1/m.
    pub density: f32,
    /// The active velocity set.
    pub set: VelocitySet,
    /// Contiguous time of strafing, s (§4.5); beyond its limit, the limit plus the rest that is due.
    pub strafing_s: f32,
    /// Contiguous time of stepping back, s; beyond its limit, the limit plus the rest that is due.
    pub stepping_back_s: f32,
    /// Distances of what is nearest on the left and on the right of an agent that passes a narrow gap, m; none in the
    /// open, and of planners that do not measure it.
    pub gap_m: Option<[f32; 2]>,
    /// How far the body may reach to each side, world axes, m.
    pub room: ElbowRoom,
}

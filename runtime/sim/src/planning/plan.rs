//! What passes between planner and synthesis (`FbCrowd` §3, Fig. 2): the plan one way, the stance foot the other.
//!
//! MCN and HMS never see each other; only `step.rs` sees both.

use glam::{Vec2, Vec3};
use motiondb::quality::planted_feet;

/// Blended contact Σ w·c from which a foot is planted.
pub const PLANTED_CONTACT: f32 = planted_feet::PLANTED_CONTACT as f32;

/// What synthesis tells the planner: how the body stands (`FbCrowd` §4.2).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stance {
    /// The foot that carries the body alone; none while both feet or no foot stand.
    pub foot: Option<StanceFoot>,
}

impl Stance {
    /// How a body that faces `forward` stands on its soles (heel, ball and toe tip of each foot, in the root's frame,
    /// metres), given the contact of each foot and when a swing foot would land, by its side.
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

/// A single stance foot, on the ground, relative to the root's position, in world axes, metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StanceFoot {
    /// 0 left, 1 right.
    pub side: usize,
    /// St_h.
    pub heel_m: Vec2,
    /// St_b.
    pub ball_m: Vec2,
    /// St_t.
    pub toe_m: Vec2,
    /// The swing foot's ball, likewise.
    pub swing_m: Vec2,
    /// Seconds until the swing foot lands at the present phase rate.
    pub time_to_landing_s: f32,
}

/// Which velocity set limits a plan ([`motiondb::velocity_sets::velocity_hull`]).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u8)]
pub enum VelocitySet {
    /// The facing follows the velocity.
    #[default]
    Turning = 0,
    /// The facing is held: side-stepping, stepping back.
    Holding = 1,
}

/// What the planner tells synthesis, and what of it the recording keeps.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Plan {
    /// v_i: the velocity to walk at, world, m/s.
    pub velocity_mps: Vec2,
    /// o_i^d: the facing to turn to, world, radians.
    pub facing_rad: f32,
    /// Least time to collision, s; infinite where nothing is met.
    pub time_to_collision_s: f32,
    /// Local density as the density filter sees it.
    pub density: f32,
    /// The set in force.
    pub set: VelocitySet,
    /// Contiguous time spent strafing, s (§4.5).
    pub strafing_s: f32,
    /// Contiguous time spent stepping back, s.
    pub stepping_back_s: f32,
}

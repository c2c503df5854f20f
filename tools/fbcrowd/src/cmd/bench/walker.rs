//! A body alone, stepped as in a simulation: what the benches of synthesis let walk.

use std::f32::consts::PI;
use std::sync::Arc;

use fbcrowd_sim::hms::hybrid::Hybrid;
use fbcrowd_sim::hms::params::{HmsParams, Modes};
use fbcrowd_sim::hms::repertoire;
use fbcrowd_sim::hms::space::Space;
use fbcrowd_sim::hms::time_step::TimeStep;
use fbcrowd_sim::hms::{Body, Motion};
use fbcrowd_sim::plan::Plan;
use glam::{Vec2, Vec3};
use motiondb::motion_db::MotionDb;
use motiondb::parameters::Parameters;
use motiondb::pose::Root;

/// Steps of time in which the bars of synthesis shall hold, s: a display's, a film's, and that of Table 1.
pub(super) const DT_S: [f32; 3] = [1.0 / 120.0, 1.0 / 30.0, 0.1];

/// A database, made ready for one synthesis.
pub(super) struct Studio {
    pub(super) db: Arc<MotionDb>,
    pub(super) space: Space,
    hybrid: Option<Hybrid>,
    pub(super) params: HmsParams,
}

impl Studio {
    pub(super) fn new(db: MotionDb, modes: Modes) -> Self {
        let db = repertoire::complete(Arc::new(db));
        let params = HmsParams { modes, ..HmsParams::default() };
        Self { space: Space::new(&db), hybrid: Hybrid::new(&db, modes), params, db }
    }

    fn motion(&self) -> Motion<'_> {
        Motion { db: &self.db, space: &self.space, hybrid: self.hybrid.as_ref(), params: &self.params }
    }

    /// A standing body follows a plan of time and root; as it was at first and after each step.
    pub(super) fn bodies(&self, seconds: f32, dt_s: f32, plan: impl Fn(f32, &Root) -> Plan) -> Vec<Body> {
        let motion = self.motion();
        let (mut body, _) = Body::standing(&motion, Root::default(), 0.0);
        let mut bodies = vec![body];
        let time_step = TimeStep::new(dt_s);
        for step in 0..(seconds / dt_s).round() as usize {
            body.advance(&motion, &plan(step as f32 * dt_s, &body.root), &time_step);
            body.synthesize(&motion, &time_step);
            bodies.push(body);
        }
        bodies
    }

    /// Only its roots.
    pub(super) fn walk(&self, seconds: f32, dt_s: f32, plan: impl Fn(f32, &Root) -> Plan) -> Vec<Root> {
        self.bodies(seconds, dt_s, plan).into_iter().map(|body| body.root).collect()
    }

    /// The plan by which a body at `root` is asked for exactly these parameters (the inverse of `hms/asked.rs`).
    pub(super) fn plan_for(&self, asked: Parameters, root: &Root) -> Plan {
        let lead_rad = asked.turn_rate_rad_s * self.params.turn_time_s;
        let facing_rad = root.facing_rad + lead_rad;
        let velocity_mps = Vec2::new(asked.speed_mps, asked.strafe_mps) / lead_rad.cos();
        Plan {
            velocity_mps: Vec2::from_angle(facing_rad).rotate(velocity_mps),
            facing_rad,
            time_to_collision_s: f32::INFINITY,
            ..Plan::default()
        }
    }
}

/// The angle by which a root turned in a step, rad.
pub(super) fn turned_rad(before: &Root, after: &Root) -> f32 {
    (after.facing_rad - before.facing_rad + PI).rem_euclid(2.0 * PI) - PI
}

/// What a root did over some steps: its mean (v_f, ω_t, ω_s), each step's way taken as an arc.
pub(super) fn achieved(roots: &[Root], dt_s: f32) -> Parameters {
    let mut sum = Vec3::ZERO;
    for pair in roots.windows(2) {
        let half_turn_rad = 0.5 * turned_rad(&pair[0], &pair[1]);
        let chord = if half_turn_rad.abs() > 1e-3 { half_turn_rad.sin() / half_turn_rad } else { 1.0 };
        let moved_m = pair[1].position_m - pair[0].position_m;
        let local_m = Vec2::from_angle(-pair[0].facing_rad - half_turn_rad).rotate(moved_m) / chord;
        sum += Vec3::new(local_m.x, 2.0 * half_turn_rad, local_m.y);
    }
    Parameters::from_vec3(sum / (dt_s * (roots.len() - 1) as f32))
}

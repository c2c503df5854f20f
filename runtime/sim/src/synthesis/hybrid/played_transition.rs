//! A recorded transition that a body plays: its pose comes from the clip, its root from the plan.
//!
//! The plan alone moves the root; the clip never does. The pace g of the clip is chosen such that the clip's root keeps up
//! with the body's root. v and v_c are the speeds of both, in the direction in which the transition ends; ℓ is the lead of
//! the drawn body over its root ([`StepTiming`]):
//!
//! ```text
//! g = (v − ℓ/T + v_0)/(v_c + v_0), within limits.
//! ```
//!
//! v_0 lets a clip begin at its own pace, when both roots are at rest. The drawn body moves as the clip does, so planted
//! feet hold. The phase advances at the mean rate of the example in which the transition ends, and reaches the example's
//! phase with the last frame.
//!
//! Root frames (x forward, y left); metres, seconds.
//!
//! [`StepTiming`]: crate::synthesis::hybrid::step_timing::StepTiming

use glam::{Quat, Vec2};
use motiondb::motion::{ACTION_RATE_HZ, Action, ActionFrame, MotionDb, MotionExample, wrapped};

use crate::planning::plan::PLANTED_CONTACT;

/// T: time in which a clip makes up for its lead, s.
const CATCH_UP_TIME_S: f32 = 0.3;
/// v_0: speed that is small beside that of a walk, m/s.
const RESTING_MPS: f32 = 0.2;
/// Range of the pace g.
const PACE_RANGE: [f32; 2] = [0.7, 1.5];
/// Interval over which the velocity of a clip's root is taken, s.
const VELOCITY_SPAN_S: f32 = 0.1;

/// A transition of the database, and how far a body is in it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PlayedTransition {
    /// Index of the action.
    action: u32,
    /// Time from its first frame, s.
    time_s: f32,
}

impl PlayedTransition {
    /// A transition at its first frame.
    pub(crate) fn begin(action: u32) -> Self {
        Self { action, time_s: 0.0 }
    }

    /// The transition of the database.
    fn action<'a>(&self, db: &'a MotionDb) -> &'a Action {
        &db.actions[self.action as usize]
    }

    /// The example in which the transition ends.
    fn exit<'a>(&self, db: &'a MotionDb) -> &'a MotionExample {
        &db.examples[self.action(db).exit.example as usize]
    }

    /// Duration of the cycle in which the transition ends, s.
    fn period_s(&self, db: &MotionDb) -> f32 {
        self.exit(db).phase_map.period_s
    }

    /// φ', 1/s.
    pub(crate) fn phase_rate_hz(&self, db: &MotionDb) -> f32 {
        1.0 / self.period_s(db)
    }

    /// Phase of the body: at the end it is that of the example.
    pub(crate) fn phase(&self, db: &MotionDb) -> f32 {
        let action = self.action(db);
        wrapped(action.exit.phase - (action.duration_s() - self.time_s) / self.period_s(db))
    }

    /// The motion at a phase, at most half a cycle from the present one.
    pub(crate) fn at(&self, db: &MotionDb, phase: f32) -> ActionFrame {
        self.action(db).at(self.time_at_s(db, phase))
    }

    /// Frames of the extra joints at such a phase, and their shares.
    pub(crate) fn extra_frames<'a>(&self, db: &'a MotionDb, phase: f32) -> [(&'a [Quat], f32); 2] {
        db.extra_frames(self.action as usize, self.time_at_s(db, phase))
    }

    /// Time in the clip at a phase, at most half a cycle from the present one, s.
    fn time_at_s(&self, db: &MotionDb, phase: f32) -> f32 {
        let cycles = phase - self.phase(db);
        self.time_s + (cycles - cycles.round()) * self.period_s(db)
    }

    /// The pace of the clip, given the velocity of the body's root and the lead of the drawn body over it, in the root's
    /// frame.
    pub(crate) fn pace(&self, velocity_mps: Vec2, lead_m: Vec2, db: &MotionDb) -> f32 {
        let along = self.exit(db).parameters.velocity_mps().normalize_or_zero();
        let wanted_mps = along.dot(velocity_mps - lead_m / CATCH_UP_TIME_S);
        let [least, greatest] = PACE_RANGE;
        ((wanted_mps + RESTING_MPS) / (along.dot(self.velocity_mps(db)) + RESTING_MPS)).clamp(least, greatest)
    }

    /// Velocity of the clip's root over the next moments, in the root's frame, m/s.
    fn velocity_mps(&self, db: &MotionDb) -> Vec2 {
        let mut later = *self;
        later.advance(VELOCITY_SPAN_S, db) / VELOCITY_SPAN_S
    }

    /// Advances by a duration of the clip's own time. Returns the displacement of its root, in the root's frame, m.
    pub(crate) fn advance(&mut self, duration_s: f32, db: &MotionDb) -> Vec2 {
        let action = self.action(db);
        let from = action.at(self.time_s).root;
        self.time_s += duration_s;
        let to = action.at(self.time_s).root;
        let middle_rad = 0.5 * (from.facing_rad + to.facing_rad);
        Vec2::from_angle(-middle_rad).rotate(to.position_m - from.position_m)
    }

    /// Whether the cycle can replace the clip: from the last mid-stance of the clip on. One foot then rests flat on the
    /// ground, and the other does not land soon.
    pub(crate) fn is_over(&self, db: &MotionDb) -> bool {
        let action = self.action(db);
        let since_mid_stance_s = (action.exit.phase % 0.5) * self.period_s(db);
        self.time_s >= action.duration_s() - since_mid_stance_s
    }

    /// Acceleration of the clip's root, in the root's frame, m/s², at the clip's own pace.
    pub(crate) fn acceleration_mps2(&self, db: &MotionDb) -> Vec2 {
        let action = self.action(db);
        let [before, now, after] =
            [-VELOCITY_SPAN_S, 0.0, VELOCITY_SPAN_S].map(|off_s| action.at(self.time_s + off_s).root);
        let bend_m = before.position_m - 2.0 * now.position_m + after.position_m;
        Vec2::from_angle(-now.facing_rad).rotate(bend_m) / (VELOCITY_SPAN_S * VELOCITY_SPAN_S)
    }

    /// Time until a swinging foot lands, s; the rest of the clip where it does not.
    pub(crate) fn time_to_landing_s(&self, db: &MotionDb, side: usize) -> f32 {
        let action = self.action(db);
        let index = (self.time_s * ACTION_RATE_HZ) as usize;
        let lands = |frame: &ActionFrame| frame.contacts[side] >= PLANTED_CONTACT;
        let frames = action.frames.get(index..).unwrap_or_default();
        let until = frames.iter().position(lands).unwrap_or(frames.len());
        until as f32 / ACTION_RATE_HZ
    }

    /// Slide of the planted feet of the example in which the transition ends, cm/s.
    pub(crate) fn slide_cm_s(&self, db: &MotionDb) -> f32 {
        self.exit(db).planted_slide_cm_s
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use glam::Vec3;
    use motiondb::body::{Joint, Root};
    use motiondb::motion::{ActionEnd, ActionKind};

    use super::*;
    use crate::planning::plan::Plan;
    use crate::synthesis::{HmsParams, Mode, SynthesisContext};
    use crate::test_db::test_db;

    const DT_S: f32 = 1.0 / 60.0;
    /// Speed of the example `walk`, m/s.
    const WALK_MPS: f32 = 1.0;
    /// Time at which bodies are to start, s.
    const START_S: f32 = 1.0;

    /// A body in one step.
    struct Step {
        mode: Mode,
        /// Root, m.
        root_m: Vec2,
        frame: ActionFrame,
        /// Balls of the feet in the world, m.
        balls_m: [Vec3; 2],
        phase: f32,
    }

    /// A body that stands, then follows a plan at `velocity_mps` up to `end_s`, and stands again.
    fn walk(db: &MotionDb, velocity_mps: Vec2, end_s: f32) -> Vec<Step> {
        let context = SynthesisContext::new(Arc::new(db.clone()), HmsParams::default());
        let plan = |time_s: f32, _: &Root| {
            let walks = (START_S..end_s).contains(&time_s);
            let share = if walks { (2.0 * (time_s - START_S)).min(1.0) } else { 0.0 };
            Plan { velocity_mps: share * velocity_mps, time_to_collision_s: f32::INFINITY, ..Plan::default() }
        };
        context.walk_alone(0.3, 4.0, DT_S, plan, |body, output| {
            let joints = output.pose.forward_kinematics(&context.db.skeleton);
            let ball_m = |side: usize| body.root.to_world(joints.sole_points_m(&context.db.skeleton, side)[1]);
            Step {
                mode: body.motion.mode,
                root_m: body.root.position_m,
                frame: ActionFrame { pose: output.pose, contacts: output.contacts, root: body.root },
                balls_m: [0, 1].map(ball_m),
                phase: body.motion.phase,
            }
        })
    }

    /// The test database with a start: a body that starts without one, with its left hand raised.
    fn with_start() -> MotionDb {
        let mut db = test_db();
        let steps = walk(&db, WALK_MPS * Vec2::X, f32::INFINITY);
        let first = (START_S / DT_S) as usize;
        let last = (first + 75..).find(|&index| steps[index].phase < steps[index - 1].phase).unwrap() + 6;
        let raised = |step: &Step| {
            let mut frame = step.frame;
            frame.pose.rotations[Joint::LeftUpperArm.index()] *= glam::Quat::from_rotation_x(0.5);
            frame
        };
        let example = |name: &str| db.examples.iter().position(|example| example.name == name).unwrap() as u32;
        let (entry, exit) = (example("idle"), example("walk"));
        db.actions.push(Action {
            name: "start".into(),
            kind: ActionKind::Start,
            source: 0,
            window_s: [0.0, 1.0],
            mirrored: false,
            entry: ActionEnd { example: entry, phase: 0.0 },
            exit: ActionEnd { example: exit, phase: steps[last].phase },
            frames: steps[first..=last].iter().map(raised).collect(),
        });
        db
    }

    /// Speeds of the test's bodies forward, m/s.
    const SPEEDS_MPS: [f32; 3] = [0.8, 1.0, 1.3];

    #[test]
    fn a_body_that_starts_forward_plays_the_clip() {
        let db = with_start();
        for speed_mps in SPEEDS_MPS {
            let steps = walk(&db, speed_mps * Vec2::X, f32::INFINITY);
            let played = steps.iter().filter(|step| step.mode == Mode::Transition).count() as f32 * DT_S;
            assert!((0.5..2.2).contains(&played), "{speed_mps} m/s: {played} s");
            assert!(steps.last().unwrap().mode != Mode::Transition);
        }
    }

    #[test]
    fn feet_rest_and_no_joint_jumps_in_a_recorded_start() {
        let db = with_start();
        for speed_mps in SPEEDS_MPS {
            let steps = walk(&db, speed_mps * Vec2::X, f32::INFINITY);
            for pair in steps.windows(2) {
                let [before, after] = [&pair[0], &pair[1]];
                for side in [0, 1] {
                    let is_flat = |step: &Step| step.frame.contacts[side] >= 0.99 && step.balls_m[side].z < 0.003;
                    let moved_m = (after.balls_m[side] - before.balls_m[side]).truncate().length();
                    assert!(
                        !(is_flat(before) && is_flat(after)) || moved_m < 2e-3,
                        "{speed_mps} m/s: foot {side} slides {moved_m} m"
                    );
                }
                let step_m = before.frame.pose.pelvis_m.distance(after.frame.pose.pelvis_m);
                assert!(step_m < 0.02, "{speed_mps} m/s: the pelvis jumps {step_m} m");
                let turned = |joint: Joint| {
                    let [from, to] = [before, after].map(|step| step.frame.pose.rotations[joint.index()]);
                    from.angle_between(to)
                };
                assert!(turned(Joint::LeftUpperArm) < 0.12, "{speed_mps} m/s: the arm jumps");
            }
        }
    }

    #[test]
    fn the_root_moves_as_without_the_clip() {
        let [recorded, procedural] = [with_start(), test_db()].map(|db| walk(&db, Vec2::new(1.1, 0.0), f32::INFINITY));
        let apart = recorded.iter().zip(&procedural).map(|(a, b)| a.root_m.distance(b.root_m)).fold(0.0, f32::max);
        assert!(apart < 0.02, "{apart} m");
    }

    #[test]
    fn a_body_that_starts_aside_or_back_plays_no_clip() {
        let db = with_start();
        for velocity_mps in [Vec2::new(0.0, 0.5), Vec2::new(-0.5, 0.0)] {
            let steps = walk(&db, velocity_mps, f32::INFINITY);
            assert!(steps.iter().all(|step| step.mode != Mode::Transition), "{velocity_mps}");
        }
    }

    #[test]
    fn a_body_that_soon_stops_leaves_the_clip() {
        let steps = walk(&with_start(), WALK_MPS * Vec2::X, START_S + 0.5);
        assert!(steps.iter().any(|step| step.mode == Mode::Transition));
        assert!(steps[160..].iter().all(|step| step.mode != Mode::Transition));
    }
}

//! Idle clock: which idle of the database a body stands in, and when in it.
//!
//! An idle plays at its own length, apart from the phase of the gait. Its pose takes the place of the standing example
//! in every mix, so that a body enters and leaves it as the shares change. One draw gives each body an idle and a start
//! of its own. The clock runs on while the body walks: no two rests begin alike. Seconds.

use glam::Quat;
use motiondb::body::Pose;
use motiondb::motion::MotionDb;

/// The idle of a body.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct IdleClock {
    /// Index of the idle among the actions of the database; idles come first.
    idle: u32,
    /// Time from the first frame of the idle, s.
    time_s: f32,
}

impl IdleClock {
    /// An idle and a time in it, by a draw from [0, 1).
    pub(crate) fn drawn(db: &MotionDb, draw: f32) -> Self {
        let count = db.idles().count();
        let position = draw * count as f32;
        let idle = (position as usize).min(count.saturating_sub(1));
        let time_s = (position - idle as f32) * db.actions.get(idle).map_or(0.0, |idle| idle.duration_s());
        Self { idle: idle as u32, time_s }
    }

    /// Advances by a duration, negative for an earlier time; the idle begins again at its end.
    pub(crate) fn advance(&mut self, db: &MotionDb, duration_s: f32) {
        if let Some(idle) = db.idles().nth(self.idle as usize) {
            let (time_s, length_s) = (self.time_s + duration_s, idle.duration_s());
            self.time_s = time_s - length_s * libm::floorf(time_s / length_s);
        }
    }

    /// The pose in the root frame; `None` where the database has no idle.
    pub(crate) fn pose(&self, db: &MotionDb) -> Option<Pose> {
        db.idles().nth(self.idle as usize).map(|idle| idle.at(self.time_s).pose)
    }

    /// Frames of the extra joints and their shares; `None` where the database has no idle.
    pub(crate) fn extra_frames<'a>(&self, db: &'a MotionDb) -> Option<[(&'a [Quat], f32); 2]> {
        let idle = self.idle as usize;
        (idle < db.idles().count()).then(|| db.extra_frames(idle, self.time_s))
    }
}

#[cfg(test)]
mod tests {
    use std::f32::consts::TAU;
    use std::sync::Arc;

    use motiondb::body::Root;
    use motiondb::motion::{Action, ActionEnd, ActionFrame, ActionKind};

    use super::*;
    use crate::planning::plan::Plan;
    use crate::synthesis::{HmsParams, SynthesisContext};
    use crate::test_db::test_db;

    fn idle(last: usize) -> Action {
        let frame = ActionFrame { pose: test_db().rows.pose(0, 0), contacts: [1.0; 2], root: Default::default() };
        let end = ActionEnd { example: 0, phase: 0.0 };
        let (name, kind) = (format!("{last}"), ActionKind::Idle);
        Action {
            name,
            kind,
            source: 0,
            window_s: [0.0, 1.0],
            mirrored: false,
            entry: end,
            exit: end,
            frames: vec![frame; last + 1],
        }
    }

    #[test]
    fn each_draw_has_its_idle_and_time() {
        let mut db = test_db();
        assert_eq!(IdleClock::drawn(&db, 0.7).pose(&db), None);
        db.actions = vec![idle(120), idle(240)];
        let [early, late] = [0.25, 0.75].map(|draw| IdleClock::drawn(&db, draw));
        assert_eq!([early, late], [IdleClock { idle: 0, time_s: 1.0 }, IdleClock { idle: 1, time_s: 2.0 }]);
    }

    #[test]
    fn an_idle_begins_again_at_its_end() {
        let mut db = test_db();
        db.actions = vec![idle(120)];
        let mut clock = IdleClock { idle: 0, time_s: 1.5 };
        clock.advance(&db, 1.0);
        assert!((clock.time_s - 0.5).abs() < 1e-6);
        clock.advance(&db, -1.0);
        assert!((clock.time_s - 1.5).abs() < 1e-6);
    }

    /// An idle of four seconds whose pelvis sways by 2 cm to both sides.
    fn swaying() -> Action {
        let mut idle = idle(240);
        for (index, frame) in idle.frames.iter_mut().enumerate() {
            frame.pose.pelvis_m.y += 0.02 * libm::sinf(TAU * (index % 240) as f32 / 240.0);
        }
        idle
    }

    #[test]
    fn bodies_at_rest_sway_as_in_the_clip_each_in_its_own_time() {
        let mut db = test_db();
        db.actions = vec![swaying()];
        let context = SynthesisContext::new(Arc::new(db), HmsParams::default());
        let sways_m = |draw: f32| {
            let plan = |_: f32, _: &Root| Plan { time_to_collision_s: f32::INFINITY, ..Plan::default() };
            context.walk_alone(draw, 8.0, 1.0 / 60.0, plan, |_, output| {
                let soles_m =
                    output.pose.forward_kinematics(&context.db.skeleton).sole_points_m(&context.db.skeleton, 0);
                (output.pose.pelvis_m.y, soles_m[1])
            })
        };
        let [early, late] = [0.0, 0.25].map(sways_m);
        for sways_m in [&early, &late] {
            let of_pelvis = || sways_m.iter().map(|(pelvis_m, _)| *pelvis_m);
            let range_m = of_pelvis().fold(f32::MIN, f32::max) - of_pelvis().fold(f32::MAX, f32::min);
            assert!((range_m - 0.04).abs() < 0.002, "{range_m} m");
            let steps_m = sways_m.windows(2).map(|pair| (pair[1].0 - pair[0].0).abs());
            assert!(steps_m.fold(0.0, f32::max) < 1.2 * 0.02 * TAU / 240.0, "the pelvis jumps");
            assert!(sways_m.iter().all(|(_, ball_m)| ball_m.distance(sways_m[0].1) < 1e-3), "a foot slides");
        }
        let apart_m = early.iter().zip(&late).map(|(early, late)| (early.0 - late.0).abs()).fold(0.0, f32::max);
        assert!(apart_m > 0.02, "both sway alike, within {apart_m} m");
    }
}

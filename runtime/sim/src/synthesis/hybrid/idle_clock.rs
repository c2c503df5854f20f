//! Idle clock: which idle of the database a body stands in, and when in it.
//!
//! An idle plays at its own length, apart from the phase of the gait. Its pose takes the place of the standing example
//! in every mix, so that a body enters and leaves it as the shares change. One draw gives each body an idle and a start
//! of its own. The clock runs on while the body walks: no two rests begin alike. Seconds.

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
}

#[cfg(test)]
mod tests {
    use motiondb::motion::{Action, ActionEnd, ActionFrame, ActionKind};

    use super::*;
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
}

//! Idle clock: which idle of the database a body stands in, and when in it.
//!
//! An idle plays at its own length, apart from the phase of the gait. Its pose takes the place of the standing example
//! in every mix, so that a body enters and leaves it as the shares change. One draw gives each body an idle and a start
//! of its own, and the times at which it changes to another one, and with it, where the clips do, the leg that bears its
//! weight. A body that steps comes to rest in the idle of the standing example, with which its steps are blended. The clock
//! runs on while the body walks: no two rests begin alike. Seconds.

use glam::Quat;
use motiondb::body::Pose;
use motiondb::motion::{Action, MotionDb};

use crate::maths::decay::smooth_step;
use crate::maths::random::SplitMix64;

/// Mean time between two changes of the idle, s: people who stand shift their weight to the side every 199 s and fidget
/// every 49 s (Duarte and Zatsiorsky 1999, *Motor Control* 3), one or the other every 39 s.
const CHANGE_EVERY_S: f64 = 40.0;
/// Least and greatest time from a stop to the first change, s: most people who stand at ease stand unevenly.
const FIRST_CHANGE_S: [f64; 2] = [1.5, 8.0];
/// Duration of a change, s.
const CHANGE_S: f32 = 2.0;

/// The idle of a body.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct IdleClock {
    /// The idle that plays.
    current: PlayedIdle,
    /// The one before it, which plays on during a change.
    before: PlayedIdle,
    /// Time since the last change began, s.
    since_change_s: f32,
    /// Time for which the body stands until the next change, s.
    until_change_s: f32,
    /// Whether the body has stepped since it stood.
    has_stepped: bool,
    /// Seed of the draws of the body.
    seed: u32,
    /// Number of draws that have been made.
    draws: u32,
}

/// An idle, and a time in it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct PlayedIdle {
    /// Index of the idle among the actions of the database; idles come first.
    idle: u32,
    /// Time from the first frame of the idle, s.
    time_s: f32,
}

impl IdleClock {
    /// An idle and a time in it, by a draw from [0, 1).
    pub(crate) fn drawn(db: &MotionDb, draw: f32) -> Self {
        let current = PlayedIdle::drawn(db, draw);
        let clock =
            Self { current, before: current, since_change_s: CHANGE_S, seed: draw.to_bits(), ..Self::default() };
        clock.staying()
    }

    /// Advances by a duration in which the body stands or steps.
    pub(crate) fn advance(&mut self, db: &MotionDb, stands: bool, duration_s: f32) {
        self.play(db, duration_s);
        let count = db.idles().count() as u32;
        if count < 2 {
            return;
        }
        let changes = self.since_change_s < CHANGE_S;
        if !stands {
            self.has_stepped = true;
            let idle = idle_of_standing(db);
            if !changes && self.current.idle != idle {
                self.change_to(PlayedIdle { idle, ..self.current });
            }
            return;
        }
        if std::mem::take(&mut self.has_stepped) {
            let [least_s, greatest_s] = FIRST_CHANGE_S;
            self.until_change_s = (least_s + self.draw() * (greatest_s - least_s)) as f32;
        }
        self.until_change_s -= duration_s;
        if !changes && self.until_change_s <= 0.0 {
            let others = f64::from(count - 1);
            let further = 1 + (self.draw() * others) as u32;
            self.change_to(PlayedIdle { idle: (self.current.idle + further) % count, ..self.current });
            *self = self.staying();
        }
    }

    /// The clock a duration earlier, within the idles that play.
    pub(crate) fn earlier(mut self, db: &MotionDb, duration_s: f32) -> Self {
        self.play(db, -duration_s);
        self
    }

    /// The pose in the root frame; `None` where the database has no idle.
    pub(crate) fn pose(&self, db: &MotionDb) -> Option<Pose> {
        let (current, share) = (self.current.pose(db)?, self.share());
        Some(if share < 1.0 { self.before.pose(db)?.lerp(&current, share) } else { current })
    }

    /// Frames of the extra joints and their shares; `None` where the database has no idle.
    pub(crate) fn extra_frames<'a>(&self, db: &'a MotionDb) -> Option<[(&'a [Quat], f32); 4]> {
        let share = self.share();
        let [first, second] = self.before.extra_frames(db, 1.0 - share)?;
        let [third, fourth] = self.current.extra_frames(db, share)?;
        Some([first, second, third, fourth])
    }

    /// The clock with a time until its next change: changes come at random, independently of each other.
    fn staying(mut self) -> Self {
        self.until_change_s = (-CHANGE_EVERY_S * libm::log(1.0 - self.draw())) as f32;
        self
    }

    fn change_to(&mut self, idle: PlayedIdle) {
        (self.before, self.current, self.since_change_s) = (self.current, idle, 0.0);
    }

    /// Moves the times of the idles by a duration, negative for an earlier time.
    fn play(&mut self, db: &MotionDb, duration_s: f32) {
        self.since_change_s = (self.since_change_s + duration_s).max(0.0);
        self.before.play(db, duration_s);
        self.current.play(db, duration_s);
    }

    /// Share of the idle that plays; the rest is the one before it.
    fn share(&self) -> f32 {
        smooth_step(self.since_change_s / CHANGE_S)
    }

    /// The next draw from [0, 1).
    fn draw(&mut self) -> f64 {
        self.draws += 1;
        SplitMix64::new(self.seed.into(), self.draws.into()).unit()
    }
}

impl PlayedIdle {
    /// An idle and a time in it, by a draw from [0, 1).
    fn drawn(db: &MotionDb, draw: f32) -> Self {
        let count = db.idles().count();
        let position = draw * count as f32;
        let idle = (position as usize).min(count.saturating_sub(1));
        let time_s = (position - idle as f32) * db.actions.get(idle).map_or(0.0, Action::duration_s);
        Self { idle: idle as u32, time_s }
    }

    fn action<'a>(&self, db: &'a MotionDb) -> Option<&'a Action> {
        db.idles().nth(self.idle as usize)
    }

    /// Moves the time by a duration, negative for an earlier time; the idle begins again at its end.
    fn play(&mut self, db: &MotionDb, duration_s: f32) {
        if let Some(idle) = self.action(db) {
            let (time_s, length_s) = (self.time_s + duration_s, idle.duration_s());
            self.time_s = time_s - length_s * libm::floorf(time_s / length_s);
        }
    }

    fn pose(&self, db: &MotionDb) -> Option<Pose> {
        self.action(db).map(|idle| idle.at(self.time_s).pose)
    }

    fn extra_frames<'a>(&self, db: &'a MotionDb, share: f32) -> Option<[(&'a [Quat], f32); 2]> {
        self.action(db)?;
        let frames = db.extra_frames(self.idle as usize, self.time_s);
        Some(frames.map(|(rotations, of_frame)| (rotations, share * of_frame)))
    }
}

/// Index of the idle that is of one clip with the standing example, otherwise of the best one.
fn idle_of_standing(db: &MotionDb) -> u32 {
    let is_of_standing = |idle: &Action| idle.source == db.examples[idle.entry.example as usize].source;
    db.idles().position(is_of_standing).unwrap_or(0) as u32
}

#[cfg(test)]
mod tests {
    use std::f32::consts::TAU;
    use std::sync::Arc;

    use glam::Vec2;
    use motiondb::body::Root;
    use motiondb::motion::{ActionEnd, ActionFrame, ActionKind};

    use super::*;
    use crate::planning::plan::Plan;
    use crate::synthesis::pose::Posture;
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
        assert_eq!([early, late].map(|clock| (clock.current.idle, clock.current.time_s)), [(0, 1.0), (1, 2.0)]);
    }

    #[test]
    fn an_idle_begins_again_at_its_end() {
        let mut db = test_db();
        db.actions = vec![idle(120)];
        let mut clock = IdleClock::drawn(&db, 0.75);
        clock.advance(&db, true, 1.0);
        assert!((clock.current.time_s - 0.5).abs() < 1e-6);
        assert!((clock.earlier(&db, 1.0).current.time_s - 1.5).abs() < 1e-6);
    }

    /// A database of two idles, the second with its pelvis 4 cm aside.
    fn two_idles() -> MotionDb {
        let (mut db, mut aside) = (test_db(), idle(240));
        aside.source = db.examples[0].source + 1;
        aside.frames.iter_mut().for_each(|frame| frame.pose.pelvis_m.y = 0.04);
        db.actions = vec![idle(240), aside];
        db
    }

    #[test]
    fn a_body_changes_its_idle_now_and_then_without_a_jump() {
        let db = two_idles();
        let mut clock = IdleClock::drawn(&db, 0.2);
        let after_step = |_| {
            clock.advance(&db, true, 1.0 / 60.0);
            clock.pose(&db).unwrap().pelvis_m.y
        };
        let left_m: Vec<f32> = (0..60 * 1200).map(after_step).collect();
        let changes = left_m.windows(2).filter(|pair| (pair[0] < 0.02) != (pair[1] < 0.02)).count();
        assert!((18..=42).contains(&changes), "{changes} changes in 20 minutes");
        let speed_mps = left_m.windows(2).map(|pair| 60.0 * (pair[1] - pair[0]).abs()).fold(0.0, f32::max);
        assert!(speed_mps < 2.0 * 0.04 / CHANGE_S, "{speed_mps} m/s");
    }

    #[test]
    fn a_body_stops_in_the_idle_of_the_standing_example_and_soon_changes_it() {
        let db = two_idles();
        let mut clock = IdleClock::drawn(&db, 0.7);
        assert_eq!(clock.current.idle, 1);
        (0..150).for_each(|_| clock.advance(&db, false, 1.0 / 60.0));
        assert_eq!((clock.current.idle, clock.share()), (0, 1.0));
        let steps = (0..600).take_while(|_| {
            clock.advance(&db, true, 1.0 / 60.0);
            clock.current.idle == 0
        });
        assert!((89..=481).contains(&steps.count()));
        (0..150).for_each(|_| clock.advance(&db, true, 1.0 / 60.0));
        assert_eq!(clock.earlier(&db, 0.1).share(), 1.0);
    }

    #[test]
    fn a_body_with_one_idle_keeps_it() {
        let mut db = test_db();
        db.actions = vec![idle(120)];
        let mut clock = IdleClock::drawn(&db, 0.4);
        (0..60 * 300).for_each(|step| clock.advance(&db, step % 600 > 200, 1.0 / 60.0));
        assert_eq!((clock.current.idle, clock.share()), (0, 1.0));
    }

    /// An idle of four seconds whose pelvis sways by 2 cm to both sides over its feet.
    fn swaying() -> Action {
        let (mut idle, skeleton) = (idle(240), test_db().skeleton);
        for (index, frame) in idle.frames.iter_mut().enumerate() {
            let mut posture = Posture::new(frame.pose, frame.contacts, &skeleton);
            posture.shift(Vec2::Y * 0.02 * libm::sinf(TAU * (index % 240) as f32 / 240.0));
            posture.bend_legs(&skeleton);
            frame.pose = posture.pose;
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

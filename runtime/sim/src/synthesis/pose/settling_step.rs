//! Settling step: a standing body brings its feet under itself.
//!
//! A walking body stops with one foot before the other, and one that turns or is moved leaves its feet behind. One foot
//! after the other then leaves the ground, moves to its place, and lands. Its place is the one in the standing pose where the
//! body will have come to rest: until then the pose that is drawn says little of it. The foot that is farther off moves
//! first, but one that has just landed stays: after a walk the one behind closes to the other, which may stay a little ahead.
//! People who stop do not line up their feet: a foot that comes from behind lands a little behind, one from ahead a little
//! ahead.
//!
//! Frame of the drawn body (x forward, y left); metres, seconds; sides are 0 left, 1 right.

use glam::Vec2;

use crate::planning::plan::PLANTED_CONTACT;
use crate::synthesis::pose::FootLock;
use crate::synthesis::pose::foot_lock::LANDING_AHEAD_S;

/// Distance of a foot from where it is to stand beyond which it steps, m.
const OFF_MAX_M: f32 = 0.07;
/// Duration of the step, s: steps of 15 to 30 cm in captures take .3 to .4 s, and this foot may come from 45 cm behind.
const DURATION_S: f32 = 0.44;
/// Least time for which a foot that has landed stays on the ground, s: it carries the body.
const STAY_S: f32 = 0.3;
/// Time before its landing within which a foot does not make the first step of a body that starts, s: it would touch the ground,
/// and lift again once the steps have faded in.
const LANDING_S: f32 = 0.2;
/// Greatest distance by which both feet may be ahead of their places, m: a foot that the last step of a walk has brought ahead
/// need not step back.
const AHEAD_MAX_M: f32 = 0.05;
/// Share of its displacement along the facing by which a foot lands short of its place, and the most, m.
const SHORT_SHARE: f32 = 0.2;
const SHORT_MAX_M: f32 = 0.05;

/// The settling step of a body.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct SettlingStep {
    /// The foot in the air, and the time until it lands, s.
    swing: Option<(usize, f32)>,
    /// How far ahead of its place the foot in the air is to land, m.
    ahead_m: f32,
    /// Time for which each foot has been on the ground, s.
    stood_s: [f32; 2],
}

impl SettlingStep {
    /// Goes on by one step, given the contacts of the motion, the feet after the last step, and how far each is from its
    /// place, forward and left, m. A body that does not stand begins none, but ends the one that it began, as long as its
    /// motion leaves the other foot on the ground.
    pub(crate) fn follow(
        &mut self,
        stands: bool,
        contacts: &[f32; 2],
        locks: &[FootLock; 2],
        off_m: &[Vec2; 2],
        dt_s: f32,
    ) {
        for (stood_s, lock) in self.stood_s.iter_mut().zip(locks) {
            *stood_s = if lock.planted() { *stood_s + dt_s } else { 0.0 };
        }
        let goes_on = |side: usize| stands || contacts[1 - side] >= PLANTED_CONTACT;
        self.swing = match self.swing.filter(|(side, left_s)| goes_on(*side) && *left_s > 0.0) {
            // The foot moves to its target also in the step within which it lands.
            Some((side, left_s)) => Some((side, left_s - dt_s)),
            None if stands => self.foot_off(locks, off_m).map(|side| {
                let beside_m = off_m[1 - side].x.clamp(0.0, AHEAD_MAX_M);
                let short_m = (SHORT_SHARE * (off_m[side].x - beside_m)).clamp(-SHORT_MAX_M, SHORT_MAX_M);
                self.ahead_m = beside_m + short_m;
                (side, DURATION_S)
            }),
            None => None,
        };
    }

    /// Lifts the foot in the air, given the contact of each foot, now and [`LANDING_AHEAD_S`] later.
    pub(crate) fn lift(&self, contacts: &mut [f32; 2], contacts_ahead: &mut [f32; 2]) {
        if let Some((side, left_s)) = self.swing.filter(|(_, left_s)| *left_s > 0.0) {
            contacts[side] = 0.0;
            if left_s > LANDING_AHEAD_S {
                contacts_ahead[side] = 0.0;
            }
        }
    }

    /// The foot in the air, and the time until it lands, s; 0 or less in the step within which it lands.
    pub(crate) fn swing(&self) -> Option<(usize, f32)> {
        self.swing
    }

    /// The foot that a body has to lift which starts to step while a foot is in the air or one alone has just landed: the foot in
    /// the air, or the other one if it lands soon; the other one of a foot that has landed.
    pub(crate) fn foot_to_lift(&self) -> Option<usize> {
        let Some((side, left_s)) = self.swing else {
            let stays = self.stood_s.map(|stood_s| stood_s <= STAY_S);
            return (stays[0] != stays[1]).then(|| usize::from(stays[0]));
        };
        Some(if left_s > LANDING_S { side } else { 1 - side })
    }

    /// Where the ball of a foot that settles is to land, given the places of both, m.
    pub(crate) fn landing_m(&self, side: usize, places_m: &[Vec2; 2]) -> Option<Vec2> {
        self.swing.filter(|(swinging, _)| *swinging == side).map(|_| places_m[side] + self.ahead_m * Vec2::X)
    }

    /// The foot that is farther from where it is to stand, of those that have been on the ground for long enough, if it is
    /// too far and both are planted. Both may stand ahead of their places, or a little behind, as one that lands short does.
    fn foot_off(&self, locks: &[FootLock; 2], off_m: &[Vec2; 2]) -> Option<usize> {
        let ahead_m = (0.5 * (off_m[0].x + off_m[1].x)).clamp(-0.5 * SHORT_MAX_M, AHEAD_MAX_M);
        let [left_m, right_m] = [0, 1].map(|side| {
            let way_m = off_m[side].distance(ahead_m * Vec2::X) + locks[side].twisted_off_m();
            if self.stood_s[side] > STAY_S { way_m } else { 0.0 }
        });
        let steps = locks.iter().all(FootLock::planted) && left_m.max(right_m) > OFF_MAX_M;
        steps.then(|| usize::from(right_m > left_m))
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use glam::Vec2;
    use motiondb::body::Root;

    use crate::planning::plan::{PLANTED_CONTACT, Plan};
    use crate::synthesis::pose::ContactState;
    use crate::synthesis::{HmsParams, Modes, SynthesisContext};
    use crate::test_db::test_db;

    const DT_S: f32 = 1.0 / 60.0;

    /// Distances of the balls of both feet from those of a standing body, m, whether both are planted, and place, m, after
    /// each step of a body that walks and stops at a time.
    fn stop(velocity_mps: Vec2, stop_s: f32) -> Vec<([f32; 2], bool, Vec2)> {
        let params = HmsParams { modes: Modes::Blending, ..HmsParams::default() };
        let context = SynthesisContext::new(Arc::new(test_db()), params);
        let plan = |time_s: f32, _: &Root| Plan {
            velocity_mps: if time_s < stop_s { velocity_mps } else { Vec2::ZERO },
            time_to_collision_s: f32::INFINITY,
            ..Plan::default()
        };
        context.walk_alone(0.3, 6.0, DT_S, plan, |body, output| {
            let joints = output.pose.forward_kinematics(&context.db.skeleton);
            let off_m = [0, 1].map(|side| {
                let ball_m = joints.sole_points_m(&context.db.skeleton, side)[1];
                ball_m.truncate().distance(context.domain.standing_balls_m[side])
            });
            let planted = output.contacts.iter().all(|contact| *contact >= PLANTED_CONTACT);
            (off_m, planted, body.root.position_m)
        })
    }

    #[test]
    fn a_body_stands_on_both_feet_wherever_it_stops() {
        for velocity_mps in [Vec2::new(1.2, 0.0), Vec2::new(0.4, 0.0), Vec2::new(0.0, 0.5), Vec2::new(-0.5, 0.0)] {
            for stop_s in [2.0, 2.15, 2.3, 2.45, 2.6, 2.75, 2.9] {
                let steps = stop(velocity_mps, stop_s);
                let off_m = steps[359].0;
                assert!(off_m.iter().all(|off_m| *off_m < 0.12), "{velocity_mps}, {stop_s} s: {off_m:?} m");
                assert!(steps[300..].iter().all(|(_, planted, _)| *planted), "{velocity_mps}, {stop_s} s");
            }
        }
    }

    #[test]
    fn a_foot_that_settles_lands_short_in_steps_of_any_duration() {
        let params = HmsParams { modes: Modes::Blending, ..HmsParams::default() };
        let context = SynthesisContext::new(Arc::new(test_db()), params);
        for dt_s in [1.0 / 120.0, 1.0 / 30.0, 0.1] {
            let mut greatest_m = 0.0_f32;
            for stop_s in [2.0, 2.15, 2.3, 2.45, 2.6] {
                let plan = |time_s: f32, _: &Root| Plan {
                    velocity_mps: if time_s < stop_s { Vec2::X } else { Vec2::ZERO },
                    time_to_collision_s: f32::INFINITY,
                    ..Plan::default()
                };
                let bodies = context.walk_alone(0.3, 6.0, dt_s, plan, |body, _| (body.contact, body.root));
                let side = bodies.iter().rev().find_map(|(contact, _)| Some(contact.settling.swing()?.0)).unwrap();
                let (contact, root) = &bodies[bodies.len() - 1];
                let off_m = contact.off_m(&root.frame(), &context.domain.standing_balls_m);
                let ahead_m = contact.settling.ahead_m;
                let from_landing_m = off_m[side].distance(ahead_m * Vec2::X);
                assert!(from_landing_m < 0.03, "dt {dt_s}, stopped at {stop_s} s: {from_landing_m} m");
                greatest_m = greatest_m.max(ahead_m.abs());
            }
            assert!(greatest_m > 0.03, "dt {dt_s}: {greatest_m} m");
        }
    }

    #[test]
    fn a_foot_that_stays_while_the_other_settles_is_near_its_place() {
        let params = HmsParams { modes: Modes::Blending, ..HmsParams::default() };
        let context = SynthesisContext::new(Arc::new(test_db()), params);
        for stop_s in (0..20).map(|step| 2.0 + 0.05 * step as f32) {
            let plan = |time_s: f32, _: &Root| Plan {
                velocity_mps: if time_s < stop_s { Vec2::X } else { Vec2::ZERO },
                time_to_collision_s: f32::INFINITY,
                ..Plan::default()
            };
            let bodies = context.walk_alone(0.3, 5.0, DT_S, plan, |body, _| (body.contact, body.root));
            let at_rest = bodies[bodies.len() - 1].1.frame();
            let swing = |contact: &ContactState| contact.settling.swing().map(|(side, _)| (side, *contact));
            let (side, contact) = bodies.iter().find_map(|(contact, _)| swing(contact)).unwrap();
            let off_m = contact.off_m(&at_rest, &context.domain.standing_balls_m).map(Vec2::length);
            assert!(off_m[1 - side] < 0.25, "stopped at {stop_s} s: foot {side} settles, {off_m:?} m");
        }
    }

    #[test]
    fn a_body_that_stands_well_lifts_no_foot() {
        let steps = stop(Vec2::ZERO, 0.0);
        assert!(steps.iter().all(|(_, planted, _)| *planted));
    }

    #[test]
    fn a_body_that_starts_while_a_foot_settles_has_one_on_the_ground() {
        let params = HmsParams { modes: Modes::Blending, ..HmsParams::default() };
        let context = SynthesisContext::new(Arc::new(test_db()), params);
        for start_s in (0..12).map(|step| 2.9 + 0.05 * step as f32) {
            let plan = |time_s: f32, _: &Root| Plan {
                velocity_mps: if (2.0..start_s).contains(&time_s) { Vec2::ZERO } else { Vec2::X },
                time_to_collision_s: f32::INFINITY,
                ..Plan::default()
            };
            let contacts = context.walk_alone(0.3, 5.0, DT_S, plan, |_, output| output.contacts);
            let in_the_air = |contacts: &[f32; 2]| contacts.iter().all(|contact| *contact < PLANTED_CONTACT);
            assert_eq!(contacts.iter().position(in_the_air), None, "started at {start_s} s");
        }
    }

    #[test]
    fn a_stopping_root_does_not_wait_for_the_feet() {
        for stop_s in [2.0, 2.15, 2.3, 2.45, 2.6] {
            let steps = stop(Vec2::new(1.2, 0.0), stop_s);
            let at_stop = steps[(stop_s / DT_S) as usize].2;
            let beyond_m = steps[359].2.distance(at_stop);
            assert!(beyond_m < 0.5, "stopped at {stop_s} s: {beyond_m} m");
        }
    }
}

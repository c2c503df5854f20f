//! The contact group of a body's state: what holds its feet on the ground.
//!
//! Postures and soles are in the root frame (x forward, y left, z up), the locks in the world; metres.

use glam::{Vec2, Vec3};
use motiondb::body::{Joint, RootFrame, Skeleton};

use crate::planning::elbow_room::ElbowRoom;
use crate::synthesis::TimeStep;
use crate::synthesis::pose::foot_lock::{FootLock, Footing, PosedFoot, pivot_rate_rad_s};
use crate::synthesis::pose::foot_room::back_m;
use crate::synthesis::pose::leg::FootPose;
use crate::synthesis::pose::leg_clearance::{LAG_S, aside_m};
use crate::synthesis::pose::pelvis::PelvisHeight;
use crate::synthesis::pose::posture::Posture;
use crate::synthesis::pose::settling_step::SettlingStep;

/// Foot locks, settling step and pelvis height of a body.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct ContactState {
    /// Lock of each foot, `[left, right]`.
    pub locks: [FootLock; 2],
    /// Step by which a standing body brings a foot under itself.
    pub settling: SettlingStep,
    /// Height of the pelvis.
    pelvis: PelvisHeight,
}

impl ContactState {
    /// The state of a body whose feet stand as posed.
    pub(crate) fn standing(posture: &Posture, frame: &RootFrame, skeleton: &Skeleton) -> Self {
        let soles_m = posture.soles_m(skeleton);
        let lock = |side: usize| FootLock::new(&posed_foot(frame, &posture.feet[side], soles_m[side]));
        let pelvis = PelvisHeight::standing(posture.pose.pelvis_m.z);
        Self { locks: [0, 1].map(lock), pelvis, ..Self::default() }
    }

    /// How far the ball of each foot, as it was drawn last, is from its place, forward and left; both in a frame, m.
    pub(crate) fn off_m(&self, frame: &RootFrame, places_m: &[Vec2; 2]) -> [Vec2; 2] {
        [0, 1].map(|side| frame.to_local(self.locks[side].ball_m()).truncate() - places_m[side])
    }

    /// Moves the feet of a posture to their locks, swinging ones back towards the room and past the stance leg, and moves
    /// its pelvis to where the legs then reach.
    pub(crate) fn lock_feet(
        &mut self,
        posture: &mut Posture,
        motion: &FootMotion,
        room: &ElbowRoom,
        frame: &RootFrame,
        skeleton: &Skeleton,
        step: &TimeStep,
    ) {
        let (soles_m, pivot_rad) = (posture.soles_m(skeleton), step.dt_s * pivot_rate_rad_s(motion.turn_rate_rad_s));
        // The stance foot first: the other one avoids it.
        let first = usize::from(!self.locks[0].planted());
        let (mut locked, mut held) = (posture.feet, [false; 2]);
        for side in [first, 1 - first] {
            let (foot, other) = (&posture.feet[side], &posture.feet[1 - side]);
            let posed = posed_foot(frame, foot, soles_m[side]);
            let moved_m = if motion.is_new { Vec2::ZERO } else { self.locks[side].posed_displacement_m(&posed) };
            let posed_later_m = frame.to_local(posed.ankle_m + (LAG_S / step.dt_s * moved_m).extend(0.0));
            let landing_m = self.settling.landing_m(side, &motion.places_m);
            let settling_m = landing_m.map(|landing_m| landing_m - soles_m[side][1].truncate());
            let later_m = settling_m.map_or(posed_later_m, |settling_m| foot.ankle_m + settling_m.extend(0.0));
            let sole_later_m = soles_m[side].map(|point_m| point_m + later_m - foot.ankle_m);
            let radius_m = skeleton.segment_radii_m[Joint::TOES[side].index()];
            let into_room_m = back_m(sole_later_m, radius_m, room);
            let passes = side != first && self.locks[first].planted();
            let past_stance_m = if passes {
                let stances_m = [other.ankle_m, locked[first].ankle_m];
                aside_m(side, [posed_later_m, later_m + into_room_m.extend(0.0)], stances_m)
            } else {
                Vec2::ZERO
            };
            let away_m = frame.forward.rotate(into_room_m + past_stance_m + settling_m.unwrap_or_default());
            let (planted, contact_ahead) = (motion.planted[side], motion.contacts_ahead[side]);
            let footing = Footing { planted, contact_ahead, away_m, pivot_rad, settles: settling_m.is_some() };
            let lock = self.locks[side].step(&posed, &footing, step);
            held[side] = lock.is_held;
            locked[side] =
                FootPose { ankle_m: frame.to_local(lock.ankle_m), orientation: lock.twist * foot.orientation };
        }
        posture.lock_feet(locked, held, |wanted| self.pelvis.follow(wanted, motion.runs, step));
    }

    /// Records the soles as the legs could draw them.
    pub(crate) fn record_drawn(&mut self, soles_m: &[[Vec3; 3]; 2], frame: &RootFrame, step: &TimeStep) {
        for (lock, sole_m) in self.locks.iter_mut().zip(soles_m) {
            lock.record_drawn(sole_m.map(|point_m| frame.to_world(point_m)), step);
        }
    }
}

/// What the posed motion says of the feet.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FootMotion {
    /// Which feet are planted.
    pub(crate) planted: [bool; 2],
    /// Contact of each foot [`LANDING_AHEAD_S`](crate::synthesis::pose::foot_lock::LANDING_AHEAD_S) later.
    pub(crate) contacts_ahead: [f32; 2],
    /// Places of the balls of the feet of a body that has come to rest, in the frame of the drawn body, m.
    pub(crate) places_m: [Vec2; 2],
    /// Turn rate of the body, rad/s.
    pub(crate) turn_rate_rad_s: f32,
    /// Whether the body is as fast as people who run.
    pub(crate) runs: bool,
    /// Whether this is the first step after a switch.
    pub(crate) is_new: bool,
}

/// A foot of a posture, in the world.
fn posed_foot(frame: &RootFrame, foot: &FootPose, sole_m: [Vec3; 3]) -> PosedFoot {
    PosedFoot { ankle_m: frame.to_world(foot.ankle_m), sole_m: sole_m.map(|point_m| frame.to_world(point_m)) }
}

//! The drop of the pelvis where feet are away from where the pose has them.
//!
//! d is the drop that a leg needs to reach its target, d⁰ the drop that it needs to reach the pose's own foot; both are
//! negative where the leg reaches. With the softness s,
//!
//! ```text
//! S(d) = ½(d + √(d² + 4s²))          soft maximum of d and 0
//! ⌈a, b⌉ = b + S(a − b)              soft maximum of a and b
//! ```
//!
//! - *Deformed walk*: the pelvis keeps its height above the straighter leg. The drop is D = ⌈d, d′⌉ − ⌈d⁰, d⁰′⌉ (the
//!   prime marks the other leg) where D > 0. Where D < 0 the pelvis rises by the softness at most.
//! - *Locked feet*: the pelvis only drops further. Each leg requires S(d) − S(d⁰)/(1 + (S(d) − S(d⁰))/s)²: nothing at
//!   the pose's own foot, never less than d, and a little before the leg is straight. The drop is a soft maximum of
//!   both legs'.
//! - *Over time*: the pelvis drops and rises at limited accelerations ([`PelvisDrop`]), and comes softly to the height
//!   of the pose. A foot that leaves the ground far behind needs no drop from one moment to the next, and a swinging foot
//!   may be out of reach for a moment. A held foot may not.
//!
//! Root frame (x forward, y left, z up), metres.

use glam::Vec2;

use crate::maths::decay::soft_maximum;
use crate::synthesis::TimeStep;
use crate::synthesis::pose::leg::{FootPose, PosedLeg};
use crate::synthesis::pose::leg_length::length_max_m;

/// Greatest drop of the pelvis, m.
pub(crate) const DROP_MAX_M: f32 = 0.12;
/// Softness s for locked feet, m: less than the hips bob in walking. At 0.01 m knees snap at stops.
pub(crate) const SOFTNESS_M: f32 = 0.014;
/// Greatest upward acceleration that the pelvis has from the end of a drop, m/s². With that of walking, 4 m/s², it
/// stays well below a lurch.
const RISE_MPS2: f32 = 8.0;
/// Greatest downward acceleration from a drop that begins, m/s², as long as held feet are in reach.
const DROP_MPS2: f32 = 10.0;
/// Acceleration at which the pelvis meets the needed drop, m/s²: less, because the motion itself may turn meanwhile.
const MEETING_MPS2: f32 = 4.0;
/// Height by which the pelvis may be above the drop that held feet need, m: what straight legs still have beyond
/// [`EXTENSION`](crate::synthesis::pose::leg_length::EXTENSION).
const LATE_MAX_M: f32 = 0.006;
/// Softness for deformed walks, m: what a knee flexed by 15° lacks until its leg is straight.
const DEFORMED_SOFTNESS_M: f32 = 0.006;

/// Drop of the pelvis of a body over time. It follows the drop that the pose has and the legs need at limited
/// accelerations, in either direction.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct PelvisDrop {
    /// Drop beyond the needed one, m; negative where the pelvis is late.
    lag_m: f32,
    /// Rate of change of the whole drop, m/s.
    rate_mps: f32,
    /// Needed drop, m.
    needed_m: f32,
    /// Rate of change of the needed drop, m/s.
    needed_mps: f32,
}

impl PelvisDrop {
    /// The drop after a step in which `needed_m` is needed in all, and `held_m` by the feet that are held, m. In the
    /// first step after a switch (`is_new_motion`) the needed drop jumps with the pose, and inertialization carries the
    /// jump.
    pub(crate) fn follow(&mut self, [needed_m, held_m]: [f32; 2], is_new_motion: bool, step: &TimeStep) -> f32 {
        if !is_new_motion {
            self.needed_mps = (needed_m - self.needed_m) / step.dt_s;
        }
        let (least_mps, greatest_mps) = (self.rate_mps - RISE_MPS2 * step.dt_s, self.rate_mps + DROP_MPS2 * step.dt_s);
        let rate_mps = (self.needed_mps - meeting_mps(self.lag_m, step.dt_s)).clamp(least_mps, greatest_mps);
        let drop_m = needed_m - step.dt_s * self.needed_mps + self.lag_m;
        let to_pose_m = (drop_m - needed_m.min(0.0)).max(0.0);
        let rate_mps = rate_mps.max(-meeting_mps(to_pose_m, step.dt_s));
        let lag_m = self.lag_m + step.dt_s * (rate_mps - self.needed_mps);
        let late_max_m = LATE_MAX_M + (needed_m - held_m).max(0.0);
        let lag_m = lag_m.clamp(-late_max_m, (DROP_MAX_M - needed_m).max(0.0));
        self.rate_mps = self.needed_mps + (lag_m - self.lag_m) / step.dt_s;
        (self.lag_m, self.needed_m) = (lag_m, needed_m);
        needed_m + lag_m
    }
}

/// The greatest speed at which a lag can shrink and still end without a bump, in whole steps, m/s.
fn meeting_mps(lag_m: f32, dt_s: f32) -> f32 {
    let half_step_mps = 0.5 * MEETING_MPS2 * dt_s;
    let size_mps = libm::sqrtf(2.0 * MEETING_MPS2 * lag_m.abs() + half_step_mps * half_step_mps) - half_step_mps;
    size_mps.min(lag_m.abs() / dt_s).copysign(lag_m)
}

/// D: drop of the pelvis where the feet are at the targets of a deformed walk, m; negative where the pelvis rises.
pub(crate) fn deformed_drop_m(legs: &[PosedLeg; 2], targets: &[FootPose; 2]) -> f32 {
    let [[left_m, left_own_m], [right_m, right_own_m]] =
        needed_drops_m(legs, &legs.each_ref().map(PosedLeg::foot), targets);
    let drop_m = soft_greater_m(left_m, right_m) - soft_greater_m(left_own_m, right_own_m);
    soft_positive_m(drop_m).min(DROP_MAX_M)
}

/// Soft positive part of a length, m: 0 at 0, and at most the softness below the length.
pub(crate) fn soft_positive_m(length_m: f32) -> f32 {
    DEFORMED_SOFTNESS_M * (soft_maximum(length_m / DEFORMED_SOFTNESS_M) - 1.0)
}

/// ⌈a, b⌉, m.
fn soft_greater_m(a_m: f32, b_m: f32) -> f32 {
    b_m + DEFORMED_SOFTNESS_M * soft_maximum((a_m - b_m) / DEFORMED_SOFTNESS_M)
}

/// Drop that the legs require where locks move the feet from the pose's `own` to `targets`, and the drop at which those
/// that are `held` are just in reach, negative where legs reach further, m.
pub(crate) fn locked_drops_m(
    legs: &[PosedLeg; 2],
    own: &[FootPose; 2],
    targets: &[FootPose; 2],
    held: [bool; 2],
) -> [f32; 2] {
    let needed_m = needed_drops_m(legs, own, targets);
    let [left_m, right_m] = needed_m.map(required_drop_m);
    let required_m = libm::sqrtf(Vec2::new(left_m * left_m, right_m * right_m).length()).min(DROP_MAX_M);
    let of_held = needed_m.into_iter().zip(held).filter(|(_, is_held)| *is_held);
    [required_m, of_held.map(|([target_m, _], _)| target_m).fold(f32::NEG_INFINITY, f32::max)]
}

/// [d, d⁰] of each leg, m.
fn needed_drops_m(legs: &[PosedLeg; 2], own: &[FootPose; 2], targets: &[FootPose; 2]) -> [[f32; 2]; 2] {
    [0, 1].map(|side| {
        let length_max_m = length_max_m(&legs[side], &own[side]);
        [&targets[side], &own[side]].map(|foot| needed_drop_m(&legs[side], length_max_m, foot))
    })
}

/// Drop that one leg requires of the pelvis, given its d and d⁰, m.
fn required_drop_m([target_m, own_m]: [f32; 2]) -> f32 {
    let own = soft_maximum(own_m.min(0.0) / SOFTNESS_M);
    let more = (soft_maximum(target_m / SOFTNESS_M) - own).max(0.0);
    SOFTNESS_M * (own + more - own / ((1.0 + more) * (1.0 + more)))
}

/// Drop of the hip by which its leg just reaches a foot, m; negative where the leg reaches it.
fn needed_drop_m(leg: &PosedLeg, length_max_m: f32, foot: &FootPose) -> f32 {
    let to_foot_m = foot.ankle_m - leg.hip_m();
    -to_foot_m.z - libm::sqrtf((length_max_m * length_max_m - to_foot_m.truncate().length_squared()).max(0.0))
}

#[cfg(test)]
mod tests {
    use glam::Quat;
    use motiondb::body::{JOINT_COUNT, Joint, Pose};

    use super::*;
    use crate::synthesis::pose::leg::legs;
    use crate::test_db::skeleton;

    /// Legs and feet of a standing body whose knees are flexed by an angle.
    fn flexed(flexion_rad: f32) -> ([PosedLeg; 2], [FootPose; 2]) {
        let skeleton = skeleton();
        let mut pose = Pose { pelvis_m: skeleton.offsets_m[0], rotations: [Quat::IDENTITY; JOINT_COUNT] };
        for shank in Joint::SHANKS {
            pose.rotations[shank.index()] = Quat::from_rotation_y(flexion_rad);
        }
        let legs = legs(&pose, &skeleton);
        (legs, legs.each_ref().map(PosedLeg::foot))
    }

    /// Drop of that body whose right foot is `behind_m` behind its own, and the drop that this leg needs, m.
    fn drops_m(flexion_rad: f32, behind_m: f32) -> (f32, f32) {
        let (legs, own) = flexed(flexion_rad);
        let mut feet = own;
        feet[1].ankle_m.x -= behind_m;
        let needed_m = needed_drop_m(&legs[1], length_max_m(&legs[1], &own[1]), &feet[1]);
        (locked_drops_m(&legs, &own, &feet, [true; 2])[0], needed_m)
    }

    #[test]
    fn the_drop_is_sufficient_and_smooth() {
        let step_m = 0.01;
        let drops_m: Vec<(f32, f32)> = (0..40).map(|step| drops_m(0.0, step as f32 * step_m)).collect();
        assert!(drops_m.iter().all(|&(drop_m, needed_m)| drop_m >= needed_m));
        let slopes: Vec<f32> = drops_m.windows(2).map(|pair| (pair[1].0 - pair[0].0) / step_m).collect();
        assert!(slopes.windows(2).all(|pair| (pair[1] - pair[0]).abs() < 0.05), "{slopes:?}");
    }

    #[test]
    fn feet_at_the_poses_own_positions_need_no_drop() {
        assert!(drops_m(0.15, 0.0).0.abs() < 1e-6);
    }

    /// Drop in a deformed walk that spreads the feet by so much forward and backward, m.
    fn spread_drop_m(flexion_rad: f32, spread_m: f32) -> f32 {
        let (legs, mut feet) = flexed(flexion_rad);
        feet[0].ankle_m.x += spread_m;
        feet[1].ankle_m.x -= spread_m;
        deformed_drop_m(&legs, &feet)
    }

    #[test]
    fn a_deformed_walk_keeps_its_height() {
        assert!(spread_drop_m(0.15, 0.0).abs() < 1e-6 && spread_drop_m(0.6, 0.0).abs() < 1e-6);
        let step_m = 0.005;
        let drops_m: Vec<f32> = (0..60).map(|step| spread_drop_m(0.3, step as f32 * step_m)).collect();
        assert!(drops_m.is_sorted() && drops_m[50] > 0.03);
        let slopes: Vec<f32> = drops_m.windows(2).map(|pair| (pair[1] - pair[0]) / step_m).collect();
        assert!(slopes.windows(2).all(|pair| (pair[1] - pair[0]).abs() < 0.05), "{slopes:?}");
    }

    #[test]
    fn the_pelvis_rises_slowly_after_a_foot_leaves() {
        let step = TimeStep::new(1.0 / 120.0);
        let mut drop = PelvisDrop::default();
        let required_m = (0..120).map(|step| if (30..60).contains(&step) { 0.002 * (step - 30) as f32 } else { 0.0 });
        let drops_m: Vec<f32> =
            required_m.clone().map(|required_m| drop.follow([required_m; 2], false, &step)).collect();
        assert!(required_m.zip(&drops_m).all(|(required_m, &drop_m)| drop_m >= required_m - LATE_MAX_M));
        let rising = drops_m[59..].windows(3);
        let accelerations_mps2 = rising.map(|three| (three[0] - 2.0 * three[1] + three[2]).abs() * 120.0 * 120.0);
        assert!(accelerations_mps2.fold(0.0, f32::max) < 1.1 * RISE_MPS2 && drops_m[119] < 1e-3);
    }

    #[test]
    fn a_sudden_drop_ends_at_the_greatest() {
        let step = TimeStep::new(1.0 / 120.0);
        let mut drop = PelvisDrop::default();
        let needed_m = (0..60).map(|step: i32| (0.03 * step as f32).min(DROP_MAX_M));
        let deepest_m = needed_m.map(|needed_m| drop.follow([needed_m; 2], false, &step)).fold(0.0, f32::max);
        assert!(deepest_m <= DROP_MAX_M, "{deepest_m}");
    }

    /// Greatest vertical acceleration from 0.5 s on of a pelvis whose feet need drops, step by step, m/s²; `held` where
    /// the feet are held.
    fn greatest_mps2(needed_m: impl Fn(usize) -> f32, held: bool) -> f32 {
        let step = TimeStep::new(1.0 / 120.0);
        let mut drop = PelvisDrop::default();
        let held_m = |needed_m: f32| if held { needed_m } else { f32::NEG_INFINITY };
        let drops_m: Vec<f32> =
            (0..180).map(needed_m).map(|needed_m| drop.follow([needed_m, held_m(needed_m)], false, &step)).collect();
        let bends_m = drops_m[60..].windows(3).map(|three| (three[0] - 2.0 * three[1] + three[2]).abs());
        bends_m.fold(0.0, f32::max) / (step.dt_s * step.dt_s)
    }

    #[test]
    fn a_swinging_foot_out_of_reach_is_no_lurch() {
        let jump_m = |step: usize| if step < 70 { 0.0 } else { 0.08 };
        assert!(greatest_mps2(jump_m, false) < 1.1 * DROP_MPS2);
    }

    #[test]
    fn the_pelvis_comes_softly_to_the_height_of_the_pose() {
        let rise_m = |step: usize| (0.1 - 0.008 * step.saturating_sub(70) as f32).max(0.0);
        let released_m = |step: usize| {
            let left_m = 0.1 - 0.0025 * step.saturating_sub(70) as f32;
            if left_m > 0.025 { left_m } else { 0.0 }
        };
        for needed_m in [&rise_m as &dyn Fn(usize) -> f32, &released_m] {
            assert!(greatest_mps2(needed_m, true) < 1.1 * RISE_MPS2, "{}", greatest_mps2(needed_m, true));
        }
    }

    #[test]
    fn the_pelvis_keeps_its_lag_where_the_motion_changes() {
        let step = TimeStep::new(1.0 / 120.0);
        let mut drop = PelvisDrop::default();
        let mut lags_m = (0..30).map(|step| if step < 15 { 0.05 } else { 0.0 }).collect::<Vec<f32>>();
        lags_m.iter_mut().for_each(|needed_m| *needed_m = drop.follow([*needed_m; 2], false, &step) - *needed_m);
        let lag_m = drop.follow([0.03; 2], true, &step) - 0.03;
        assert!(lag_m > 0.01 && (lag_m - (2.0 * lags_m[29] - lags_m[28])).abs() < 1e-3, "{lag_m} {lags_m:?}");
    }

    #[test]
    fn the_drop_is_limited() {
        assert!((drops_m(0.0, 100.0).0 - DROP_MAX_M).abs() < 1e-6);
    }
}

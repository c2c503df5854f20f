//! The height of the pelvis: its drop where feet are away from where the pose has them, and how it moves over time.
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
//! - *Over time*: the pelvis as it is drawn rises and falls at limited accelerations ([`PelvisHeight`]), those of pose and
//!   drop together, and comes softly to the height of the pose. A foot that leaves the ground far behind needs no drop from
//!   one moment to the next, and a swinging foot may be out of reach for a moment. A held foot may not.
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
/// Greatest accelerations up and down of the pelvis of a body that walks, m/s², as long as held feet are in reach: walks have
/// 4 m/s², a lurch 18.
const RISE_MPS2: f32 = 12.0;
const FALL_MPS2: f32 = 14.0;
/// Acceleration at which the pelvis meets the height that is wanted, m/s²: less, because the motion itself may turn meanwhile.
const MEETING_MPS2: f32 = 4.0;
/// Height by which the pelvis may be above the reach of held feet, m: what straight legs still have beyond
/// [`EXTENSION`](crate::synthesis::pose::leg_length::EXTENSION).
const LATE_MAX_M: f32 = 0.006;
/// Depth beyond the greatest drop to which a pelvis may sink that stops softly, m.
const SAG_MAX_M: f32 = 0.06;
/// Softness for deformed walks, m: what a knee flexed by 15° lacks until its leg is straight.
const DEFORMED_SOFTNESS_M: f32 = 0.006;

/// Height of the pelvis of a body over time. At limited accelerations it follows the height from which the legs reach the
/// feet easily; it meets that height, and the pose, without a bump.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct PelvisHeight {
    /// Height as drawn, m.
    height_m: f32,
    /// Rate of change of that height, m/s.
    climb_mps: f32,
    /// The heights that were wanted last.
    wanted: WantedHeights,
    /// Rate of change of the pose's height, m/s.
    posed_mps: f32,
}

/// Heights that pose and legs want of the pelvis, m.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct WantedHeights {
    /// Height of the pose.
    pub(crate) posed_m: f32,
    /// Greatest height from which the legs reach the feet easily; at most that of the pose.
    pub(crate) easy_m: f32,
    /// Greatest height from which the legs reach the feet that are held; infinite where none is.
    pub(crate) greatest_m: f32,
}

impl PelvisHeight {
    /// The pelvis of a body that stands, at a height, m.
    pub(crate) fn standing(height_m: f32) -> Self {
        let wanted = WantedHeights { posed_m: height_m, easy_m: height_m, greatest_m: f32::INFINITY };
        Self { height_m, wanted, ..Self::default() }
    }

    /// The height after a step, m. The pelvis of a body that runs may accelerate as its pose does.
    pub(crate) fn follow(&mut self, wanted: &WantedHeights, runs: bool, step: &TimeStep) -> f32 {
        let dt_s = step.dt_s;
        let posed_mps = (wanted.posed_m - self.wanted.posed_m) / dt_s;
        let easy_mps = (wanted.easy_m - self.wanted.easy_m) / dt_s;
        let own_mps2 = if runs { (posed_mps - self.posed_mps) / dt_s } else { 0.0 };
        let least_mps = self.climb_mps - FALL_MPS2.max(-own_mps2) * dt_s;
        let greatest_mps = self.climb_mps + RISE_MPS2.max(own_mps2) * dt_s;
        let to_easy_mps = easy_mps + meeting_mps(self.wanted.easy_m - self.height_m, dt_s);
        let to_pose_mps = posed_mps + meeting_mps((self.wanted.posed_m - self.height_m).max(0.0), dt_s);
        let climb_mps = to_easy_mps.min(to_pose_mps).clamp(least_mps, greatest_mps);
        let least_m = wanted.posed_m - DROP_MAX_M - SAG_MAX_M;
        let greatest_m = wanted.greatest_m.max(wanted.easy_m) + LATE_MAX_M;
        let height_m = (self.height_m + dt_s * climb_mps).clamp(least_m, greatest_m);
        self.climb_mps = (height_m - self.height_m) / dt_s;
        (self.height_m, self.wanted, self.posed_mps) = (height_m, *wanted, posed_mps);
        height_m
    }
}

/// The greatest speed at which a distance can shrink and still end without a bump, in whole steps, m/s.
fn meeting_mps(distance_m: f32, dt_s: f32) -> f32 {
    let half_step_mps = 0.5 * MEETING_MPS2 * dt_s;
    let size_mps = libm::sqrtf(2.0 * MEETING_MPS2 * distance_m.abs() + half_step_mps * half_step_mps) - half_step_mps;
    size_mps.min(distance_m.abs() / dt_s).copysign(distance_m)
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

    const DT_S: f32 = 1.0 / 120.0;

    /// Drops below the pose, step by step, of a pelvis whose pose is at `posed_m` and whose feet need `needed_m`, m; the feet
    /// are held, or swing.
    fn followed_m(posed_m: impl Fn(usize) -> f32, needed_m: impl Fn(usize) -> f32, held: bool, runs: bool) -> Vec<f32> {
        let mut pelvis = PelvisHeight::standing(posed_m(0));
        let follow = |index: usize| {
            let (posed_m, needed_m) = (posed_m(index), needed_m(index));
            let easy_m = posed_m - needed_m;
            let greatest_m = if held { easy_m } else { f32::INFINITY };
            let wanted = WantedHeights { posed_m, easy_m, greatest_m };
            posed_m - pelvis.follow(&wanted, runs, &TimeStep::new(DT_S))
        };
        (0..180).map(follow).collect()
    }

    /// Greatest vertical acceleration over steps from 0.5 s on, m/s².
    fn greatest_mps2(heights_m: &[f32]) -> f32 {
        let bends_m = heights_m[60..].windows(3).map(|three| (three[0] - 2.0 * three[1] + three[2]).abs());
        bends_m.fold(0.0, f32::max) / (DT_S * DT_S)
    }

    /// Drops below a pose that keeps its height, m.
    fn followed_drops_m(needed_m: impl Fn(usize) -> f32, held: bool) -> Vec<f32> {
        followed_m(|_| 0.9, needed_m, held, false)
    }

    #[test]
    fn the_pelvis_rises_slowly_after_a_foot_leaves() {
        let needed_m = |step: usize| if (60..90).contains(&step) { 0.002 * (step - 60) as f32 } else { 0.0 };
        let drops_m = followed_drops_m(needed_m, true);
        assert!((0..180).all(|step| drops_m[step] >= needed_m(step) - LATE_MAX_M - 1e-6));
        assert!(greatest_mps2(&drops_m) < 1.1 * FALL_MPS2 && drops_m[179] < 1e-3, "{}", greatest_mps2(&drops_m));
    }

    #[test]
    fn a_sudden_drop_ends_near_the_greatest() {
        let drops_m = followed_drops_m(|step| (0.03 * step as f32).min(DROP_MAX_M), true);
        let deepest_m = drops_m.iter().copied().fold(0.0, f32::max);
        assert!(deepest_m <= DROP_MAX_M + SAG_MAX_M + 1e-6, "{deepest_m}");
        assert!((drops_m[179] - DROP_MAX_M).abs() < 1e-3, "{}", drops_m[179]);
    }

    #[test]
    fn a_swinging_foot_out_of_reach_is_no_lurch() {
        let drops_m = followed_drops_m(|step| if step < 70 { 0.0 } else { 0.08 }, false);
        assert!(greatest_mps2(&drops_m) < 1.1 * FALL_MPS2, "{}", greatest_mps2(&drops_m));
    }

    #[test]
    fn the_pelvis_comes_softly_to_the_height_of_the_pose() {
        let rise_m = |step: usize| (0.1 - 0.008 * step.saturating_sub(70) as f32).max(0.0);
        let released_m = |step: usize| {
            let left_m = 0.1 - 0.0025 * step.saturating_sub(70) as f32;
            if left_m > 0.025 { left_m } else { 0.0 }
        };
        for needed_m in [&rise_m as &dyn Fn(usize) -> f32, &released_m] {
            let drops_m = followed_drops_m(needed_m, true);
            assert!(greatest_mps2(&drops_m) < 1.1 * RISE_MPS2, "{}", greatest_mps2(&drops_m));
            assert!(drops_m.iter().all(|&drop_m| drop_m > -0.002));
        }
    }

    /// A pose that bounces with so many m/s², three times a second.
    fn bounce_m(mps2: f32) -> impl Fn(usize) -> f32 {
        let rate = 6.0 * std::f32::consts::PI;
        move |step| 0.9 - mps2 / (rate * rate) * libm::cosf(rate * step as f32 * DT_S)
    }

    /// The height as drawn of a pelvis whose pose is at `posed_m`, m.
    fn drawn_m(posed_m: impl Fn(usize) -> f32, needed_m: impl Fn(usize) -> f32, runs: bool) -> Vec<f32> {
        let drops_m = followed_m(&posed_m, needed_m, false, runs);
        (0..180).map(|step| posed_m(step) - drops_m[step]).collect()
    }

    #[test]
    fn pose_and_drop_together_are_no_lurch() {
        // The drop begins where the pose falls, as after a landing.
        let needed_m = |step: usize| if step % 40 < 20 { 0.0 } else { 0.03 };
        let heights_m = drawn_m(bounce_m(8.0), needed_m, false);
        assert!(greatest_mps2(&heights_m) < 1.1 * FALL_MPS2, "{}", greatest_mps2(&heights_m));
    }

    #[test]
    fn a_walk_keeps_its_bounce_and_a_run_a_greater_one() {
        for (mps2, runs) in [(5.0, false), (25.0, true)] {
            let (posed_m, heights_m) = (bounce_m(mps2), drawn_m(bounce_m(mps2), |_| 0.0, runs));
            assert!((60..180).all(|step| (heights_m[step] - posed_m(step)).abs() < 1e-3), "{mps2} m/s²");
        }
        let heights_m = drawn_m(bounce_m(25.0), |_| 0.0, false);
        assert!(greatest_mps2(&heights_m) < 1.1 * FALL_MPS2, "{}", greatest_mps2(&heights_m));
    }

    #[test]
    fn the_drop_is_limited() {
        assert!((drops_m(0.0, 100.0).0 - DROP_MAX_M).abs() < 1e-6);
    }
}

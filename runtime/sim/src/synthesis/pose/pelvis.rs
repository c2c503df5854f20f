//! How high the pelvis is over feet that are not where the pose has them.
//!
//! With d and d⁰ the descents that a leg needs to reach its target and the pose's own foot, negative where it reaches,
//! and S a soft maximum with none, s its softness,
//!
//! ```text
//! S(d) = ½(d + √(d² + 4s²)),   ⌈a, b⌉ = b + S(a − b):
//! ```
//!
//! - in another walk hips are as high over the straighter leg as they are in the clip: lower by D = ⌈d, d′⌉ − ⌈d⁰, d⁰′⌉
//!   where that is positive, and higher by a share of it where legs would else bend more than they need;
//! - over feet that are held they only come down. Each leg asks for S(d) − S(d⁰)/(1 + (S(d) − S(d⁰))/s)²: nothing where
//!   the foot is where the pose has it, never less than what is needed, and a little before it must, so that neither
//!   hips nor knee jerk as the leg comes to its end. The pelvis comes down by a little more than what the more exacting
//!   leg asks for. It does so when it is asked to, and goes up again gently ([`Descent`]): a trailing foot that leaves
//!   the ground, or comes back under the body, asks for nothing from one step to the next, and hips that followed would
//!   shoot up.
//!
//! All vectors are in the root frame (x forward, y left, z up), metres.

use glam::Vec2;

use crate::maths::decay::soft_maximum;
use crate::synthesis::pose::leg::{FootPose, Leg};
use crate::synthesis::time_step::TimeStep;

/// Straightest a leg may be before the pelvis comes down for it, as a share of its length; straighter only where the
/// pose is.
pub(crate) const EXTENSION: f32 = 0.99;
/// Straightest of all, a knee flexed by 6°: a blend of straight legs may be straighter than any of them, and beyond it
/// the knee would snap at the end of the leg.
const EXTENSION_MAX: f32 = 0.9985;
/// Furthest that the pelvis comes down, m.
pub(crate) const DROP_MAX_M: f32 = 0.12;
/// s, m: less than what the hips bob in walking. With 0.01 knees snap at stops.
pub(crate) const SOFTNESS_M: f32 = 0.014;
/// Share by which hips are raised where legs would otherwise bend more than in the clip: with all of it, short strides
/// would take them higher as feet land than at mid-stance.
const RAISED: f32 = 0.45;
/// Edges of what one leg or the other needs are rounded off below about this, m: what a knee has that is flexed by 15°,
/// until its leg is straight.
const ROUNDING_M: f32 = 0.006;
/// Rate of the filter by which the pelvis goes up again, 1/s: of a descent, an eighth is left after 0.25 s, a swing.
pub(crate) const RISE_RATE_HZ: f32 = 20.0;

/// How far the pelvis has come down, m, its rate and the rate of that, a second.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Descent([f32; 3]);

impl Descent {
    /// How far the pelvis is to be down after a step that asks for so much.
    pub fn follow(&mut self, asked_m: f32, step: &TimeStep) -> f32 {
        let [before_m, ..] = self.0;
        self.0 = match step.rise.pass(self.0) {
            rising @ [rising_m, ..] if rising_m > asked_m => rising,
            _ => [asked_m, (asked_m - before_m) / step.dt_s, 0.0],
        };
        self.0[0]
    }
}

/// How much lower the pelvis is where feet are where another walk has them than over the pose's own, m; negative where
/// it is higher.
pub(crate) fn lower_m(legs: &[Leg; 2], feet: &[FootPose; 2]) -> f32 {
    let [[left_m, left_own_m], [right_m, right_own_m]] = needs_m(legs, &legs.each_ref().map(Leg::foot), feet);
    let lower_m = greater_m(left_m, right_m) - greater_m(left_own_m, right_own_m);
    (RAISED * lower_m + (1.0 - RAISED) * softly_positive_m(lower_m)).min(DROP_MAX_M)
}

/// The positive part of a length, m, without an edge: none at 0, and less than the length by no more than the rounding.
pub(crate) fn softly_positive_m(length_m: f32) -> f32 {
    ROUNDING_M * (soft_maximum(length_m / ROUNDING_M) - 1.0)
}

/// The greater of two lengths, without an edge.
fn greater_m(one_m: f32, other_m: f32) -> f32 {
    other_m + ROUNDING_M * soft_maximum((one_m - other_m) / ROUNDING_M)
}

/// How far the pelvis comes down where feet move from where the pose has them, m.
pub(crate) fn drop_m(legs: &[Leg; 2], posed: &[FootPose; 2], feet: &[FootPose; 2]) -> f32 {
    let [left_m, right_m] = needs_m(legs, posed, feet).map(|[target_m, own_m]| asked_m(target_m, own_m));
    libm::sqrtf(Vec2::new(left_m * left_m, right_m * right_m).length()).min(DROP_MAX_M)
}

/// d and d⁰ of each leg.
fn needs_m(legs: &[Leg; 2], posed: &[FootPose; 2], feet: &[FootPose; 2]) -> [[f32; 2]; 2] {
    [0, 1].map(|side| {
        let extent_m = extent_m(&legs[side], &posed[side]);
        [&feet[side], &posed[side]].map(|foot| needed_m(&legs[side], extent_m, foot))
    })
}

/// What a leg asks for, of what it needs to reach its target and its own foot.
fn asked_m(target_m: f32, own_m: f32) -> f32 {
    let own = soft_maximum(own_m.min(0.0) / SOFTNESS_M);
    let more = (soft_maximum(target_m / SOFTNESS_M) - own).max(0.0);
    SOFTNESS_M * (own + more - own / ((1.0 + more) * (1.0 + more)))
}

/// How far a leg may stretch: no more than the pose does.
fn extent_m(leg: &Leg, posed: &FootPose) -> f32 {
    let leg_m = leg.bones_m[0] + leg.bones_m[1];
    posed.ankle_m.distance(leg.hip_m()).clamp(EXTENSION * leg_m, EXTENSION_MAX * leg_m)
}

/// How far the hip must come down for its leg to reach a foot; negative if it reaches.
fn needed_m(leg: &Leg, extent_m: f32, foot: &FootPose) -> f32 {
    let to_foot_m = foot.ankle_m - leg.hip_m();
    -to_foot_m.z - libm::sqrtf((extent_m * extent_m - to_foot_m.truncate().length_squared()).max(0.0))
}

#[cfg(test)]
mod tests {
    use glam::Quat;
    use motiondb::body::{JOINT_COUNT, Joint, Pose};

    use super::*;
    use crate::synthesis::pose::leg::legs;
    use crate::test_db::skeleton;

    /// The legs of a standing body, its knees flexed by an angle, and its feet.
    fn flexed(flexion_rad: f32) -> ([Leg; 2], [FootPose; 2]) {
        let skeleton = skeleton();
        let mut pose = Pose { pelvis_m: skeleton.offsets_m[0], rotations: [Quat::IDENTITY; JOINT_COUNT] };
        for shank in Joint::SHANKS {
            pose.rotations[shank.index()] = Quat::from_rotation_y(flexion_rad);
        }
        let legs = legs(&pose, &skeleton);
        (legs, legs.each_ref().map(Leg::foot))
    }

    /// Its descent where its right foot is left behind by a length, and the descent that its leg needs.
    fn lowered_m(flexion_rad: f32, behind_m: f32) -> (f32, f32) {
        let (legs, posed) = flexed(flexion_rad);
        let mut feet = posed;
        feet[1].ankle_m.x -= behind_m;
        let needed_m = needed_m(&legs[1], extent_m(&legs[1], &posed[1]), &feet[1]);
        (drop_m(&legs, &posed, &feet), needed_m)
    }

    #[test]
    fn comes_down_far_enough_and_without_a_jerk() {
        let step_m = 0.01;
        let lowered_m: Vec<(f32, f32)> = (0..40).map(|step| lowered_m(0.0, step as f32 * step_m)).collect();
        assert!(lowered_m.iter().all(|&(drop_m, needed_m)| drop_m >= needed_m));
        let slopes: Vec<f32> = lowered_m.windows(2).map(|pair| (pair[1].0 - pair[0].0) / step_m).collect();
        assert!(slopes.windows(2).all(|pair| (pair[1] - pair[0]).abs() < 0.05), "{slopes:?}");
    }

    #[test]
    fn a_pose_whose_feet_are_where_they_should_be_is_left_as_it_is() {
        assert!(lowered_m(0.15, 0.0).0.abs() < 1e-6);
    }

    /// How much lower its hips are where another walk spreads its feet by so much to either side.
    fn spread_lower_m(flexion_rad: f32, spread_m: f32) -> f32 {
        let (legs, mut feet) = flexed(flexion_rad);
        feet[0].ankle_m.x += spread_m;
        feet[1].ankle_m.x -= spread_m;
        lower_m(&legs, &feet)
    }

    #[test]
    fn another_walk_has_its_hips_as_high_over_the_straighter_leg_without_an_edge() {
        assert!(spread_lower_m(0.15, 0.0).abs() < 1e-6 && spread_lower_m(0.6, 0.0).abs() < 1e-6);
        let step_m = 0.005;
        let lower_m: Vec<f32> = (0..60).map(|step| spread_lower_m(0.3, step as f32 * step_m)).collect();
        assert!(lower_m.is_sorted() && lower_m[50] > 0.03);
        let slopes: Vec<f32> = lower_m.windows(2).map(|pair| (pair[1] - pair[0]) / step_m).collect();
        assert!(slopes.windows(2).all(|pair| (pair[1] - pair[0]).abs() < 0.05), "{slopes:?}");
    }

    #[test]
    fn goes_up_gently_when_a_foot_leaves_the_ground() {
        let step = TimeStep::new(1.0 / 120.0);
        let mut descent = Descent::default();
        let asked_m = (0..120).map(|step| if (30..60).contains(&step) { 0.002 * (step - 30) as f32 } else { 0.0 });
        let lowered_m: Vec<f32> = asked_m.clone().map(|asked_m| descent.follow(asked_m, &step)).collect();
        assert!(asked_m.zip(&lowered_m).all(|(asked_m, &lowered_m)| lowered_m >= asked_m));
        let rising = lowered_m[59..].windows(3);
        let greatest_mps2 = rising.map(|three| (three[0] - 2.0 * three[1] + three[2]).abs() * 120.0 * 120.0);
        assert!(greatest_mps2.fold(0.0, f32::max) < 12.0 && lowered_m[119] < 1e-3);
    }

    #[test]
    fn a_foot_out_of_all_reach_takes_it_down_no_further_than_a_crouch() {
        assert!((lowered_m(0.0, 100.0).0 - DROP_MAX_M).abs() < 1e-6);
    }
}

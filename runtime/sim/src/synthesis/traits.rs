//! Traits: what makes the body of one agent move unlike others that play the same motion. `FbCrowd` does not have them.
//!
//! - *Cadence* at equal speed. A body of quick steps plays the gait of a lower speed, at a higher rate
//!   ([`crate::synthesis::blending::cadence_curve`]). Semi-procedural locomotion states its cadence itself.
//! - *Arms*: upper arms and forearms swing more or less about their mean in the motion that plays, each side by itself.
//! - *Pitch* of trunk and head. The head takes the trunk's pitch back.
//! - *Secondary motion*: head, forearms and hands of a walking body move a little
//!   ([`crate::synthesis::pose::upper_body::secondary_motion`]).
//! - *First foot*: where both feet stand side by side, one of them makes the first step.
//!
//! Lengths in metres, angles in radians; a pitch is positive forward.

use glam::{Quat, Vec3};
use motiondb::body::{Joint, Pose};

use crate::maths::angle::rotation;

/// Joints of each arm that swing, `[left, right]`.
pub(crate) const ARMS: [[Joint; 2]; 2] =
    [[Joint::LeftUpperArm, Joint::LeftForearm], [Joint::RightUpperArm, Joint::RightForearm]];

/// Rotations of [`ARMS`].
pub(crate) type ArmRotations = [[Quat; 2]; 2];

/// Rotations of the joints of the arms in a pose.
pub(crate) fn arm_rotations(pose: &Pose) -> ArmRotations {
    ARMS.map(|arm| arm.map(|joint| pose.rotations[joint.index()]))
}

/// Scales the swing of each arm about its mean, `[left, right]`.
pub(crate) fn swing_arms(pose: &mut Pose, means: &ArmRotations, swing: [f32; 2]) {
    for ((arm, means), swing) in ARMS.iter().zip(means).zip(swing).filter(|(_, swing)| *swing != 1.0) {
        for (joint, mean) in arm.iter().zip(means) {
            let rotation = &mut pose.rotations[joint.index()];
            *rotation = swung(*mean, *rotation, swing);
        }
    }
}

/// What one body does differently.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Traits {
    /// Cadence at equal speed, divided by that of the clips. Step length changes inversely.
    pub cadence: f32,
    /// Swing of each arm about its mean, `[left, right]`, divided by that of the clips.
    pub arm_swing: [f32; 2],
    /// Forward pitch that the trunk adds, rad.
    pub trunk_pitch_rad: f32,
    /// Forward pitch that the head adds, rad.
    pub head_pitch_rad: f32,
    /// Lead of the left foot, m, up to which it makes the first step; negative where the right foot does.
    pub first_foot_m: f32,
    /// Secondary motion, divided by that of captures, where the clips lack it.
    pub secondary_motion: f32,
    /// Seed of the secondary motion.
    pub secondary_seed: u64,
}

impl Default for Traits {
    /// A body that moves as in the clips.
    fn default() -> Self {
        Self {
            cadence: 1.0,
            arm_swing: [1.0; 2],
            trunk_pitch_rad: 0.0,
            head_pitch_rad: 0.0,
            first_foot_m: 0.0,
            secondary_motion: 0.0,
            secondary_seed: 0,
        }
    }
}

impl Traits {
    /// Pitches trunk and head of a pose.
    pub(crate) fn pitch(&self, pose: &mut Pose) {
        pitch(pose, Joint::SpineLower, self.trunk_pitch_rad);
        pitch(pose, Joint::Head, self.head_pitch_rad - self.trunk_pitch_rad);
    }
}

/// A rotation whose deviation from a mean is scaled.
fn swung(mean: Quat, rotation: Quat, factor: f32) -> Quat {
    let mean = if mean.dot(rotation) < 0.0 { -mean } else { mean };
    (mean * (1.0 - factor) + rotation * factor).normalize()
}

/// Turns a joint forward about its parent's axis to the left.
fn pitch(pose: &mut Pose, joint: Joint, pitch_rad: f32) {
    if pitch_rad != 0.0 {
        let rotated = &mut pose.rotations[joint.index()];
        *rotated = rotation(pitch_rad * Vec3::Y) * *rotated;
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use glam::Vec2;
    use motiondb::body::{JOINT_COUNT, Root};
    use motiondb::motion::{PHASE_COUNT, Parameters};

    use super::*;
    use crate::planning::plan::Plan;
    use crate::synthesis::blending::BlendDomain;
    use crate::synthesis::{Body, BodyOutput, HmsParams, Modes, SynthesisContext, TimeStep};
    use crate::test_db::{DUTY, test_db};

    const DT_S: f32 = 1.0 / 60.0;

    fn context(modes: Modes) -> SynthesisContext {
        SynthesisContext::new(Arc::new(test_db()), HmsParams { modes, ..HmsParams::default() })
    }

    /// A body with traits that walks ahead from rest for 6 s, after each step.
    fn walk(context: &SynthesisContext, traits: Traits, speed_mps: f32) -> Vec<(Body, BodyOutput)> {
        let step = TimeStep::new(DT_S);
        let (mut body, _) = Body::standing_with(context, Root::default(), 0.3, traits);
        let density = if context.params.modes == Modes::SemiProcedural { 1.0 } else { 0.0 };
        let plan = Plan { velocity_mps: Vec2::new(speed_mps, 0.0), density, ..Plan::default() };
        let mut after_step = || {
            body.advance(context, &plan, &step);
            let output = body.synthesize(context, &step);
            (body, output)
        };
        (0..360).map(|_| after_step()).collect()
    }

    /// Strides per second, speed of the root (m/s) and greatest displacement of a planted sole (m) in the last 4 s.
    fn gait(context: &SynthesisContext, cadence: f32) -> [f32; 3] {
        let steps = &walk(context, Traits { cadence, ..Traits::default() }, 1.1)[120..];
        let phases = steps.windows(2).map(|pair| (pair[1].0.motion.phase - pair[0].0.motion.phase).rem_euclid(1.0));
        let duration_s = (steps.len() - 1) as f32 * DT_S;
        let path_m = steps[steps.len() - 1].0.root.position_m.distance(steps[0].0.root.position_m);
        let ball_m = |(body, output): &(Body, BodyOutput)| {
            let joints = output.pose.forward_kinematics(&context.db.skeleton);
            body.root.to_world(joints.sole_points_m(&context.db.skeleton, 0)[1])
        };
        // Flat on the ground about mid-stance.
        let flat = |step: &(Body, BodyOutput)| (step.0.motion.phase - 0.5).abs() < 0.2 * DUTY;
        let slides_m = steps.windows(2).filter(|pair| flat(&pair[0]) && flat(&pair[1]));
        let slide_m = slides_m.map(|pair| ball_m(&pair[0]).distance(ball_m(&pair[1]))).fold(0.0, f32::max);
        [phases.sum::<f32>() / duration_s, path_m / duration_s, slide_m]
    }

    #[test]
    fn quick_bodies_walk_as_fast_in_shorter_steps() {
        for modes in [Modes::Blending, Modes::SemiProcedural] {
            let context = context(modes);
            let [slow, as_in_clips, quick] = [0.92, 1.0, 1.08].map(|cadence| gait(&context, cadence));
            for [_, speed_mps, slide_m] in [slow, as_in_clips, quick] {
                assert!((speed_mps - 1.1).abs() < 1e-3 && slide_m < 1e-3, "{modes:?}: {speed_mps} m/s, {slide_m} m");
            }
            let ratios = [slow[0] / as_in_clips[0], quick[0] / as_in_clips[0]];
            assert!((ratios[0] - 0.92).abs() < 0.01 && (ratios[1] - 1.08).abs() < 0.01, "{modes:?}: {ratios:?}");
        }
    }

    #[test]
    fn long_strides_yield_at_the_border_of_the_examples() {
        let db = test_db();
        let domain = BlendDomain::new(&db);
        for (speed_mps, turn_rate_rad_s, strafe_mps) in
            [(1.5, 0.0, 0.0), (1.4, 0.0, 0.0), (0.7, 1.2, 0.0), (0.0, 0.0, -0.45), (0.3, 0.3, 0.25), (-0.55, 0.0, 0.0)]
        {
            let query = Parameters { speed_mps, turn_rate_rad_s, strafe_mps };
            for cadence in [0.88, 0.95, 1.0, 1.12] {
                let reachable = domain.reachable_with(query, cadence);
                let off = reachable.parameters.to_vec3().distance(query.to_vec3());
                assert!(off < 2e-3, "{query:?} at {cadence}: {reachable:?}");
                assert!(cadence > 1.0 || reachable.playback_rate <= 1.0);
            }
        }
        let inside = Parameters { speed_mps: 0.9, ..Parameters::default() };
        assert!(domain.reachable_with(inside, 0.9).playback_rate < 0.92);
    }

    #[test]
    fn a_body_begins_with_its_first_foot() {
        let context = context(Modes::Blending);
        let lifts_left = |first_foot_m: f32| {
            let steps = walk(&context, Traits { first_foot_m, ..Traits::default() }, 1.1);
            let contacts = steps.iter().map(|(_, output)| output.contacts);
            contacts.into_iter().find(|contacts| contacts.iter().any(|contact| *contact < 0.5)).unwrap()[0] < 0.5
        };
        assert_eq!([0.05, -0.05].map(lifts_left), [true, false]);
    }

    #[test]
    fn arms_swing_about_the_mean_of_the_gait_that_plays() {
        let mut db = test_db();
        let (fast, forearm) = (3, Joint::LeftForearm.index());
        for row in 0..PHASE_COUNT {
            let bent = &mut db.rows.rotations[(fast * PHASE_COUNT + row) * JOINT_COUNT + forearm];
            *bent = Quat::from_rotation_z(-1.2) * *bent;
        }
        let params = HmsParams { modes: Modes::Blending, ..HmsParams::default() };
        let context = SynthesisContext::new(Arc::new(db), params);
        let bend = |swing: f32| {
            let steps = walk(&context, Traits { arm_swing: [swing; 2], ..Traits::default() }, 1.5);
            steps[300].1.pose.rotations[forearm]
        };
        assert!(bend(1.0).angle_between(Quat::IDENTITY) > 0.8, "{}", bend(1.0));
        assert!(bend(1.4).angle_between(bend(1.0)) < 0.1, "{} {}", bend(1.4), bend(1.0));
    }

    #[test]
    fn arms_swing_about_their_mean_and_legs_stay() {
        let db = test_db();
        let (mean_pose, mut pose) = (db.rows.mean_pose(2), db.rows.pose(2, 10));
        let mean = mean_pose.rotations;
        let [left, right] = ARMS.map(|arm| arm[0].index());
        pose.rotations[left] = Quat::from_rotation_y(0.2) * mean[left];
        pose.rotations[right] = Quat::from_rotation_y(-0.2) * mean[right];
        let before = pose;
        let traits = Traits { arm_swing: [1.5, 0.5], trunk_pitch_rad: 0.05, head_pitch_rad: 0.1, ..Traits::default() };
        swing_arms(&mut pose, &arm_rotations(&mean_pose), traits.arm_swing);
        traits.pitch(&mut pose);
        let swing_rad = |joint: usize| pose.rotations[joint].angle_between(mean[joint]);
        assert!((swing_rad(left) - 0.3).abs() < 5e-3 && (swing_rad(right) - 0.1).abs() < 5e-3);
        let skeleton = &db.skeleton;
        let [joints_before, joints] = [before, pose].map(|pose| pose.forward_kinematics(skeleton));
        let head_rad =
            joints.orientations[Joint::Head.index()].angle_between(joints_before.orientations[Joint::Head.index()]);
        assert!((head_rad - 0.1).abs() < 2e-3, "{head_rad}");
        let legs = Joint::LeftThigh.index()..;
        assert_eq!(joints.positions_m[legs.clone()], joints_before.positions_m[legs]);
    }
}

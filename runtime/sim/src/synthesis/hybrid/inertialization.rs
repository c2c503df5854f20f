//! Inertialization (Bollo 2018): after a switch the body moves on as it did, and the difference of poses decays on top
//! of the new synthesis. Only the new one is computed; nothing is cross-faded.
//!
//! A difference is an offset of the pelvis and a rotation vector for each joint, each with its rate of change. Each
//! decays like a critically damped spring that starts at that rate, so neither pose nor velocity jumps.
//!
//! Root frame; metres, radians, seconds.

use glam::{Quat, Vec3};
use motiondb::body::{JOINT_COUNT, Pose};

use crate::maths::angle::rotation;
use crate::synthesis::TimeStep;

/// Difference, and rate of change, below which inertialization ends, m and rad, per second.
pub(super) const NEGLIGIBLE: f32 = 1e-4;

/// A difference of two poses: offset of the pelvis, m, then the rotation vector of each joint, rad. Plain numbers let
/// the compiler emit vector instructions.
#[derive(Clone, Copy, Debug, PartialEq)]
struct PoseDifference([[f32; 3]; 1 + JOINT_COUNT]);

/// The difference that is left and its rate of change per second; `None` where nothing is left.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Inertialization(Option<[PoseDifference; 2]>);

impl Inertialization {
    /// Takes up the difference of a switch. `old` and `new` are the poses of both syntheses, now and `interval_s`
    /// before, without any difference that is left.
    pub(crate) fn begin(&mut self, old: [&Pose; 2], new: [&Pose; 2], interval_s: f32) {
        let [now, before] = [0, 1].map(|time| PoseDifference::between(old[time], new[time]));
        let rate = now.combined(1.0 / interval_s, &before, -1.0 / interval_s);
        self.0 = Some(match &self.0 {
            Some([left, left_rate]) => [left.after(&now), left_rate.combined(1.0, &rate, 1.0)],
            None => [now, rate],
        });
    }

    /// Whether a difference is left.
    pub(crate) fn is_active(&self) -> bool {
        self.0.is_some()
    }

    /// Lets the difference decay over one step.
    pub(crate) fn decay(&mut self, step: &TimeStep) {
        let Some([left, rate]) = &mut self.0 else { return };
        for (left, rate) in left.values_mut().iter_mut().zip(rate.values_mut()) {
            (*left, *rate) = step.inertia.decayed(*left, *rate);
        }
        if left.greatest().max(rate.greatest()) <= NEGLIGIBLE {
            self.0 = None;
        }
    }

    /// Adds the difference that is left to a pose.
    pub(crate) fn add_to(&self, pose: &mut Pose) {
        if let Some([left, _]) = &self.0 {
            left.add_to(pose);
        }
    }
}

impl PoseDifference {
    fn between(old: &Pose, new: &Pose) -> Self {
        let mut vectors = [(old.pelvis_m - new.pelvis_m).to_array(); 1 + JOINT_COUNT];
        for (vector, (old, new)) in vectors[1..].iter_mut().zip(old.rotations.iter().zip(&new.rotations)) {
            *vector = rotation_vector(*old * new.conjugate()).to_array();
        }
        Self(vectors)
    }

    /// This difference on top of another.
    fn after(&self, other: &Self) -> Self {
        let mut both = self.combined(1.0, other, 1.0);
        for (both, (own, other)) in both.0.iter_mut().zip(self.0.iter().zip(&other.0)).skip(1) {
            let [own, other] = [own, other].map(|vector_rad| rotation(Vec3::from(*vector_rad)));
            *both = rotation_vector(own * other).to_array();
        }
        both
    }

    /// Weighted sum of two differences, value by value.
    fn combined(&self, factor: f32, other: &Self, other_factor: f32) -> Self {
        let mut sum = *self;
        for (own, other) in sum.values_mut().iter_mut().zip(other.0.as_flattened()) {
            *own = factor * *own + other_factor * *other;
        }
        sum
    }

    fn add_to(&self, pose: &mut Pose) {
        pose.pelvis_m += Vec3::from(self.0[0]);
        for (posed, vector_rad) in pose.rotations.iter_mut().zip(&self.0[1..]) {
            *posed = rotation(Vec3::from(*vector_rad)) * *posed;
        }
    }

    /// The greatest absolute value.
    fn greatest(&self) -> f32 {
        // Bit patterns of non-negative floats are ordered like their values.
        f32::from_bits(self.0.as_flattened().iter().fold(0, |greatest, value| greatest.max(value.abs().to_bits())))
    }

    fn values_mut(&mut self) -> &mut [f32] {
        self.0.as_flattened_mut()
    }
}

/// The rotation vector of the shorter turn, rad.
pub(super) fn rotation_vector(turn: Quat) -> Vec3 {
    if turn.w < 0.0 { -turn } else { turn }.to_scaled_axis()
}

#[cfg(test)]
mod tests {
    use super::*;

    const INTERVAL_S: f32 = 1.0 / 120.0;

    fn bent(angle_rad: f32) -> Pose {
        Pose {
            pelvis_m: Vec3::new(0.0, 0.1 * angle_rad, 0.9),
            rotations: [Quat::from_rotation_y(angle_rad); JOINT_COUNT],
        }
    }

    fn angle_rad(pose: &Pose) -> f32 {
        pose.rotations[3].to_scaled_axis().y
    }

    #[test]
    fn the_pose_moves_on_into_the_new_synthesis() {
        let speed_rad_s = 1.5;
        let before = 0.3 - speed_rad_s * INTERVAL_S;
        let mut inertialization = Inertialization::default();
        inertialization.begin([&bent(0.3), &bent(before)], [&bent(0.0), &bent(0.0)], INTERVAL_S);
        let dt_s = 1.0 / 240.0;
        let shown: Vec<f32> = (0..480)
            .map(|_| {
                inertialization.decay(&TimeStep::new(dt_s));
                let mut pose = bent(0.0);
                inertialization.add_to(&mut pose);
                angle_rad(&pose)
            })
            .collect();
        assert!((shown[0] - (0.3 + speed_rad_s * dt_s)).abs() < 3e-3, "{}", shown[0]);
        let steps = shown.windows(2).map(|pair| pair[1] - pair[0]).collect::<Vec<_>>();
        assert!(steps.windows(2).all(|pair| (pair[1] - pair[0]).abs() < 1.2e-3));
        assert!(shown[96] < 0.1 && shown[479].abs() < 1e-3 && !inertialization.is_active());
    }

    #[test]
    fn differences_of_two_switches_add_up() {
        let mut inertialization = Inertialization::default();
        let [shown, played, next] = [Quat::from_rotation_y(0.5), Quat::IDENTITY, Quat::from_rotation_x(0.6)]
            .map(|rotation| Pose { rotations: [rotation; JOINT_COUNT], ..bent(0.0) });
        inertialization.begin([&shown; 2], [&played; 2], INTERVAL_S);
        inertialization.begin([&played; 2], [&next; 2], INTERVAL_S);
        let mut pose = next;
        inertialization.add_to(&mut pose);
        assert!(pose.rotations[3].angle_between(shown.rotations[3]) < 1e-3);
    }

    #[test]
    fn without_a_switch_nothing_is_added() {
        let mut pose = bent(0.4);
        Inertialization::default().add_to(&mut pose);
        assert_eq!(pose, bent(0.4));
    }
}

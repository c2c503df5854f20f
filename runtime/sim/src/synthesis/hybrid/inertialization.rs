//! What difference of pose a switch of synthesis leaves is carried away by inertialisation (Bollo 2018): the body goes
//! on as it moved, and the difference dies out on top of the new synthesis. Only the new one is computed; nothing is
//! cross-faded.
//!
//! A difference is a rotation vector per joint and an offset of the pelvis, each with its rate; each decays like a
//! critically damped spring, which begins at that rate, so neither pose nor velocity jumps. Radians, metres, seconds.

use glam::{Quat, Vec3};
use motiondb::body::{JOINT_COUNT, Pose};

use crate::maths::angle::rotation;
use crate::synthesis::time_step::TimeStep;

/// Rate of the springs, 1/s: from mid-stance, where synthesis changes hands, 14 % of a difference is left when the next
/// foot lands (0.3 s), and 5 % after a step (0.4 s).
pub(crate) const RATE_HZ: f32 = 12.0;
/// By then a difference has died out, s.
pub const CARRIED_S: f32 = 0.4;
/// Less than this of a difference is none, rad and m.
const NEGLIGIBLE: f32 = 1e-4;
/// A rate is a difference over this time before the switch, or over the step where that is shorter, s.
pub(crate) const LOOK_BACK_S: f32 = 1.0 / 120.0;

/// A difference of two poses: of the pelvis, m, then of each joint's rotation, as a vector, rad. Of plain numbers, so
/// that vector instructions come of it.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Difference([[f32; 3]; 1 + JOINT_COUNT]);

/// The difference that is left, and its rate; none where there is nothing left.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Inertia(Option<[Difference; 2]>);

impl Inertia {
    /// Takes up the difference of a switch. `old` and `new` are the poses of both syntheses now and a moment ago, as
    /// they were without what is left.
    pub fn begin(&mut self, old: [&Pose; 2], new: [&Pose; 2], moment_s: f32) {
        let [now, before] = [0, 1].map(|time| Difference::between(old[time], new[time]));
        let rate = now.combined(1.0 / moment_s, &before, -1.0 / moment_s);
        self.0 = Some(match &self.0 {
            Some([left, left_rate]) => [left.after(&now), left_rate.combined(1.0, &rate, 1.0)],
            None => [now, rate],
        });
    }

    /// Whether a difference is left.
    pub fn carries(&self) -> bool {
        self.0.is_some()
    }

    /// Lets a step pass.
    pub fn pass(&mut self, step: &TimeStep) {
        let Some([left, rate]) = &mut self.0 else { return };
        for (left, rate) in left.values_mut().iter_mut().zip(rate.values_mut()) {
            (*left, *rate) = step.inertia.pass(*left, *rate);
        }
        if left.greatest().max(rate.greatest()) <= NEGLIGIBLE {
            self.0 = None;
        }
    }

    /// Adds what is left to the pose of the new synthesis.
    pub fn add_to(&self, pose: &mut Pose) {
        if let Some([left, _]) = &self.0 {
            left.add_to(pose);
        }
    }
}

impl Difference {
    fn between(old: &Pose, new: &Pose) -> Self {
        let mut vectors = [(old.pelvis_m - new.pelvis_m).to_array(); 1 + JOINT_COUNT];
        for (vector, (old, new)) in vectors[1..].iter_mut().zip(old.rotations.iter().zip(&new.rotations)) {
            *vector = rotation_vector(*old * new.conjugate()).to_array();
        }
        Self(vectors)
    }

    /// Of both, this one on top of the other.
    fn after(&self, other: &Self) -> Self {
        let mut both = self.combined(1.0, other, 1.0);
        for (both, (own, other)) in both.0.iter_mut().zip(self.0.iter().zip(&other.0)).skip(1) {
            let [own, other] = [own, other].map(|vector_rad| rotation(Vec3::from(*vector_rad)));
            *both = rotation_vector(own * other).to_array();
        }
        both
    }

    /// Of both, each times its factor.
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

    /// The greatest of its values.
    fn greatest(&self) -> f32 {
        // Sizes are in the order of their bits.
        f32::from_bits(self.0.as_flattened().iter().fold(0, |greatest, value| greatest.max(value.abs().to_bits())))
    }

    fn values_mut(&mut self) -> &mut [f32] {
        self.0.as_flattened_mut()
    }
}

/// The shorter way round.
fn rotation_vector(turn: Quat) -> Vec3 {
    if turn.w < 0.0 { -turn } else { turn }.to_scaled_axis()
}

#[cfg(test)]
mod tests {
    use super::*;

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
    fn goes_on_at_the_old_speed_and_ends_in_the_new_synthesis() {
        let speed_rad_s = 1.5;
        let before = 0.3 - speed_rad_s * LOOK_BACK_S;
        let mut inertia = Inertia::default();
        inertia.begin([&bent(0.3), &bent(before)], [&bent(0.0), &bent(0.0)], LOOK_BACK_S);
        let dt_s = 1.0 / 240.0;
        let shown: Vec<f32> = (0..480)
            .map(|_| {
                inertia.pass(&TimeStep::new(dt_s));
                let mut pose = bent(0.0);
                inertia.add_to(&mut pose);
                angle_rad(&pose)
            })
            .collect();
        assert!((shown[0] - (0.3 + speed_rad_s * dt_s)).abs() < 3e-3, "{}", shown[0]);
        let steps = shown.windows(2).map(|pair| pair[1] - pair[0]).collect::<Vec<_>>();
        assert!(steps.windows(2).all(|pair| (pair[1] - pair[0]).abs() < 1.2e-3));
        assert!(shown[96] < 0.1 && shown[479].abs() < 1e-3 && inertia == Inertia::default());
    }

    #[test]
    fn a_switch_within_a_switch_adds_up() {
        let mut inertia = Inertia::default();
        let [shown, played, next] = [Quat::from_rotation_y(0.5), Quat::IDENTITY, Quat::from_rotation_x(0.6)]
            .map(|rotation| Pose { rotations: [rotation; JOINT_COUNT], ..bent(0.0) });
        inertia.begin([&shown; 2], [&played; 2], LOOK_BACK_S);
        inertia.begin([&played; 2], [&next; 2], LOOK_BACK_S);
        let mut pose = next;
        inertia.add_to(&mut pose);
        assert!(pose.rotations[3].angle_between(shown.rotations[3]) < 1e-3);
    }

    #[test]
    fn without_a_switch_nothing_is_added() {
        let mut pose = bent(0.4);
        Inertia::default().add_to(&mut pose);
        assert_eq!(pose, bent(0.4));
    }
}

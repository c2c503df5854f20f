//! How long a leg may become, from hip to ankle. Root frame (x forward, y left, z up), metres.

use glam::Vec3;

use crate::synthesis::pose::leg::{FootPose, PosedLeg};

/// Greatest length of a leg, divided by thigh plus shank, before the pelvis drops. A pose with a straighter leg keeps
/// it.
pub(crate) const EXTENSION: f32 = 0.99;
/// Greatest length of a leg, divided by thigh plus shank, in any case: a knee flexed by 6°. A blend may be straighter
/// than its examples; beyond this the knee would snap at the end of the leg.
const EXTENSION_MAX: f32 = 0.9985;

/// Greatest distance from hip to ankle: at most that of the pose, within the limits, m.
pub(crate) fn length_max_m(leg: &PosedLeg, own: &FootPose) -> f32 {
    let leg_m = leg.bones_m[0] + leg.bones_m[1];
    own.ankle_m.distance(leg.hip_m()).clamp(EXTENSION * leg_m, EXTENSION_MAX * leg_m)
}

/// The point to which a leg stretches for an ankle, m. Beyond the length that the pose has, and [`EXTENSION`], the leg nears
/// [`EXTENSION_MAX`] ever more slowly: its knee would snap where it comes to its end at a speed.
pub(crate) fn softly_reached_m(leg: &PosedLeg, ankle_m: Vec3) -> Vec3 {
    let (leg_m, to_ankle_m) = (leg.bones_m[0] + leg.bones_m[1], ankle_m - leg.hip_m());
    let length_m = to_ankle_m.length();
    let [free_m, end_m] = [length_max_m(leg, &leg.foot()), EXTENSION_MAX * leg_m];
    let (more_m, room_m) = (length_m - free_m, end_m - free_m);
    if more_m <= 0.0 || room_m <= 0.0 {
        return ankle_m;
    }
    leg.hip_m() + to_ankle_m * ((free_m + room_m * (1.0 - libm::expf(-more_m / room_m))) / length_m)
}

#[cfg(test)]
mod tests {
    use glam::Quat;
    use motiondb::body::{JOINT_COUNT, Joint, Pose};

    use super::*;
    use crate::test_db::skeleton;

    /// The left leg of a standing body whose knee is flexed by an angle.
    fn flexed_leg(flexion_rad: f32) -> PosedLeg {
        let skeleton = skeleton();
        let mut pose = Pose { pelvis_m: skeleton.offsets_m[0], rotations: [Quat::IDENTITY; JOINT_COUNT] };
        pose.rotations[Joint::SHANKS[0].index()] = Quat::from_rotation_y(flexion_rad);
        PosedLeg::new(&pose, &skeleton, 0)
    }

    #[test]
    fn a_leg_stretches_softly_to_its_end() {
        let leg = flexed_leg(0.5);
        let leg_m = leg.bones_m[0] + leg.bones_m[1];
        let reached = |length: f32| {
            let ankle_m = leg.hip_m() - length * leg_m * Vec3::Z;
            softly_reached_m(&leg, ankle_m).distance(leg.hip_m()) / leg_m
        };
        assert!([0.5, 0.9, 0.989].into_iter().all(|length| (reached(length) - length).abs() < 1e-6));
        let lengths: Vec<f32> = (0..40).map(|step| reached(0.98 + 0.001 * step as f32)).collect();
        assert!(lengths.is_sorted() && lengths[39] < EXTENSION_MAX && lengths[39] > 0.998);
        let slopes: Vec<f32> = lengths.windows(2).map(|pair| (pair[1] - pair[0]) / 0.001).collect();
        assert!(slopes.windows(2).all(|pair| (pair[1] - pair[0]).abs() < 0.15), "{slopes:?}");
    }
}

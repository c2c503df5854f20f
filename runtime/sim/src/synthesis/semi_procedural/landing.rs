//! Where hips are lowest: as a foot lands, and the lower the longer the stride.
//!
//! Hips rise and fall twice in a stride, as the legs spread and close (Kuo 2007, "The six determinants of gait and the
//! inverted pendulum analogy"). A body that came down only as its leg runs out would drop by centimetres within a tenth
//! of a second, onto a knee that gives way. So m_sp tells how long the legs are as their feet land, in either direction
//! of time; how much lower the hips must be for them to be as long in another stride is known ahead of every landing,
//! and hips swing down to that.
//!
//! Root frame: x forward, y left, z up, metres; seconds; phases.

use glam::{Vec2, Vec3};
use motiondb::body::{Joint, Joints, Side};
use motiondb::motion::PHASE_COUNT;

use crate::synthesis::semi_procedural::foot_path::Foothold;

/// A foot as it lands: the mean of both, as if they were left ones.
#[derive(Clone, Copy, Debug, Default)]
pub struct Landing {
    /// When it does so, after the mid-stance of the other foot.
    pub after_mid_stance: f32,
    /// How long the root is yet to go until the foot's place is under it.
    pub ahead_s: f32,
    /// From the hip to the foot's place.
    to_place_m: Vec3,
    /// From the hip to the ankle.
    leg_m: f32,
}

impl Landing {
    /// At the phases where each foot strikes or, in reversed time, where it leaves.
    pub fn new(rows: &[Joints], feet: &[[Foothold; 2]], phases: [f32; 2], reversed: bool) -> Self {
        let mut mean = Self::default();
        for (side, phase) in Side::BOTH.into_iter().zip(phases) {
            let row = (phase * PHASE_COUNT as f32) as usize % PHASE_COUNT;
            let [hip_m, ankle_m] =
                [Joint::THIGHS, Joint::FEET].map(|of| rows[row].positions_m[of[side.index()].index()]);
            let Foothold { since_s, place_m, .. } = feet[row][side.index()];
            mean.after_mid_stance += 0.5 * if reversed { 1.0 - phase } else { phase }.rem_euclid(0.5);
            mean.ahead_s += 0.5 * if reversed { since_s } else { -since_s };
            mean.to_place_m += 0.5 * Vec3::new(1.0, side.sign(), 1.0) * (place_m - hip_m);
            mean.leg_m += 0.5 * hip_m.distance(ankle_m);
        }
        mean
    }

    /// How much lower the hips must be for the legs to be as long where both feet land so far from their places, and
    /// so much further outward, m.
    pub fn lower_m(&self, off_m: Vec2, outward_m: f32) -> f32 {
        let along_m = self.to_place_m.truncate() + Vec2::new(off_m.x, outward_m);
        // What one foot lands nearer to the middle, the other lands further from it.
        let square_m2 = along_m.length_squared() + off_m.y * off_m.y;
        -self.to_place_m.z - libm::sqrtf((self.leg_m * self.leg_m - square_m2).max(0.0))
    }
}

/// How far down hips are so many half-strides after a landing, from 0 between two landings to 1 at each:
/// cos² πh to 2 %, without a call.
pub(crate) fn lowering(half_strides: f32) -> f32 {
    let off = half_strides - libm::roundf(half_strides);
    let square = off * off;
    (1.0 - 4.0 * square) * (1.0 - 4.0 * square) * (1.0 - 1.87 * square)
}

#[cfg(test)]
mod tests {
    use std::f32::consts::PI;

    use super::*;

    /// A foot that lands 0.3 m ahead of a hip 0.85 m above its ankle, walking at 1 m/s.
    fn landing() -> Landing {
        let to_place_m = Vec3::new(0.0, 0.02, -0.85);
        Landing { after_mid_stance: 0.19, ahead_s: 0.3, to_place_m, leg_m: Vec3::new(0.3, 0.02, -0.85).length() }
    }

    #[test]
    fn in_its_own_stride_hips_are_as_high_and_the_lower_the_longer_and_wider_it_is() {
        let landing = landing();
        let lower_m =
            |ahead_m: f32, aside_m: f32, outward_m: f32| landing.lower_m(Vec2::new(ahead_m, aside_m), outward_m);
        assert!(lower_m(0.3, 0.0, 0.0).abs() < 1e-6 && lower_m(0.2, 0.0, 0.0) < 0.0);
        let lower_m = [lower_m(0.4, 0.0, 0.0), lower_m(0.4, 0.1, 0.0), lower_m(0.4, 0.1, 0.1), lower_m(0.5, 0.1, 0.1)];
        assert!(lower_m[0] > 0.03 && lower_m.is_sorted(), "{lower_m:?}");
        assert!(landing.lower_m(Vec2::splat(1e9), 0.0).is_finite());
    }

    #[test]
    fn hips_go_down_to_each_landing_and_up_between() {
        for step in -300..=300 {
            let half_strides = step as f32 * 0.01;
            let cosine = (PI * half_strides).cos();
            assert!((lowering(half_strides) - cosine * cosine).abs() < 0.02, "{half_strides}");
        }
        assert_eq!([lowering(0.0), lowering(3.0), lowering(0.5)], [1.0, 1.0, 0.0]);
    }
}

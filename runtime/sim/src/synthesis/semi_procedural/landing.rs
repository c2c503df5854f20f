//! Landing: how low the hips must be as a foot lands; the longer the stride, the lower.
//!
//! Hips rise and fall twice in a stride, as the legs spread and close (Kuo 2007, "The six determinants of gait and the
//! inverted pendulum analogy"). If they came down only where a leg runs out, they would drop by centimetres within 0.1
//! s, onto a knee that bends under them. m_sp gives the length of the legs as its feet land, in either direction of
//! time. So the drop that keeps this length in another stride is known ahead of every landing. The hips oscillate down
//! to it.
//!
//! Root frame (x forward, y left, z up), metres; seconds; phases.

use glam::{Vec2, Vec3};
use motiondb::body::{Joint, Joints, Side};
use motiondb::motion::PHASE_COUNT;

use crate::synthesis::semi_procedural::foot_path::FootPathPoint;

/// A foot of m_sp as it lands: the mean of both, the right one mirrored.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Landing {
    /// Phase of the landing after the mid-stance of the other foot.
    pub after_mid_stance: f32,
    /// Time until the root is over the foot's position, s.
    pub ahead_s: f32,
    /// From the hip to the foot's position, m.
    to_position_m: Vec3,
    /// Distance from hip to ankle, m.
    leg_m: f32,
}

impl Landing {
    /// The landing at the phases at which each foot strikes or, in reversed time, leaves.
    pub(crate) fn new(rows: &[Joints], feet: &[[FootPathPoint; 2]], phases: [f32; 2], reversed: bool) -> Self {
        let mut mean = Self::default();
        for (side, phase) in Side::BOTH.into_iter().zip(phases) {
            let row = (phase * PHASE_COUNT as f32) as usize % PHASE_COUNT;
            let [hip_m, ankle_m] =
                [Joint::THIGHS, Joint::FEET].map(|of| rows[row].positions_m[of[side.index()].index()]);
            let FootPathPoint { carried_s, position_m, .. } = feet[row][side.index()];
            mean.after_mid_stance += 0.5 * if reversed { 1.0 - phase } else { phase }.rem_euclid(0.5);
            mean.ahead_s += 0.5 * if reversed { carried_s } else { -carried_s };
            mean.to_position_m += 0.5 * Vec3::new(1.0, side.sign(), 1.0) * (position_m - hip_m);
            mean.leg_m += 0.5 * hip_m.distance(ankle_m);
        }
        mean
    }

    /// Drop of the hips at which the legs keep their length where both feet land `off_m` from their positions and
    /// `outward_m` further outward, m.
    pub(crate) fn drop_m(&self, off_m: Vec2, outward_m: f32) -> f32 {
        let along_m = self.to_position_m.truncate() + Vec2::new(off_m.x, outward_m);
        // One foot lands nearer to the middle by off_m.y, the other further from it.
        let square_m2 = along_m.length_squared() + off_m.y * off_m.y;
        -self.to_position_m.z - libm::sqrtf((self.leg_m * self.leg_m - square_m2).max(0.0))
    }
}

/// Share of the drop at a time after a landing, in half-strides: 1 at each landing, 0 half-way between two. cos² πh to
/// 2 %, without a call.
pub(crate) fn drop_share(half_strides: f32) -> f32 {
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
        let to_position_m = Vec3::new(0.0, 0.02, -0.85);
        Landing { after_mid_stance: 0.19, ahead_s: 0.3, to_position_m, leg_m: Vec3::new(0.3, 0.02, -0.85).length() }
    }

    #[test]
    fn the_drop_grows_with_the_stride() {
        let landing = landing();
        let drop_m =
            |ahead_m: f32, aside_m: f32, outward_m: f32| landing.drop_m(Vec2::new(ahead_m, aside_m), outward_m);
        assert!(drop_m(0.3, 0.0, 0.0).abs() < 1e-6 && drop_m(0.2, 0.0, 0.0) < 0.0);
        let drops_m = [drop_m(0.4, 0.0, 0.0), drop_m(0.4, 0.1, 0.0), drop_m(0.4, 0.1, 0.1), drop_m(0.5, 0.1, 0.1)];
        assert!(drops_m[0] > 0.03 && drops_m.is_sorted(), "{drops_m:?}");
        assert!(landing.drop_m(Vec2::splat(1e9), 0.0).is_finite());
    }

    #[test]
    fn hips_are_down_at_each_landing_and_up_between() {
        for step in -300..=300 {
            let half_strides = step as f32 * 0.01;
            let cosine = libm::cosf(PI * half_strides);
            assert!((drop_share(half_strides) - cosine * cosine).abs() < 0.02, "{half_strides}");
        }
        assert_eq!([drop_share(0.0), drop_share(3.0), drop_share(0.5)], [1.0, 1.0, 0.0]);
    }
}

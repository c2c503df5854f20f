//! Carriage: how a body holds its trunk and its arms, by the mean directions of their bones.
//!
//! Frame of the facing: x forward, y left, z up.

use std::f32::consts::{FRAC_PI_2, FRAC_PI_4};

use glam::Vec3;

/// Greatest angle between the mean directions of an arm's bone in one carriage, rad: 35°. Retargeted copies of captures reach
/// 19; an edit that bends elbows or crosses arms makes another motion of the same steps.
const ARMS_APART_MAX_RAD: f32 = 35.0 * std::f32::consts::PI / 180.0;
/// The same of the trunk, rad: 12°. Copies reach 5.
const TRUNK_APART_MAX_RAD: f32 = 12.0 * std::f32::consts::PI / 180.0;

/// Mean directions of the bones of trunk and arms.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Carriage {
    /// Upper arms, then forearms, left before right.
    pub(crate) arms: [Vec3; 4],
    /// From the pelvis to the neck.
    pub(crate) trunk: Vec3,
}

impl Carriage {
    /// Whether both bodies hold trunk and arms alike.
    pub(crate) fn is_like(&self, other: &Self) -> bool {
        // Maxima ignore a bone without length, whose angle is no number.
        let arms = self.arms.iter().zip(other.arms).map(|(one, other)| one.angle_between(other)).fold(0.0, f32::max);
        let trunks = self.trunk.angle_between(other.trunk);
        arms <= ARMS_APART_MAX_RAD && trunks.max(0.0) <= TRUNK_APART_MAX_RAD
    }

    /// How far it is from an upright trunk and hanging arms: mean angle of the arms' bones off straight down, as a share
    /// of 90°, plus the angle of the trunk off the vertical, as a share of 45°.
    pub(crate) fn effort(&self) -> f64 {
        let off_down_rad = |bone: &Vec3| bone.angle_between(Vec3::NEG_Z).max(0.0);
        let arms_rad = self.arms.iter().map(off_down_rad).sum::<f32>() / self.arms.len() as f32;
        f64::from(arms_rad / FRAC_PI_2 + self.trunk.angle_between(Vec3::Z).max(0.0) / FRAC_PI_4)
    }
}

//! Sections of the surfaces of a figure. Rest pose, metres.

use glam::Vec3;

use crate::figure::style::Cloth;

/// A section: an ellipse with two different halves, or a boxier curve.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Section {
    /// Its middle.
    pub(crate) at: Vec3,
    /// From the middle to the side.
    pub(crate) side: Vec3,
    /// From the middle to the front.
    pub(crate) front: Vec3,
    /// From the back to the middle.
    pub(crate) back: Vec3,
    /// Exponent of the curve: 2 is an ellipse, greater ones are boxier.
    pub(crate) power: f32,
    /// The two joints that it follows.
    pub(crate) joints: [usize; 2],
    /// Share of the second joint.
    pub(crate) share: f32,
    pub(crate) cloth: Cloth,
}

impl Section {
    /// An ellipse that follows one joint.
    pub(crate) fn round(at: Vec3, side: Vec3, front: Vec3, joint: usize, cloth: Cloth) -> Self {
        Self { at, side, front, back: front, power: 2.0, joints: [joint; 2], share: 0.0, cloth }
    }

    /// The point at a turn, 0 to 1: front, side, back, other side.
    pub(crate) fn point(&self, turn: f32) -> Vec3 {
        let (sin, cos) = libm::sincosf(turn * std::f32::consts::TAU);
        let bent = |value: f32| {
            let magnitude = libm::powf(value.abs(), 2.0 / self.power);
            if value < 0.0 { -magnitude } else { magnitude }
        };
        let (along, across) = (bent(cos), bent(sin));
        self.at + across * self.side + along * if along > 0.0 { self.front } else { self.back }
    }
}

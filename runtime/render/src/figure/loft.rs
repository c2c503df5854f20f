//! Lofts: a closed surface through sections, with a cap at both ends. Rest pose, metres.

use glam::Vec3;

use crate::figure::style::Cloth;
use crate::figure::template::{Template, Vertex};

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

    fn point(&self, turn: f32, power: f32) -> Vec3 {
        let (sin, cos) = libm::sincosf(turn * std::f32::consts::TAU);
        let bent = |value: f32| {
            let magnitude = libm::powf(value.abs(), 2.0 / power);
            if value < 0.0 { -magnitude } else { magnitude }
        };
        let (along, across) = (bent(cos), bent(sin));
        self.at + across * self.side + along * if along > 0.0 { self.front } else { self.back }
    }
}

impl Template {
    /// Adds the surface through sections, with `count` points on each. The surface faces outward where the sections'
    /// front, side and direction are right-handed.
    pub(crate) fn loft(&mut self, sections: &[Section], count: u32) {
        let first = self.vertices.len() as u32;
        for section in sections {
            let points = (0..count).map(|point| section.point(point as f32 / count as f32, section.power));
            let vertices: Vec<Vertex> = points.map(|position| Vertex::new(position, section)).collect();
            self.vertices.extend(vertices);
        }
        for ring in 0..sections.len() as u32 - 1 {
            for point in 0..count {
                let next = (point + 1) % count;
                let [a, b] = [point, next].map(|point| first + ring * count + point);
                let [c, d] = [a + count, b + count];
                self.triangles.extend([[a, b, d], [a, d, c]]);
            }
        }
        self.cap(&sections[0], first, count, true);
        self.cap(&sections[sections.len() - 1], first + (sections.len() as u32 - 1) * count, count, false);
    }

    fn cap(&mut self, section: &Section, ring: u32, count: u32, is_first: bool) {
        let middle = self.vertices.len() as u32;
        self.vertices.push(Vertex::new(section.at + 0.5 * (section.front - section.back), section));
        for point in 0..count {
            let [a, b] = [ring + point, ring + (point + 1) % count];
            self.triangles.push(if is_first { [middle, b, a] } else { [middle, a, b] });
        }
    }
}

//! Lofts: a closed surface through sections, with a cap at both ends. Rest pose, metres.

use crate::figure::section::Section;
use crate::figure::template::{Template, Vertex};

impl Template {
    /// Adds the surface through sections, with `count` points on each. The surface faces outward where the sections'
    /// front, side and direction are right-handed.
    pub(crate) fn loft(&mut self, sections: &[Section], count: u32) {
        let first = self.vertices.len() as u32;
        for section in sections {
            let points = (0..count).map(|point| section.point(point as f32 / count as f32));
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

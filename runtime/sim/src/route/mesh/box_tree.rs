//! Boxes around triangles, four to a box, level by level: finds the triangle at a point, and the one nearest to it.
//!
//! The triangles must be sorted so that neighbours in the list lie near each other
//! ([`morton_code`](crate::maths::morton::morton_code)). A uniform grid would be quick only where all triangles are of
//! one size; open ground has a few that span the whole scene. World, metres.

use glam::DVec2;

/// Number of boxes, or triangles, in one box.
const WIDTH: usize = 4;

/// The boxes of all levels.
#[derive(Clone, Debug, Default)]
pub(crate) struct BoxTree {
    /// Boxes of each level, the finest first; each holds [`WIDTH`] of the level below, those of the first triangles.
    levels: Vec<Vec<BoundingBox>>,
    triangles: usize,
}

/// An axis-aligned box.
#[derive(Clone, Copy, Debug)]
struct BoundingBox {
    low_m: DVec2,
    high_m: DVec2,
}

/// The nearest triangle found so far.
struct NearestTriangle {
    triangle: u32,
    squared_m2: f64,
}

impl BoundingBox {
    fn squared_distance_m2(&self, point_m: DVec2) -> f64 {
        (point_m - point_m.clamp(self.low_m, self.high_m)).length_squared()
    }

    fn around(boxes: &[Self]) -> Self {
        let fold = |all: Self, one: &Self| Self { low_m: all.low_m.min(one.low_m), high_m: all.high_m.max(one.high_m) };
        boxes[1..].iter().fold(boxes[0], fold)
    }
}

impl BoxTree {
    /// The boxes around triangles, given their corners.
    pub(crate) fn new(corners_m: impl Iterator<Item = [DVec2; 3]>) -> Self {
        let around = |[a, b, c]: [DVec2; 3]| BoundingBox { low_m: a.min(b).min(c), high_m: a.max(b).max(c) };
        let mut level: Vec<BoundingBox> = corners_m.map(around).collect();
        let mut tree = Self { levels: Vec::new(), triangles: level.len() };
        while level.len() > 1 || (tree.levels.is_empty() && !level.is_empty()) {
            level = level.chunks(WIDTH).map(BoundingBox::around).collect();
            tree.levels.push(level.clone());
        }
        tree
    }

    /// The triangle nearest to a point within a squared distance, m², and its squared distance; that of any one triangle
    /// is given, infinite for one that does not count. The search ends at the first that holds the point.
    pub(crate) fn nearest(
        &self,
        point_m: DVec2,
        within_m2: f64,
        squared_m2: impl Fn(u32) -> f64,
    ) -> Option<(u32, f64)> {
        let top = self.levels.len().checked_sub(1)?;
        let mut best = NearestTriangle { triangle: u32::MAX, squared_m2: within_m2 };
        self.search(top, 0, point_m, &squared_m2, &mut best);
        (best.triangle != u32::MAX).then_some((best.triangle, best.squared_m2))
    }

    /// Searches one box of a level, the nearest of its boxes first.
    fn search(
        &self,
        level: usize,
        index: usize,
        point_m: DVec2,
        squared_m2: &impl Fn(u32) -> f64,
        best: &mut NearestTriangle,
    ) {
        let Some(finer) = level.checked_sub(1) else {
            for triangle in WIDTH * index..self.triangles.min(WIDTH * (index + 1)) {
                let squared_m2 = squared_m2(triangle as u32);
                if squared_m2 < best.squared_m2 {
                    *best = NearestTriangle { triangle: triangle as u32, squared_m2 };
                }
            }
            return;
        };
        let boxes = &self.levels[finer];
        let mut order = [(f64::INFINITY, 0); WIDTH];
        for (slot, child) in order.iter_mut().zip(WIDTH * index..boxes.len()) {
            *slot = (boxes[child].squared_distance_m2(point_m), child);
        }
        order.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        for (squared_box_m2, child) in order {
            if squared_box_m2 < best.squared_m2 {
                self.search(finer, child, point_m, squared_m2, best);
            }
        }
    }

    /// Size in memory, bytes.
    pub(crate) fn bytes(&self) -> usize {
        self.levels.iter().map(|level| size_of_val(&level[..])).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::maths::random::SplitMix64;

    #[test]
    fn nearest_box_is_that_of_brute_force() {
        let mut random = SplitMix64::new(7, 0);
        let mut point = |reach_m| DVec2::new(random.within(reach_m), random.within(reach_m));
        for count in [0, 1, 3, 4, 5, 17, 300] {
            let points_m: Vec<DVec2> = (0..count).map(|_| point(9.0)).collect();
            let tree = BoxTree::new(points_m.iter().map(|point_m| [*point_m; 3]));
            for _ in 0..100 {
                let at_m = point(12.0);
                let squared_m2 = |index: u32| points_m[index as usize].distance_squared(at_m);
                let nearest_m2 = (0..count).map(squared_m2).reduce(f64::min);
                assert_eq!(tree.nearest(at_m, f64::INFINITY, squared_m2).map(|(_, squared_m2)| squared_m2), nearest_m2);
            }
        }
    }
}

//! The nearest point of a surface of triangles, segments or points: of the hull, for queries outside it.
//!
//! A tree of boxes (Rubin and Whitted 1980), halved at the median, spares all but the few facets near the answer: time
//! is logarithmic in their number, and no memory is taken.

use glam::DVec3;

use crate::blend_space::simplex::{Nearest, Simplex};

/// Facets and the boxes around them.
#[derive(Clone, Debug)]
pub(crate) struct Surface {
    /// In the order of the tree's leaves.
    facets: Vec<Simplex>,
    /// The root first; the first child of a node follows it.
    nodes: Vec<Node>,
}

/// A box around facets.
#[derive(Clone, Copy, Debug)]
struct Node {
    least: DVec3,
    greatest: DVec3,
    below: Below,
}

#[derive(Clone, Copy, Debug)]
enum Below {
    Facet(usize),
    SecondChild(usize),
}

impl Surface {
    pub(crate) fn new(mut facets: Vec<Simplex>) -> Self {
        let mut nodes = Vec::with_capacity(2 * facets.len());
        if !facets.is_empty() {
            grow(&mut nodes, &mut facets, 0);
        }
        Self { facets, nodes }
    }

    /// Its point nearest to `point`; [`Nearest::NOTHING`] of an empty surface, and where `point` is not finite.
    pub(crate) fn nearest(&self, point: DVec3) -> Nearest {
        let mut nearest = Nearest::NOTHING;
        if !self.nodes.is_empty() && point.is_finite() {
            self.search(0, point, &mut nearest);
        }
        nearest
    }

    /// The nearer child first: it often spares the other.
    fn search(&self, node: usize, point: DVec3, nearest: &mut Nearest) {
        match self.nodes[node].below {
            Below::Facet(index) => self.facets[index].approach(point, nearest),
            Below::SecondChild(second) => {
                let mut children = [node + 1, second].map(|child| (self.nodes[child].distance_squared(point), child));
                if children[1].0 < children[0].0 {
                    children.swap(0, 1);
                }
                for (distance_squared, child) in children {
                    if distance_squared < nearest.distance_squared && !self.nodes[child].lies_behind(nearest, point) {
                        self.search(child, point, nearest);
                    }
                }
            }
        }
    }
}

impl Node {
    fn distance_squared(&self, point: DVec3) -> f64 {
        point.clamp(self.least, self.greatest).distance_squared(point)
    }

    /// Whether no point of the box lies further towards `point` than the nearest one so far: then none is nearer.
    fn lies_behind(&self, nearest: &Nearest, point: DVec3) -> bool {
        let towards = point - nearest.foot;
        let foremost = DVec3::select(towards.cmpgt(DVec3::ZERO), self.greatest, self.least);
        (foremost - nearest.foot).dot(towards) <= 0.0
    }
}

/// Appends the tree of some facets, halving them along the longest side of their box; `first` is the index of the
/// first of them.
fn grow(nodes: &mut Vec<Node>, facets: &mut [Simplex], first: usize) {
    let bounds = facets.iter().map(Simplex::bounds);
    let both = |[least, greatest]: [DVec3; 2], other: [DVec3; 2]| [least.min(other[0]), greatest.max(other[1])];
    let [least, greatest] = bounds.reduce(both).unwrap_or_default();
    let node = nodes.len();
    nodes.push(Node { least, greatest, below: Below::Facet(first) });
    if facets.len() == 1 {
        return;
    }
    let axis = (greatest - least).max_position();
    let middle = |facet: &Simplex| facet.bounds()[0][axis] + facet.bounds()[1][axis];
    let half = facets.len() / 2;
    facets.select_nth_unstable_by(half, |a, b| middle(a).total_cmp(&middle(b)));
    let (lower, upper) = facets.split_at_mut(half);
    grow(nodes, lower, first);
    nodes[node].below = Below::SecondChild(nodes.len());
    grow(nodes, upper, first + lower.len());
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::blend_space::simplex::soup;
    use proptest::prelude::*;

    proptest! {
        /// Whether they fit together or cross, are needles or lie on each other.
        #[test]
        fn the_tree_finds_what_a_search_through_all_facets_does(
            points in prop::collection::vec(prop::array::uniform3(-3i8..4), 4..12),
            corners in prop::collection::vec(prop::array::uniform4(0usize..12), 1..40),
            count in 1usize..4,
            query in prop::array::uniform3(-9.0f64..9.0),
        ) {
            let (facets, point) = (soup(&points, &corners, count), DVec3::from_array(query));
            let distance_squared = |facet: &Simplex| {
                let mut nearest = Nearest::NOTHING;
                facet.approach(point, &mut nearest);
                nearest.distance_squared
            };
            let least = facets.iter().map(distance_squared).fold(f64::INFINITY, f64::min);
            prop_assert_eq!(Surface::new(facets).nearest(point).distance_squared, least);
        }
    }
}

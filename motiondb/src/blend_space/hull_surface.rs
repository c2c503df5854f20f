//! The hull's surface of triangles, segments or points: its point nearest to a query outside the hull.
//!
//! A tree of bounding boxes (Rubin and Whitted 1980), split at the median. A search visits only the few facets near the
//! answer: its time is logarithmic in their number, and it allocates nothing. Points are in the metric of the blend
//! space.

use glam::DVec3;

use crate::blend_space::simplex::{NearestPoint, Simplex};

/// Facets, and a tree of the boxes around them.
#[derive(Clone, Debug)]
pub(crate) struct HullSurface {
    /// Facets, in the order of the tree's leaves.
    facets: Vec<Simplex>,
    /// Nodes of the tree: the root first, and each node directly before its first child.
    nodes: Vec<BoxNode>,
}

/// A box around some facets.
#[derive(Clone, Copy, Debug)]
struct BoxNode {
    /// Least corner of the box.
    least: DVec3,
    /// Greatest corner of the box.
    greatest: DVec3,
    content: NodeContent,
}

/// What a node holds, by index: one facet, or two children, of which the first follows the node.
#[derive(Clone, Copy, Debug)]
enum NodeContent {
    Facet(usize),
    SecondChild(usize),
}

impl HullSurface {
    pub(crate) fn new(mut facets: Vec<Simplex>) -> Self {
        let mut nodes = Vec::with_capacity(2 * facets.len());
        if !facets.is_empty() {
            grow(&mut nodes, &mut facets, 0);
        }
        Self { facets, nodes }
    }

    /// The surface's point nearest to `query`; [`NearestPoint::NONE`] for an empty surface or a query that is not
    /// finite.
    pub(crate) fn nearest(&self, query: DVec3) -> NearestPoint {
        let mut nearest = NearestPoint::NONE;
        if !self.nodes.is_empty() && query.is_finite() {
            self.search(0, query, &mut nearest);
        }
        nearest
    }

    /// Searches the nearer child first: often the other need not be searched.
    fn search(&self, node: usize, query: DVec3, nearest: &mut NearestPoint) {
        match self.nodes[node].content {
            NodeContent::Facet(index) => self.facets[index].approach(query, nearest),
            NodeContent::SecondChild(second) => {
                let mut children = [node + 1, second].map(|child| (self.nodes[child].distance_squared(query), child));
                if children[1].0 < children[0].0 {
                    children.swap(0, 1);
                }
                for (distance_squared, child) in children {
                    if distance_squared < nearest.distance_squared && !self.nodes[child].lies_behind(nearest, query) {
                        self.search(child, query, nearest);
                    }
                }
            }
        }
    }
}

impl BoxNode {
    fn distance_squared(&self, query: DVec3) -> f64 {
        query.clamp(self.least, self.greatest).distance_squared(query)
    }

    /// Whether no point of the box lies farther towards `query` than the nearest point so far: then none is nearer.
    fn lies_behind(&self, nearest: &NearestPoint, query: DVec3) -> bool {
        let towards = query - nearest.point;
        let foremost = DVec3::select(towards.cmpgt(DVec3::ZERO), self.greatest, self.least);
        (foremost - nearest.point).dot(towards) <= 0.0
    }
}

/// Appends the tree of some facets to `nodes`, splitting them along the longest side of their box. `first` is the index
/// of the first of these facets.
fn grow(nodes: &mut Vec<BoxNode>, facets: &mut [Simplex], first: usize) {
    let bounds = facets.iter().map(Simplex::bounds);
    let both = |[least, greatest]: [DVec3; 2], other: [DVec3; 2]| [least.min(other[0]), greatest.max(other[1])];
    let [least, greatest] = bounds.reduce(both).unwrap_or_default();
    let node = nodes.len();
    nodes.push(BoxNode { least, greatest, content: NodeContent::Facet(first) });
    if facets.len() == 1 {
        return;
    }
    let axis = (greatest - least).max_position();
    let middle = |facet: &Simplex| facet.bounds()[0][axis] + facet.bounds()[1][axis];
    let half = facets.len() / 2;
    facets.select_nth_unstable_by(half, |a, b| middle(a).total_cmp(&middle(b)));
    let (lower, upper) = facets.split_at_mut(half);
    grow(nodes, lower, first);
    nodes[node].content = NodeContent::SecondChild(nodes.len());
    grow(nodes, upper, first + lower.len());
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::blend_space::simplex::soup;
    use proptest::prelude::*;

    proptest! {
        /// Facets may intersect, coincide or be needles.
        #[test]
        fn the_tree_agrees_with_a_search_of_all_facets(
            points in prop::collection::vec(prop::array::uniform3(-3i8..4), 4..12),
            corners in prop::collection::vec(prop::array::uniform4(0usize..12), 1..40),
            count in 1usize..4,
            query in prop::array::uniform3(-9.0f64..9.0),
        ) {
            let (facets, query) = (soup(&points, &corners, count), DVec3::from_array(query));
            let distance_squared = |facet: &Simplex| {
                let mut nearest = NearestPoint::NONE;
                facet.approach(query, &mut nearest);
                nearest.distance_squared
            };
            let least = facets.iter().map(distance_squared).fold(f64::INFINITY, f64::min);
            prop_assert_eq!(HullSurface::new(facets).nearest(query).distance_squared, least);
        }
    }
}

//! The nodes of a glTF document in an order in which parents stand before their children, and the bodies among them.
//!
//! A file may hold several characters, props, cameras and lights. A body is a tree of nodes of its own, or what hangs
//! from the joint that all joints of a skin hang from where one tree carries several such skins; each body is a clip of
//! its own, together with the nodes above it, whose transforms it inherits.

use gltf::json::Root;

use crate::read::gltf::document::{Flaw, flaw};

/// A tree of fewer nodes that no skin uses is a prop, a camera, a light or a control: a body has two legs and two arms
/// of three joints each.
const BODY_NODES_MIN: usize = 10;

/// More bodies than this are a crowd or a heap of things, and are not told apart.
const BODIES_MAX: usize = 64;

/// The nodes of a document.
pub(crate) struct Tree {
    /// Node by place.
    pub order: Vec<usize>,
    /// Place of each node's parent, by place.
    pub parents: Vec<Option<usize>>,
}

/// What one clip is made of.
pub(crate) struct Body {
    /// To tell bodies apart.
    pub name: String,
    /// Places, in order; a parent's stands before its children's.
    pub places: Vec<usize>,
}

impl Body {
    /// Index within the body of each place's parent.
    pub(crate) fn parents(&self, tree: &Tree) -> Vec<Option<usize>> {
        let within = |place: &usize| tree.parents[*place].and_then(|parent| self.places.binary_search(&parent).ok());
        self.places.iter().map(within).collect()
    }

    /// By node.
    pub(crate) fn is_in(&self, tree: &Tree) -> Vec<bool> {
        let mut is_in = vec![false; tree.order.len()];
        self.places.iter().for_each(|&place| is_in[tree.order[place]] = true);
        is_in
    }
}

impl Tree {
    /// Orders the nodes, roots first.
    pub(crate) fn new(root: &Root) -> Result<Self, Flaw> {
        let count = root.nodes.len();
        let children = |node: usize| root.nodes[node].children.iter().flatten().map(|child| child.value());
        let mut is_child = vec![false; count];
        for child in (0..count).flat_map(children) {
            if std::mem::replace(&mut is_child[child], true) {
                return flaw("nodes", "a node has two parents", "check the file with the glTF validator");
            }
        }
        let roots = (0..count).filter(|&node| !is_child[node]);
        let mut waiting: Vec<(usize, Option<usize>)> = roots.map(|root| (root, None)).collect();
        waiting.reverse();
        let mut tree = Self { order: Vec::new(), parents: Vec::new() };
        while let Some((node, parent)) = waiting.pop() {
            let place = tree.order.len();
            tree.order.push(node);
            tree.parents.push(parent);
            let first = waiting.len();
            waiting.extend(children(node).map(|child| (child, Some(place))));
            waiting[first..].reverse();
        }
        if tree.order.len() < count {
            return flaw("nodes", "a node is its own ancestor", "check the file with the glTF validator");
        }
        Ok(tree)
    }

    /// The bodies of a document; all nodes where none stands out, or too many do.
    pub(crate) fn bodies(&self, root: &Root) -> Vec<Body> {
        let mut bodies = Vec::new();
        let tops = self.skin_tops(root);
        for (start, end) in self.trees() {
            let inside: Vec<usize> = tops.iter().copied().filter(|top| (start..end).contains(top)).collect();
            if inside.len() > 1 {
                bodies.extend(inside.into_iter().map(|top| self.body(root, top)));
            } else if inside.len() == 1 || end - start >= BODY_NODES_MIN {
                bodies.push(Body { name: self.name(root, start), places: (start..end).collect() });
            }
        }
        if bodies.is_empty() || bodies.len() > BODIES_MAX {
            bodies.clear();
            bodies.push(Body { name: String::new(), places: (0..self.order.len()).collect() });
        }
        bodies
    }

    fn name(&self, root: &Root, place: usize) -> String {
        root.nodes[self.order[place]].name.clone().unwrap_or_default()
    }

    /// First and last place of each tree, the last exclusive.
    fn trees(&self) -> Vec<(usize, usize)> {
        let starts: Vec<usize> = (0..self.order.len()).filter(|&place| self.parents[place].is_none()).collect();
        let ends = starts.iter().copied().skip(1).chain([self.order.len()]);
        starts.iter().copied().zip(ends).collect()
    }

    /// A place, all above and all below it.
    fn body(&self, root: &Root, top: usize) -> Body {
        let mut places: Vec<usize> = self.above(top).collect();
        places.reverse();
        places.extend(top..self.end(top));
        let own = self.parents[top].map_or(top, |parent| if self.parents[parent].is_some() { parent } else { top });
        Body { name: self.name(root, own), places }
    }

    /// Place after the last that hangs from a place: descendants stand together.
    fn end(&self, top: usize) -> usize {
        let outside = |&place: &usize| self.parents[place].is_none_or(|parent| parent < top);
        (top + 1..self.order.len()).find(outside).unwrap_or(self.order.len())
    }

    /// From the parent up.
    fn above(&self, place: usize) -> impl Iterator<Item = usize> {
        std::iter::successors(self.parents[place], |&place| self.parents[place])
    }

    /// The places from which the joints of each skin hang, skins that share some joints as one, in order; those of
    /// small trees are props.
    fn skin_tops(&self, root: &Root) -> Vec<usize> {
        let mut place_of = vec![0; self.order.len()];
        for (place, &node) in self.order.iter().enumerate() {
            place_of[node] = place;
        }
        let top = |skin: &gltf::json::Skin| {
            let joints = skin.joints.iter().filter_map(|joint| place_of.get(joint.value()).copied());
            joints.reduce(|a, b| self.common(a, b))
        };
        let mut tops: Vec<usize> = root.skins.iter().filter_map(top).collect();
        tops.sort_unstable();
        tops.dedup();
        let mut kept: Vec<usize> = Vec::new();
        for top in tops {
            let is_inside = kept.last().is_some_and(|&above| top < self.end(above));
            if !is_inside && self.end(top) - top >= BODY_NODES_MIN {
                kept.push(top);
            }
        }
        kept
    }

    /// The lowest place from which two places hang; where there is none, the first of the second's tree.
    fn common(&self, a: usize, b: usize) -> usize {
        let (mut a, mut b) = (a, b);
        while a != b {
            let deeper = if a > b { &mut a } else { &mut b };
            match self.parents[*deeper] {
                Some(parent) => *deeper = parent,
                None => return *deeper,
            }
        }
        a
    }
}

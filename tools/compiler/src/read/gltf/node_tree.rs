//! Nodes of a glTF document, parents before children, and the bodies among them.
//!
//! A file may hold several characters, props, cameras and lights. A body is a tree of nodes of its own. Where one tree
//! carries several skins, a body is the part below the joint from which all joints of a skin hang. Each body is a clip
//! of its own, together with the nodes above it, whose transforms it inherits.

use gltf::json::Root;

use crate::error::RejectionReason;
use crate::read::gltf::node_channel::VALIDATE;
use crate::read::malformed::malformed;

/// Least number of nodes of a body without a skin: two legs and two arms have twelve joints. Smaller trees are props,
/// cameras, lights and controls.
const BODY_NODES_MIN: usize = 10;
/// Greatest number of bodies; a file of more is a crowd or a heap of things and is read as one body.
const BODIES_MAX: usize = 64;

/// All nodes in an order in which parents come before their children, and a node's descendants follow it. The position
/// of a node in this order is its slot.
pub(crate) struct NodeTree {
    /// Node of each slot.
    pub order: Vec<usize>,
    /// Slot of the parent of each slot's node.
    pub parents: Vec<Option<usize>>,
}

/// The nodes of one body.
pub(crate) struct BodyNodes {
    /// Name that tells bodies of one animation apart.
    pub name: String,
    /// Slots of the nodes, in order.
    pub slots: Vec<usize>,
}

impl BodyNodes {
    /// Parent of each node as an index into `slots`.
    pub(crate) fn parents(&self, tree: &NodeTree) -> Vec<Option<usize>> {
        let within = |slot: &usize| tree.parents[*slot].and_then(|parent| self.slots.binary_search(&parent).ok());
        self.slots.iter().map(within).collect()
    }

    /// Whether each node of the document belongs to the body.
    pub(crate) fn is_member(&self, tree: &NodeTree) -> Vec<bool> {
        let mut is_member = vec![false; tree.order.len()];
        self.slots.iter().for_each(|&slot| is_member[tree.order[slot]] = true);
        is_member
    }
}

impl NodeTree {
    /// Orders the nodes, depth first.
    pub(crate) fn new(root: &Root) -> Result<Self, RejectionReason> {
        let count = root.nodes.len();
        let children = |node: usize| root.nodes[node].children.iter().flatten().map(|child| child.value());
        let mut is_child = vec![false; count];
        for child in (0..count).flat_map(children) {
            if std::mem::replace(&mut is_child[child], true) {
                return malformed("nodes", "a node has two parents", VALIDATE);
            }
        }
        let roots = (0..count).filter(|&node| !is_child[node]);
        let mut waiting: Vec<(usize, Option<usize>)> = roots.map(|root| (root, None)).collect();
        waiting.reverse();
        let mut tree = Self { order: Vec::new(), parents: Vec::new() };
        while let Some((node, parent)) = waiting.pop() {
            let slot = tree.order.len();
            tree.order.push(node);
            tree.parents.push(parent);
            let first = waiting.len();
            waiting.extend(children(node).map(|child| (child, Some(slot))));
            waiting[first..].reverse();
        }
        if tree.order.len() < count {
            return malformed("nodes", "a node is its own ancestor", VALIDATE);
        }
        Ok(tree)
    }

    /// The bodies of a document. All nodes are one body where none is found, or too many are.
    pub(crate) fn bodies(&self, root: &Root) -> Vec<BodyNodes> {
        let mut bodies = Vec::new();
        let tops = self.skin_tops(root);
        for (start, end) in self.trees() {
            let inside: Vec<usize> = tops.iter().copied().filter(|top| (start..end).contains(top)).collect();
            if inside.len() > 1 {
                bodies.extend(inside.into_iter().map(|top| self.body_below(root, top)));
            } else if inside.len() == 1 || end - start >= BODY_NODES_MIN {
                bodies.push(BodyNodes { name: self.name(root, start), slots: (start..end).collect() });
            }
        }
        if bodies.is_empty() || bodies.len() > BODIES_MAX {
            bodies.clear();
            bodies.push(BodyNodes { name: String::new(), slots: (0..self.order.len()).collect() });
        }
        bodies
    }

    fn name(&self, root: &Root, slot: usize) -> String {
        root.nodes[self.order[slot]].name.clone().unwrap_or_default()
    }

    /// First slot of each tree, and the slot after its last.
    fn trees(&self) -> Vec<(usize, usize)> {
        let starts: Vec<usize> = (0..self.order.len()).filter(|&slot| self.parents[slot].is_none()).collect();
        let ends = starts.iter().copied().skip(1).chain([self.order.len()]);
        starts.iter().copied().zip(ends).collect()
    }

    /// The body whose topmost node is at `top`, with all nodes above it.
    fn body_below(&self, root: &Root, top: usize) -> BodyNodes {
        let mut slots: Vec<usize> = self.slots_above(top).collect();
        slots.reverse();
        slots.extend(top..self.end(top));
        let own = self.parents[top].map_or(top, |parent| if self.parents[parent].is_some() { parent } else { top });
        BodyNodes { name: self.name(root, own), slots }
    }

    /// Slot after the last descendant of `top`.
    fn end(&self, top: usize) -> usize {
        let is_outside = |&slot: &usize| self.parents[slot].is_none_or(|parent| parent < top);
        (top + 1..self.order.len()).find(is_outside).unwrap_or(self.order.len())
    }

    /// Slots of all ancestors, the parent first.
    fn slots_above(&self, slot: usize) -> impl Iterator<Item = usize> {
        std::iter::successors(self.parents[slot], |&slot| self.parents[slot])
    }

    /// Slots from which all joints of a skin hang, in order. Skins that share joints count once; small skins are props.
    fn skin_tops(&self, root: &Root) -> Vec<usize> {
        let mut slot_of = vec![0; self.order.len()];
        for (slot, &node) in self.order.iter().enumerate() {
            slot_of[node] = slot;
        }
        let top = |skin: &gltf::json::Skin| {
            let joints = skin.joints.iter().filter_map(|joint| slot_of.get(joint.value()).copied());
            joints.reduce(|a, b| self.common_ancestor(a, b))
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

    /// The lowest slot from which both slots hang; if there is none, the root above the later slot.
    fn common_ancestor(&self, a: usize, b: usize) -> usize {
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

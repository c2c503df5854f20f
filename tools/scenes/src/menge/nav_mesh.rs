//! Navigation meshes (`.nav`): convex nodes that share edges. World, metres.
//!
//! Whitespace separates all words of the file:
//! - number of vertices, then x and y of each;
//! - number of shared edges, then two vertices and two nodes of each;
//! - number of boundary edges, then two vertices, the node and the next edge of each;
//! - groups until the end: name, number of nodes, then each node: centre, number of vertices, the vertices, elevation
//!   `A x + B y + C`, number of shared edges and these, number of boundary edges and these.

use std::collections::BTreeSet;
use std::ops::Range;
use std::str::SplitAsciiWhitespace;

use motiondb::files::SourceText;

use crate::error::SceneError;
use crate::geometry::polygon::{is_simple, signed_area_m2, without_repeats};
use crate::geometry::rings::{closed_rings, united};
use crate::scene::Point;

/// Slope below which a node is flat: 1 mm over 1 m.
const FLAT: f64 = 1e-3;
/// Greatest coordinate, m.
const COORDINATE_MAX_M: f64 = 10_000.0;

/// A navigation mesh.
pub(crate) struct NavMesh {
    vertices_m: Vec<Point>,
    /// Vertices of each node, in order.
    nodes: Vec<Vec<usize>>,
    /// Edges between two nodes, the lesser vertex first.
    shared: BTreeSet<(usize, usize)>,
    /// Number of nodes that are not level.
    pub(crate) sloped_nodes: usize,
}

impl NavMesh {
    /// Reads a mesh.
    pub(crate) fn parse(source: &SourceText) -> Result<Self, SceneError> {
        let mut words = Words { source, rest: source.text.split_ascii_whitespace(), at: 0..0 };
        let mut mesh = Self { vertices_m: Vec::new(), nodes: Vec::new(), shared: BTreeSet::new(), sloped_nodes: 0 };
        for _ in 0..words.count()? {
            mesh.vertices_m.push([words.metres()?, words.metres()?]);
        }
        let vertices = mesh.vertices_m.len();
        for _ in 0..words.count()? {
            let [a, b] = [words.index(vertices)?, words.index(vertices)?];
            mesh.shared.insert((a.min(b), a.max(b)));
            words.skip(2)?;
        }
        let boundary = words.count()?;
        for _ in 0..boundary {
            words.skip(4)?;
        }
        while words.next_word().is_some() {
            for _ in 0..words.count()? {
                mesh.read_node(&mut words, vertices)?;
            }
        }
        Ok(mesh)
    }

    fn read_node(&mut self, words: &mut Words<'_>, vertices: usize) -> Result<(), SceneError> {
        words.skip(2)?;
        let mut node = Vec::new();
        for _ in 0..words.count()? {
            node.push(words.index(vertices)?);
        }
        let slope = [words.number()?, words.number()?];
        words.skip(1)?;
        for _ in 0..2 {
            let count = words.count()?;
            words.skip(count)?;
        }
        self.sloped_nodes += usize::from(slope.iter().any(|rise| rise.abs() > FLAT));
        self.nodes.push(node);
        Ok(())
    }

    /// Number of nodes.
    pub(crate) fn node_count(&self) -> usize {
        self.nodes.len()
    }

    /// Outlines of the mesh: counter-clockwise about walkable ground, clockwise about holes.
    ///
    /// They are the boundary edges, where these close and nodes do not overlap. Else, as where a stair ends beside rows
    /// of seats or below a floor, they are the outlines of all nodes together.
    pub(crate) fn outlines_m(&self) -> Vec<Vec<Point>> {
        let walls = self.walls();
        let mut edges = Vec::new();
        let mut nodes_m: Vec<Vec<Point>> = Vec::new();
        for node in &self.nodes {
            let corners_m: Vec<Point> = node.iter().map(|&vertex| self.vertices_m[vertex]).collect();
            let is_clockwise = signed_area_m2(&corners_m) < 0.0;
            nodes_m.push(corners_m);
            for (a, b) in edges_of(node) {
                let edge = (a.min(b), a.max(b));
                if a != b && !self.shared.contains(&edge) && !walls.contains(&edge) {
                    edges.push(if is_clockwise { (b, a) } else { (a, b) });
                }
            }
        }
        let rings: Vec<Vec<Point>> =
            closed_rings(&self.vertices_m, &edges).iter().map(|ring_m| without_repeats(ring_m)).collect();
        let united = united(&nodes_m);
        let area_m2 = |rings: &[Vec<Point>]| rings.iter().map(|ring_m| signed_area_m2(ring_m)).sum::<f64>();
        let is_whole = (area_m2(&rings) - area_m2(&united)).abs() < 1e-3 * area_m2(&united);
        if is_whole && rings.iter().all(|ring_m| is_simple(ring_m)) { rings } else { united }
    }

    /// Edges between two nodes that the mesh does not share: walls without thickness.
    pub(crate) fn walls_m(&self) -> Vec<[Point; 2]> {
        self.walls().into_iter().map(|(a, b)| [self.vertices_m[a], self.vertices_m[b]]).collect()
    }

    fn walls(&self) -> BTreeSet<(usize, usize)> {
        let (mut once, mut twice) = (BTreeSet::new(), BTreeSet::new());
        for (a, b) in self.nodes.iter().flat_map(|node| edges_of(node)) {
            let edge = (a.min(b), a.max(b));
            if a != b && !once.insert(edge) && !self.shared.contains(&edge) {
                twice.insert(edge);
            }
        }
        twice
    }
}

fn edges_of(node: &[usize]) -> impl Iterator<Item = (usize, usize)> + '_ {
    node.iter().copied().zip(node.iter().copied().cycle().skip(1))
}

/// The words of a file, with the position of the last one.
struct Words<'a> {
    source: &'a SourceText,
    rest: SplitAsciiWhitespace<'a>,
    at: Range<usize>,
}

impl<'a> Words<'a> {
    fn next_word(&mut self) -> Option<&'a str> {
        let word = self.rest.next()?;
        let begin = word.as_ptr() as usize - self.source.text.as_ptr() as usize;
        self.at = begin..begin + word.len();
        Some(word)
    }

    fn word(&mut self) -> Result<&'a str, SceneError> {
        match self.next_word() {
            Some(word) => Ok(word),
            None => Err(self.fault("the navigation mesh ends too early")),
        }
    }

    fn skip(&mut self, count: usize) -> Result<(), SceneError> {
        (0..count).try_for_each(|_| self.word().map(drop))
    }

    fn number(&mut self) -> Result<f64, SceneError> {
        match self.word()?.parse::<f64>() {
            Ok(number) if number.is_finite() => Ok(number),
            _ => Err(self.fault("this is no finite number")),
        }
    }

    fn metres(&mut self) -> Result<f64, SceneError> {
        let metres = self.number()?;
        if metres.abs() <= COORDINATE_MAX_M {
            Ok(metres)
        } else {
            Err(self.fault("this is not within 10 km of the origin"))
        }
    }

    /// A count; no greater than the text is long, so that a short file takes little time.
    fn count(&mut self) -> Result<usize, SceneError> {
        match self.word()?.parse::<usize>() {
            Ok(count) if count <= self.source.text.len() => Ok(count),
            _ => Err(self.fault("this is no number of items")),
        }
    }

    fn index(&mut self, count: usize) -> Result<usize, SceneError> {
        match self.word()?.parse::<usize>() {
            Ok(index) if index < count => Ok(index),
            _ => Err(self.fault("this is no vertex of the mesh")),
        }
    }

    fn fault(&self, message: &str) -> SceneError {
        let help = "name a navigation mesh of Menge, or write it anew";
        let invalid = self.source.invalid(self.at.clone(), message, help);
        motiondb::files::Invalid { is_quotable: false, ..invalid }.into()
    }
}

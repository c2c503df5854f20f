//! The entries and exits of one-way zones on a mesh, which agents pass in one direction. World, metres.
//!
//! A mesh is cut along both; each side of a cut has vertices of its own. A *gate* leads from a triangle before a cut to
//! the one beyond it. Parts of the mesh between cuts are *cells*.

use glam::DVec2;

use crate::route::mesh::triangulation::NONE;

/// Distance against the heading of a zone that counts as rounding, m: corners of the grid miss a slanted line by 1 mm.
pub(crate) const LEVEL_M: f64 = 5e-3;

/// One end of a gate: a triangle, and its edge on the cut.
pub(crate) type GateEnd = [u32; 2];

/// The gates of a mesh, and its triangles in zones.
#[derive(Clone, Debug, Default)]
pub(crate) struct Gates {
    /// Ends of each gate in the direction of agents, sorted.
    pub(crate) onwards: Vec<[GateEnd; 2]>,
    /// The same, the far end first, sorted.
    pub(crate) back: Vec<[GateEnd; 2]>,
    /// Vertices beyond and before a gate at one position, sorted.
    pub(crate) vertices: Vec<[u32; 2]>,
    /// Unit vector along each zone.
    pub(crate) headings: Vec<DVec2>,
    /// Index of the zone of each triangle; [`NONE`] elsewhere.
    pub(crate) zones: Vec<u32>,
    /// Index of the cell of each triangle.
    pub(crate) cells: Vec<u32>,
    /// Whether routes turn at walls within zones.
    pub(crate) have_corners: bool,
    /// Cells before and beyond gates, sorted, each pair once.
    pub(crate) cell_gates: Vec<[u32; 2]>,
}

impl Gates {
    /// The triangle and edge beyond a gate; none where agents pass no gate over this edge.
    pub(crate) fn beyond(&self, triangle: u32, edge: usize) -> Option<GateEnd> {
        far_end(&self.onwards, [triangle, edge as u32])
    }

    /// The triangle and edge from which agents come over an edge; none where they pass no gate over it.
    pub(crate) fn before(&self, triangle: u32, edge: usize) -> Option<GateEnd> {
        far_end(&self.back, [triangle, edge as u32])
    }

    /// The vertices before gates at the position of a vertex beyond.
    pub(crate) fn vertices_before(&self, vertex: u32) -> impl Iterator<Item = u32> + '_ {
        let first = self.vertices.partition_point(|&[beyond, _]| beyond < vertex);
        self.vertices[first..].iter().take_while(move |[beyond, _]| *beyond == vertex).map(|[_, before]| *before)
    }

    /// Whether gates lead from a cell to another one, or they are the same.
    pub(crate) fn leads(&self, from: u32, to: u32) -> bool {
        let (mut reached, mut at) = (vec![from], 0);
        while let Some(&cell) = reached.get(at) {
            if cell == to {
                return true;
            }
            at += 1;
            let first = self.cell_gates.partition_point(|&[before, _]| before < cell);
            let beyond = self.cell_gates[first..].iter().take_while(|[before, _]| *before == cell);
            for &[_, beyond] in beyond {
                if !reached.contains(&beyond) {
                    reached.push(beyond);
                }
            }
        }
        false
    }

    /// Whether gates lead from a cell out of it and back into it.
    pub(crate) fn leads_back(&self, cell: u32) -> bool {
        let first = self.cell_gates.partition_point(|&[before, _]| before < cell);
        self.cell_gates[first..]
            .iter()
            .take_while(|[before, _]| *before == cell)
            .any(|&[_, beyond]| self.leads(beyond, cell))
    }

    /// The zone of a triangle; none elsewhere.
    pub(crate) fn zone(&self, triangle: u32) -> Option<u32> {
        Some(self.zones[triangle as usize]).filter(|&zone| zone != NONE)
    }

    /// Distance of a point ahead of another one along the heading of a zone, m.
    pub(crate) fn ahead_m(&self, zone: u32, from_m: DVec2, point_m: DVec2) -> f64 {
        self.headings[zone as usize].dot(point_m - from_m)
    }

    /// Size in memory, bytes.
    pub(crate) fn bytes(&self) -> usize {
        size_of_val(&self.onwards[..])
            + size_of_val(&self.back[..])
            + size_of_val(&self.vertices[..])
            + size_of_val(&self.zones[..])
            + size_of_val(&self.cells[..])
            + size_of_val(&self.cell_gates[..])
    }
}

fn far_end(gates: &[[GateEnd; 2]], near: GateEnd) -> Option<GateEnd> {
    gates.binary_search_by(|[end, _]| end.cmp(&near)).ok().map(|gate| gates[gate][1])
}

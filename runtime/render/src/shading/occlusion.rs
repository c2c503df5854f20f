//! Ambient occlusion: how much of the sky near parts hide. World, metres.
//!
//! Each part counts as the ball nearest to the point: with the radius r, the distance D and the angle θ from the normal
//! it hides cos θ · r²/D² of the light. Parts are listed in cells of the ground, by how far each can be noticed.

use glam::{Vec2, Vec3};

use crate::visibility::{Cone, SceneParts};

/// Which surfaces are darkened where they see little of the sky.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Occlusion {
    /// None.
    None,
    /// The ground at the feet.
    Ground,
    /// The ground and the bodies.
    #[default]
    Full,
}

/// Side of a cell, m.
const CELL_M: f32 = 0.25;
/// Greatest number of cells along a side: larger crowds have larger cells.
const MAX_CELLS: f32 = 1024.0;
/// Occlusion that is not noticed: it bounds the reach of a part.
const UNNOTICED: f32 = 0.012;
/// Greatest reach of a part, m.
const MAX_REACH_M: f32 = 0.9;
/// Height from which a part hardly darkens the ground, m.
const LOW_M: f32 = 1.3;
/// Strength on the ground, and on bodies.
const STRENGTH: [f32; 2] = [1.15, 0.75];
/// Least share of the sky's light.
const LEAST: f32 = 0.12;

/// A part as occlusion sees it.
#[derive(Clone, Copy, Debug)]
struct Occluder {
    from: Vec3,
    axis: Vec3,
    inverse_length_squared: f32,
    radii: [f32; 2],
}

/// The occluders of a scene, by cells of the ground and by agents.
#[derive(Clone, Debug)]
pub(crate) struct OcclusionGrid {
    occluders: Vec<Occluder>,
    low_m: Vec2,
    cell_m: f32,
    columns: usize,
    rows: usize,
    starts: Vec<u32>,
    entries: Vec<u32>,
    /// First and last occluder (exclusive) of each agent, by rising agent.
    ranges: Vec<(u32, [u32; 2])>,
}

impl Occluder {
    fn new(cone: &Cone) -> Self {
        let axis = cone.ends_m[1] - cone.ends_m[0];
        let inverse_length_squared = 1.0 / axis.length_squared().max(1e-9);
        Self { from: cone.ends_m[0], axis, inverse_length_squared, radii: cone.radii_m }
    }

    /// Share of the light that it hides from a point with a normal.
    #[inline]
    fn hidden(&self, point_m: Vec3, normal: Vec3) -> f32 {
        let offset = point_m - self.from;
        let share = (offset.dot(self.axis) * self.inverse_length_squared).clamp(0.0, 1.0);
        let to_ball = share * self.axis - offset;
        let facing = normal.dot(to_ball);
        if facing <= 0.0 {
            return 0.0;
        }
        let radius = self.radii[0] + share * (self.radii[1] - self.radii[0]);
        let distance_squared = to_ball.length_squared().max(radius * radius);
        let hidden = facing * radius * radius / (distance_squared * distance_squared.sqrt());
        (hidden - UNNOTICED).max(0.0)
    }

    /// Distance on the ground at which it is no longer noticed, m.
    fn reach_m(&self) -> f32 {
        let radius = self.radii[0].max(self.radii[1]);
        let height = self.from.z.min(self.from.z + self.axis.z).max(radius);
        if height > LOW_M {
            return 0.0;
        }
        libm::cbrtf(radius * radius * height / UNNOTICED).min(MAX_REACH_M)
    }
}

impl OcclusionGrid {
    pub(crate) fn new(scene: &SceneParts) -> Self {
        let occluders: Vec<Occluder> = scene.occluders.iter().map(Occluder::new).collect();
        let bounds = |occluder: &Occluder| {
            let (reach, to) = (occluder.reach_m(), occluder.from + occluder.axis);
            let (low, high) = (occluder.from.min(to).truncate(), occluder.from.max(to).truncate());
            (reach > 0.0 && low.is_finite() && high.is_finite()).then(|| [low - reach, high + reach])
        };
        let all = occluders.iter().filter_map(bounds);
        let all = all.reduce(|[low, high], [other_low, other_high]| [low.min(other_low), high.max(other_high)]);
        let [low_m, high_m] = all.unwrap_or_default();
        let cell_m = ((high_m - low_m).max_element() / MAX_CELLS).max(CELL_M);
        let [columns, rows] = ((high_m - low_m) / cell_m).to_array().map(|side| side as usize + 1);
        let cells = |occluder: &Occluder| {
            let [low, high] = bounds(occluder)?;
            let [first, last] = [low, high].map(|at| ((at - low_m) / cell_m).to_array().map(|side| side as usize));
            Some(
                (first[1]..=last[1])
                    .flat_map(move |row| (first[0]..=last[0]).map(move |column| row * columns + column)),
            )
        };
        let mut starts = vec![0_u32; columns * rows + 1];
        for cell in occluders.iter().filter_map(cells).flatten() {
            starts[cell + 1] += 1;
        }
        for cell in 1..starts.len() {
            starts[cell] += starts[cell - 1];
        }
        let (mut next, mut entries) = (starts.clone(), vec![0; starts[starts.len() - 1] as usize]);
        for (index, occluder) in occluders.iter().enumerate() {
            for cell in cells(occluder).into_iter().flatten() {
                entries[next[cell] as usize] = index as u32;
                next[cell] += 1;
            }
        }
        Self { ranges: agent_ranges(&scene.occluders), occluders, low_m, cell_m, columns, rows, starts, entries }
    }

    /// Share of the sky's light that reaches a point of the ground.
    pub(crate) fn on_ground(&self, point_m: Vec3) -> f32 {
        let cell = (point_m.truncate() - self.low_m) / self.cell_m;
        if cell.x < 0.0 || cell.y < 0.0 || cell.x >= self.columns as f32 || cell.y >= self.rows as f32 {
            return 1.0;
        }
        let cell = cell.y as usize * self.columns + cell.x as usize;
        let entries = &self.entries[self.starts[cell] as usize..self.starts[cell + 1] as usize];
        let mut left = 1.0;
        for index in entries {
            left *= 1.0 - self.occluders[*index as usize].hidden(point_m, Vec3::Z).min(1.0);
        }
        (1.0 - STRENGTH[0] * (1.0 - left)).max(LEAST)
    }

    /// Share of the sky's light that reaches a point of an agent's body; its own parts hide the rest.
    pub(crate) fn on_body(&self, agent: u32, point_m: Vec3, normal: Vec3) -> f32 {
        let Ok(range) = self.ranges.binary_search_by_key(&agent, |(agent, _)| *agent) else { return 1.0 };
        let [from, to] = self.ranges[range].1;
        let mut left = 1.0;
        for occluder in &self.occluders[from as usize..to as usize] {
            left *= 1.0 - 0.8 * occluder.hidden(point_m, normal).min(1.0);
        }
        (1.0 - STRENGTH[1] * (1.0 - left)).max(LEAST)
    }
}

/// First and last cone (exclusive) of each agent, by rising agent.
fn agent_ranges(cones: &[Cone]) -> Vec<(u32, [u32; 2])> {
    let mut from = 0;
    let runs = cones.chunk_by(|one, other| one.owner.agent == other.owner.agent);
    runs.map(|run| {
        let range = [from, from + run.len() as u32];
        from = range[1];
        (run[0].owner.agent, range)
    })
    .collect()
}

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
/// Greatest reach of a part, m: it bounds the work of characters with huge heads.
const MAX_REACH_M: f32 = 1.5;
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
    /// Distance on the ground at which it is no longer noticed, m.
    reach_m: f32,
    /// Occlusion of the ground at that distance or less, which is not drawn, so that the ground darkens without an edge.
    faint: f32,
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
        let [from, to] = cone.ends_m;
        let radius = cone.radii_m[0].max(cone.radii_m[1]);
        let [low, high] = [from.z.min(to.z), from.z.max(to.z)].map(|height| height.max(0.0));
        // A ball at the height h hides h r² / (d² + h²)^1.5 of the light at the distance d: most at the height d / √2, which
        // is 4 r where UNNOTICED is hidden.
        let height = (4.0 * radius).clamp(low, high);
        let root = libm::cbrtf(radius * radius * height / UNNOTICED);
        let reach_m = (root * root - height * height).max(0.0).sqrt().min(MAX_REACH_M);
        let height = (MAX_REACH_M / std::f32::consts::SQRT_2).clamp(low, high);
        let distance = (MAX_REACH_M * MAX_REACH_M + height * height).sqrt();
        let faint = (radius * radius * height / (distance * distance * distance)).max(UNNOTICED);
        let axis = to - from;
        let inverse_length_squared = 1.0 / axis.length_squared().max(1e-9);
        Self { from, axis, inverse_length_squared, radii: cone.radii_m, reach_m, faint }
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
        facing * radius * radius / (distance_squared * distance_squared.sqrt())
    }
}

impl OcclusionGrid {
    pub(crate) fn new(scene: &SceneParts) -> Self {
        let occluders: Vec<Occluder> = scene.occluders.iter().map(Occluder::new).collect();
        let bounds = |occluder: &Occluder| {
            let (reach, to) = (occluder.reach_m, occluder.from + occluder.axis);
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
            let occluder = &self.occluders[*index as usize];
            left *= 1.0 - (occluder.hidden(point_m, Vec3::Z) - occluder.faint).clamp(0.0, 1.0);
        }
        (1.0 - STRENGTH[0] * (1.0 - left)).max(LEAST)
    }

    /// Share of the sky's light that reaches a point of an agent's body; its own parts hide the rest.
    pub(crate) fn on_body(&self, agent: u32, point_m: Vec3, normal: Vec3) -> f32 {
        let Ok(range) = self.ranges.binary_search_by_key(&agent, |(agent, _)| *agent) else { return 1.0 };
        let [from, to] = self.ranges[range].1;
        let mut left = 1.0;
        for occluder in &self.occluders[from as usize..to as usize] {
            left *= 1.0 - 0.8 * (occluder.hidden(point_m, normal) - UNNOTICED).clamp(0.0, 1.0);
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::visibility::Owner;

    #[test]
    fn the_ground_darkens_without_an_edge() {
        for (radius, low, high) in [(0.06, 0.1, 0.45), (0.17, 1.0, 1.3), (0.5, 0.5, 0.9), (0.8, 0.9, 2.5)] {
            let ends_m = [low, high].map(|height| Vec3::new(0.1, 0.2, height));
            let cone = Cone { ends_m, radii_m: [radius; 2], colour: Vec3::ONE, owner: Owner::SCENE };
            let grid = OcclusionGrid::new(&SceneParts { occluders: vec![cone], ..SceneParts::default() });
            let light = |step: i32| grid.on_ground(Vec3::new(0.1 + 2e-4 * step as f32, 0.2, 0.0));
            let greatest = (0..20_000).map(|step| (light(step + 1) - light(step)).abs()).fold(0.0, f32::max);
            assert!(greatest < 0.001, "radius {radius} m: a jump by {greatest}");
            assert_eq!(light(20_000), 1.0);
        }
    }
}

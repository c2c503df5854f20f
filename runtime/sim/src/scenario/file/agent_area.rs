//! Agents that are spread over an area, apart from walls and from each other. World, metres.
//!
//! `area = { rect_m = [x, y, x, y], count = 50, apart_m = 1.0 }`: the keys of an area (`behaviour/area_table.rs`), and
//! exactly one of `count` and `density_per_m2`.
//!
//! 1. Below [`LOOSE_SHARE`] of the ground, positions are drawn one after the other; one that has no room is drawn again.
//! 2. Where that finds no room, or the crowd is denser: positions of a hexagonal lattice, as wide as there is room for
//!    all agents, chosen at random.

use std::collections::BTreeMap;
use std::f64::consts::PI;

use glam::Vec2;
use serde::Deserialize;

use crate::behaviour::Area;
use crate::maths::polygon::signed_area_m2;
use crate::maths::random::SplitMix64;
use crate::scenario::fault::TableFault;
use crate::scenario::file::behaviour::AreaKeys;
use crate::scenario::point::Point;
use crate::scenario::ranges::AGENTS_MAX;
use crate::world::obstacles::Obstacles;

/// Share of the ground that discs may cover where positions are drawn; random discs jam at 0.547 (Rényi's limit in the
/// plane, Torquato 2006).
const LOOSE_SHARE: f64 = 0.4;
/// Positions drawn for one agent before the lattice is used.
const DRAWS_MAX: usize = 300;
/// Widths of the lattice that are tried, by halving.
const HALVINGS: usize = 12;
/// Greatest `apart_m`: distance between the centres of two agents, m.
const APART_MAX_M: f32 = 100.0;
/// Positions of the lattice that are tried at most: ten for each agent of the largest crowd.
const SITES_MAX: f64 = 1e7;
/// Rounding of discs that are meant to touch, m.
const TOUCH_M: f32 = 1e-4;

/// `area` of agents.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct AgentArea {
    circle_m: Option<[f32; 3]>,
    rect_m: Option<[f32; 4]>,
    polygon_m: Option<Vec<Point>>,
    count: Option<usize>,
    density_per_m2: Option<f64>,
    #[serde(default)]
    apart_m: f32,
}

impl AgentArea {
    /// Least distance between the centres of two agents, m; the sum of their radii where that is greater.
    pub(crate) fn apart_m(&self) -> f32 {
        self.apart_m
    }

    /// The area, and the number of its agents, checked before anything is allocated for them.
    pub(crate) fn resolve(&self) -> Result<(Area, usize), TableFault> {
        let Self { circle_m, rect_m, .. } = *self;
        let area = AreaKeys { point_m: None, circle_m, rect_m, polygon_m: self.polygon_m.as_deref() }.area()?;
        let [low_m, high_m] = area.bounds_m();
        if !(low_m.is_finite() && high_m.is_finite()) || low_m.abs().max(high_m.abs()).max_element() > 1e4 {
            return Err(("the area is not within 10 km of the origin".into(), "give coordinates in metres"));
        }
        if !(0.0..=APART_MAX_M).contains(&self.apart_m) {
            return Err((format!("`apart_m` is {}", self.apart_m), "give a distance of 0 to 100 m between centres"));
        }
        let count = match (self.count, self.density_per_m2) {
            (Some(count), None) => count as f64,
            (None, Some(density_per_m2)) => (density_per_m2 * size_m2(&area)).round(),
            _ => {
                let message = "an `area` of agents needs exactly one of `count` and `density_per_m2`";
                return Err((message.into(), "write `area = { rect_m = [x, y, x, y], count = 20 }`"));
            }
        };
        if !(1.0..=AGENTS_MAX as f64).contains(&count) {
            let message = format!("the number of agents is {count}, not between 1 and {AGENTS_MAX}");
            return Err((message, "set `count` or `density_per_m2`, and the area, for a number in this range"));
        }
        Ok((area, count as usize))
    }

    /// Positions for agents of these radii, m, each apart from walls and from those in `taken`, which they join.
    pub(crate) fn positions_m(
        &self,
        area: &Area,
        discs: &[AreaDisc],
        taken: &mut TakenGround<'_>,
        mut random: SplitMix64,
    ) -> Result<Vec<Vec2>, TableFault> {
        let widest = discs.iter().fold(AreaDisc::default(), |a, b| AreaDisc {
            radius_m: a.radius_m.max(b.radius_m),
            wall_radius_m: a.wall_radius_m.max(b.wall_radius_m),
        });
        let spacing_m = self.apart_m.max(2.0 * widest.radius_m);
        let covered_m2 = discs.len() as f64 * PI / 4.0 * f64::from(spacing_m) * f64::from(spacing_m);
        if covered_m2 <= LOOSE_SHARE * size_m2(area) {
            let before = taken.mark();
            if let Some(positions_m) = self.drawn_m(area, discs, taken, &mut random) {
                return Ok(positions_m);
            }
            taken.forget_since(before);
        }
        let mut sites_m = widest_lattice_m(area, discs.len(), spacing_m, |position_m| {
            taken.has_room(position_m, widest, self.apart_m)
        })?;
        // Fisher and Yates: the first of a shuffled list.
        for index in 0..discs.len() {
            let other = index + (random.unit() * (sites_m.len() - index) as f64) as usize;
            sites_m.swap(index, other);
        }
        sites_m.truncate(discs.len());
        sites_m.iter().zip(discs).for_each(|(&position_m, disc)| taken.take(position_m, disc.radius_m));
        Ok(sites_m)
    }

    fn drawn_m(
        &self,
        area: &Area,
        discs: &[AreaDisc],
        taken: &mut TakenGround<'_>,
        random: &mut SplitMix64,
    ) -> Option<Vec<Vec2>> {
        let mut position_m = |disc: &AreaDisc| {
            let mut drawn_m = (0..DRAWS_MAX).map(|_| area.draw_m(random));
            let position_m = drawn_m.find(|&position_m| taken.has_room(position_m, *disc, self.apart_m))?;
            taken.take(position_m, disc.radius_m);
            Some(position_m)
        };
        discs.iter().map(&mut position_m).collect()
    }
}

/// The discs of an agent.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct AreaDisc {
    /// Radius of the disc that other agents see, m.
    pub(crate) radius_m: f32,
    /// Radius of the disc that walls hold, m.
    pub(crate) wall_radius_m: f32,
}

/// Ground that walls and agents cover.
pub(crate) struct TakenGround<'a> {
    obstacles: &'a Obstacles,
    /// The walls of the agents of the present table, where zones are closed to some.
    pub(crate) with_zones: Option<Obstacles>,
    /// Side of a cell, m: no less than any distance that centres keep.
    cell_m: f32,
    /// Discs of agents, sorted into the cells of their centres.
    cells: BTreeMap<(i32, i32), Vec<(Vec2, f32)>>,
    /// Cells of the discs, in the order in which they came.
    order: Vec<(i32, i32)>,
}

impl<'a> TakenGround<'a> {
    /// Ground with walls alone; no two centres are kept farther apart than `apart_max_m`.
    pub(crate) fn new(obstacles: &'a Obstacles, apart_max_m: f32) -> Self {
        Self { obstacles, with_zones: None, cell_m: apart_max_m.max(2.0), cells: BTreeMap::new(), order: Vec::new() }
    }

    fn cell(&self, position_m: Vec2) -> (i32, i32) {
        let cell = (position_m / self.cell_m).floor();
        (cell.x as i32, cell.y as i32)
    }

    /// Adds the disc of an agent.
    pub(crate) fn take(&mut self, position_m: Vec2, radius_m: f32) {
        let cell = self.cell(position_m);
        self.cells.entry(cell).or_default().push((position_m, radius_m));
        self.order.push(cell);
    }

    fn mark(&self) -> usize {
        self.order.len()
    }

    /// Removes the discs that were added after a mark.
    fn forget_since(&mut self, mark: usize) {
        for cell in self.order.drain(mark..).rev() {
            if let Some(discs) = self.cells.get_mut(&cell) {
                discs.pop();
            }
        }
    }

    /// Whether a disc overlaps no wall and no agent, and its centre keeps a distance from all others.
    fn has_room(&self, position_m: Vec2, disc: AreaDisc, apart_m: f32) -> bool {
        let (x, y) = self.cell(position_m);
        let cells = (-1..=1).flat_map(|dx| (-1..=1).map(move |dy| (x + dx, y + dy)));
        let mut others = cells.filter_map(|cell| self.cells.get(&cell)).flatten();
        let is_apart = others.all(|&(other_m, radius_m)| {
            position_m.distance(other_m) >= apart_m.max(disc.radius_m + radius_m) - TOUCH_M
        });
        let walls = self.with_zones.as_ref().unwrap_or(self.obstacles);
        is_apart && walls.depth_m(position_m, disc.wall_radius_m) <= 0.0
    }
}

/// Positions of the widest hexagonal lattice over an area that has room for a number of agents.
fn widest_lattice_m(
    area: &Area,
    count: usize,
    spacing_m: f32,
    has_room: impl Fn(Vec2) -> bool,
) -> Result<Vec<Vec2>, TableFault> {
    let tightest_m2 = 0.5 * 3.0_f64.sqrt() * f64::from(spacing_m) * f64::from(spacing_m);
    let [low_m, high_m] = area.bounds_m();
    let box_m2 = f64::from(high_m.x - low_m.x) * f64::from(high_m.y - low_m.y);
    if box_m2 / tightest_m2 > SITES_MAX {
        return Err(("the area is too large for its number of agents".into(), "give a smaller area"));
    }
    let sites_m = |spacing_m: f32| -> Vec<Vec2> {
        hexagonal_lattice_m(area, spacing_m).filter(|&position_m| has_room(position_m)).collect()
    };
    let tightest_m = sites_m(spacing_m);
    if tightest_m.len() < count {
        let message = format!("the area has room for {} agents, not for {count}", tightest_m.len());
        return Err((message, "give fewer agents, a larger area, or a smaller `apart_m` or `radius_m`"));
    }
    let widest_m = (size_m2(area) / count as f64 * 2.0 / 3.0_f64.sqrt()).sqrt() as f32;
    let (mut fits_m, mut best_m, mut fails_m) = (spacing_m, tightest_m, widest_m.max(spacing_m));
    for _ in 0..HALVINGS {
        let tried_m = 0.5 * (fits_m + fails_m);
        let tried = sites_m(tried_m);
        if tried.len() >= count {
            (fits_m, best_m) = (tried_m, tried);
        } else {
            fails_m = tried_m;
        }
    }
    Ok(best_m)
}

/// The positions of a hexagonal lattice that lie in an area, row by row.
fn hexagonal_lattice_m(area: &Area, spacing_m: f32) -> impl Iterator<Item = Vec2> {
    let [low_m, high_m] = area.bounds_m();
    let row_m = spacing_m * 0.866_025_4;
    let [columns, rows] = [(high_m.x - low_m.x) / spacing_m, (high_m.y - low_m.y) / row_m].map(|count| count as u32);
    let margin_m = 0.5 * (high_m - low_m - Vec2::new(columns as f32 * spacing_m, rows as f32 * row_m));
    let at_m = move |row: u32, column: u32| {
        let aside_m = if row % 2 == 1 { 0.5 * spacing_m } else { 0.0 };
        low_m + margin_m + Vec2::new(column as f32 * spacing_m + aside_m, row as f32 * row_m)
    };
    let all = (0..=rows).flat_map(move |row| (0..=columns).map(move |column| at_m(row, column)));
    all.filter(|&position_m| area.holds(position_m))
}

fn size_m2(area: &Area) -> f64 {
    match area {
        Area::Disc { radius_m, .. } => PI * f64::from(*radius_m) * f64::from(*radius_m),
        Area::Polygon(corners_m) => signed_area_m2(corners_m).abs(),
    }
}

//! Density, speed and level of service in an area.
//!
//! Classical density: agents inside over the size of the area. Voronoi density (Steffen and Seyfried 2010): the mean over
//! the area of 1/A_i, where A_i is the size of the cell (`voronoi_cell`, cut by walls in `cell_part`) that holds the
//! ground; 0 where no cell does. The
//! level of service is Fruin's for walkways (1971), by the classical density. World, metres, seconds.

use glam::Vec2;
use serde::Serialize;

use crate::behaviour::Area;
use crate::maths::polygon::signed_area_m2;
use crate::measures::frame_pairs::FramePairs;
use crate::measures::places::cell_part::CellWalls;
use crate::measures::places::voronoi_cell::{CELL_RADIUS_M, VoronoiCell, disc_m};
use crate::recording::frame::AgentFrame;

/// Fruin's levels of service of walkways, and the greatest density of each, 1/m²: 35, 25, 15, 10 and 5 square feet per
/// person.
pub const LEVELS_OF_SERVICE: [(&str, f64); 6] =
    [("A", 0.308), ("B", 0.431), ("C", 0.718), ("D", 1.076), ("E", 2.153), ("F", f64::INFINITY)];
/// Time between two moments that are measured, s; at least a step.
const MOMENT_S: f64 = 0.5;
/// Corners of a disc.
const DISC_CORNERS: usize = 64;

/// The measures of an area. Means are over its moments.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct AreaMeasures {
    /// Size, m².
    pub size_m2: f64,
    /// Mean number of agents inside.
    pub mean_number: f64,
    /// Mean classical density, 1/m².
    pub mean_density_per_m2: f64,
    /// Greatest classical density, 1/m².
    pub greatest_density_per_m2: f64,
    /// Mean Voronoi density, 1/m².
    pub mean_voronoi_density_per_m2: f64,
    /// Greatest Voronoi density, 1/m².
    pub greatest_voronoi_density_per_m2: f64,
    /// Mean speed of the agents inside, over agents and moments, m/s; none where no agent was inside.
    pub mean_speed_mps: Option<f64>,
    /// Share of the moments at each of Fruin's levels of service, A to F.
    pub level_of_service_shares: [f64; 6],
    /// The moments, half a second apart.
    pub moments: Vec<AreaMoment>,
}

/// An area at one moment.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct AreaMoment {
    /// Time, s.
    pub time_s: f64,
    /// Number of agents inside.
    pub number: usize,
    /// Classical density, 1/m².
    pub density_per_m2: f64,
    /// Voronoi density, 1/m².
    pub voronoi_density_per_m2: f64,
    /// Mean speed of the agents inside in the step before, m/s; none where no agent is inside.
    pub mean_speed_mps: Option<f64>,
}

impl AreaMoment {
    /// Index of the level of service in [`LEVELS_OF_SERVICE`], by the classical density.
    pub fn level_of_service(&self) -> usize {
        let level = LEVELS_OF_SERVICE.iter().position(|(_, most)| self.density_per_m2 <= *most);
        level.unwrap_or(LEVELS_OF_SERVICE.len() - 1)
    }
}

/// An area while frames come.
#[derive(Debug)]
pub(crate) struct MeasuredArea {
    polygon_m: Vec<Vec2>,
    area: Area,
    size_m2: f64,
    dt_s: f64,
    walls: CellWalls,
    /// Frames between two moments.
    stride: u32,
    moments: Vec<AreaMoment>,
}

impl MeasuredArea {
    pub(crate) fn new(area: &Area, dt_s: f64, walls: CellWalls, start: &[AgentFrame]) -> Self {
        let polygon_m = match area {
            Area::Disc { centre_m, radius_m } => disc_m(*centre_m, *radius_m, DISC_CORNERS),
            Area::Polygon(corners_m) => corners_m.clone(),
        };
        let size_m2 = signed_area_m2(&polygon_m).abs();
        let stride = (MOMENT_S / dt_s).round().max(1.0) as u32;
        let mut measured = Self { polygon_m, area: area.clone(), size_m2, dt_s, walls, stride, moments: Vec::new() };
        measured.add(0, start, |_| 0.0);
        measured
    }

    /// Takes the walls of the frames to come.
    pub(crate) fn set_walls(&mut self, walls: &CellWalls) {
        self.walls = walls.clone();
    }

    pub(crate) fn push(&mut self, frame: u32, pairs: &FramePairs<'_>, after: &[AgentFrame]) {
        if !frame.is_multiple_of(self.stride) {
            return;
        }
        let dt_s = self.dt_s;
        self.add(frame, after, |agent| {
            let pair = pairs.common.binary_search_by_key(&agent.id, |(_, after)| after.id);
            let moved_m = pair
                .map(|pair| pairs.common[pair])
                .map_or(0.0, |(before, after)| f64::from(before.root.position_m.distance(after.root.position_m)));
            moved_m / dt_s
        });
    }

    fn add(&mut self, frame: u32, agents: &[AgentFrame], speed_mps: impl Fn(&AgentFrame) -> f64) {
        let inside: Vec<&AgentFrame> = agents.iter().filter(|agent| self.area.holds(agent.root.position_m)).collect();
        let speeds_mps: f64 = inside.iter().map(|agent| speed_mps(agent)).sum();
        self.moments.push(AreaMoment {
            time_s: f64::from(frame) * self.dt_s,
            number: inside.len(),
            density_per_m2: inside.len() as f64 / self.size_m2,
            voronoi_density_per_m2: self.voronoi_density_per_m2(agents),
            mean_speed_mps: (!inside.is_empty()).then(|| speeds_mps / inside.len() as f64),
        });
    }

    fn voronoi_density_per_m2(&self, agents: &[AgentFrame]) -> f64 {
        let [low_m, high_m] = self.area.bounds_m();
        let beside = |margin_m: f32| {
            move |position_m: &Vec2| {
                position_m.cmpge(low_m - margin_m).all() && position_m.cmple(high_m + margin_m).all()
            }
        };
        // Cells that reach into the area, and all agents that cut them.
        let mut near_m: Vec<Vec2> =
            agents.iter().map(|agent| agent.root.position_m).filter(beside(3.2 * CELL_RADIUS_M)).collect();
        near_m.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
        let (reaches_in, range_m) = (beside(1.1 * CELL_RADIUS_M), 2.2 * CELL_RADIUS_M);
        let mut agents_within = 0.0;
        for (index, &position_m) in near_m.iter().enumerate().filter(|(_, position_m)| reaches_in(position_m)) {
            let from = near_m.partition_point(|other_m| other_m.x < position_m.x - range_m);
            let to = near_m.partition_point(|other_m| other_m.x <= position_m.x + range_m);
            let others = (from..to).filter(|&other| other != index).map(|other| near_m[other]);
            let mut others_m: Vec<Vec2> = others.filter(|other_m| other_m.distance(position_m) < range_m).collect();
            let cell = VoronoiCell::new(position_m, &mut others_m);
            let [size_m2, within_m2] = match self.walls.part_of(position_m, cell.corners_m()) {
                Some(part) => [part.size_m2, part.size_within_m2(&self.polygon_m)],
                None => [cell.size_m2, cell.size_within_m2(&self.polygon_m)],
            };
            if size_m2 > 0.0 {
                agents_within += within_m2 / size_m2;
            }
        }
        agents_within / self.size_m2
    }

    pub(crate) fn finish(self) -> AreaMeasures {
        let Self { size_m2, moments, .. } = self;
        let count = moments.len() as f64;
        let mean = |value: fn(&AreaMoment) -> f64| moments.iter().map(value).sum::<f64>() / count;
        let greatest = |value: fn(&AreaMoment) -> f64| moments.iter().map(value).fold(0.0, f64::max);
        let weighted = moments.iter().filter_map(|moment| Some((moment.mean_speed_mps?, moment.number as f64)));
        let (sum_mps, number) =
            weighted.fold((0.0, 0.0), |(sum, all), (speed, number)| (sum + speed * number, all + number));
        let mut level_of_service_shares = [0.0; 6];
        for moment in &moments {
            level_of_service_shares[moment.level_of_service()] += 1.0 / count;
        }
        AreaMeasures {
            size_m2,
            mean_number: mean(|moment| moment.number as f64),
            mean_density_per_m2: mean(|moment| moment.density_per_m2),
            greatest_density_per_m2: greatest(|moment| moment.density_per_m2),
            mean_voronoi_density_per_m2: mean(|moment| moment.voronoi_density_per_m2),
            greatest_voronoi_density_per_m2: greatest(|moment| moment.voronoi_density_per_m2),
            mean_speed_mps: (number > 0.0).then_some(sum_mps / number),
            level_of_service_shares,
            moments,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::population::AgentId;

    fn crowd(spacing_m: f32, shift_m: f32) -> Vec<AgentFrame> {
        let positions = (-10..=10).flat_map(|x| (-10..=10).map(move |y| spacing_m * Vec2::new(x as f32, y as f32)));
        let frame = |(id, position_m): (usize, Vec2)| {
            let mut frame = AgentFrame { id: AgentId::from(id), ..AgentFrame::default() };
            frame.root.position_m = position_m + Vec2::new(shift_m, 0.0);
            frame
        };
        positions.enumerate().map(frame).collect()
    }

    #[test]
    fn an_even_crowd_has_its_density_and_speed() {
        let area = Area::rectangle(Vec2::splat(-2.0), Vec2::splat(2.0));
        let mut measured = MeasuredArea::new(&area, 0.5, CellWalls::default(), &crowd(0.8, 0.0));
        let (before, after) = (crowd(0.8, 0.0), crowd(0.8, 0.1));
        measured.push(1, &FramePairs::new(&before, &after), &after);
        let measures = measured.finish();
        // 1/0.64 agents per m²; the classical density depends on where the grid lies.
        assert!((measures.mean_voronoi_density_per_m2 - 1.5625).abs() < 1e-3, "{measures:?}");
        assert!((measures.mean_density_per_m2 - 1.5625).abs() < 0.1, "{measures:?}");
        assert!((measures.moments[1].mean_speed_mps.unwrap() - 0.2).abs() < 1e-6);
        assert_eq!(measures.level_of_service_shares, [0.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
    }

    #[test]
    fn an_empty_area_has_level_a() {
        let disc = Area::Disc { centre_m: Vec2::new(50.0, 50.0), radius_m: 2.0 };
        let measures = MeasuredArea::new(&disc, 0.1, CellWalls::default(), &crowd(1.0, 0.0)).finish();
        assert_eq!((measures.mean_number, measures.mean_speed_mps), (0.0, None));
        assert_eq!((measures.mean_voronoi_density_per_m2, measures.level_of_service_shares[0]), (0.0, 1.0));
        assert!((measures.size_m2 - 4.0 * std::f64::consts::PI).abs() < 1e-3);
    }
}

//! What is painted on the ground: its colour at any point, from polygons in layers. World, metres; linear colours.
//!
//! A grid of cells keeps the polygons whose outline crosses a cell, and the layer of a cell that no outline crosses, so
//! that most points need one look-up.

use fbcrowd_sim::scenario::{Marking, MarkingColour, Scenario};
use glam::{Vec2, Vec3};

use crate::raster::palette::{self, Rgb, SIGNAL, decode_srgb};

/// Least side of a cell, m.
const MIN_CELL_M: f32 = 0.5;
/// Greatest number of cells along a side.
const MAX_CELLS: f32 = 384.0;
/// Light that ground of the camera view reflects, of that in the top view: paper white dazzles beside people.
const GROUND_SHARE: f32 = 0.60;

/// Colour of a layer of the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
enum LayerColour {
    /// Always the same, sRGB-encoded.
    Fixed(Rgb),
    /// Green or red, as a signal is; the signal by index.
    Signal(u32),
}

/// A polygon, or several with holes by the even-odd rule.
#[derive(Clone, Debug, PartialEq)]
struct Shape {
    contours_m: Vec<Vec<Vec2>>,
    low_m: Vec2,
    high_m: Vec2,
    /// Whether it is outside that is painted.
    is_outside: bool,
    layer: u32,
}

/// The painted ground of a scenario.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct GroundPlan {
    shapes: Vec<Shape>,
    /// Colours of the layers; layer 0 is the bare ground.
    colours: Vec<LayerColour>,
    /// Layer beyond all cells.
    beyond: u32,
    low_m: Vec2,
    cell_m: f32,
    columns: usize,
    rows: usize,
    /// Layer of each cell below the shapes of its list.
    bases: Vec<u32>,
    /// Shapes whose outline crosses the cell, the lowest first.
    crossing: Vec<Vec<u32>>,
}

impl GroundPlan {
    pub(crate) fn new(scenario: &Scenario) -> Self {
        let mut colours = vec![LayerColour::Fixed(palette::GROUND)];
        let mut shapes = Vec::new();
        let lines_m = scenario.ground_lines_m();
        if !lines_m.is_empty() {
            let layer = layer_of(&mut colours, LayerColour::Fixed(palette::OUTSIDE));
            shapes.push(Shape::new(lines_m, true, layer));
        }
        for Marking { shape, colour } in &scenario.markings {
            let colour = match *colour {
                MarkingColour::Fixed(rgb) => LayerColour::Fixed(palette::from_bytes(rgb)),
                MarkingColour::Signal(signal) => LayerColour::Signal(signal),
            };
            let layer = layer_of(&mut colours, colour);
            shapes.extend(shape.polygons_m().into_iter().map(|corners_m| Shape::new(vec![corners_m], false, layer)));
        }
        let mut plan = Self::sized(shapes, colours);
        for index in 0..plan.shapes.len() {
            plan.paint(index);
        }
        plan
    }

    /// A plan with cells over all shapes, bare.
    fn sized(shapes: Vec<Shape>, colours: Vec<LayerColour>) -> Self {
        let bounds = shapes.iter().map(|shape| [shape.low_m, shape.high_m]);
        let all = bounds.reduce(|[low, high], [other_low, other_high]| [low.min(other_low), high.max(other_high)]);
        let [low_m, high_m] = all.unwrap_or_default();
        let extent_m = (high_m - low_m).max(Vec2::splat(MIN_CELL_M));
        let cell_m = (extent_m.max_element() / MAX_CELLS).max(MIN_CELL_M);
        let [columns, rows] = extent_m.to_array().map(|side| (side / cell_m) as usize + 1);
        let beyond = shapes.iter().find(|shape| shape.is_outside).map_or(0, |shape| shape.layer);
        let count = columns * rows;
        let (bases, crossing) = (vec![0; count], vec![Vec::new(); count]);
        Self { shapes, colours, beyond, low_m, cell_m, columns, rows, bases, crossing }
    }

    fn paint(&mut self, index: usize) {
        let shape = &self.shapes[index];
        let whole_m = Vec2::new(self.columns as f32, self.rows as f32) * self.cell_m;
        let [first_m, last_m] = if shape.is_outside {
            [Vec2::ZERO, whole_m]
        } else {
            [shape.low_m, shape.high_m].map(|at| at - self.low_m)
        };
        let cell_of = |at_m: f32, count: usize| ((at_m / self.cell_m).max(0.0) as usize).min(count - 1);
        for row in cell_of(first_m.y, self.rows)..=cell_of(last_m.y, self.rows) {
            for column in cell_of(first_m.x, self.columns)..=cell_of(last_m.x, self.columns) {
                let middle_m = self.low_m + self.cell_m * Vec2::new(column as f32 + 0.5, row as f32 + 0.5);
                let cell = row * self.columns + column;
                if shape.crosses_box(middle_m, 0.5 * self.cell_m) {
                    self.crossing[cell].push(index as u32);
                } else if shape.holds(middle_m) {
                    self.bases[cell] = shape.layer;
                    self.crossing[cell].clear();
                }
            }
        }
    }

    /// The uppermost layer at a point.
    pub(crate) fn layer_at(&self, point_m: Vec2) -> u32 {
        if self.shapes.is_empty() {
            return 0;
        }
        let cell = (point_m - self.low_m) / self.cell_m;
        if cell.x < 0.0 || cell.y < 0.0 || cell.x >= self.columns as f32 || cell.y >= self.rows as f32 {
            return self.beyond;
        }
        let cell = cell.y as usize * self.columns + cell.x as usize;
        let shapes = self.crossing[cell].iter().rev().map(|index| &self.shapes[*index as usize]);
        shapes.into_iter().find(|shape| shape.holds(point_m)).map_or(self.bases[cell], |shape| shape.layer)
    }

    /// Colours of the layers at a time, linear.
    pub(crate) fn colours(&self, scenario: &Scenario, time_s: f64) -> Vec<Vec3> {
        let encoded = self.colours.iter().map(|colour| match *colour {
            LayerColour::Fixed(rgb) => rgb,
            LayerColour::Signal(signal) => {
                let signal = scenario.behaviour.signals.get(signal as usize);
                SIGNAL[usize::from(signal.is_some_and(|signal| signal.is_green(time_s)))]
            }
        });
        encoded.map(|rgb| GROUND_SHARE * rgb.map(decode_srgb)).collect()
    }
}

fn layer_of(colours: &mut Vec<LayerColour>, colour: LayerColour) -> u32 {
    let known = colours.iter().position(|known| *known == colour);
    known.unwrap_or_else(|| {
        colours.push(colour);
        colours.len() - 1
    }) as u32
}

impl Shape {
    fn new(contours_m: Vec<Vec<Vec2>>, is_outside: bool, layer: u32) -> Self {
        let corners = || contours_m.iter().flatten().copied();
        let low_m = corners().fold(Vec2::INFINITY, Vec2::min);
        let high_m = corners().fold(Vec2::NEG_INFINITY, Vec2::max);
        Self { contours_m, low_m, high_m, is_outside, layer }
    }

    fn edges(&self) -> impl Iterator<Item = [Vec2; 2]> + '_ {
        let edges = |contour_m: &[Vec2]| {
            let count = contour_m.len();
            let contour_m = contour_m.to_vec();
            (0..count).map(move |index| [contour_m[index], contour_m[(index + 1) % count]])
        };
        self.contours_m.iter().flat_map(move |contour_m| edges(contour_m))
    }

    fn holds(&self, point_m: Vec2) -> bool {
        let mut is_inside = self.is_outside;
        for contour_m in &self.contours_m {
            let mut from = contour_m[contour_m.len() - 1];
            for &to in contour_m {
                if (from.y > point_m.y) != (to.y > point_m.y) {
                    let x = from.x + (point_m.y - from.y) / (to.y - from.y) * (to.x - from.x);
                    is_inside ^= x > point_m.x;
                }
                from = to;
            }
        }
        is_inside
    }

    /// Whether an edge touches a square, given by its middle and half its side.
    fn crosses_box(&self, middle_m: Vec2, half_m: f32) -> bool {
        self.edges().any(|[from, to]| {
            let (from, to) = (from - middle_m, to - middle_m);
            if from.min(to).max_element() > half_m || from.max(to).min_element() < -half_m {
                return false;
            }
            let normal = (to - from).perp();
            normal.dot(from).abs() <= half_m * normal.abs().element_sum()
        })
    }
}

#[cfg(test)]
mod tests {
    use fbcrowd_sim::maths::SplitMix64;
    use fbcrowd_sim::scenario::MarkingShape;

    use super::*;

    #[test]
    fn a_point_has_the_uppermost_polygon_around_it() {
        let mut random = SplitMix64::new(6, 6);
        let mut scenario = Scenario::of(Vec::new());
        for index in 0..40 {
            let mut at_m = || Vec2::new(random.within(9.0) as f32, random.within(9.0) as f32);
            let ends_m = [at_m(), at_m()];
            let dash_m = (index % 3 == 0).then_some([0.4, 0.3]);
            let shape = MarkingShape::Line { ends_m, width_m: 0.1 + 0.05 * index as f32, dash_m };
            scenario.markings.push(Marking { shape, colour: MarkingColour::Fixed([index, 0, 0]) });
        }
        let plan = GroundPlan::new(&scenario);
        let mut painted = 0;
        for _ in 0..4000 {
            let point_m = Vec2::new(random.within(11.0) as f32, random.within(11.0) as f32);
            let above = plan.shapes.iter().rev().find(|shape| shape.holds(point_m));
            let expected = above.map_or(0, |shape| shape.layer);
            assert_eq!(plan.layer_at(point_m), expected, "{point_m}");
            painted += usize::from(expected > 0);
        }
        assert!(painted > 1000, "{painted}");
    }
}

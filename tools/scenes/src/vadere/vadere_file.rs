//! The keys of a Vadere scenario that are read, as written. Metres, seconds.

use serde::Deserialize;
use serde_json::Value;

use crate::scene::{Point, Shape};

/// The file.
#[derive(Debug, Deserialize)]
pub(crate) struct VadereFile {
    #[serde(default)]
    pub(crate) release: Option<String>,
    pub(crate) scenario: VadereScenario,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct VadereScenario {
    #[serde(default)]
    pub(crate) attributes_simulation: VadereSimulation,
    pub(crate) topography: VadereTopography,
}

#[derive(Debug, Default, Deserialize)]
#[serde(rename_all = "camelCase", default)]
pub(crate) struct VadereSimulation {
    pub(crate) finish_time: Option<f64>,
    pub(crate) use_fixed_seed: bool,
    pub(crate) fixed_seed: Option<i64>,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct VadereTopography {
    pub(crate) attributes: VadereBounds,
    #[serde(default)]
    pub(crate) obstacles: Vec<VadereItem>,
    #[serde(default)]
    pub(crate) targets: Vec<VadereTarget>,
    #[serde(default)]
    pub(crate) sources: Vec<VadereSource>,
    #[serde(default)]
    pub(crate) dynamic_elements: Vec<VadereAgent>,
    #[serde(default)]
    pub(crate) attributes_pedestrian: VaderePedestrian,
    #[serde(default)]
    pub(crate) stairs: Vec<Value>,
    #[serde(default)]
    pub(crate) target_changers: Vec<Value>,
    #[serde(default)]
    pub(crate) measurement_areas: Vec<VadereItem>,
    #[serde(default)]
    pub(crate) absorbing_areas: Vec<Value>,
    #[serde(default)]
    pub(crate) teleporter: Option<Value>,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct VadereBounds {
    pub(crate) bounds: VadereRect,
    #[serde(default)]
    pub(crate) bounding_box_width: f64,
    #[serde(default = "yes")]
    pub(crate) bounded: bool,
}

#[derive(Clone, Copy, Debug, Deserialize)]
pub(crate) struct VadereRect {
    pub(crate) x: f64,
    pub(crate) y: f64,
    pub(crate) width: f64,
    pub(crate) height: f64,
}

/// A shape: a rectangle, a polygon or a circle.
#[derive(Debug, Deserialize)]
#[serde(tag = "type", rename_all = "UPPERCASE")]
pub(crate) enum VadereShape {
    Rectangle(VadereRect),
    Polygon { points: Vec<VaderePoint> },
    Circle { center: VaderePoint, radius: f64 },
}

#[derive(Clone, Copy, Debug, Deserialize)]
pub(crate) struct VaderePoint {
    pub(crate) x: f64,
    pub(crate) y: f64,
}

#[derive(Debug, Deserialize)]
pub(crate) struct VadereItem {
    #[serde(default)]
    pub(crate) id: i64,
    pub(crate) shape: VadereShape,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct VadereTarget {
    pub(crate) id: i64,
    pub(crate) shape: VadereShape,
    /// Release 3.
    pub(crate) absorber: Option<VadereAbsorber>,
    /// Release 3.
    pub(crate) waiter: Option<VadereWaiter>,
    /// Releases 1 and 2.
    #[serde(default = "yes")]
    pub(crate) absorbing: bool,
    /// Releases 1 and 2.
    #[serde(default)]
    pub(crate) waiting_time: f64,
    #[serde(default)]
    pub(crate) parallel_waiters: i64,
    #[serde(default)]
    pub(crate) parallel_events: i64,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct VadereAbsorber {
    #[serde(default = "yes")]
    pub(crate) enabled: bool,
    #[serde(default)]
    pub(crate) deletion_distance: f64,
}

#[derive(Debug, Deserialize)]
pub(crate) struct VadereWaiter {
    #[serde(default)]
    pub(crate) enabled: bool,
    pub(crate) distribution: Option<VadereDistribution>,
}

/// A distribution: each kind has keys of its own.
#[derive(Debug, Default, Deserialize)]
#[serde(rename_all = "camelCase", default)]
pub(crate) struct VadereDistribution {
    #[serde(rename = "type")]
    pub(crate) kind: String,
    pub(crate) update_frequency: Option<f64>,
    pub(crate) value: Option<f64>,
    pub(crate) mean: Option<f64>,
    pub(crate) standard_deviation: Option<f64>,
    pub(crate) sd: Option<f64>,
    pub(crate) min: Option<f64>,
    pub(crate) max: Option<f64>,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct VadereSource {
    pub(crate) id: i64,
    pub(crate) shape: VadereShape,
    #[serde(default)]
    pub(crate) target_ids: Vec<i64>,
    /// Release 3.
    pub(crate) spawner: Option<VadereSpawner>,
    #[serde(default)]
    pub(crate) group_size_distribution: Vec<f64>,
    // Releases 1 and 2.
    #[serde(default)]
    pub(crate) spawn_number: Option<f64>,
    #[serde(default)]
    pub(crate) max_spawn_number_total: Option<i64>,
    #[serde(default)]
    pub(crate) start_time: f64,
    #[serde(default)]
    pub(crate) end_time: f64,
    #[serde(default)]
    pub(crate) inter_spawn_time_distribution: Option<String>,
    #[serde(default)]
    pub(crate) distribution_parameters: Value,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct VadereSpawner {
    #[serde(default = "no_limit")]
    pub(crate) constraints_elements_max: i64,
    #[serde(default)]
    pub(crate) constraints_time_start: f64,
    #[serde(default)]
    pub(crate) constraints_time_end: f64,
    #[serde(default = "one")]
    pub(crate) event_element_count: f64,
    #[serde(default)]
    pub(crate) distribution: VadereDistribution,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct VadereAgent {
    pub(crate) position: VaderePoint,
    #[serde(default)]
    pub(crate) target_ids: Vec<i64>,
    /// Preferred speed of the agent, m/s; without it, or at zero, it is drawn.
    pub(crate) free_flow_speed: Option<f64>,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase", default)]
pub(crate) struct VaderePedestrian {
    pub(crate) radius: f64,
    pub(crate) speed_distribution_mean: f64,
    pub(crate) speed_distribution_standard_deviation: f64,
    pub(crate) minimum_speed: f64,
    pub(crate) maximum_speed: f64,
}

impl Default for VaderePedestrian {
    /// Vadere's own.
    fn default() -> Self {
        Self {
            radius: 0.2,
            speed_distribution_mean: 1.34,
            speed_distribution_standard_deviation: 0.26,
            minimum_speed: 0.5,
            maximum_speed: 2.2,
        }
    }
}

fn yes() -> bool {
    true
}

fn one() -> f64 {
    1.0
}

fn no_limit() -> i64 {
    -1
}

impl VaderePoint {
    pub(crate) fn position_m(self) -> Point {
        [self.x, self.y]
    }
}

impl VadereRect {
    /// Least and greatest corner, m.
    pub(crate) fn corners_m(self) -> [Point; 2] {
        let Self { x, y, width, height } = self;
        // Sums of decimals.
        [[x, y], [x + width, y + height].map(|metres| (metres * 1e9).round() / 1e9)]
    }
}

impl VadereShape {
    /// The shape.
    pub(crate) fn shape(&self) -> Shape {
        match self {
            Self::Rectangle(rect) => {
                let [a_m, b_m] = rect.corners_m();
                Shape::rect(a_m, b_m)
            }
            Self::Polygon { points } => Shape::Polygon(points.iter().map(|point| point.position_m()).collect()),
            Self::Circle { center, radius } => Shape::Circle(center.position_m(), radius.abs()),
        }
    }
}

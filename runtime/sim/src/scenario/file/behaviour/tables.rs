//! The tables of behaviour as written: names, not indices. World, metres, seconds, degrees.

use std::collections::BTreeMap;

use serde::Deserialize;
use toml::Spanned;

use crate::behaviour::event::SignalOrder;
use crate::scenario::file::behaviour::area_table::{AreaKeys, AreaTable};
use crate::scenario::file::behaviour::numbers::DistributionValue;
use crate::scenario::point::Point;

/// The state before, as a target.
pub(crate) const BACK: &str = "back";

/// All tables of behaviour; names are sorted, so that their order in the text does not matter.
#[derive(Debug, Default)]
pub(crate) struct BehaviourTables {
    pub(crate) signals: BTreeMap<String, Spanned<SignalTable>>,
    pub(crate) areas: BTreeMap<String, Spanned<AreaTable>>,
    pub(crate) goals: BTreeMap<String, Spanned<GoalsTable>>,
    pub(crate) states: BTreeMap<String, Spanned<StateTable>>,
    pub(crate) events: BTreeMap<String, Spanned<EventTable>>,
}

/// `[signals.NAME]`
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct SignalTable {
    pub(crate) green_s: f32,
    pub(crate) red_s: f32,
    #[serde(default)]
    pub(crate) offset_s: f32,
}

/// `[goals.NAME]`
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct GoalsTable {
    #[serde(default)]
    pub(crate) choose: ChooseValue,
    pub(crate) capacity: Option<Spanned<u32>>,
    #[serde(default)]
    pub(crate) queue: bool,
    pub(crate) copies_m: Option<Vec<Point>>,
    pub(crate) areas: Vec<Spanned<GoalAreaTable>>,
}

/// One of the `areas` of `[goals.NAME]`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct GoalAreaTable {
    point_m: Option<Point>,
    circle_m: Option<[f32; 3]>,
    rect_m: Option<[f32; 4]>,
    polygon_m: Option<Vec<Point>>,
    pub(crate) facing_deg: Option<f32>,
    pub(crate) capacity: Option<u32>,
    pub(crate) weight: Option<f32>,
}

impl GoalAreaTable {
    /// Number of corners of its polygon.
    pub(crate) fn corner_count(&self) -> usize {
        self.polygon_m.as_ref().map_or(4, Vec::len)
    }

    /// The keys of its area.
    pub(crate) fn keys(&self) -> AreaKeys<'_> {
        let Self { point_m, circle_m, rect_m, .. } = *self;
        AreaKeys { point_m, circle_m, rect_m, polygon_m: self.polygon_m.as_deref() }
    }
}

/// `choose` of `[goals.NAME]`.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(
    untagged,
    expecting = "\"nearest\", \"farthest\", \"random\", \"weighted\", \"least_busy\" or `{ nearest_of = N }`"
)]
pub(crate) enum ChooseValue {
    Named(ChooseName),
    NearestOf(NearestOfTable),
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum ChooseName {
    Nearest,
    Farthest,
    Random,
    Weighted,
    LeastBusy,
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct NearestOfTable {
    pub(crate) nearest_of: u32,
}

impl Default for ChooseValue {
    fn default() -> Self {
        Self::Named(ChooseName::Nearest)
    }
}

/// `[states.NAME]`; exactly one of `go`, `stand`, `walk_mps` and `remove`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct StateTable {
    pub(crate) go: Option<Spanned<GoValue>>,
    pub(crate) remember: Option<Spanned<RememberValue>>,
    pub(crate) stand: Option<StandTable>,
    pub(crate) walk_mps: Option<Point>,
    pub(crate) remove: Option<RemoveValue>,
    #[serde(default)]
    pub(crate) set: Option<Spanned<SetTable>>,
    #[serde(default)]
    pub(crate) then: Vec<Spanned<ThenTable>>,
}

/// `go` of `[states.NAME]`.
#[derive(Debug, Deserialize)]
#[serde(untagged, expecting = "the name of goals, \"own_path\", `{ mirror_m = [x, y] }` or `{ offset_m = [x, y] }`")]
pub(crate) enum GoValue {
    Goals(String),
    Mirror(MirrorTable),
    Offset(OffsetTable),
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct MirrorTable {
    pub(crate) mirror_m: Point,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct OffsetTable {
    pub(crate) offset_m: Point,
}

/// `remember` of `[states.NAME]`.
#[derive(Debug, Deserialize)]
#[serde(untagged, expecting = "`true`, `false` or the name of a state")]
pub(crate) enum RememberValue {
    Own(bool),
    Of(String),
}

/// `stand` of `[states.NAME]`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct StandTable {
    pub(crate) facing: Option<FacingName>,
    pub(crate) facing_deg: Option<f32>,
    pub(crate) facing_m: Option<Point>,
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum FacingName {
    Goal,
}

/// `remove` of `[states.NAME]`.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(untagged, expecting = "`true`, \"between_steps\" or \"at_once\"")]
pub(crate) enum RemoveValue {
    Flag(bool),
    Named(RemoveName),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum RemoveName {
    BetweenSteps,
    AtOnce,
}

/// `set` of `[states.NAME]`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct SetTable {
    pub(crate) preferred_speed_mps: Option<DistributionValue>,
    pub(crate) speed_factor: Option<DistributionValue>,
    pub(crate) radius_m: Option<DistributionValue>,
    pub(crate) priority: Option<f32>,
    pub(crate) teleport: Option<AreaTable>,
    #[serde(default)]
    pub(crate) remain: bool,
}

/// One of `then` of `[states.NAME]`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct ThenTable {
    #[serde(default)]
    pub(crate) when: WhenTable,
    pub(crate) to: Spanned<ToValue>,
}

/// `to` of a transition: a state, `"back"`, or states with weights.
#[derive(Debug, Deserialize)]
#[serde(untagged, expecting = "the name of a state, \"back\", or states with weights as in `{ a = 0.8, b = 0.2 }`")]
pub(crate) enum ToValue {
    State(String),
    Weights(BTreeMap<String, f32>),
}

/// `when` of a transition: all its keys must hold; none: it is taken at once.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct WhenTable {
    pub(crate) reached_m: Option<f32>,
    pub(crate) after_s: Option<DistributionValue>,
    pub(crate) served_s: Option<DistributionValue>,
    pub(crate) inside: Option<String>,
    pub(crate) green: Option<String>,
    pub(crate) number: Option<NumberTable>,
    pub(crate) population: Option<PopulationTable>,
    pub(crate) all: Option<Vec<WhenTable>>,
    pub(crate) any: Option<Vec<WhenTable>>,
    pub(crate) not: Option<Box<WhenTable>>,
}

/// `[events.NAME]`
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct EventTable {
    pub(crate) when: WhenTable,
    pub(crate) from: Option<Spanned<Vec<String>>>,
    pub(crate) to: Option<Spanned<String>>,
    #[serde(default)]
    pub(crate) signals: BTreeMap<String, SignalOrder>,
}

/// Number of agents inside an area.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct NumberTable {
    pub(crate) inside: String,
    pub(crate) at_least: Option<u32>,
    pub(crate) at_most: Option<u32>,
}

/// Number of agents in a state.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct PopulationTable {
    pub(crate) state: String,
    pub(crate) at_least: Option<u32>,
    pub(crate) at_most: Option<u32>,
}

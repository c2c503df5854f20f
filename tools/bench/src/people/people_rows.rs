//! The measures of the bench of people: where each comes from, and what a release must reach.

use fbcrowd_sim::measures::people::PeopleMeasures;
use motiondb::statistics::mean;

use crate::kit::report::Criterion;
use crate::people::people_scenes::{CrowdRun, PeopleRuns};

/// What a measure must reach.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Limits {
    /// No more than this.
    AtMost(f64),
    /// No less than this.
    AtLeast(f64),
    /// From the first to the second.
    Within(f64, f64),
    /// The measure has no criterion.
    Shown,
}

/// One measure.
pub(crate) struct PeopleRow {
    /// What is measured, and its unit.
    pub(crate) name: &'static str,
    /// The measure of the simulated bodies.
    pub(crate) of_runs: fn(&PeopleRuns) -> Option<f64>,
    /// The measure of captures; none where captures cannot show it.
    pub(crate) of_captures: Option<fn(&PeopleMeasures) -> Option<f64>>,
    /// What it must reach.
    pub(crate) limits: Limits,
}

impl PeopleRow {
    /// The criteria of one database.
    pub(crate) fn criteria(&self, database: &str, measured: Option<f64>) -> Vec<Criterion> {
        let name = || format!("{database}: {}", self.name);
        match self.limits {
            Limits::AtMost(limit) => vec![Criterion::at_most(name(), limit, measured)],
            Limits::AtLeast(limit) => vec![Criterion::at_least(name(), limit, measured)],
            Limits::Within(least, greatest) => {
                vec![Criterion::at_least(name(), least, measured), Criterion::at_most(name(), greatest, measured)]
            }
            Limits::Shown => Vec::new(),
        }
    }
}

impl Limits {
    /// The limits as text.
    pub(crate) fn text(self) -> String {
        match self {
            Self::AtMost(limit) => format!("≤ {limit}"),
            Self::AtLeast(limit) => format!("≥ {limit}"),
            Self::Within(least, greatest) => format!("{least} to {greatest}"),
            Self::Shown => String::new(),
        }
    }
}

/// A row of the crowds, which captures show too.
macro_rules! row {
    ($name:literal, $runs:expr, $captures:expr, $limits:expr) => {
        PeopleRow { name: $name, of_runs: $runs, of_captures: Some($captures), limits: $limits }
    };
    ($name:literal, $runs:expr, $limits:expr) => {
        PeopleRow { name: $name, of_runs: $runs, of_captures: None, limits: $limits }
    };
}

/// Mean phase order of the starts at one of the times.
fn order(starts: &[PeopleMeasures], which: usize) -> Option<f64> {
    mean(starts.iter().filter_map(|people| people.phase_order[which].order))
}

/// Mean of a number of agents over the starts.
fn of_starts(runs: &PeopleRuns, of: fn(&PeopleMeasures) -> Option<f64>) -> Option<f64> {
    mean(runs.starts.iter().filter_map(of))
}

/// Mean of a number over the doors.
fn of_doors(runs: &PeopleRuns, of: fn(&CrowdRun) -> Option<f64>) -> Option<f64> {
    mean(runs.doors.iter().filter_map(of))
}

/// Share of the agents that begin with the foot which fewer agents begin with.
fn rarer_foot_share(people: &PeopleMeasures) -> Option<f64> {
    let [left, right] = [people.first_steps.left, people.first_steps.right];
    (left + right > 0).then(|| left.min(right) as f64 / (left + right) as f64)
}

/// Share of the agents that lift the same foot within 10 ms.
fn together_share(people: &PeopleMeasures) -> Option<f64> {
    let steps = &people.first_steps;
    let all = steps.left + steps.right;
    (all > 0).then(|| steps.together as f64 / all as f64)
}

/// All measures, in the order of the table.
#[rustfmt::skip]
pub(crate) const ROWS: [PeopleRow; 56] = [
    row!("phase order R at 1 s", |runs| order(&runs.starts, 0), Limits::Shown),
    row!("phase order R at 3 s", |runs| order(&runs.starts, 1), Limits::AtMost(0.2)),
    row!("phase order R at 8 s", |runs| order(&runs.starts, 2), Limits::AtMost(0.2)),
    row!("R of phases at random, 8 s", |runs| mean(runs.starts.iter().filter_map(|people| people.phase_order[2].random)), Limits::Shown),
    row!("first steps with the rarer foot, share", |runs| of_starts(runs, rarer_foot_share), Limits::AtLeast(0.2)),
    row!("first steps of one foot within 10 ms, share", |runs| of_starts(runs, together_share), Limits::Shown),
    row!("first steps, 10 to 90 % of their times, s", |runs| of_starts(runs, |people| people.first_steps.spread_s), Limits::AtLeast(0.3)),
    row!("lanes: phase order R at 1 s", |runs| order(&runs.lane_starts, 0), Limits::Shown),
    row!("lanes: phase order R at 3 s", |runs| order(&runs.lane_starts, 1), Limits::AtMost(0.2)),
    row!("lanes: phase order R at 8 s", |runs| order(&runs.lane_starts, 2), Limits::AtMost(0.2)),
    row!("lanes: first steps of one foot within 10 ms, share", |runs| together_share(&runs.lanes), Limits::Shown),
    row!("cadence, coefficient of variation at one speed", |runs| mean(runs.lane_starts.iter().filter_map(|people| people.cadence.variation)), Limits::Within(0.04, 0.08)),
    row!("steps of 15 to 30 cm: clearance, cm", |runs| runs.pooled.swings[0].clearance_cm, |people| people.swings[0].clearance_cm, Limits::AtLeast(1.5)),
    row!("steps of 15 to 30 cm: duration, s", |runs| runs.pooled.swings[0].duration_s, |people| people.swings[0].duration_s, Limits::Within(0.25, 0.4)),
    row!("steps of 30 to 60 cm: clearance, cm", |runs| runs.pooled.swings[1].clearance_cm, |people| people.swings[1].clearance_cm, Limits::AtLeast(2.0)),
    row!("steps of 30 to 60 cm: duration, s", |runs| runs.pooled.swings[1].duration_s, |people| people.swings[1].duration_s, Limits::AtMost(0.42)),
    row!("start: time to 90 % of the speed, s", |runs| runs.lanes.starts.duration_s, |people| people.starts.duration_s, Limits::Within(0.8, 1.2)),
    row!("start: mean acceleration, m/s²", |runs| runs.lanes.starts.acceleration_mps2, |people| people.starts.acceleration_mps2, Limits::Shown),
    row!("start: peak acceleration, m/s²", |runs| runs.lanes.starts.peak_mps2, |people| people.starts.peak_mps2, Limits::Shown),
    row!("start: lean, ° per m/s²", |runs| runs.lanes.starts.lean_deg_per_mps2, |people| people.starts.lean_deg_per_mps2, Limits::Within(0.5, 1.7)),
    row!("starts in crowds", |runs| Some(runs.pooled.starts.count as f64), Limits::Shown),
    row!("starts in crowds that play a recorded transition, share", |runs| runs.pooled.starts.recorded_share, Limits::Shown),
    row!("stop: duration, s", |runs| runs.lanes.stops.duration_s, |people| people.stops.duration_s, Limits::Shown),
    row!("stop: peak deceleration, m/s²", |runs| runs.lanes.stops.peak_mps2, |people| people.stops.peak_mps2, Limits::Shown),
    row!("stop: creep below 0.3 m/s, s", |runs| runs.lanes.stops.creep_s, |people| people.stops.creep_s, Limits::AtMost(0.4)),
    row!("stop: speed of creeping, m/s", |runs| runs.lanes.stops.creep_mps, |people| people.stops.creep_mps, Limits::Shown),
    row!("stop: closing step, s", |runs| runs.lanes.stops.closing_step_s, |people| people.stops.closing_step_s, Limits::AtMost(0.5)),
    row!("standing: upper bodies apart, °", |runs| runs.lanes.standing.likeness_deg, Limits::AtLeast(0.5)),
    row!("standing: sway in 6 s, mm", |runs| runs.lanes.standing.sway_mm, |people| people.standing.sway_mm, Limits::Shown),
    row!("standing: repeats after, s", |runs| runs.lanes.standing.repeat_s, |people| people.standing.repeat_s, Limits::Shown),
    row!("pelvis lurches in crowds, per agent-min", |runs| runs.pooled.pelvis_lurches.per_minute, |people| people.pelvis_lurches.per_minute, Limits::AtMost(0.0)),
    row!("pelvis lurches in lanes, per agent-min", |runs| runs.lanes.pelvis_lurches.per_minute, Limits::AtMost(0.0)),
    row!("pelvis: greatest vertical acceleration, m/s²", |runs| Some(runs.pooled.pelvis_lurches.greatest_mps2), |people| Some(people.pelvis_lurches.greatest_mps2), Limits::Shown),
    row!("shanks too near, per agent-min", |runs| runs.pooled.shank_gaps.per_minute, |people| people.shank_gaps.per_minute, Limits::AtMost(0.05)),
    row!("shanks: least distance of axes over radii", |runs| runs.pooled.shank_gaps.least_over_radii, |people| people.shank_gaps.least_over_radii, Limits::Shown),
    row!("sudden turns, per agent-min", |runs| runs.pooled.turning.sudden_per_minute, |people| people.turning.sudden_per_minute, Limits::AtMost(0.1)),
    row!("turns to and fro, per agent-min", |runs| runs.pooled.turning.to_and_fro_per_minute, |people| people.turning.to_and_fro_per_minute, Limits::AtMost(0.1)),
    row!("fast turns of the head, per agent-min", |runs| runs.pooled.turning.fast_head_per_minute, |people| people.turning.fast_head_per_minute, Limits::AtMost(0.1)),
    row!("queues at doors: time going backward, share", |runs| of_doors(runs, |door| door.people.queues.backward_share), Limits::AtMost(0.03)),
    row!("doors: agent-steps that touch, share", |runs| of_doors(runs, |door| Some(door.measures.body_touching_share)), Limits::AtMost(0.1)),
    row!("doors: deepest overlap of a run, mean, mm", |runs| of_doors(runs, |door| Some(door.measures.body_penetration_max_mm)), Limits::AtMost(59.0)),
    row!("doors: bodies in walls, share", |runs| of_doors(runs, |door| Some(door.measures.wall_body_share)), Limits::AtMost(0.01)),
    row!("doors: deepest body in a wall of a run, mean, mm", |runs| of_doors(runs, |door| Some(door.measures.wall_body_max_mm)), Limits::AtMost(30.0)),
    row!("shoulders turned in a gap of 1 breadth, walls, °", |runs| runs.shoulders_deg[0][0], Limits::AtLeast(20.0)),
    row!("shoulders turned in a gap of 1.5 breadths, walls, °", |runs| runs.shoulders_deg[0][1], Limits::AtMost(10.0)),
    row!("shoulders turned in a gap of 1 breadth, agents, °", |runs| runs.shoulders_deg[1][0], Limits::AtLeast(20.0)),
    row!("shoulders turned in a gap of 1.5 breadths, agents, °", |runs| runs.shoulders_deg[1][1], Limits::AtMost(10.0)),
    row!("head roll in walks, standard deviation, °", |runs| runs.lanes.upper_bodies.head_roll_deg, |people| people.upper_bodies.head_roll_deg, Limits::Within(0.4, 2.3)),
    row!("head pitch in walks, standard deviation, °", |runs| runs.lanes.upper_bodies.head_pitch_deg, |people| people.upper_bodies.head_pitch_deg, Limits::Within(0.4, 3.1)),
    row!("wrists' angular acceleration in walks, rad/s²", |runs| runs.lanes.upper_bodies.wrist_acceleration_rad_s2, |people| people.upper_bodies.wrist_acceleration_rad_s2, Limits::Within(11.0, 52.0)),
    row!("flat foot's pivot in turns, °", |runs| runs.turns.foot_pivots.pivot_deg, |people| people.foot_pivots.pivot_deg, Limits::Within(1.5, 8.0)),
    row!("turn rate of these turns, °/s", |runs| runs.turns.foot_pivots.turn_rate_deg_s, |people| people.foot_pivots.turn_rate_deg_s, Limits::Shown),
    row!("planted slide at the soles, lanes, cm/s", |runs| runs.lanes.slide.at_soles_cm_s, Limits::Shown),
    row!("planted slide at the joints, lanes, cm/s", |runs| runs.lanes.slide.at_joints_cm_s, Limits::Shown),
    row!("planted slide at the soles, crossing, cm/s", |runs| runs.crowd("crossing")?.people.slide.at_soles_cm_s, Limits::Shown),
    row!("planted slide at the joints, crossing, cm/s", |runs| runs.crowd("crossing")?.people.slide.at_joints_cm_s, Limits::Shown),
];

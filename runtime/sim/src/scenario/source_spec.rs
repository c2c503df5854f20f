//! A source of agents: an area in which agents appear one after the other. World, metres, seconds.
//!
//! The times at which agents are due (`due_times`) depend on the scenario's seed and the source's index alone. So the
//! number of agents is known before the simulation.

use glam::Vec2;
use serde::{Deserialize, Serialize};

use crate::behaviour::Area;
use crate::maths::random::SplitMix64;
use crate::scenario::agent_spec::{
    AgentSpec, AtGoal, enters_all, follows_path, has_no_style, is_0, is_of_skeleton, is_stated, of_skeleton,
};
use crate::scenario::characters::character_spec::wears_any;
use crate::scenario::due_times::DueTimes;
use crate::scenario::profile::{DrawnNumbers, Profile};
use crate::scenario::schedule::{RateRow, Schedule};
use crate::scenario::social_group::GroupSizes;

/// First random stream of the sources' due times; the scenario and the starting phases use those below.
const DUE_STREAM: u64 = 1 << 34;
/// First random stream of the positions at which sources place agents.
const POSITION_STREAM: u64 = 1 << 35;
/// First random stream of the numbers of agents; a source takes 2^20, a stream for each agent.
const NUMBER_STREAM: u64 = 1 << 37;
/// First random stream of the sizes of groups.
const GROUP_STREAM: u64 = 1 << 39;

/// A source of agents.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SourceSpec {
    /// Least corner of the rectangle in which agents appear, world, m.
    pub low_m: Vec2,
    /// Greatest corner of the rectangle, world, m; equal to the least one for a source at a position.
    pub high_m: Vec2,
    /// The part of the rectangle in which agents appear; none of a source that fills it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub area: Option<Area>,
    /// Mean number of agents per second, without a schedule.
    pub rate_per_s: f32,
    /// Time from which agents are due, without a schedule, s.
    pub from_s: f32,
    /// Time until which agents are due, without a schedule, s.
    pub to_s: f32,
    /// When agents are due, instead of one rate.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub schedule: Option<Schedule>,
    /// Greatest number of agents; none where time alone ends the source.
    pub count: Option<u32>,
    /// Facing of each agent when it appears, rad; towards its first goal where none is given.
    pub facing_rad: Option<f32>,
    /// Waypoints of all agents in order, world, m.
    pub goals_m: Vec<Vec2>,
    /// Goal after the waypoints, relative to each agent's own start, m.
    pub goal_offset_m: Option<Vec2>,
    /// Radius of the disc that other agents see, m.
    pub radius_m: f32,
    /// Radius of the disc that walls hold, m.
    pub wall_radius_m: f32,
    /// Speed of v_pref, m/s.
    pub preferred_speed_mps: f32,
    /// What the agents do when they arrive at their goals.
    pub at_goal: AtGoal,
    /// State of the behaviour in which the agents begin, by index; 0: they follow their waypoints.
    #[serde(default, skip_serializing_if = "follows_path")]
    pub state: u32,
    /// Time for which an agent stands after its birth before it begins, s.
    #[serde(default, skip_serializing_if = "is_0")]
    pub pre_movement_s: f32,
    /// Numbers that are drawn for each agent.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub profiles: Vec<Profile>,
    /// Zones that the agents do not enter, by bits as in [`AgentSpec`].
    #[serde(default, skip_serializing_if = "enters_all")]
    pub closed_zones: u32,
    /// Right of way of the agents, as in [`AgentSpec`].
    #[serde(default, skip_serializing_if = "is_0")]
    pub priority: f32,
    /// Size of the bodies, relative to the database's skeleton.
    #[serde(default = "of_skeleton", skip_serializing_if = "is_of_skeleton")]
    pub stature: f32,
    /// Characters that the agents may wear, by bits as in [`AgentSpec`].
    #[serde(default, skip_serializing_if = "wears_any")]
    pub characters: u64,
    /// Whether the radius is that of the character that an agent wears, because the scenario states none.
    #[serde(default, skip_serializing_if = "is_stated")]
    pub wears_radius: bool,
    /// Style of the agents' motion, as in [`AgentSpec`].
    #[serde(default, skip_serializing_if = "has_no_style")]
    pub style: u32,
    /// Sizes of the groups in which agents appear; none: each alone.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub groups: Option<GroupSizes>,
}

impl Default for SourceSpec {
    /// At the origin, one adult a second for an hour.
    fn default() -> Self {
        let AgentSpec { radius_m, wall_radius_m, preferred_speed_mps, at_goal, .. } = AgentSpec::default();
        Self {
            low_m: Vec2::ZERO,
            high_m: Vec2::ZERO,
            area: None,
            rate_per_s: 1.0,
            from_s: 0.0,
            to_s: 3_600.0,
            schedule: None,
            count: None,
            facing_rad: None,
            goals_m: Vec::new(),
            goal_offset_m: None,
            radius_m,
            wall_radius_m,
            preferred_speed_mps,
            at_goal,
            state: 0,
            pre_movement_s: 0.0,
            profiles: Vec::new(),
            closed_zones: 0,
            priority: 0.0,
            stature: 1.0,
            characters: 0,
            wears_radius: false,
            style: 0,
            groups: None,
        }
    }
}

impl SourceSpec {
    /// The agent that appears at a position.
    pub fn agent(&self, position_m: Vec2) -> AgentSpec {
        let own_m = self.goal_offset_m.map(|offset_m| position_m + offset_m);
        let goals_m: Vec<Vec2> = self.goals_m.iter().copied().chain(own_m).collect();
        let ahead_m = goals_m.first().map_or(Vec2::ZERO, |goal_m| goal_m - position_m);
        AgentSpec {
            position_m,
            facing_rad: self.facing_rad.unwrap_or_else(|| libm::atan2f(ahead_m.y, ahead_m.x)),
            goals_m,
            radius_m: self.radius_m,
            wall_radius_m: self.wall_radius_m,
            preferred_speed_mps: self.preferred_speed_mps,
            at_goal: self.at_goal,
            state: self.state,
            pre_movement_s: self.pre_movement_s,
            closed_zones: self.closed_zones,
            priority: self.priority,
            stature: self.stature,
            characters: self.characters,
            wears_radius: self.wears_radius,
            style: self.style,
            group: None,
        }
    }

    /// The source with the numbers of one agent: those of the source with this index after a number of births.
    pub fn drawn(&self, seed: u64, index: usize, born: u32) -> Self {
        let stream = NUMBER_STREAM + ((index as u64) << 20) + u64::from(born);
        let numbers = DrawnNumbers {
            preferred_speed_mps: self.preferred_speed_mps,
            radius_m: self.radius_m,
            pre_movement_s: self.pre_movement_s,
            closed_zones: self.closed_zones,
            priority: self.priority,
            stature: self.stature,
            characters: self.characters,
            wears_radius: self.wears_radius,
            style: self.style,
        };
        let numbers = numbers.draw(&self.profiles, &mut SplitMix64::new(seed, stream));
        Self {
            preferred_speed_mps: numbers.preferred_speed_mps,
            radius_m: numbers.radius_m,
            wall_radius_m: self.wall_radius_m.min(numbers.radius_m),
            pre_movement_s: numbers.pre_movement_s,
            closed_zones: numbers.closed_zones,
            priority: numbers.priority,
            stature: numbers.stature,
            characters: numbers.characters,
            wears_radius: numbers.wears_radius,
            style: numbers.style,
            ..self.clone()
        }
    }

    /// The sets of zones that agents of the source do not enter, by bits; each once or more.
    pub(crate) fn closed_zone_sets(&self) -> Vec<u32> {
        let of_profiles = self.profiles.iter().filter(|profile| profile.weight > 0.0);
        let sets: Vec<u32> = of_profiles.map(|profile| profile.closed_zones).collect();
        if sets.is_empty() { vec![self.closed_zones] } else { sets }
    }

    /// The times at which agents of the source with this index are due, in order, s.
    pub fn due_times(&self, seed: u64, index: usize) -> DueTimes {
        let &Self { from_s, to_s, rate_per_s, .. } = self;
        let one_rate = || Schedule::Rates(vec![RateRow { from_s, to_s, rate_per_s }]);
        let schedule = self.schedule.clone().unwrap_or_else(one_rate);
        let random = SplitMix64::new(seed, DUE_STREAM + index as u64);
        DueTimes::new(&schedule, self.count.unwrap_or(u32::MAX), random)
    }

    /// The generator of the positions at which the source with this index places its agents.
    pub(crate) fn positions(seed: u64, index: usize) -> SplitMix64 {
        SplitMix64::new(seed, POSITION_STREAM + index as u64)
    }

    /// The generator of the sizes of the groups of the source with this index.
    pub(crate) fn group_sizes(seed: u64, index: usize) -> SplitMix64 {
        SplitMix64::new(seed, GROUP_STREAM + index as u64)
    }

    /// A position in the area, uniformly distributed, world, m.
    pub(crate) fn position_m(&self, random: &mut SplitMix64) -> Vec2 {
        if let Some(area) = &self.area {
            return area.draw_m(random);
        }
        let [x, y] = [random.unit(), random.unit()].map(|share| share as f32);
        self.low_m + Vec2::new(x, y) * (self.high_m - self.low_m)
    }

    /// The middle of the area, world, m; of an area whose middle lies outside it the position nearest to that.
    pub fn middle_m(&self) -> Vec2 {
        let middle_m = self.low_m.midpoint(self.high_m);
        self.area.as_ref().map_or(middle_m, |area| area.nearest_m(area.centre_m()))
    }

    /// Whether a position lies in the area.
    pub(crate) fn holds(&self, position_m: Vec2) -> bool {
        let is_in_box = position_m.cmpge(self.low_m).all() && position_m.cmple(self.high_m).all();
        is_in_box && self.area.as_ref().is_none_or(|area| area.holds(position_m))
    }

    /// Corners of the outline of the area, counter-clockwise, world, m; of a rectangle that of the discs in it.
    pub fn outline_m(&self) -> Vec<Vec2> {
        let of_discs = || Area::rectangle(self.low_m - self.radius_m, self.high_m + self.radius_m);
        self.area.clone().unwrap_or_else(of_discs).outline_m()
    }
}

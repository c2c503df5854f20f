//! The `[[sources]]` tables of a scenario file. World, metres, seconds.
//!
//! A table has exactly one of `at_m = [x, y]`, `rect_m = [least x, least y, greatest x, greatest y]`, `circle_m` and
//! `polygon_m`; a rate and its times, a `schedule`, or a `schedule_file`; and the keys that `[[agents]]` has for goals, discs and speed.

use std::collections::BTreeMap;
use std::path::PathBuf;

use glam::Vec2;
use motiondb::files::SourceText;
use serde::Deserialize;
use toml::Spanned;

use crate::behaviour::Area;
use crate::scenario::agent_spec::{AtGoal, PREFERRED_SPEED_MPS, RADIUS_M, WALL_RADIUS_M};
use crate::scenario::error::ScenarioError;
use crate::scenario::fault::TableFault;
use crate::scenario::file::agent_placement::PlacementInput;
use crate::scenario::file::behaviour::{AreaKeys, DistributionValue, fixed_number};
use crate::scenario::file::group_keys::group_sizes;
use crate::scenario::file::profile_tables::ProfileValue;
use crate::scenario::file::sources::schedule_file::{read_schedule, schedule_path};
use crate::scenario::file::sources::schedule_value::ScheduleValue;
use crate::scenario::point::Point;
use crate::scenario::schedule::Schedule;
use crate::scenario::source_spec::SourceSpec;

/// One `[[sources]]` table, as written.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct SourceTable {
    at_m: Option<Point>,
    rect_m: Option<[f32; 4]>,
    circle_m: Option<[f32; 3]>,
    polygon_m: Option<Vec<Point>>,
    rate_per_s: Option<f32>,
    schedule: Option<Spanned<ScheduleValue>>,
    schedule_file: Option<Spanned<String>>,
    from_s: Option<f32>,
    to_s: Option<f32>,
    count: Option<u32>,
    #[serde(default)]
    goals_m: Vec<Point>,
    goal_offset_m: Option<Point>,
    facing_deg: Option<f32>,
    #[serde(default, deserialize_with = "fixed_number")]
    radius_m: Option<f32>,
    wall_radius_m: Option<f32>,
    #[serde(default, deserialize_with = "fixed_number")]
    preferred_speed_mps: Option<f32>,
    #[serde(default)]
    at_goal: AtGoal,
    state: Option<Spanned<String>>,
    pre_movement_s: Option<DistributionValue>,
    profile: Option<Spanned<ProfileValue>>,
    groups: Option<BTreeMap<String, f32>>,
    group_spacing_m: Option<f32>,
    characters: Option<Vec<String>>,
    pub(crate) style: Option<Spanned<String>>,
}

/// The sources of all tables; they end with the scenario at the latest.
pub(crate) fn sources(
    input: &PlacementInput<'_>,
    tables: &[Spanned<SourceTable>],
    duration_s: f32,
) -> Result<Vec<SourceSpec>, ScenarioError> {
    let PlacementInput { source, states, profiles, .. } = *input;
    let resolve = |table: &Spanned<SourceTable>| {
        let at_table = |(message, help): TableFault| ScenarioError::from(source.invalid(table.span(), message, help));
        let SourceTable { state, profile, pre_movement_s, preferred_speed_mps, radius_m, .. } = table.get_ref();
        let SourceTable { groups, group_spacing_m, characters, style, .. } = table.get_ref();
        let [states_speed, states_radius] = [preferred_speed_mps, radius_m].map(Option::is_some);
        let resolved = table.get_ref().source(duration_s).map_err(at_table)?;
        let schedule = table.get_ref().schedule(source);
        let profiles = profiles.of_table(profile.as_ref(), *pre_movement_s, states_speed, states_radius);
        let profiles = profiles.map_err(at_table)?;
        let groups = group_sizes(groups.as_ref(), *group_spacing_m).map_err(at_table)?;
        let (state, schedule) = (states.index(state.as_ref(), source)?, schedule.transpose()?);
        let (profiles, characters) = input.profiles.with_characters(profiles, characters.as_ref()).map_err(at_table)?;
        let (profiles, style) = input.profiles.with_style(profiles, style.as_ref());
        let wears_radius = !states_radius && input.profiles.has_characters();
        Ok(SourceSpec { characters, wears_radius, style, state, schedule, profiles, groups, ..resolved })
    };
    tables.iter().map(resolve).collect()
}

impl SourceTable {
    /// The schedule file that the table names.
    pub(crate) fn file(&self, source: &SourceText) -> Option<PathBuf> {
        schedule_path(source, self.schedule_file.as_ref()?.get_ref())
    }

    fn schedule(&self, source: &SourceText) -> Option<Result<Schedule, ScenarioError>> {
        let of_file = || self.schedule_file.as_ref().map(|name| read_schedule(source, name));
        self.schedule.as_ref().map(|schedule| ScheduleValue::resolve(schedule, source)).or_else(of_file)
    }

    fn source(&self, duration_s: f32) -> Result<SourceSpec, TableFault> {
        let ([low_m, high_m], area) = self.place()?;
        let (rate_per_s, from_s) = (self.rate()?, self.from_s.unwrap_or(0.0));
        if self.goals_m.is_empty() && self.goal_offset_m.is_none() && self.state.is_none() {
            let help = "add `goals_m = [[x, y]]`, `goal_offset_m = [x, y]` or both, or `state = \"NAME\"`";
            return Err(("the agents of a source need a goal".into(), help));
        }
        let radius_m = self.radius_m.unwrap_or(RADIUS_M);
        Ok(SourceSpec {
            low_m,
            high_m,
            area,
            rate_per_s,
            from_s,
            to_s: self.to_s.unwrap_or(duration_s.max(from_s)),
            count: self.count,
            facing_rad: self.facing_deg.map(f32::to_radians),
            goals_m: self.goals_m.iter().map(|&Point(goal_m)| goal_m).collect(),
            goal_offset_m: self.goal_offset_m.map(|Point(offset_m)| offset_m),
            radius_m,
            wall_radius_m: self.wall_radius_m.unwrap_or(WALL_RADIUS_M.min(radius_m)),
            preferred_speed_mps: self.preferred_speed_mps.unwrap_or(PREFERRED_SPEED_MPS),
            at_goal: self.at_goal,
            ..SourceSpec::default()
        })
    }

    /// Least and greatest corner of the box in which agents appear, and their area where that is no box, m.
    fn place(&self) -> Result<([Vec2; 2], Option<Area>), TableFault> {
        match (self.at_m, self.rect_m, self.circle_m, self.polygon_m.as_deref()) {
            (Some(Point(at_m)), None, None, None) => Ok(([at_m, at_m], None)),
            (None, Some([left, low, right, high]), None, None) => {
                Ok(([Vec2::new(left, low), Vec2::new(right, high)], None))
            }
            (None, None, circle_m, polygon_m) if circle_m.is_some() != polygon_m.is_some() => {
                let area = AreaKeys { point_m: None, circle_m, rect_m: None, polygon_m }.area()?;
                Ok((area.bounds_m(), Some(area)))
            }
            _ => {
                let message = "a source needs exactly one of `at_m`, `rect_m`, `circle_m` and `polygon_m`";
                let help = "write `at_m = [x, y]`, or `rect_m = [least x, least y, greatest x, greatest y]`";
                Err((message.into(), help))
            }
        }
    }

    /// Mean number of agents per second; 0 where a schedule, here or in a file, states the times.
    fn rate(&self) -> Result<f32, TableFault> {
        match (self.rate_per_s, self.schedule.is_some(), self.schedule_file.is_some()) {
            (Some(rate_per_s), false, false) => Ok(rate_per_s),
            (None, true, false) | (None, false, true) if self.from_s.is_none() && self.to_s.is_none() => Ok(0.0),
            (None, true, false) | (None, false, true) => {
                let help = "remove `from_s` and `to_s`";
                Err(("the rows of the `schedule` state the times of this source".into(), help))
            }
            _ => {
                let message = "a source needs exactly one of `rate_per_s`, `schedule` and `schedule_file`";
                let help = "write `rate_per_s = 0.5`, or `schedule = [[from_s, to_s, rate_per_s], …]`";
                Err((message.into(), help))
            }
        }
    }
}

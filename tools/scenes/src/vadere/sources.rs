//! Sources of agents, and agents that are there at the start.

use std::collections::{BTreeMap, BTreeSet};

use crate::scene::{DrawnNumber, Point, Scene, SceneAgents, SceneProfile, SceneSource, Shape, SourceTimes, Starts};
use crate::vadere::shapes::{PROFILE, PlacedFault, VadereFault, at_item, check_shape};
use crate::vadere::targets::{Targets, drawn};
use crate::vadere::vadere_file::{VadereSource, VadereTopography};

/// Greatest number of agents; that of scenario files.
const AGENTS_MAX: f64 = 1e6;
/// Rates that a scenario takes, agents per second.
const RATES_PER_S: [f64; 2] = [1e-5, 1e3];
/// Preferred speeds that a scenario takes, m/s.
const SPEEDS_MPS: [f64; 2] = [0.1, 10.0];
/// Greatest number of times that are written one by one.
const BEATS_MAX: usize = 120;

/// When a source makes agents, in one form for all releases.
struct Spawning {
    from_s: f64,
    to_s: f64,
    /// Agents of each event.
    count: f64,
    /// Duration between events, s.
    every_s: f64,
    most: Option<u64>,
    /// Whether the duration between events is always the same.
    has_beat: bool,
}

/// What the agents of a group share: the list of targets, and a `freeFlowSpeed` of their own, cm/s.
type TargetsAndSpeed<'a> = (&'a [i64], Option<u64>);
/// Index of the first agent of a group, and the starts of all.
type FirstAndStarts = (usize, Vec<Point>);

/// Reads sources and single agents.
pub(crate) fn read_sources(
    topography: &VadereTopography,
    radius_m: f64,
    targets: &mut Targets,
    scene: &mut Scene,
) -> Result<(), PlacedFault> {
    for (index, source) in topography.sources.iter().enumerate() {
        read_source(source, radius_m, targets, scene).map_err(at_item("sources", index))?;
    }
    let mut groups: BTreeMap<TargetsAndSpeed, FirstAndStarts> = BTreeMap::new();
    for (index, agent) in topography.dynamic_elements.iter().enumerate() {
        let at_m = agent.position.position_m();
        check_shape(&Shape::Point(at_m)).map_err(at_item("dynamicElements", index))?;
        let speed_mps = agent.free_flow_speed.filter(|speed_mps| *speed_mps > 0.0);
        if speed_mps.is_some_and(|speed_mps| !(SPEEDS_MPS[0]..=SPEEDS_MPS[1]).contains(&speed_mps)) {
            let [least, most] = SPEEDS_MPS;
            let (file, what) = (scene.source.clone(), format!("`freeFlowSpeed` is cut to {least} to {most} m/s"));
            scene.notes.add(&file, 0, what, true);
        }
        let speed = speed_mps.map(hundredths);
        groups.entry((&agent.target_ids, speed)).or_insert((index, Vec::new())).1.push(at_m);
    }
    let speeds: BTreeSet<u64> = groups.keys().filter_map(|(_, speed)| *speed).collect();
    scene.profiles.extend(speeds.into_iter().map(profile_of_speed));
    for ((list, speed), (first, starts_m)) in groups {
        let state = targets.state(list, "an agent").map_err(at_item("dynamicElements", first))?;
        let starts = Starts::Points(starts_m);
        let profile = speed.map_or_else(|| PROFILE.to_owned(), |speed| profile_of_speed(speed).name);
        let group = agents(starts, state, radius_m, "dynamicElements");
        scene.agents.push(SceneAgents { profiles: vec![(profile, 1.0)], ..group });
    }
    Ok(())
}

/// A speed within those that a scenario takes, cm/s: fewer steps than a scenario takes profiles.
fn hundredths(speed_mps: f64) -> u64 {
    (speed_mps.clamp(SPEEDS_MPS[0], SPEEDS_MPS[1]) * 100.0).round() as u64
}

/// The profile of agents with a `freeFlowSpeed` of their own, cm/s.
fn profile_of_speed(speed: u64) -> SceneProfile {
    SceneProfile {
        name: format!("{PROFILE}_{speed}_cm_per_s"),
        inherits: Some(PROFILE.to_owned()),
        preferred_speed_mps: Some(DrawnNumber::Constant(speed as f64 / 100.0)),
        radius_m: None,
        origin: "freeFlowSpeed".to_owned(),
    }
}

fn agents(starts: Starts, state: Option<String>, radius_m: f64, origin: &str) -> SceneAgents {
    SceneAgents {
        starts,
        profiles: vec![(PROFILE.to_owned(), 1.0)],
        state,
        radius_max_m: radius_m,
        wall_radius_m: None,
        own_goal_mirrors: None,
        origin: origin.to_owned(),
    }
}

fn read_source(
    source: &VadereSource,
    radius_m: f64,
    targets: &mut Targets,
    scene: &mut Scene,
) -> Result<(), VadereFault> {
    let name = format!("source {}", source.id);
    let file = scene.source.clone();
    let Some(state) = targets.state(&source.target_ids, &name)? else {
        scene.notes.add(&file, 0, format!("{name} has no target and is left out"), true);
        return Ok(());
    };
    let shape = source.shape.shape();
    check_shape(&shape)?;
    if source.group_size_distribution.len() > 1 {
        scene.notes.add(&file, 0, format!("{name}: agents walk alone, not in groups"), true);
    }
    let spawning = spawning(source, &name, scene)?;
    let of_moment = spawning.most.map_or(spawning.count, |most| spawning.count.min(most as f64));
    if spawning.to_s <= spawning.from_s && spawning.from_s <= 0.0 {
        if of_moment >= 1.0 {
            let starts = Starts::Spread { shape, count: of_moment as usize };
            scene.agents.push(agents(starts, Some(state), radius_m, &name));
        }
        return Ok(());
    }
    let times = times(&spawning, of_moment as u64, scene);
    scene.sources.push(SceneSource {
        shape,
        times,
        state: Some(state),
        profile: Some(PROFILE.to_owned()),
        origin: name,
    });
    Ok(())
}

/// When the agents are due: at stated times where these are few, else at a rate.
fn times(spawning: &Spawning, of_moment: u64, scene: &mut Scene) -> SourceTimes {
    let &Spawning { from_s, to_s, count, every_s, most, has_beat } = spawning;
    if to_s <= from_s {
        return SourceTimes::Stated(vec![(from_s, of_moment)]);
    }
    let until_s = scene.duration_s.map_or(to_s, |duration_s| to_s.min(duration_s));
    let mut rows: Vec<(f64, u64)> = Vec::new();
    let mut left = most.unwrap_or(u64::MAX);
    let beats = (0..=BEATS_MAX).map(|beat| from_s + beat as f64 * every_s);
    for due_s in beats.take_while(|due_s| *due_s <= until_s) {
        let number = left.min(count as u64);
        left -= number;
        if number > 0 {
            rows.push(((due_s * 1e3).round() / 1e3, number));
        }
    }
    if has_beat && count.fract() == 0.0 && (1..=BEATS_MAX).contains(&rows.len()) {
        return SourceTimes::Stated(rows);
    }
    let file = scene.source.clone();
    let what = "agents of a source come at random times with the stated rate, not in a fixed beat";
    scene.notes.add(&file, 0, what, false);
    let rate_per_s = (count / every_s).clamp(RATES_PER_S[0], RATES_PER_S[1]);
    SourceTimes::Rate { rate_per_s, from_s, to_s, count: most }
}

fn spawning(source: &VadereSource, name: &str, scene: &mut Scene) -> Result<Spawning, VadereFault> {
    let limit = |most: i64| u64::try_from(most).ok();
    let spawning = match &source.spawner {
        Some(spawner) => {
            let drawn = drawn(&spawner.distribution);
            let is_constant = spawner.distribution.kind.ends_with("ConstantDistribution");
            let every_s = drawn.map(DrawnNumber::mean);
            if every_s.is_none() {
                let what = format!("{name}: its distribution is unknown; an agent comes each second");
                let file = scene.source.clone();
                scene.notes.add(&file, 0, what, true);
            }
            Spawning {
                from_s: spawner.constraints_time_start,
                to_s: spawner.constraints_time_end,
                count: spawner.event_element_count,
                every_s: every_s.unwrap_or(1.0),
                most: limit(spawner.constraints_elements_max),
                has_beat: is_constant && every_s.is_some(),
            }
        }
        None => Spawning {
            from_s: source.start_time,
            to_s: source.end_time,
            count: source.spawn_number.unwrap_or(1.0),
            every_s: first_number(&source.distribution_parameters).unwrap_or(1.0),
            most: source.max_spawn_number_total.and_then(limit),
            has_beat: source.inter_spawn_time_distribution.as_deref().is_none_or(|kind| kind.contains("Constant")),
        },
    };
    let is_time = |time_s: f64| (0.0..=86_400.0).contains(&time_s);
    // Files without an end state the greatest number of Java.
    let spawning = Spawning { to_s: spawning.to_s.min(86_400.0), ..spawning };
    if !is_time(spawning.from_s) || !is_time(spawning.to_s) || !(0.0..=AGENTS_MAX).contains(&spawning.count) {
        return Err((
            format!("{name} has times or numbers out of range"),
            "give times within a day, and a million agents",
        ));
    }
    Ok(Spawning { every_s: spawning.every_s.max(1e-3), ..spawning })
}

/// The first number of a list, or of the values of an object.
fn first_number(value: &serde_json::Value) -> Option<f64> {
    let list = value.as_array().and_then(|list| list.first());
    list.or_else(|| value.as_object().and_then(|object| object.values().next())).and_then(serde_json::Value::as_f64)
}

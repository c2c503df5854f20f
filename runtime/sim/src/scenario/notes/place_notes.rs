//! Paths, sources, doors, zones and parts of the ground without effect.

use glam::Vec2;

use crate::behaviour::Movement;
use crate::maths::polygon::contains;
use crate::scenario::notes::behaviour_notes::{has_path, is_ever_green};
use crate::scenario::resolved::Scenario;

/// Distance from the origin from which on f32 shows in the feet, m: positions are known to 0.1 mm there.
const FAR_M: f32 = 2_000.0;

/// One sentence for each.
pub(crate) fn notes(scenario: &Scenario) -> Vec<String> {
    let own_path = scenario.behaviour.states.iter().skip(1).find(|state| state.movement == Movement::OwnPath);
    let pathless = own_path.filter(|_| !has_path(scenario)).map(|state| {
        format!("state `{}`: agents go along their own paths, but no agent has `goals_m`; they stand", state.name)
    });
    let sources = scenario.sources.iter().enumerate().filter(|(index, source)| {
        let first_s = source.due_times(scenario.seed, *index).next();
        first_s.is_none_or(|first_s| first_s > f64::from(scenario.duration_s))
    });
    let sources = sources.map(|(index, _)| format!("source {index}: no agent is due within {} s", scenario.duration_s));
    let doors = scenario.doors.iter().enumerate().filter(|(_, door)| !is_ever_green(scenario, door.signal as usize));
    let doors = doors.map(|(index, door)| {
        let signal = &scenario.behaviour.signals[door.signal as usize].name;
        format!("door {index} never opens: signal `{signal}` is never green")
    });
    let own = pathless.into_iter().chain(sources).chain(doors);
    own.chain(narrow_zones(scenario)).chain(holes(scenario)).chain(far(scenario)).collect()
}

/// One-way zones that no agent fits through.
fn narrow_zones(scenario: &Scenario) -> impl Iterator<Item = String> {
    let agents = scenario.agents.iter().map(|agent| agent.wall_radius_m);
    let radii_m = agents.chain(scenario.sources.iter().map(|source| source.wall_radius_m));
    let least_m = 2.0 * radii_m.fold(f32::INFINITY, f32::min);
    scenario.zones.iter().enumerate().filter_map(move |(index, zone)| {
        let [from_m, to_m] = zone.one_way()?.gates_m()[0];
        let width_m = from_m.distance(to_m);
        (width_m < least_m).then(|| format!("one-way zone {index} is {width_m:.2} m wide: no agent fits through"))
    })
}

/// Holes that lie outside all walkable polygons.
fn holes(scenario: &Scenario) -> impl Iterator<Item = String> {
    scenario.walkable_m.iter().enumerate().flat_map(move |(index, polygon)| {
        let is_off = move |hole_m: &Vec<Vec2>| {
            let inside = |outline_m: &[Vec2], hole_m: &[Vec2]| hole_m.iter().any(|at_m| contains(outline_m, *at_m));
            !scenario.walkable_m.iter().any(|of| inside(&of.outline_m, hole_m) || inside(hole_m, &of.outline_m))
        };
        let off = polygon.holes_m.iter().enumerate().filter(move |(_, hole_m)| is_off(hole_m));
        off.map(move |(hole, _)| format!("hole {hole} of walkable polygon {index} lies off the walkable ground"))
    })
}

fn far(scenario: &Scenario) -> Option<String> {
    let farthest_m = scenario.points_m().into_iter().map(|at_m| at_m.abs().max_element()).fold(0.0, f32::max);
    (farthest_m > FAR_M).then(|| {
        format!(
            "agents walk {:.1} km from the origin, where positions are rounded to {:.1} mm; move the scene to the \
             origin for feet that do not slide",
            farthest_m / 1e3,
            // 24 bits of mantissa.
            farthest_m * 1e3 / 16_777_216.0 * 2.0
        )
    })
}

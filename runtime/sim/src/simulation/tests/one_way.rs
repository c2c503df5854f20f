//! Agents in one-way zones: lanes, a loop, starts within a zone, and agents that others push.

use glam::Vec2;

use super::{run, scenario_of};

/// Distance from its goal within which an agent has arrived, beside others that stand there, m.
const ARRIVED_M: f32 = 0.7;
/// Distance that an agent may lose against the heading of a zone, m: a body that sways.
const LOST_MAX_M: f32 = 0.05;
/// A ring about a block of 4 × 4 m, whose lower side leads to the right.
const RING: &str = "walkable = [{ polygon_m = [[0, 0], [12, 0], [12, 12], [0, 12]] }]\n\
    obstacles = [{ polygon_m = [[4, 4], [8, 4], [8, 8], [4, 8]] }]\n\
    zones = [{ rect_m = [5, 0, 7, 4], one_way_deg = 0 }]\n";

/// Runs a scenario. All agents arrive, and none moves back in a zone. Returns where each one was at every step, m.
fn check(text: &str) -> Vec<Vec<Vec2>> {
    let scenario = scenario_of(&format!("clips = '.'\n{text}"));
    let zones = scenario.one_way_zones();
    let mut paths_m: Vec<Vec<Vec2>> = scenario.agents.iter().map(|agent| vec![agent.position_m]).collect();
    let mut farthest_m = vec![vec![f32::NEG_INFINITY; zones.len()]; scenario.agents.len()];
    run(&scenario, |simulation, now_s| {
        for (index, frame) in simulation.frames().iter().enumerate() {
            let at_m = frame.root.position_m;
            paths_m[index].push(at_m);
            for (zone, farthest_m) in zones.iter().zip(&mut farthest_m[index]) {
                let along_m = at_m.dot(zone.heading);
                if zone.holds(at_m) {
                    assert!(along_m > *farthest_m - LOST_MAX_M, "agent {index} goes back to {at_m} at {now_s} s");
                    *farthest_m = farthest_m.max(along_m);
                } else {
                    *farthest_m = f32::NEG_INFINITY;
                }
            }
        }
    });
    for (agent, path_m) in scenario.agents.iter().zip(&paths_m) {
        let (at_m, goal_m) = (path_m[path_m.len() - 1], agent.goals_m[agent.goals_m.len() - 1]);
        assert!(at_m.distance(goal_m) < ARRIVED_M, "{at_m} instead of {goal_m}");
    }
    paths_m
}

fn length_m(path_m: &[Vec2]) -> f32 {
    path_m.windows(2).map(|ends_m| ends_m[0].distance(ends_m[1])).sum()
}

#[test]
fn opposite_streams_take_their_lanes_with_every_planner() {
    for planner in ["mcn", "orca", "social_force"] {
        let agents: Vec<String> = (0..8)
            .map(|index| {
                let (x, y) = (1.0 + 1.2 * (index / 4) as f32, 0.5 + (index % 4) as f32);
                let (from, to) = if index < 4 { (x, 27.0 + x) } else { (29.5 - x, 3.5 - x) };
                format!("{{ at_m = [{from}, {y}], goals_m = [[{to}, {y}]] }}")
            })
            .collect();
        let paths_m = check(&format!(
            "planner = '{planner}'\nduration_s = 40\nagents = [{}]\n\
             walkable = [{{ polygon_m = [[0, 0], [30, 0], [30, 4], [0, 4]] }}]\n\
             zones = [{{ rect_m = [8, 0, 22, 2], one_way_deg = 0 }}, {{ rect_m = [8, 2, 22, 4], one_way_deg = 180 }}]\n",
            agents.join(", ")
        ));
        for (index, path_m) in paths_m.iter().enumerate() {
            let in_lane = |at_m: &Vec2| (at_m.y < 2.0) == (index < 4);
            assert!(path_m.iter().filter(|at_m| (10.0..20.0).contains(&at_m.x)).all(in_lane), "{planner} {index}");
        }
    }
}

#[test]
fn a_goal_behind_is_reached_round_the_loop() {
    for from in ["8.5, 2", "6, 2"] {
        let paths_m = check(&format!("duration_s = 40\nagents = [{{ at_m = [{from}], goals_m = [[3, 2]] }}]\n{RING}"));
        assert!(length_m(&paths_m[0]) > 15.0, "{from}: {}", length_m(&paths_m[0]));
    }
    let straight_m = check(&format!("duration_s = 20\nagents = [{{ at_m = [3, 2], goals_m = [[8.5, 2]] }}]\n{RING}"));
    assert!(length_m(&straight_m[0]) < 6.0);
}

#[test]
fn waypoints_lead_through_a_zone_again_and_again() {
    let goals = "[9, 2], [3, 2], [9, 2], [3, 2]";
    let paths_m = check(&format!("duration_s = 80\nagents = [{{ at_m = [3, 2], goals_m = [{goals}] }}]\n{RING}"));
    assert!(length_m(&paths_m[0]) > 40.0);
}

#[test]
fn agents_in_a_zone_are_not_pushed_back() {
    // A crowd that comes out of a narrow zone meets another one that passes its exit.
    let out: Vec<String> = (0..6)
        .map(|at| format!("{{ at_m = [{}, 2], goals_m = [[11, {}]] }}", 1.0 + 0.7 * at as f32, 6.5 + 0.8 * at as f32))
        .collect();
    let past: Vec<String> = (0..8)
        .map(|at| {
            format!(
                "{{ at_m = [{}, {}], goals_m = [[{}, 1]] }}",
                8.5 + 0.8 * (at % 4) as f32,
                6.0 + (at / 4) as f32,
                11.4 - 0.6 * at as f32
            )
        })
        .collect();
    check(&format!(
        "duration_s = 40\nagents = [{}, {}]\nzones = [{{ rect_m = [5, 1.2, 7, 2.8], one_way_deg = 0 }}]\n\
         walkable = [{{ polygon_m = [[0, 0], [12, 0], [12, 12], [0, 12]] }}]\n\
         obstacles = [{{ polygon_m = [[5, 2.8], [7, 2.8], [7, 12], [5, 12]] }}, {{ polygon_m = [[5, 0], [7, 0], [7, 1.2], [5, 1.2]] }}]\n",
        out.join(", "),
        past.join(", ")
    ));
}

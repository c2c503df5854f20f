//! Claims about the tables of agents.

use std::f32::consts::FRAC_PI_2;
use std::time::Instant;

use fbcrowd_sim::scenario::{ScenarioError, read};
use glam::Vec2;

use crate::support::{HEAD, ONE, check_rejected, scenario, write};

#[test]
fn wall_radius_is_at_most_the_radius() {
    let agents = scenario(
        "wall_radius",
        "agents = [{ at_m = [1, 1], goals_m = [[9, 9]], radius_m = 0.15 }, { at_m = [3, 3], goals_m = [[4, 4]], radius_m = 0.4, wall_radius_m = 0.4 }]",
    )
    .agents;
    assert_eq!([agents[0].wall_radius_m, agents[1].wall_radius_m], [0.15, 0.4]);
}

#[test]
fn agent_faces_first_goal_by_default() {
    let agents = scenario(
        "facing",
        "agents = [{ at_m = [1, 1], goals_m = [[1, 4], [9, 9]] }, { at_m = [3, 3], goals_m = [[4, 4]], facing_deg = 180 }]",
    )
    .agents;
    assert_eq!((agents[0].facing_rad, agents[0].goals_m.len()), (FRAC_PI_2, 2));
    assert_eq!(agents[1].facing_rad, std::f32::consts::PI);
}

#[test]
fn goals_of_a_circle_are_exactly_opposite() {
    let agents = scenario("circle", "agents = { circle = { count = 17, radius_m = 4 } }").agents;
    assert_eq!(agents.len(), 17);
    assert!(agents.iter().all(|agent| agent.goals_m == [-agent.position_m]));
    assert_eq!(agents[0].position_m, Vec2::new(4.0, 0.0));
}

#[test]
fn grid_is_centred_with_seeded_jitter() {
    let grid = |jitter_m: f32, seed: u64| {
        let body = format!(
            "seed = {seed}\nagents = {{ grid = {{ columns = 3, rows = 2, spacing_m = 2, centre_m = [10, 0], jitter_m = {jitter_m} }}, goal_offset_m = [0, 7] }}"
        );
        scenario("grid", &body).agents
    };
    let plain: Vec<Vec2> = grid(0.0, 1).iter().map(|agent| agent.position_m).collect();
    let at = Vec2::new;
    assert_eq!(plain, [at(8.0, -1.0), at(10.0, -1.0), at(12.0, -1.0), at(8.0, 1.0), at(10.0, 1.0), at(12.0, 1.0)]);
    let jittered = grid(0.3, 1);
    assert_eq!(jittered, grid(0.3, 1));
    assert_ne!(jittered, grid(0.3, 2));
    for (agent, position_m) in jittered.iter().zip(plain) {
        assert!((agent.position_m - position_m).abs().max_element() <= 0.3);
        assert_eq!(agent.goals_m, [agent.position_m + Vec2::new(0.0, 7.0)]);
    }
}

#[test]
fn shared_waypoints_come_before_each_agents_own_goal() {
    let grid = "{ columns = 2, rows = 1, spacing_m = 2 }";
    let agents =
        scenario("door", &format!("agents = {{ grid = {grid}, goals_m = [[3, 3]], goal_offset_m = [9, 0] }}")).agents;
    assert_eq!(agents[0].goals_m, [Vec2::new(3.0, 3.0), Vec2::new(8.0, 0.0)]);
    assert_eq!(agents[1].goals_m, [Vec2::new(3.0, 3.0), Vec2::new(10.0, 0.0)]);
}

#[test]
fn agents_of_no_layout_or_two_are_rejected() {
    let none = "{ goals_m = [[5, 0]] }";
    check_rejected("none", &format!("{HEAD}agents = {none}"), none, "exactly one");
    let aimless = "{ at_m = [0, 0] }";
    check_rejected("aimless", &format!("{HEAD}agents = {aimless}"), aimless, "need a goal");
    let two = "{ at_m = [0, 0], file = \"scene.toml\" }";
    check_rejected("two", &format!("{HEAD}agents = {two}"), two, "exactly one");
}

#[test]
fn agents_start_apart_from_each_other_and_from_obstacles() {
    let second = "{ at_m = [0.3, 0], goals_m = [[5, 0]] }";
    let agents = format!("agents = [{{ at_m = [0, 0], goals_m = [[5, 0]] }}, {second}]");
    check_rejected("overlap", &format!("{HEAD}{agents}"), second, "agents 0 and 1 overlap by 0.20 m");

    let with_obstacle = |polygon: &str| format!("{HEAD}agents = [{second}]\n[[obstacles]]\npolygon_m = {polygon}\n");
    check_rejected(
        "inside",
        &with_obstacle("[[-1, -1], [1, -1], [1, 1], [-1, 1]]"),
        second,
        "agent 0 starts inside obstacle 0",
    );
    check_rejected(
        "grazing",
        &with_obstacle("[[-1, 0.15], [1, 0.15], [0, 1]]"),
        second,
        "agent 0 overlaps obstacle 0 by 0.05 m",
    );
    check_rejected("goal", &with_obstacle("[[4, -1], [6, -1], [6, 2]]"), second, "of agent 0 lies inside obstacle 0");
    let broad = "{ at_m = [0, 0], goals_m = [[5, 0]], radius_m = 0.6, wall_radius_m = 0.6 }";
    check_rejected(
        "goal_beside",
        &format!("{HEAD}agents = [{broad}]\n[[obstacles]]\npolygon_m = [[5.05, -2], [6, -2], [6, 2], [5.05, 2]]\n"),
        broad,
        "agent 0 with a wall radius of 0.60 m cannot come within 0.5 m of its goal, which lies 0.05 m from obstacle 0",
    );
}

#[test]
fn distributions_of_agents_belong_in_profiles() {
    let drawn = "{ uniform = [1, 1.5] }";
    let message = "write a distribution in `[profiles.NAME]`";
    for key in ["preferred_speed_mps", "radius_m"] {
        let keys = format!("at_m = [0, 0]\ngoals_m = [[5, 0]]\n{key} = {drawn}\n");
        check_rejected("drawn_agents", &format!("{HEAD}[[agents]]\n{keys}"), drawn, message);
        check_rejected("drawn_source", &format!("{HEAD}[[sources]]\nrate_per_s = 1\n{keys}"), drawn, message);
    }
    let text = "\"fast\"";
    let agents = format!("agents = {{ at_m = [0, 0], goals_m = [[5, 0]], preferred_speed_mps = {text} }}");
    check_rejected("word", &format!("{HEAD}{agents}"), text, "a number is expected here, not \"fast\"");
    let whole = scenario("whole", "agents = { at_m = [0, 0], goals_m = [[5, 0]], preferred_speed_mps = 2 }");
    assert_eq!(whole.agents[0].preferred_speed_mps, 2.0);
}

#[test]
fn lines_and_areas_that_are_measured_have_an_extent() {
    let line = "[[measure]]\nname = \"l\"\nline_m = [[1, 0], [1, 0]]\n";
    let message = "the length of the line is 0 m, less than 0.01 m";
    match read(&write("no_line", &format!("{HEAD}{ONE}{line}"))) {
        Err(ScenarioError::Invalid(invalid)) => assert!(invalid.message.contains(message), "{invalid}"),
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_crowd_in_a_line_is_checked_quickly() {
    for (columns, rows) in [(1, 16_000), (16_000, 1), (126, 127)] {
        let grid = format!("{{ columns = {columns}, rows = {rows}, spacing_m = 0.6 }}");
        let start = Instant::now();
        scenario("line", &format!("agents = {{ grid = {grid}, goal_offset_m = [1, 1] }}"));
        assert!(start.elapsed().as_secs_f64() < 0.5, "{columns} × {rows} took {:?}", start.elapsed());
    }
}

#[test]
fn huge_crowd_is_rejected_early() {
    let crowd = "[[agents]]\ngrid = { columns = 800, rows = 1000, spacing_m = 1 }\ngoal_offset_m = [1, 0]\n";
    check_rejected("crowds", &format!("{HEAD}{}", crowd.repeat(50)), "[[agents]]", "1600000 agents");
    let goals = "[1, 2], ".repeat(5_000);
    let table = format!("{{ grid = {{ columns = 800, rows = 1000, spacing_m = 1 }}, goals_m = [{goals}] }}");
    check_rejected("goals", &format!("{HEAD}agents = {table}"), &table, "4000000000 waypoints");
}

#[test]
fn goals_without_a_route_are_errors_at_their_agents() {
    let agents = "{ at_m = [0, 0], goals_m = [[5, 0]] }";
    let scene = |walls: &str| format!("{HEAD}agents = [{agents}]\n{walls}");
    let around = "[[obstacles]]\nkind = \"enclosure\"\npolygon_m = [[4, -2], [7, -2], [7, 2], [4, 2]]\n";
    check_rejected("unreachable", &scene(around), agents, "no route leads agent 0 to the goal [5, 0]");
    let small = "[[walkable]]\npolygon_m = [[-1, -1], [3, -1], [3, 1], [-1, 1]]\n";
    check_rejected("off", &scene(small), agents, "lies inside a wall or off the walkable ground");
    let beside = "[[walkable]]\npolygon_m = [[1, -1], [9, -1], [9, 1], [1, 1]]\n";
    check_rejected("start", &scene(beside), agents, "agent 0 starts at [0, 0], in a wall or off the walkable ground");
}

#[test]
fn wrong_groups_are_shown_at_their_table() {
    let agents = |keys: &str| {
        format!("{HEAD}agents = {{ grid = {{ columns = 2, rows = 2, spacing_m = 1 }}, goals_m = [[9, 9]], {keys} }}\n")
    };
    let cases = [
        ("groups = { 0 = 1 }", "`0` in `groups` is no size of a group"),
        ("groups = { 5 = 1 }", "`5` in `groups` is no size of a group"),
        ("groups = { pairs = 1 }", "`pairs` in `groups` is no size of a group"),
        ("groups = { 1 = 0, 2 = 0 }", "the sum of the shares in `groups` is 0"),
        ("groups = { 1 = -1, 2 = 3 }", "a share in `groups` is -1"),
        ("groups = { 2 = nan }", "the sum of the shares in `groups` is NaN"),
        ("groups = { 2 = inf }", "the sum of the shares in `groups` is inf"),
        ("groups = { 2 = 1 }, group_spacing_m = 0.1", "group_spacing_m is 0.1"),
        ("group_spacing_m = 1", "`group_spacing_m` needs `groups`"),
    ];
    for (keys, message) in cases {
        match read(&write("groups", &agents(keys))) {
            Err(ScenarioError::Invalid(invalid)) => assert!(invalid.message.contains(message), "{keys}: {invalid}"),
            other => panic!("{keys} gave {other:?}"),
        }
        let source = format!("{HEAD}[[sources]]\nat_m = [0, 0]\nrate_per_s = 1\ngoals_m = [[9, 9]]\n");
        let text = source + &keys.replace("}, group", "}\ngroup") + "\n";
        match read(&write("groups", &text)) {
            Err(ScenarioError::Invalid(invalid)) => assert!(invalid.message.contains(message), "{keys}: {invalid}"),
            other => panic!("{text} gave {other:?}"),
        }
    }
}

//! Claims about scenario files with behaviour, profiles and areas of agents.

use std::path::PathBuf;

use fbcrowd_sim::scenario::{Scenario, parse};
use glam::Vec2;
use motiondb::files::SourceText;

fn parsed(text: &str) -> Result<Scenario, String> {
    let text = format!("duration_s = 10\n{text}");
    let source = SourceText { path: PathBuf::from("crowd.toml"), text };
    parse(&source).map(|(scenario, _)| scenario).map_err(|error| error.to_string())
}

/// A mistake is shown at its line, below the line of the duration.
fn check_refused(text: &str, line: usize, parts: &[&str]) {
    let message = parsed(text).expect_err(text);
    let place = format!("crowd.toml:{}:", line + 1);
    assert!(message.contains(&place) && parts.iter().all(|part| message.contains(part)), "{message}");
}

fn least_distance_m(agents_m: &[Vec2]) -> f32 {
    let pairs =
        agents_m.iter().enumerate().flat_map(|(index, a)| agents_m[..index].iter().map(move |b| a.distance(*b)));
    pairs.fold(f32::INFINITY, f32::min)
}

const ROOM: &str = "
[[obstacles]]
polygon_m = [[4, 4], [6, 4], [6, 6], [4, 6]]
";

#[test]
fn agents_of_an_area_keep_apart() {
    let text = format!(
        "{ROOM}[[agents]]\narea = {{ rect_m = [0, 0, 10, 10], count = 60, apart_m = 0.8 }}\ngoals_m = [[20, 0]]\n[[agents]]\nat_m = [1, 1]\ngoals_m = [[20, 1]]"
    );
    let scenario = parsed(&text).unwrap();
    let starts_m: Vec<Vec2> = scenario.agents.iter().map(|agent| agent.position_m).collect();
    assert_eq!(starts_m.len(), 61);
    assert!(least_distance_m(&starts_m[..60]) >= 0.799 && least_distance_m(&starts_m) >= 0.799);
    assert!(starts_m.iter().all(|at_m| at_m.cmpge(Vec2::ZERO).all() && at_m.cmple(Vec2::splat(10.0)).all()));
    assert_eq!(scenario, parsed(&text).unwrap());
    assert_ne!(scenario.agents, parsed(&format!("seed = 2{text}")).unwrap().agents);
}

#[test]
fn dense_areas_are_filled_evenly() {
    for (density, count) in [(0.5, 50), (2.0, 200), (3.5, 350)] {
        let text = format!(
            "[[agents]]\narea = {{ rect_m = [0, 0, 10, 10], density_per_m2 = {density} }}\ngoals_m = [[20, 0]]"
        );
        let starts_m: Vec<Vec2> = parsed(&text).unwrap().agents.iter().map(|agent| agent.position_m).collect();
        assert_eq!(starts_m.len(), count);
        assert!(least_distance_m(&starts_m) >= 0.4998, "{}", least_distance_m(&starts_m));
        let left = starts_m.iter().filter(|at_m| at_m.x < 5.0).count();
        assert!(left.abs_diff(count / 2) < 8 + count / 12, "{left} of {count}");
    }
}

#[test]
fn an_area_without_room_names_how_many_fit() {
    let text = "[[agents]]\narea = { rect_m = [0, 0, 2, 2], count = 30 }\ngoals_m = [[20, 0]]";
    check_refused(text, 1, &["room for 17", "not for 30"]);
    let text = "[[agents]]\narea = { circle_m = [0, 0, 3], count = 9, density_per_m2 = 1 }\ngoals_m = [[20, 0]]";
    check_refused(text, 1, &["exactly one of `count`"]);
    let text = "[[agents]]\narea = { circle_m = [0, 0, 3], density_per_m2 = 1e9 }\ngoals_m = [[20, 0]]";
    check_refused(text, 1, &["not between 1 and 1000000"]);
    check_refused("[[agents]]\narea = { rect_m = [0, 0, 2, 2], count = 1 }", 1, &["need a goal"]);
    let inside = format!("{ROOM}[[agents]]\narea = {{ rect_m = [4, 4, 6, 6], count = 1 }}\ngoals_m = [[20, 0]]");
    check_refused(&inside, 4, &["room for 0"]);
}

const PROFILES: &str = "
[profiles.adult]
preferred_speed_mps = { normal = [1.34, 0.2], min = 1.0, max = 1.8 }
radius_m = { uniform = [0.2, 0.3] }
[profiles.elderly]
inherits = 'adult'
preferred_speed_mps = { uniform = [0.5, 0.8] }
pre_movement_s = 4
";

#[test]
fn profiles_are_drawn_by_their_shares() {
    let agents = "[[agents]]\narea = { rect_m = [0, 0, 60, 60], count = 800 }\ngoals_m = [[90, 0]]\nprofile = { adult = 3, elderly = 1 }";
    let agents = parsed(&format!("{PROFILES}{agents}")).unwrap().agents;
    let elderly = agents.iter().filter(|agent| agent.pre_movement_s == 4.0).count();
    assert!(elderly.abs_diff(200) < 40, "{elderly}");
    for agent in &agents {
        let range = if agent.pre_movement_s > 0.0 { 0.5..=0.8 } else { 1.0..=1.8 };
        assert!(range.contains(&agent.preferred_speed_mps) && (0.2..=0.3).contains(&agent.radius_m), "{agent:?}");
        assert!(agent.wall_radius_m <= agent.radius_m);
    }
}

#[test]
fn keys_of_a_table_go_before_its_profile() {
    let agents = "[[agents]]\nat_m = [0, 0]\ngoals_m = [[9, 0]]\nprofile = 'elderly'\npreferred_speed_mps = 1.2\npre_movement_s = 2\n[[agents]]\nat_m = [0, 3]\ngoals_m = [[9, 0]]";
    let agents = parsed(&format!("{PROFILES}{agents}")).unwrap().agents;
    assert_eq!((agents[0].preferred_speed_mps, agents[0].pre_movement_s), (1.2, 2.0));
    assert!(agents[0].radius_m != 0.25);
    assert_eq!((agents[1].preferred_speed_mps, agents[1].radius_m, agents[1].pre_movement_s), (1.33, 0.25, 0.0));
}

#[test]
fn agents_of_a_source_are_drawn_one_by_one() {
    let source = "[[sources]]\nat_m = [0, 0]\nrate_per_s = 1\ngoals_m = [[9, 0]]\nprofile = 'adult'";
    let scenario = parsed(&format!("{PROFILES}{source}")).unwrap();
    let drawn: Vec<f32> = (0..50).map(|born| scenario.sources[0].drawn(1, 0, born).preferred_speed_mps).collect();
    assert!(drawn.iter().all(|speed_mps| (1.0..=1.8).contains(speed_mps)));
    assert!(drawn.windows(2).all(|pair| pair[0] != pair[1]));
}

#[test]
fn mistakes_in_profiles_are_shown_at_their_line() {
    let agents = "[[agents]]\nat_m = [0, 0]\ngoals_m = [[9, 0]]\nprofile = 'child'";
    check_refused(&format!("{PROFILES}{agents}"), 9, &["no profile `child`", "`adult`, `elderly`"]);
    const AGENT: &str = "[[agents]]\nat_m = [0, 0]\ngoals_m = [[9, 0]]\n";
    let circle = format!("{AGENT}[profiles.a]\ninherits = 'b'\n[profiles.b]\ninherits = 'a'");
    check_refused(&circle, 4, &["inherits from itself"]);
    check_refused(&format!("{AGENT}[profiles.a]\nradius_m = 9"), 4, &["within 0.1 and 1"]);
    check_refused(
        &format!("{PROFILES}[[agents]]\nat_m = [0, 0]\ngoals_m = [[9, 0]]\nprofile = {{ adult = -1 }}"),
        9,
        &["shares"],
    );
}

#[test]
fn states_of_agents_and_sources_are_found() {
    let states = "[goals.far]\nareas = [{ point_m = [0, 9] }]\n[states.go]\ngo = 'far'\n";
    let agents = "[[agents]]\nat_m = [0, 0]\nstate = 'go'\n[[sources]]\nat_m = [3, 0]\nrate_per_s = 1\nstate = 'go'";
    let scenario = parsed(&format!("{states}{agents}")).unwrap();
    assert_eq!((scenario.agents[0].state, scenario.sources[0].state), (1, 1));
    assert!((scenario.agents[0].facing_rad - std::f32::consts::FRAC_PI_2).abs() < 1e-3);
    check_refused(&format!("{states}[[agents]]\nat_m = [0, 0]\nstate = 'stay'"), 7, &["no state `stay`", "`go`"]);
    check_refused("[[agents]]\nat_m = [0, 0]", 1, &["need a goal", "state"]);
}

#[test]
fn goals_inside_obstacles_are_refused() {
    let text = format!(
        "{ROOM}[goals.far]\nareas = [{{ rect_m = [4.5, 4.5, 5.5, 5.5] }}]\n[states.go]\ngo = 'far'\n[[agents]]\nat_m = [0, 0]\nstate = 'go'"
    );
    check_refused(&text, 4, &["goals `far` at [5, 5] has no free ground"]);
    check_refused(
        "[goals.far]\nareas = [{ point_m = [0, 90000] }]\n[[agents]]\nat_m = [0, 0]\ngoals_m = [[1, 1]]",
        1,
        &["10 km"],
    );
}

#[test]
fn agents_of_a_source_appear_in_its_polygon() {
    let text = "[[sources]]\npolygon_m = [[0, 0], [8, 0], [8, 1], [1, 1], [1, 8], [0, 8]]\nrate_per_s = 1\ngoals_m = [[20, 0]]\n";
    let scenario = parsed(text).unwrap();
    let source = &scenario.sources[0];
    assert_eq!([source.low_m, source.high_m], [Vec2::ZERO, Vec2::splat(8.0)]);
    assert!(source.area.as_ref().unwrap().holds(source.middle_m() + Vec2::splat(-1e-3)), "{}", source.middle_m());
    let round = text.replace("polygon_m = [[0, 0], [8, 0], [8, 1], [1, 1], [1, 8], [0, 8]]", "circle_m = [4, 4, 2]");
    assert_eq!(parsed(&round).unwrap().sources[0].middle_m(), Vec2::splat(4.0));
}

#[test]
fn a_schedule_states_when_agents_come() {
    let source = |schedule: &str| {
        let text = format!("[[sources]]\nat_m = [0, 0]\nschedule = {schedule}\ngoals_m = [[20, 0]]\n");
        parsed(&text).map(|scenario| scenario.sources[0].due_times(1, 0).collect::<Vec<f64>>())
    };
    assert_eq!(source("[[0, 1], [2.5, 2], [7, 1]]").unwrap(), [0.0, 2.5, 2.5, 7.0]);
    let times_s = source("[[1, 2, 5], [2, 3, 0], [6, 9, 2.5]]").unwrap();
    assert!(
        times_s.len() > 5 && times_s.iter().all(|due_s| (1.0..=2.0).contains(due_s) || (6.0..=9.0).contains(due_s))
    );
}

#[test]
fn a_mistake_in_a_schedule_is_shown_at_its_row() {
    let text = |rows: &str| format!("[[sources]]\nat_m = [0, 0]\ngoals_m = [[20, 0]]\nschedule = [\n{rows}\n]\n");
    for (rows, line, message) in [
        ("[0, 2, 1],\n[1, 3, 1],", 6, "the row begins at 1 s, before the row above ends at 2 s"),
        ("[5, 1],\n[7, 1],\n[6, 1],", 7, "the row is at 6 s, after one at 7 s"),
        ("[0, 5, inf],", 5, "the rate is inf agents per second, not within 0 and 1000"),
        ("[5, 5, 1],", 5, "the row lasts from 5 s to 5 s"),
        ("[0, 5, 1],\n[6, 1],", 6, "the row has 2 numbers, but the first row has 3"),
        ("[0, 1.5],", 5, "1.5 is no number of agents"),
        ("[nan, 1],", 5, "the time is NaN s"),
        ("[1, 2, 3, 4],", 5, "the row has 4 numbers"),
        ("[0, 2000000],", 5, "the number of agents is 2000000, not between 1 and 1000000"),
        ("", 4, "a schedule has 1 to 10000 rows, this one has 0"),
    ] {
        check_refused(&text(rows), line, &[message]);
    }
    check_refused(
        &text("[0, 600000],\n[1, 600000],"),
        1,
        &["with this source the scenario has more than 1000000 agents"],
    );
    let both = "[[sources]]\nat_m = [0, 0]\ngoals_m = [[20, 0]]\nrate_per_s = 1\nschedule = [[0, 1]]";
    check_refused(both, 1, &["exactly one of `rate_per_s`, `schedule` and `schedule_file`"]);
    check_refused(&both.replace("rate_per_s", "to_s"), 1, &["remove `from_s` and `to_s`"]);
    check_refused(
        "[[sources]]\nrate_per_s = 1\ngoals_m = [[20, 0]]\npolygon_m = [[0, 0], [1, 1], [1, 0], [0, 1]]",
        1,
        &["crosses or touches itself"],
    );
}

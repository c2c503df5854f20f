//! Claims about the tables of sources.

use std::fs;
use std::time::Instant;

use fbcrowd_sim::scenario::{AtGoal, ScenarioError, agent_files, read};
use glam::Vec2;

use crate::support::{BLOCK, HEAD, ONE, check_at_table_or_key, check_points_at, check_rejected, scenario, write};

/// Keys that every source needs beside its position.
const SOURCE: &str = "rate_per_s = 0.5\ngoals_m = [[9, 9]]\n";

#[test]
fn a_source_has_the_keys_and_defaults_of_agents() {
    let keys = "rect_m = [-2, -1, 2, 1]\nto_s = 4\nfrom_s = 1\ncount = 3\nat_goal = 'leave'\nradius_m = 0.15";
    let body = format!("[[sources]]\nat_m = [1, 2]\n{SOURCE}[[sources]]\n{keys}\n{SOURCE}goal_offset_m = [1, 0]\n");
    let sources = scenario("sources", &body).sources;
    let at_m = Vec2::new(1.0, 2.0);
    assert_eq!([sources[0].low_m, sources[0].high_m], [at_m; 2]);
    assert_eq!((sources[0].from_s, sources[0].to_s, sources[0].count), (0.0, 10.0, None));
    assert_eq!((sources[0].radius_m, sources[0].wall_radius_m, sources[0].at_goal), (0.25, 0.2, AtGoal::Stay));
    assert_eq!((sources[1].from_s, sources[1].to_s, sources[1].count), (1.0, 4.0, Some(3)));
    assert_eq!((sources[1].wall_radius_m, sources[1].at_goal), (0.15, AtGoal::Leave));
    let agent = sources[1].agent(at_m);
    assert_eq!(agent.goals_m, [Vec2::new(9.0, 9.0), Vec2::new(2.0, 2.0)]);
    assert_eq!(agent.facing_rad, libm::atan2f(7.0, 8.0));
}

#[test]
fn broken_sources_are_shown_at_their_table() {
    let check = |test: &str, keys: &str, message: &str| {
        let table = format!("[[sources]]\n{keys}");
        let text = format!("{HEAD}{ONE}{table}\n[[obstacles]]\npolygon_m = {BLOCK}\n");
        match read(&write(test, &text)) {
            Err(ScenarioError::Invalid(invalid)) => {
                assert!(invalid.message.contains(message), "{invalid}");
                check_at_table_or_key(&invalid, 4);
            }
            other => panic!("{keys} gave {other:?}"),
        }
    };
    let at = "at_m = [1, 3]";
    for rate in ["inf", "nan", "-1.0", "0.0", "1e9"] {
        check("rate", &format!("{at}\nrate_per_s = {rate}\ngoals_m = [[9, 9]]"), "rate_per_s is");
    }
    check(
        "two_areas",
        &format!("{at}\nrect_m = [0, 0, 1, 1]\n{SOURCE}"),
        "exactly one of `at_m`, `rect_m`, `circle_m` and `polygon_m`",
    );
    check("no_area", SOURCE, "exactly one of `at_m`, `rect_m`, `circle_m` and `polygon_m`");
    check("turned_rect", &format!("rect_m = [1, 0, 0, 1]\n{SOURCE}"), "rect_m has no inside");
    check("no_goal", &format!("{at}\nrate_per_s = 1.0"), "need a goal");
    check("never", &format!("{at}\nfrom_s = 5\nto_s = 4\n{SOURCE}"), "to_s is 4, not between 5");
    check("no agent", &format!("{at}\ncount = 0\n{SOURCE}"), "count is 0");
    check("broad", &format!("{at}\nradius_m = 3\n{SOURCE}"), "radius_m is 3");
    check("inside", &format!("at_m = [21, 21]\n{SOURCE}"), "source 0 has no free ground");
    check("beside", &format!("rect_m = [19.9, 20.5, 19.95, 21]\n{SOURCE}"), "source 0 has no free ground");
    check("walled", &format!("{at}\nrate_per_s = 1.0\ngoals_m = [[21, 21]]"), "of source 0 lies inside");
    let offset = "rect_m = [0, 5, 1, 6]\nrate_per_s = 1.0\ngoal_offset_m = [20.5, 15.5]";
    check("offset", offset, "of source 0 lies inside");
    let broad = "radius_m = 1.0\nwall_radius_m = 1.0\nrate_per_s = 1.0\ngoals_m = [[19.9, 21]]";
    check("too_near", &format!("{at}\n{broad}"), "cannot come within 0.5 m of their goal");
}

#[test]
fn unknown_keys_of_sources_are_rejected() {
    let text = format!("{HEAD}[[sources]]\nat_m = [0, 0]\nrate_per_min = 3\n");
    check_rejected("rate_key", &text, "rate_per_min", "rate_per_min");
    let text = format!("{HEAD}[[sources]]\nat_m = [0, 0]\nat_goal = \"vanish\"\n{SOURCE}");
    check_rejected("at_goal", &text, "\"vanish\"", "vanish");
}

#[test]
fn sources_give_no_more_agents_than_a_scenario_may_have() {
    let begun = Instant::now();
    let long = "clips = \".\"\nduration_s = 86400\n";
    let source = |rate: f32| format!("[[sources]]\nat_m = [1, 3]\nrate_per_s = {rate}\ngoals_m = [[9, 9]]\n");
    let check = |test: &str, text: &str, message: &str| match read(&write(test, text)) {
        Err(ScenarioError::Invalid(invalid)) => assert!(invalid.message.contains(message), "{invalid}"),
        other => panic!("{:?}", other.map(|(scenario, _)| scenario.sources)),
    };
    check("flood", &format!("{long}{}", source(1_000.0)), "more than 1000000 agents");
    check("streams", &format!("{long}{}", source(2.0).repeat(12)), "more than 1000000 agents");
    check("too_many", &format!("{long}{}", source(0.0001).repeat(1_001)), "the number of sources is 1001");
    assert!(read(&write("enough", &format!("{long}{}", source(2.0).repeat(5)))).is_ok());
    assert!(begun.elapsed().as_secs() < 10);
}

#[test]
fn a_schedule_file_states_when_agents_come() {
    let body = "[[sources]]\nat_m = [1, 3]\ngoals_m = [[9, 9]]\nschedule_file = 'lists/trains.csv'\n";
    let path = write("trains", &format!("{HEAD}{body}"));
    fs::create_dir_all(path.with_file_name("lists")).unwrap();
    let list = path.with_file_name("lists").join("trains.csv");
    fs::write(&list, "time_s,count\n1,2\n4.5,1\n").unwrap();
    let scenario = read(&path).unwrap().0;
    assert_eq!(scenario.sources[0].due_times(1, 0).collect::<Vec<f64>>(), [1.0, 1.0, 4.5]);
    assert_eq!(agent_files(&path).unwrap(), std::slice::from_ref(&list));
    fs::write(&list, "time_s,count\n4.5,1\n# late\n1,2\n").unwrap();
    let Err(ScenarioError::Invalid(invalid)) = read(&path) else { panic!("accepted") };
    check_points_at(&invalid, "1,2", "the row is at 1 s, after one at 4.5 s");
    assert_eq!((invalid.line(), invalid.path), (4, list));
}

#[test]
fn a_schedule_file_lies_in_the_folder() {
    let body = |name: &str| format!("{HEAD}[[sources]]\nat_m = [1, 3]\ngoals_m = [[9, 9]]\nschedule_file = {name}\n");
    for name in ["'../trains.csv'", "'/etc/hostname'", "'lists/../../trains.csv'"] {
        check_rejected("outside", &body(name), name, "leads out of the scenario's folder");
    }
    check_rejected("missing", &body("'none.csv'"), "'none.csv'", "none.csv does not exist");
    check_rejected("folder", &body("'.'"), "'.'", "cannot be read");
    let with_rate = format!("{}rate_per_s = 1\n", body("'none.csv'"));
    let Err(ScenarioError::Invalid(invalid)) = read(&write("both", &with_rate)) else { panic!("accepted") };
    assert!(invalid.message.contains("exactly one of `rate_per_s`, `schedule` and `schedule_file`"), "{invalid}");
}

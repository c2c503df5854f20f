//! Claims about files of agents: lines, limits, mistakes.

use std::fs;

use fbcrowd_sim::scenario::{ScenarioError, read};
use glam::Vec2;

use crate::support::{BLOCK, HEAD, check_points_at, write};

#[test]
fn an_agent_file_gives_an_agent_per_line() {
    let path = write("lines", &format!("{HEAD}agents = {{ file = \"a.txt\", radius_m = 0.3 }}"));
    fs::write(path.with_file_name("a.txt"), "# start and goal\n0 0 5 0\n\n 1.5 2 -3e0 4 # the other\n").unwrap();
    let agents = read(&path).unwrap().0.agents;
    assert_eq!((agents[1].position_m, &agents[1].goals_m[..]), (Vec2::new(1.5, 2.0), &[Vec2::new(-3.0, 4.0)][..]));
    assert_eq!(agents[1].radius_m, 0.3);
}

#[test]
fn agent_file_mistakes_are_shown_there() {
    let path = write("bad_lines", &format!("{HEAD}agents = {{ file = \"a.txt\" }}"));
    fs::write(path.with_file_name("a.txt"), "# x\n0 0 5 0\n1 2 3\n").unwrap();
    let Err(ScenarioError::Invalid(invalid)) = read(&path) else { panic!("accepted") };
    check_points_at(&invalid, "1 2 3", "3 numbers, not the four");
    assert_eq!((invalid.line(), invalid.path.file_name().unwrap().to_str().unwrap()), (3, "a.txt"));
    for (line, message) in [("0 nan 5 0", "`nan` is not within"), ("0 0 1e99 0", "`1e99` is not within")] {
        fs::write(path.with_file_name("a.txt"), format!("1 1 2 2\n{line}\n")).unwrap();
        let Err(ScenarioError::Invalid(invalid)) = read(&path) else { panic!("accepted") };
        check_points_at(&invalid, line, message);
    }
}

#[test]
fn agent_faults_are_shown_at_their_lines() {
    let check = |agents: &str, a: &str, b: &str, file: &str, part: &str, message: &str| {
        let path = write("crowded_lines", &format!("{HEAD}agents = [{agents}]\n[[obstacles]]\npolygon_m = {BLOCK}"));
        fs::write(path.with_file_name("a.txt"), a).unwrap();
        fs::write(path.with_file_name("b.txt"), b).unwrap();
        let Err(ScenarioError::Invalid(invalid)) = read(&path) else { panic!("accepted") };
        check_points_at(&invalid, part, message);
        assert_eq!(invalid.path.file_name().unwrap(), file);
    };
    let agents = "{ file = \"a.txt\" }, { at_m = [9, 9], goals_m = [[5, 0]] }, { file = \"b.txt\" }";
    let two = "0 0 5 0\n# x\n0 1 5 1\n";
    check(agents, "0 0 5 0\n# x\n0 0.2 5 1\n", "0 5 5 5", "a.txt", "0 0.2 5 1", "agents 0 and 1 overlap");
    check(agents, two, "\n0 5 5 5\n0 7 21 21 # in", "b.txt", "0 7 21 21 # in", "of agent 4 lies inside");
    check(agents, "", "\n0 5 5 5\n21 21 1 1", "b.txt", "21 21 1 1", "agent 2 starts inside obstacle 0");
    // A wrong key of the table is shown in the table.
    let broad = "{ file = \"b.txt\", radius_m = 3 }";
    check(&format!("{{ file = \"a.txt\" }}, {broad}"), two, "0 5 5 5", "scene.toml", broad, "radius_m is 3");
}

/// Fails unless an agent file is rejected at a line of it.
#[track_caller]
fn check_lines_rejected(test: &str, agents: &str, lines: &str, line: usize, message: &str) {
    let path = write(test, &format!("{HEAD}agents = {agents}"));
    fs::write(path.with_file_name("a.txt"), lines).unwrap();
    let Err(ScenarioError::Invalid(invalid)) = read(&path) else { panic!("accepted") };
    assert_eq!(invalid.path.file_name().unwrap(), "a.txt", "{invalid}");
    assert_eq!(invalid.line(), line, "{}", invalid.message);
    assert!(invalid.message.contains(message), "{}", invalid.message);
}

#[test]
fn an_agent_file_is_read_up_to_its_limit() {
    let file = "{ file = \"a.txt\" }";
    let crowd = format!("# crowd\n{}wrong", "0 0 1 1\n".repeat(1_000_001));
    check_lines_rejected("crowd_lines", file, &crowd, 1_000_002, "more than 1000000 agents");
    let two = format!("[{{ circle = {{ count = 999_999, radius_m = 9 }} }}, {file}]");
    check_lines_rejected("crowd_rest", &two, "0 0 1 1\n0 9 9 9\nwrong", 2, "more than 1000000 agents");
    let long = format!("0 0 1 1\n0 9 9 9 # {}\n", "é".repeat(1 << 20));
    check_lines_rejected("long_line", file, &long, 2, "longer than 4096 bytes");
    let comments = format!("0 0 1 1\n{}", format!("#{}\n", "x".repeat(4_000)).repeat(1_000));
    let many = format!("[{}]", [file; 20].join(", "));
    check_lines_rejected("many_lines", &many, &comments, 770, "longer than 64 MiB");
}

#[test]
fn a_file_of_zeros_is_no_agent_file() {
    let path = write("zeros", &format!("{HEAD}agents = {{ file = \"zeros.txt\" }}"));
    fs::File::create(path.with_file_name("zeros.txt")).unwrap().set_len(1 << 40).unwrap();
    let Err(ScenarioError::Invalid(invalid)) = read(&path) else { panic!("accepted") };
    check_points_at(&invalid, "\"zeros.txt\"", "line 1 holds a zero byte");
}

#[test]
fn lines_without_goals_need_a_state() {
    let body = |state: &str| {
        format!("{HEAD}[[agents]]\nfile = \"starts.txt\"\n{state}[states.wait]\nstand = {{ facing_deg = 90 }}\n")
    };
    let path = write("starts", &body("state = \"wait\"\n"));
    fs::write(path.with_file_name("starts.txt"), "# x y\n1 2\n3 4 5 6 # and a goal\n").unwrap();
    let agents = read(&path).unwrap().0.agents;
    assert_eq!((agents.len(), agents[0].goals_m.len(), agents[1].goals_m.len()), (2, 0, 1));
    fs::write(&path, body("")).unwrap();
    let message = read(&path).unwrap_err().to_string();
    let expected = "starts.txt:2: the line states no goal, and the agents have no `state`; write `x y goal_x goal_y`, in metres; with a `state`, `x y` is enough";
    assert!(message.ends_with(expected), "{message}");
}

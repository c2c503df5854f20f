//! Menge projects: what becomes of each feature, and mistakes at their lines.

mod support;

use std::fs;
use std::path::Path;

use fbcrowd_scenes::{ReadOptions, read};
use support::{Project, SCENE, projects, written};

fn check_contains(text: &str, parts: &[&str]) {
    for part in parts {
        assert!(text.contains(part), "{part}\nis missing in\n{text}");
    }
}

/// The error of the project with a part of a file replaced.
fn check_refused(file: &str, from: &str, to: &str, words: &[&str]) {
    let error = Project::with(file, from, to).read().expect_err(to).to_string();
    check_contains(&error, words);
}

#[test]
fn a_project_reads_as_if_written_by_hand() {
    let (written, _) = Project::new(&[]).converted();
    check_contains(
        &written.scenario,
        &[
            "duration_s = 90\nseed = 7\n",
            "[profiles.adult]                        # fair/scene.xml:5\npreferred_speed_mps = 1.2\nradius_m = 0.25\n",
            "[profiles.child]                        # fair/scene.xml:11\ninherits = \"adult\"\npreferred_speed_mps = { uniform = [0.8, 1.1] }\nradius_m = 0.15\n",
            "grid = { columns = 3, rows = 2, spacing_m = 2, centre_m = [-2, 1], jitter_m = 0.141 }\nprofile = \"adult\"\n",
            "at_m = [5, 5]\nprofile = { adult = 3, child = 1 }\nstate = \"Visit\"\n",
            "polygon_m = [[8, 8], [9, 8], [9, 9], [8, 9]]\n",
            "kind = \"enclosure\"\npolygon_m = [[-20, -20], [-20, 20], [20, 20], [20, -20]]\n",
            "[view]\nwidth = 320\nheight = 200\n",
        ],
    );
    assert!(!written.scenario.contains("alike") && written.agent_files.is_empty());
}

#[test]
fn states_keep_their_names_goals_and_transitions() {
    let (written, _) = Project::new(&[]).converted();
    check_contains(
        &written.scenario,
        &[
            "[goals.set_4]                           # fair/behaviour.xml:3\nchoose = \"weighted\"\n",
            "    { rect_m = [10, 0, 12, 1], capacity = 2, weight = 3 },\n    { circle_m = [-10, 0, 0.5] },\n",
            "    { polygon_m = [[0, 12], [0, 14], [-1, 14], [-1, 12]] },\n",
            "[goals.set_4_goal_1]",
            "[states.Visit]\ngo = \"set_4\"\nset = { speed_factor = 0.5, remain = true }\nthen = [\n    { when = { reached_m = 0.4 }, to = \"Look\" },\n",
            "{ when = { after_s = { normal = [5, 2], min = 1, max = 9 } }, to = { Visit = 2, Home = 1 } }",
            "then = [{ when = { all = [{ inside = \"area_1\" }, { not = { not = { inside = \"area_2\" } } }] }, to = \"End\" }]\n",
            "[states.End]                            # final\nstand = {}\n",
            "[areas.area_1]\ncircle_m = [-10, 0, 2]\n",
        ],
    );
}

#[test]
fn what_is_not_supported_is_noted_with_its_line() {
    let (_, notes) = Project::new(&[]).converted();
    let noted = notes.join("\n");
    check_contains(
        &noted,
        &[
            "\n29: no agent sees the obstacles of class 2",
            "\n16: routes are found between the obstacles, not on the road map",
            "20: 1 of 2 agents start in walls or in each other and move: [8.5, 8.5] to ",
            "!3: goal set 4 is picked in several ways; each counts its capacity apart",
        ],
    );
}

/// Scene of the project with a mesh as its obstacles, and a second generator in a group.
fn with_mesh(mesh: &str) -> Project {
    let scene = SCENE.replace("</Experiment>", "<ObstacleSet type=\"nav_mesh\" file_name=\"m.nav\"/></Experiment>");
    let scene = scene.replace(
        "<Generator type=\"explicit\">",
        "<Generator type=\"explicit\"><Agent p_x=\"-5\" p_y=\"-5\"/></Generator>\n    <Generator type=\"explicit\">",
    );
    Project::new(&[("fair/scene.xml", &scene), ("fair/m.nav", mesh)])
}

#[test]
fn rows_beside_a_stair_are_ground_and_every_generator_adds_agents() {
    // A floor, a stair that ends beside it, and a row of seats along a part of the stair's side.
    let mesh = "12  -20 -20  20 -20  20 0  -20 0   -1 0  1 0  1 8  -1 8   1 3  9 3  9 4  1 4
        2  4 5 0 1  8 11 1 2
        3  0 1 0 1  1 2 0 2  2 3 0 0
        stadium 3
        0 -10  4 0 1 2 3  0 0 0  1 0  3 0 1 2
        0 4  4 4 5 6 7  0 1 0  2 0 1  0
        5 3.5  4 8 9 10 11  0 0 3  1 1  0";
    let (written, _) = with_mesh(mesh).converted();
    let scenario: toml::Value = toml::from_str(&written.scenario).unwrap();
    let number = |value: &toml::Value| value.as_float().or(value.as_integer().map(|whole| whole as f64)).unwrap();
    let walkable = scenario["walkable"].as_array().unwrap();
    let corner = |corner: &toml::Value| [number(&corner[0]), number(&corner[1])];
    let mut corners: Vec<[f64; 2]> = walkable[0]["polygon_m"].as_array().unwrap().iter().map(corner).collect();
    corners.sort_by(|a, b| a.partial_cmp(b).unwrap());
    let low = [[-20.0, -20.0], [-20.0, 0.0], [-1.0, 0.0], [-1.0, 8.0], [1.0, 0.0], [1.0, 3.0], [1.0, 4.0], [1.0, 8.0]];
    let high = [[9.0, 3.0], [9.0, 4.0], [20.0, -20.0], [20.0, 0.0]];
    assert_eq!((walkable.len(), corners), (1, [&low[..], &high].concat()));
    check_contains(&written.scenario, &["at_m = [-5, -5]\n", "at_m = [5, 3.8]\n"]);
}

#[test]
fn a_wall_within_a_mesh_is_thin_and_stands() {
    let mesh = "6  -20 -20  0 -20  20 -20  20 20  0 20  -20 20  0  7
        0 1 0 0  1 2 1 0  2 3 1 0  3 4 1 0  4 5 0 0  5 0 0 0  1 4 0 -1
        hall 2
        -10 0  4 0 1 4 5  0 0 0  0  4 0 4 5 6
        10 0  4 1 2 3 4  0 0 0  0  4 1 2 3 6";
    let (written, notes) = with_mesh(mesh).converted();
    check_contains(&written.scenario, &["[[0.01, -20.01], [0.01, 20.01], [-0.01, 20.01], [-0.01, -20.01]]"]);
    check_contains(&notes.join("\n"), &["walls within the mesh become 2 cm thick"]);
}

#[test]
fn long_lists_of_agents_become_a_file() {
    let agents: String = (0..30).map(|index| format!("<Agent p_x=\"{index}.50\" p_y=\"-4\"/>")).collect();
    let project = Project::with("fair/scene.xml", "<Agent p_x=\"5\" p_y=\"5\"/>", &agents);
    let (written, _) = project.converted();
    check_contains(&written.scenario, &["file = \"fair_agents.txt\"\n"]);
    let file = &written.agent_files[0];
    assert_eq!((file.name.as_str(), file.text.lines().count()), ("fair_agents.txt", 32));
    check_contains(&file.text, &["\n0.5 -4\n"]);
}

#[test]
fn selectors_find_their_form() {
    let check = |selector: &str, parts: &[&str]| {
        let project = Project::with("fair/behaviour.xml", "<GoalSelector type=\"weighted\" goal_set=\"4\"/>", selector);
        check_contains(&project.converted().0.scenario, parts);
    };
    check(
        "<GoalSelector type=\"nearest\" goal_set=\"4\" persistent=\"1\"/>",
        &["choose = \"nearest\"", "remember = true"],
    );
    check("<GoalSelector type=\"farthest\" goal_set=\"4\"/>", &["choose = \"farthest\""]);
    check("<GoalSelector type=\"random\" goal_set=\"4\"/>", &["choose = \"random\""]);
    check("<GoalSelector type=\"mirror\" mirror_x=\"1\" mirror_y=\"1\"/>", &["go = { mirror_m = [0, 0] }"]);
    check(
        "<GoalSelector type=\"mirror\" mirror_x=\"1\" mirror_y=\"0\"/>",
        &["go = \"own_path\"", "goals_m = [[-5, 5]]"],
    );
    check(
        "<GoalSelector type=\"offset\" dist=\"c\" x_value=\"3\" y_value=\"-1.5\"/>",
        &["go = { offset_m = [3, -1.5] }"],
    );
    check(
        "<GoalSelector type=\"shared\" state_name=\"Home\"/>",
        &["go = \"set_4_goal_1\"\nremember = \"Home\"", "remember = true"],
    );
}

#[test]
fn velocities_and_actions_find_their_form() {
    let check = |from: &str, to: &str, parts: &[&str]| {
        check_contains(&Project::with("fair/behaviour.xml", from, to).converted().0.scenario, parts);
    };
    let zero = "<VelComponent type=\"zero\"/>";
    check(zero, "<VelComponent type=\"const\" x=\"0.5\" y=\"-1\"/>", &["walk_mps = [0.5, -1]"]);
    check(zero, "<VelComponent type=\"const_dir\" x=\"0\" y=\"2\"/>", &["walk_mps = [0, 1.117]"]);
    let action = "<Action type=\"scale_property\" property=\"pref_speed\" dist=\"c\" value=\"0.5\" exit_reset=\"0\"/>";
    check(
        action,
        "<Action type=\"set_property\" property=\"r\" dist=\"u\" min=\"0.2\" max=\"0.3\"/>",
        &["set = { radius_m = { uniform = [0.2, 0.3] } }"],
    );
    check(
        action,
        "<Action type=\"teleport\" dist=\"u\" min_x=\"1\" max_x=\"0\" min_y=\"-3\" max_y=\"-2\"/>",
        &["set = { teleport = { rect_m = [0, -3, 1, -2] } }"],
    );
}

#[test]
fn mistakes_are_shown_at_their_line() {
    check_refused(
        "fair/scene.xml",
        "inherits=\"adult\">\n    <Common class",
        "inherits=\"alike\">\n    <Common class",
        &["scene.xml:8", "does not come before it"],
    );
    check_refused("fair/scene.xml", "name=\"Visit\"", "name=\"Nowhere\"", &["Nowhere", "scene.xml:14"]);
    check_refused("fair/scene.xml", "offset_x=\"-2\"", "offset_x=\"two\"", &["scene.xml:17", "no finite number"]);
    check_refused("fair/scene.xml", "count_x=\"3\"", "count_x=\"3000000\"", &["scene.xml:17", "more than a million"]);
    check_refused("fair/scene.xml", "p_x=\"5\"", "p_x=\"1e9\"", &["scene.xml:23", "10 km"]);
    check_refused("fair/scene.xml", "</Experiment>", "", &["no XML"]);
    check_refused("fair/behaviour.xml", "goal=\"1\"", "goal=\"9\"", &["behaviour.xml:15", "no goal 9"]);
    check_refused("fair/behaviour.xml", "to=\"Look\"", "to=\"Lok\"", &["behaviour.xml:19", "no state `Lok`"]);
    check_refused("fair/behaviour.xml", "roads.txt", "missing.txt", &["behaviour.xml:16", "does not exist"]);
    check_refused("fair.xml", "fair/scene.xml", "fair/none.xml", &["fair.xml:2", "does not exist"]);
    check_refused("fair.xml", "<Project", "<Thing", &["fair.xml:2", "<Project>"]);
}

#[test]
fn entities_are_refused() {
    let bomb = "<?xml version=\"1.0\"?><!DOCTYPE a [<!ENTITY a \"ha\"><!ENTITY b \"&a;&a;&a;&a;\">]><Experiment>&b;</Experiment>";
    let error = Project::new(&[("fair/scene.xml", bomb)]).read().unwrap_err().to_string();
    check_contains(&error, &["scene.xml:1", "document type"]);
}

#[test]
fn files_outside_the_folder_need_permission() {
    let project = Project::with("fair/behaviour.xml", "roads.txt", "../../roads_of_others.txt");
    let outside = project.0.path().parent().unwrap().join("roads_of_others.txt");
    fs::write(&outside, "0\n0\n").unwrap();
    let error = project.read().unwrap_err().to_string();
    check_contains(&error, &["behaviour.xml:16", "outside the project's folder", "--allow-outside"]);
    let allowed = read(&project.path(), &ReadOptions { allow_outside: true, ..ReadOptions::default() });
    fs::remove_file(outside).unwrap();
    assert!(allowed.is_ok());
}

#[test]
fn names_cannot_break_out_of_the_text() {
    let name = "a&quot;]&#10;[evil&#10;x = &quot;";
    let scene = support::SCENE.replace("\"Visit\"", &format!("\"{name}\""));
    let behaviour = support::BEHAVIOUR.replace("name=\"Visit\"", &format!("name=\"{name}\""));
    let behaviour = behaviour.replace("from=\"Visit\"", &format!("from=\"{name}\"")).replace("Look, Visit", "Look");
    let project = Project::new(&[("fair/scene.xml", &scene), ("fair/behaviour.xml", &behaviour)]);
    let table: toml::Table = toml::from_str(&project.converted().0.scenario).unwrap();
    assert!(!table.contains_key("evil") && table["states"].as_table().unwrap().contains_key("a\"]\n[evil\nx = \""));
}

#[test]
#[ignore = "needs other people's projects: set FBCROWD_MENGE to a folder of them"]
fn all_projects_of_others_are_converted() {
    let folder = std::env::var("FBCROWD_MENGE").expect("FBCROWD_MENGE names a folder");
    let all = projects(Path::new(&folder));
    assert!(!all.is_empty());
    for path in all {
        let read = read(&path, &ReadOptions { allow_outside: true, ..ReadOptions::default() });
        match read {
            Ok(read) => {
                let (written, notes) = written(&read);
                let bytes: usize = written.agent_files.iter().map(|file| file.text.len()).sum();
                println!(
                    "{}: {} agents, {} states, {} obstacles, {} walkable, {} + {bytes} bytes",
                    path.display(),
                    read.scene.agent_count(),
                    read.scene.states.len(),
                    read.scene.obstacles.len(),
                    read.scene.walkable.len(),
                    written.scenario.len(),
                );
                notes.iter().for_each(|note| println!("    {note}"));
            }
            // One of Menge's own is no XML.
            Err(error) => assert!(error.to_string().contains("no XML"), "{error}"),
        }
    }
}

#[test]
fn priorities_of_profiles_are_noted() {
    let notes = |priority: &str| {
        let (from, to) = ("obstacleSet=\"1\"", format!("obstacleSet=\"1\" priority=\"{priority}\""));
        Project::with("fair/scene.xml", from, &to).converted().1.join("\n")
    };
    assert!(!notes("0.0").contains("priorities"));
    check_contains(&notes("0.5"), &["6: priorities are not used"]);
}

/// The scenario of the made-up project with actions in the state `Look`, where agents stand, and its notes.
fn with_actions_in_look(actions: &str) -> (String, String) {
    let from = "<State name=\"Look\" final=\"0\">";
    let (written, notes) = Project::with("fair/behaviour.xml", from, &format!("{from}{actions}")).converted();
    (written.scenario, notes.join("\n"))
}

#[test]
fn obstacles_that_agents_see_in_some_states_become_zones() {
    let solid = "polygon_m = [[8, 8], [9, 8], [9, 9], [8, 9]]";
    let other = "polygon_m = [[1, -9], [2, -9], [2, -8]]";
    let (set, notes) = with_actions_in_look("<Action type=\"set_obstacle\" operand=\"2\"/>");
    check_contains(&set, &[&format!("{solid}\nclosed_in = [\"Visit\", \"Home\", \"End\"]\n")]);
    check_contains(&set, &[&format!("{other}\nclosed_in = [\"Look\"]\n"), "kind = \"enclosure\""]);
    check_contains(&notes, &["agents see the walls around them in all states here"]);
    assert!(!notes.contains("of class"), "{notes}");
    let (add, _) = with_actions_in_look("<Action type=\"add_obstacle\" operand=\"2\"/>");
    check_contains(&add, &[&format!("[[obstacles]]                           # fair/scene.xml:26\n{solid}\n")]);
    check_contains(&add, &[&format!("{other}\nclosed_in = [\"Look\"]\n")]);
    let (remove, notes) = with_actions_in_look("<Action type=\"remove_obstacle\" operand=\"3\" exit_reset=\"0\"/>");
    check_contains(&remove, &[&format!("{solid}\nclosed_in = [\"Visit\", \"Home\", \"End\"]\n")]);
    check_contains(&notes, &["ends with the state here", "no agent sees the obstacles of class 2"]);
    let actions = "<State name=\"Look\" final=\"0\"><Action type=\"add_obstacle\"/>";
    check_refused(
        "fair/behaviour.xml",
        "<State name=\"Look\" final=\"0\">",
        actions,
        &["behaviour.xml:13", "no `operand`"],
    );
}

//! The tables of profiles, agents and sources.

use crate::scene::{Grid, Scene, SceneAgents, SceneSource, Shape, SourceTimes, Starts};
use crate::write::example::example;
use crate::write::text_file::TextFile;
use crate::write::words::{commented, drawn, key, number, plain, point, quoted, shape};

/// Agents of a group that are written as tables of their own; more become an agent file.
const TABLES_MAX: usize = 6;
/// Rows of a schedule in a line.
const ROWS_IN_LINE: usize = 8;

/// The tables `[profiles.NAME]`.
pub(crate) fn profiles(scene: &Scene) -> String {
    let mut text = String::new();
    for profile in &scene.profiles {
        text += &commented(&format!("[profiles.{}]", key(&profile.name)), &profile.origin);
        if let Some(parent) = &profile.inherits {
            text += &format!("inherits = {}\n", quoted(parent));
        }
        if let Some(speed_mps) = profile.preferred_speed_mps {
            text += &format!("preferred_speed_mps = {}\n", drawn(speed_mps));
        }
        if let Some(radius_m) = profile.radius_m {
            text += &format!("radius_m = {}\n", drawn(radius_m));
        }
        text.push('\n');
    }
    text
}

/// The tables `[[agents]]`; long groups become agent files.
pub(crate) fn agents(scene: &Scene, stem: &str, files: &mut Vec<TextFile>) -> String {
    if scene.agents.is_empty() && scene.sources.is_empty() {
        return example(scene);
    }
    let is_long =
        |agents: &&SceneAgents| matches!(&agents.starts, Starts::Points(starts_m) if starts_m.len() > TABLES_MAX);
    let long = scene.agents.iter().filter(is_long).count();
    let mut text = String::new();
    for group in &scene.agents {
        match &group.starts {
            Starts::Grid(grid) => text += &table(&grid_text(grid), group, &group.origin),
            Starts::Spread { shape: area, count } => {
                text += &table(&format!("area = {{ {}, count = {count} }}", shape(area)), group, &group.origin);
            }
            Starts::Points(starts_m) if starts_m.len() <= TABLES_MAX => {
                for (index, &start_m) in starts_m.iter().enumerate() {
                    let origin = if index == 0 { group.origin.as_str() } else { "" };
                    let goal = group.own_goal_m(start_m);
                    let goal = goal.map_or_else(String::new, |goal_m| format!("\ngoals_m = [{}]", point(goal_m)));
                    text += &table(&format!("at_m = {}{goal}", point(start_m)), group, origin);
                }
            }
            Starts::Points(starts_m) => {
                let name = match long {
                    1 => format!("{stem}_agents.txt"),
                    _ => format!("{stem}_agents_{}.txt", files.len() + 1),
                };
                let line = |&start_m: &[f64; 2]| {
                    let goal_m = group.own_goal_m(start_m);
                    let numbers = start_m.into_iter().chain(goal_m.into_iter().flatten()).map(number);
                    numbers.collect::<Vec<_>>().join(" ") + "\n"
                };
                let what = if group.own_goal_mirrors.is_some() { "x y goal_x goal_y" } else { "x y" };
                let head = format!("# {}: {what}\n", plain(&group.origin));
                text += &table(&format!("file = {}", quoted(&name)), group, &group.origin);
                files.push(TextFile { name, text: head + &starts_m.iter().map(line).collect::<String>() });
            }
        }
    }
    text
}

fn table(starts: &str, group: &SceneAgents, origin: &str) -> String {
    let mut text = commented("[[agents]]", origin) + starts + "\n";
    match &group.profiles[..] {
        [] => {}
        [(only, _)] => text += &format!("profile = {}\n", quoted(only)),
        several => {
            let shares: Vec<String> =
                several.iter().map(|(name, weight)| format!("{} = {}", key(name), number(*weight))).collect();
            text += &format!("profile = {{ {} }}\n", shares.join(", "));
        }
    }
    if let Some(wall_radius_m) = group.wall_radius_m {
        text += &format!("wall_radius_m = {}\n", number(wall_radius_m));
    }
    if let Some(state) = &group.state {
        text += &format!("state = {}\n", quoted(state));
    }
    text + "\n"
}

fn grid_text(grid: &Grid) -> String {
    let Grid { columns, rows, spacing_m, centre_m, jitter_m } = *grid;
    let jitter = if jitter_m > 0.0 { format!(", jitter_m = {}", number(jitter_m)) } else { String::new() };
    let (spacing, centre) = (number(spacing_m), point(centre_m));
    format!("grid = {{ columns = {columns}, rows = {rows}, spacing_m = {spacing}, centre_m = {centre}{jitter} }}")
}

/// The tables `[[sources]]`.
pub(crate) fn sources(scene: &Scene) -> String {
    scene.sources.iter().map(source).collect()
}

fn source(source: &SceneSource) -> String {
    let area = match &source.shape {
        Shape::Point(at_m) => format!("at_m = {}", point(*at_m)),
        area => shape(area),
    };
    let mut text = commented("[[sources]]", &source.origin) + &area + "\n" + &times(&source.times);
    if let Some(profile) = &source.profile {
        text += &format!("profile = {}\n", quoted(profile));
    }
    if let Some(state) = &source.state {
        text += &format!("state = {}\n", quoted(state));
    }
    text + "\n"
}

fn times(times: &SourceTimes) -> String {
    match times {
        SourceTimes::Rate { rate_per_s, from_s, to_s, count } => {
            let from = if *from_s > 0.0 { format!("from_s = {}\n", number(*from_s)) } else { String::new() };
            let count = count.map_or_else(String::new, |count| format!("count = {count}\n"));
            format!("rate_per_s = {}\n{from}to_s = {}\n{count}", number(*rate_per_s), number(*to_s))
        }
        SourceTimes::Stated(rows) => {
            let row = |(time_s, count): &(f64, u64)| format!("[{}, {count}]", number(*time_s));
            let line = |rows: &[(f64, u64)]| rows.iter().map(row).collect::<Vec<_>>().join(", ");
            let lines: Vec<String> = rows.chunks(ROWS_IN_LINE).map(line).collect();
            match &lines[..] {
                [only] => format!("schedule = [{only}]\n"),
                _ => format!("schedule = [\n    {},\n]\n", lines.join(",\n    ")),
            }
        }
    }
}

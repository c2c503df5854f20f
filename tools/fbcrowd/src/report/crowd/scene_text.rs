//! The text of `fbcrowd check`.

use fbcrowd_jobs::scene_check::{ClosedPassageFigures, MeshFigures, SceneFigures};
use fbcrowd_jobs::wording::counted;

/// Greatest number of closed passages that are listed.
const PASSAGES_LISTED: usize = 10;

/// One figure a line.
pub(crate) fn text(figures: &SceneFigures) -> String {
    let lines = [
        ("agents", agents(figures)),
        ("duration", format!("{} s in {} of {:.4} s", figures.duration_s, steps(figures), figures.dt_s)),
        ("ground", ground(figures)),
        ("routes", routes(figures)),
        ("memory", format!("about {}, beside the database", size(figures.memory_mib))),
        ("recording", format!("about {}", size(figures.recording_mib))),
    ];
    let lines = lines.map(|(name, value)| line(name, &value)).concat();
    let barred = figures.barred_goals.iter().map(|barred| line("closed goals", &barred.text));
    let notes = figures.notes.iter().map(|note| line("note", note));
    lines + &barred.chain(notes).collect::<String>() + &closed_passages(&figures.closed_passages)
}

fn line(name: &str, value: &str) -> String {
    format!("{name:<17}{value}\n")
}

fn steps(figures: &SceneFigures) -> String {
    counted(figures.steps, "step", "steps")
}

fn agents(figures: &SceneFigures) -> String {
    let SceneFigures { agents, due_agents, sources, .. } = *figures;
    match sources {
        0 => format!("{agents}"),
        _ => format!("{agents}, and {due_agents} from {}", counted(sources, "source", "sources")),
    }
}

fn ground(figures: &SceneFigures) -> String {
    let obstacles = counted(figures.obstacles, "obstacle", "obstacles");
    match figures.walkable {
        0 => format!("open, {obstacles}"),
        count => format!("{}, {obstacles}", counted(count, "walkable polygon", "walkable polygons")),
    }
}

fn routes(figures: &SceneFigures) -> String {
    let mesh = |mesh: &MeshFigures| {
        let parts = counted(mesh.parts as usize, "part", "parts");
        format!(
            "{} in {parts}, {:.2} m from walls",
            counted(mesh.triangles, "triangle", "triangles"),
            mesh.wall_radius_m
        )
    };
    match figures.meshes.iter().map(mesh).collect::<Vec<_>>().join("; ") {
        empty if empty.is_empty() => "straight".to_owned(),
        meshes => meshes,
    }
}

fn size(mib: f64) -> String {
    if mib < 1024.0 { format!("{mib:.1} MiB") } else { format!("{:.1} GiB", mib / 1024.0) }
}

fn closed_passages(passages: &[ClosedPassageFigures]) -> String {
    let listed = passages.iter().take(PASSAGES_LISTED).map(|passage| {
        let [x, y] = passage.at_m;
        let detour = if passage.separates { "" } else { ", with a detour around it" };
        let ClosedPassageFigures { width_m, wall_radius_m, .. } = passage;
        line(
            "closed passage",
            &format!("[{x:.2}, {y:.2}], {width_m:.2} m wide, wall radius {wall_radius_m:.2} m{detour}"),
        )
    });
    let rest = passages.len().saturating_sub(PASSAGES_LISTED);
    let rest = if rest == 0 { String::new() } else { line("", &format!("and {rest} more")) };
    listed.collect::<String>() + &rest
}

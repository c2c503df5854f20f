//! The plan of a scenario before it is simulated: ground, markings, walls, the mesh that routes use, the routes of
//! agents, sources, goals and closed passages. World axes, metres.

use fbcrowd_sim::route::{ClosedToAgents, CrowdRoutes};
use fbcrowd_sim::scenario::{Scenario, SourceSpec, ZoneSpec};
use glam::Vec2;
use tiny_skia::Pixmap;

use crate::plots::chart::figure::{LegendEntry, LineStyle, PlotFigure, PlotPanel};
use crate::plots::chart::mark::PlotMark;
use crate::plots::crowd::trajectories::PathScene;
use crate::raster::palette::{
    HOLDING_SET, INK, OBSTACLE, OBSTACLE_RIM, Rgb, SHARP_TURN_EDGES, SIDES, TURNING_SET, line_colour,
};
use crate::raster::text::TextAnchor;

/// Width of the figure, pixels.
const WIDTH_PX: u32 = 1600;
/// Left, top and width of the axes, pixels.
const PANEL_LEFT_TOP_WIDTH_PX: [f32; 3] = [130.0, 190.0, 1410.0];
/// Margin below the axes, pixels.
const BELOW_PX: f32 = 120.0;
/// Left end of the title's baseline, pixels.
const TITLE_PX: Vec2 = Vec2::new(130.0, 70.0);
/// Left end of the legend's baseline, pixels.
const LEGEND_PX: Vec2 = Vec2::new(140.0, 122.0);
/// Least and greatest height of the axes, which follows the scene's, pixels.
const PANEL_HEIGHTS_PX: [f32; 2] = [480.0, 1600.0];
/// Greatest number of routes and of starts that are drawn: evenly spread over the agents.
const AGENTS_DRAWN: usize = 300;
/// Greatest number of closed passages whose widths are written.
const PASSAGES_NAMED: usize = 40;
/// Greatest number of the mesh's edges that are drawn; a denser mesh is a grey area.
const EDGES_DRAWN: usize = 60_000;
/// A kind of zones beside the one-way ones.
struct ZoneKind {
    name: &'static str,
    colour: Rgb,
    holds: fn(&ZoneSpec) -> bool,
}

/// The kinds; a zone is of the first that holds it.
const ZONE_KINDS: [ZoneKind; 2] = [
    ZoneKind { name: "closed zone", colour: HOLDING_SET, holds: |zone| zone.is_closed },
    ZoneKind { name: "zone of another speed", colour: SIDES[0], holds: |zone| zone.speed_factor != 1.0 },
];
/// Radius of the marks of a start, a goal and a closed passage, pixels.
const MARKS_PX: [f32; 3] = [4.5, 7.0, 11.0];

/// The plan of a scenario.
///
/// ```
/// use fbcrowd_render::plots::crowd::scene_plan;
/// use fbcrowd_sim::route::{CrowdRoutes, closed_to_agents};
/// use fbcrowd_sim::scenario::{AgentSpec, Scenario};
/// use glam::Vec2;
///
/// # fn main() -> Result<(), fbcrowd_sim::route::mesh::RouteError> {
/// let agent = AgentSpec { goals_m: vec![Vec2::new(8.0, 0.0)], ..AgentSpec::default() };
/// let wall_m = [[4.0, -2.0], [4.2, -2.0], [4.2, 1.0], [4.0, 1.0]].map(Vec2::from).to_vec();
/// let scenario = Scenario { obstacles_m: vec![wall_m], ..Scenario::of(vec![agent]) };
/// let plan = scene_plan(&scenario, &CrowdRoutes::new(&scenario)?, &closed_to_agents(&scenario));
/// assert_eq!(plan.width(), 1600);
/// # Ok(())
/// # }
/// ```
pub fn scene_plan(scenario: &Scenario, routes: &CrowdRoutes, closed: &[ClosedToAgents]) -> Pixmap {
    let scene = PathScene::new(scenario, &[]);
    let [left, top, width] = PANEL_LEFT_TOP_WIDTH_PX;
    let height = scene.height_px(width, PANEL_HEIGHTS_PX);
    let mut figure = PlotFigure::new([WIDTH_PX, (top + height + BELOW_PX) as u32]);
    figure.title(&title(scenario), TITLE_PX);
    figure.legend(LEGEND_PX, &legend(scenario, closed));
    let panel = scene.draw_place(&mut figure, [left, top, width, height]);
    draw_mesh(&mut figure, &panel, routes);
    draw_other_zones(&mut figure, &panel, scenario);
    draw_one_way_zones(&mut figure, &panel, scenario);
    draw_routes(&mut figure, &panel, scenario, routes);
    for source in &scenario.sources {
        draw_source(&mut figure, &panel, source, routes);
    }
    draw_starts_and_goals(&mut figure, &panel, scenario);
    draw_closed(&mut figure, &panel, closed);
    scene.draw_labels(&mut figure, &panel);
    figure.pixmap
}

fn title(scenario: &Scenario) -> String {
    let agents = match scenario.agents.len() {
        1 => "1 agent".to_owned(),
        count => format!("{count} agents"),
    };
    let sources = match scenario.sources.len() {
        0 => String::new(),
        1 => ", 1 source".to_owned(),
        count => format!(", {count} sources"),
    };
    let drawn = if scenario.agents.len() > AGENTS_DRAWN { format!(", {AGENTS_DRAWN} drawn") } else { String::new() };
    format!("{}: {agents}{drawn}{sources}, {:.1} s", scenario.name, scenario.duration_s)
}

fn legend(scenario: &Scenario, closed: &[ClosedToAgents]) -> Vec<LegendEntry<'static>> {
    let mut entries =
        vec![(PlotMark::Disc, INK, "start"), (PlotMark::Cross, INK, "goal"), (PlotMark::Bar, INK, "route")];
    if !scenario.sources.is_empty() {
        entries.push((PlotMark::Dashes, TURNING_SET, "source"));
    }
    if scenario.goal_areas().next().is_some() {
        entries.push((PlotMark::Dashes, INK, "goal area"));
    }
    if !scenario.is_open() {
        entries.push((PlotMark::Bar, OBSTACLE, "mesh for routes"));
    }
    if scenario.zones.iter().any(|zone| zone.one_way_deg.is_some()) {
        entries.push((PlotMark::Dashes, SHARP_TURN_EDGES, "one-way zone"));
    }
    let shown = ZONE_KINDS.iter().filter(|kind| scenario.zones.iter().any(kind.holds));
    entries.extend(shown.map(|kind| (PlotMark::Dashes, kind.colour, kind.name)));
    if !scenario.doors.is_empty() {
        entries.push((PlotMark::Dashes, OBSTACLE_RIM, "door"));
    }
    if !closed.is_empty() {
        entries.push((PlotMark::Ring, SHARP_TURN_EDGES, "closed passage, m"));
    }
    entries
}

/// Draws the triangles of the finest mesh thinly, and the borders of free space of all meshes.
fn draw_mesh(figure: &mut PlotFigure, panel: &PlotPanel, routes: &CrowdRoutes) {
    if let Some((_, mesh)) = routes.meshes().next()
        && 3 * mesh.triangle_count() <= EDGES_DRAWN
    {
        let inner = mesh.edges_m().filter(|(_, is_border)| !is_border).map(|(ends_m, _)| ends_m);
        figure.hatching(panel, inner, LineStyle { opacity: 0.8, ..LineStyle::solid(OBSTACLE, 1.0) });
    }
    for (_, mesh) in routes.meshes() {
        let border = mesh.edges_m().filter(|(_, is_border)| *is_border).map(|(ends_m, _)| ends_m);
        figure.hatching(panel, border, LineStyle { opacity: 0.7, ..LineStyle::solid(TURNING_SET, 1.0) });
    }
}

/// Draws the outlines of zones that are closed to some agents, and of those in which agents change their speed.
fn draw_other_zones(figure: &mut PlotFigure, panel: &PlotPanel, scenario: &Scenario) {
    for zone in &scenario.zones {
        if let Some(kind) = ZONE_KINDS.iter().find(|kind| (kind.holds)(zone)) {
            let outline_m = zone.area.outline_m();
            let line = LineStyle { is_dashed: true, ..LineStyle::solid(kind.colour, 1.6) };
            figure.polyline(panel, outline_m.iter().chain(outline_m.first()).copied(), line);
        }
    }
}

/// Draws the outlines and directions of one-way zones.
fn draw_one_way_zones(figure: &mut PlotFigure, panel: &PlotPanel, scenario: &Scenario) {
    let line = LineStyle { is_dashed: true, ..LineStyle::solid(SHARP_TURN_EDGES, 1.6) };
    for zone in scenario.one_way_zones() {
        let [first_m, ..] = zone.corners_m;
        figure.polyline(panel, zone.corners_m.into_iter().chain([first_m]), line);
        for corners_m in zone.chevrons_m() {
            figure.polygon(
                panel,
                corners_m,
                0.3,
                LineStyle { opacity: 0.3, ..LineStyle::solid(SHARP_TURN_EDGES, 0.5) },
            );
        }
    }
}

/// Indices of the agents that are drawn.
fn drawn(count: usize) -> impl Iterator<Item = usize> {
    let step = count.div_ceil(AGENTS_DRAWN).max(1);
    (0..count).step_by(step)
}

fn draw_routes(figure: &mut PlotFigure, panel: &PlotPanel, scenario: &Scenario, routes: &CrowdRoutes) {
    for index in drawn(scenario.agents.len()) {
        draw_route(figure, panel, routes.route_m(&scenario.agents[index]), line_colour(index));
    }
}

fn draw_route(figure: &mut PlotFigure, panel: &PlotPanel, route_m: Option<Vec<Vec2>>, colour: Rgb) {
    figure.polyline(panel, route_m.unwrap_or_default(), LineStyle { opacity: 0.55, ..LineStyle::solid(colour, 1.6) });
}

/// Draws the area in which a source places agents, and the route from its middle.
fn draw_source(figure: &mut PlotFigure, panel: &PlotPanel, source: &SourceSpec, routes: &CrowdRoutes) {
    let outline_m = source.outline_m();
    figure.polyline(
        panel,
        outline_m.iter().chain(outline_m.first()).copied(),
        LineStyle { is_dashed: true, ..LineStyle::solid(TURNING_SET, 2.0) },
    );
    draw_route(figure, panel, routes.route_m(&source.agent(source.middle_m())), TURNING_SET);
    if let Some(&goal_m) = source.goals_m.last() {
        figure.mark(panel, goal_m, PlotMark::Cross, MARKS_PX[1], TURNING_SET);
    }
}

fn draw_starts_and_goals(figure: &mut PlotFigure, panel: &PlotPanel, scenario: &Scenario) {
    for index in drawn(scenario.agents.len()) {
        let (agent, colour) = (&scenario.agents[index], line_colour(index));
        figure.mark(panel, agent.position_m, PlotMark::Disc, MARKS_PX[0], colour);
        if let Some(&goal_m) = agent.goals_m.last() {
            figure.mark(panel, goal_m, PlotMark::Cross, MARKS_PX[1], colour);
        }
    }
}

/// Draws a ring around each closed passage, with its width.
fn draw_closed(figure: &mut PlotFigure, panel: &PlotPanel, closed: &[ClosedToAgents]) {
    for (index, passage) in closed.iter().flat_map(|closed| &closed.passages).enumerate() {
        figure.mark(panel, passage.at_m, PlotMark::Ring, MARKS_PX[2], SHARP_TURN_EDGES);
        if index < PASSAGES_NAMED {
            let beside_px = panel.to_px(passage.at_m) + Vec2::new(1.4, 0.5) * MARKS_PX[2];
            figure.note(&format!("{:.2}", passage.width_m), beside_px, TextAnchor::Left, SHARP_TURN_EDGES);
        }
    }
}

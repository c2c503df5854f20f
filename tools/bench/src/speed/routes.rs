//! `fbcrowd bench routes`: the time and the memory of finding routes, and whether the results agree with each other.
//!
//! On each ground the free space is united and triangulated, a field is flooded for each of some goals, and agents walk
//! to goals drawn at random; each agent queries its field in each step and remembers its position. Some pairs of
//! positions are searched singly as well: the lengths must agree with those of the fields. Medians count. One thread.

use std::hint::black_box;
use std::time::Instant;

use fbcrowd_jobs::Observer;
use fbcrowd_jobs::observer::Work;
use fbcrowd_sim::maths::SplitMix64;
use fbcrowd_sim::route::field::{RouteField, RouteGoal, RoutePosition, shortest_route};
use fbcrowd_sim::route::mesh::{FreeSpace, RouteMesh, closed_passages};
use glam::Vec2;
use schemars::JsonSchema;
use serde::Serialize;

use crate::error::BenchError;
use crate::kit::report::{BenchReport, Criterion, Goal};
use crate::kit::statistics::median;
use crate::speed::route_grounds::{RouteGround, grounds, uniform};

/// Distance that routes keep from walls, m.
const WALL_RADIUS_M: f32 = 0.2;
/// Times that a ground is built.
const BUILDS: usize = 5;
/// Number of goals, each with a field.
const GOALS: usize = 16;
/// Number of agents that walk.
const AGENTS: usize = 500;
/// Number of steps that they walk.
const STEPS: usize = 200;
/// Distance of a step, m: 1.33 m/s in 0.1 s.
const STEP_M: f32 = 0.133;
/// Number of pairs of positions that are searched singly.
const PAIRS: usize = 100;
/// Greatest relative difference of two lengths of one route, f32.
const DIFFERENCE: f64 = 1e-5;
/// Goals: time of building the streets, ms; of one of their fields, ms; of queries, µs.
const BUILD_MS: f64 = 50.0;
const FIELD_MS: f64 = 20.0;
const QUERY_US: [(&str, &str, f64); 3] = [
    ("room", "query in the room, µs per agent-step", 0.3),
    ("trade show", "query at the trade show, µs per agent-step", 0.3),
    ("streets", "query in the streets, µs per agent-step", 1.0),
];

/// Time routes through a room, a trade show, streets, a maze, a door and a city.
#[derive(clap::Args)]
#[command(after_help = "Example:\n  fbcrowd bench routes --json")]
pub struct Args {
    /// Leave out grounds with more obstacles than this.
    #[arg(long, value_name = "N", default_value_t = 10_000)]
    largest: usize,
}

/// What was measured.
#[derive(JsonSchema, Serialize)]
pub struct Details {
    /// Grounds, in the order of the bench.
    pub grounds: Vec<GroundFigures>,
}

/// Figures of one ground.
#[derive(JsonSchema, Serialize)]
pub struct GroundFigures {
    /// Name of the ground.
    pub ground: &'static str,
    /// Number of obstacles.
    pub obstacles: usize,
    /// Number of the mesh's vertices.
    pub vertices: usize,
    /// Number of the mesh's triangles.
    pub triangles: usize,
    /// Duration of the union and growth of all polygons, ms.
    pub union_ms: f32,
    /// Duration of the triangulation and of the arrays made from it, ms.
    pub mesh_ms: f32,
    /// Duration of the search for passages that are too narrow, ms.
    pub passages_ms: f32,
    /// Number of passages that are too narrow.
    pub closed_passages: usize,
    /// Memory of the mesh, kB.
    pub mesh_kb: f32,
    /// Duration of the field of one goal, ms.
    pub field_ms: f32,
    /// Memory of the field of one goal, kB.
    pub field_kb: f32,
    /// Duration of one query of a walking agent, µs.
    pub query_us: f32,
    /// Duration of one single search, µs.
    pub single_us: f32,
    /// Greatest relative difference between the length of a route in a field, by its corners, and by a single search.
    pub greatest_difference: f64,
    /// Number of queries without route although one exists.
    pub without_route: usize,
}

/// Runs the bench.
///
/// # Errors
/// None today: the grounds are made here.
pub fn run(args: &Args, observer: &Observer) -> Result<BenchReport<Details>, BenchError> {
    let grounds: Vec<RouteGround> =
        grounds().into_iter().filter(|ground| ground.obstacles_m.len() <= args.largest).collect();
    let work = Work::begin(observer, "grounds", grounds.len());
    let figures = grounds.iter().filter_map(|ground| {
        let figures = figures(ground);
        work.advance();
        figures
    });
    let figures: Vec<GroundFigures> = figures.collect();
    work.end();
    let (criteria, goals, details) = (criteria(&figures), goals(&figures), Details { grounds: figures });
    Ok(BenchReport { text: text(&details), details, goals, criteria })
}

fn figures(ground: &RouteGround) -> Option<GroundFigures> {
    let (space, union_ms) = timed_ms(BUILDS, || FreeSpace::new(&ground.ground(), WALL_RADIUS_M));
    let space = space?.ok()?;
    let (mesh, mesh_ms) = timed_ms(BUILDS, || RouteMesh::of(&space));
    let mesh = mesh?.ok()?;
    let (passages, passages_ms) = timed_ms(1, || closed_passages(&ground.ground(), WALL_RADIUS_M, &mesh));
    let mut random = SplitMix64::new(4, 0);
    let mut goals_m = std::iter::repeat_with(|| position(ground, &mesh, &mut random)).take(GOALS);
    let (mut fields, mut field_ms) = (Vec::new(), Vec::new());
    for goal_m in &mut goals_m {
        let (field, duration_ms) = timed_ms(1, || RouteField::new(&mesh, RouteGoal::Points(vec![goal_m])));
        fields.extend(field);
        field_ms.push(duration_ms);
    }
    let walk = walk(ground, &mesh, &fields, &mut random);
    let pairs = compare(ground, &mesh, &fields, &mut random);
    Some(GroundFigures {
        ground: ground.name,
        obstacles: ground.obstacles_m.len(),
        vertices: mesh.vertex_count(),
        triangles: mesh.triangle_count(),
        union_ms,
        mesh_ms,
        passages_ms,
        closed_passages: passages?.ok()?.len(),
        mesh_kb: mesh.bytes() as f32 / 1e3,
        field_ms: median(field_ms.into_iter())?,
        field_kb: median(fields.iter().map(|field| field.bytes() as f32 / 1e3))?,
        query_us: walk.query_us,
        single_us: pairs.single_us,
        greatest_difference: pairs.greatest_difference,
        without_route: walk.without_route,
    })
}

/// The last result of some work that is repeated, and its median duration, ms.
fn timed_ms<T>(times: usize, mut work: impl FnMut() -> T) -> (Option<T>, f32) {
    let (mut result, mut durations_ms) = (None, Vec::new());
    for _ in 0..times {
        let start = Instant::now();
        result = Some(black_box(work()));
        durations_ms.push(start.elapsed().as_secs_f32() * 1e3);
    }
    (result, median(durations_ms.into_iter()).unwrap_or_default())
}

/// A position of the mesh's largest part, drawn at random.
fn position(ground: &RouteGround, mesh: &RouteMesh, random: &mut SplitMix64) -> Vec2 {
    let [low_m, high_m] = ground.area_m;
    let mut drawn_m = || low_m + uniform(random, high_m - low_m);
    (0..1_000).map(|_| drawn_m()).find(|at_m| mesh.largest_part_holds(*at_m)).unwrap_or_default()
}

/// Figures of agents that walk.
struct WalkFigures {
    query_us: f32,
    without_route: usize,
}

struct Walker {
    position_m: Vec2,
    remembered: RoutePosition,
    field: usize,
}

/// Agents that walk to goals, then to the next ones.
fn walk(ground: &RouteGround, mesh: &RouteMesh, fields: &[RouteField], random: &mut SplitMix64) -> WalkFigures {
    let mut walker = |index: usize| Walker {
        position_m: position(ground, mesh, random),
        remembered: RoutePosition::default(),
        field: index % fields.len(),
    };
    let mut walkers: Vec<Walker> = (0..AGENTS).map(&mut walker).collect();
    let (mut durations_us, mut without_route) = (Vec::new(), 0);
    for _ in 0..STEPS {
        let start = Instant::now();
        let steps: Vec<_> = walkers
            .iter_mut()
            .map(|walker| fields[walker.field].step(mesh, walker.position_m, &mut walker.remembered))
            .collect();
        durations_us.push(start.elapsed().as_secs_f32() * 1e6 / AGENTS as f32);
        for (walker, step) in walkers.iter_mut().zip(steps) {
            let Some(step) = step else {
                without_route += 1;
                continue;
            };
            let to_aim_m = step.aim_m(walker.position_m) - walker.position_m;
            walker.position_m += to_aim_m.clamp_length_max(STEP_M);
            if step.distance_m < STEP_M {
                walker.field = (walker.field + 1) % fields.len();
            }
        }
    }
    // The first step finds every agent on the mesh.
    WalkFigures { query_us: median(durations_us.into_iter().skip(1)).unwrap_or_default(), without_route }
}

/// Figures of routes that are found in three ways.
struct PairFigures {
    single_us: f32,
    greatest_difference: f64,
}

fn compare(ground: &RouteGround, mesh: &RouteMesh, fields: &[RouteField], random: &mut SplitMix64) -> PairFigures {
    let (mut durations_us, mut greatest_difference) = (Vec::new(), 0.0_f64);
    for field in fields.iter().cycle().take(PAIRS) {
        let from_m = position(ground, mesh, random);
        let corners_m = field.corners_m(mesh, from_m, &mut RoutePosition::default()).unwrap_or_default();
        let step = field.step(mesh, from_m, &mut RoutePosition::default());
        let Some((&to_m, step)) = corners_m.last().zip(step) else { continue };
        let start = Instant::now();
        let single = black_box(shortest_route(mesh, from_m, to_m));
        durations_us.push(start.elapsed().as_secs_f32() * 1e6);
        let ends_m = std::iter::once(&from_m).chain(&corners_m);
        let by_corners_m: f32 = ends_m.zip(&corners_m).map(|(a_m, b_m)| a_m.distance(*b_m)).sum();
        let single_m = single.map_or(f32::INFINITY, |single| single.length_m);
        for length_m in [by_corners_m, single_m].map(f64::from) {
            let difference = (length_m - f64::from(step.distance_m)).abs() / f64::from(step.distance_m).max(1.0);
            greatest_difference = greatest_difference.max(difference);
        }
    }
    PairFigures { single_us: median(durations_us.into_iter()).unwrap_or_default(), greatest_difference }
}

fn criteria(grounds: &[GroundFigures]) -> Vec<Criterion> {
    let greatest = grounds.iter().map(|ground| ground.greatest_difference).reduce(f64::max);
    let without_route = grounds.iter().map(|ground| ground.without_route as f64).reduce(|a, b| a + b);
    vec![
        Criterion::at_most("relative difference of lengths of one route", DIFFERENCE, greatest),
        Criterion::at_most("queries without route although one exists", 0.0, without_route),
    ]
}

fn goals(grounds: &[GroundFigures]) -> Vec<Goal> {
    let of = |name: &str, figure: fn(&GroundFigures) -> f32| {
        grounds.iter().find(|ground| ground.ground == name).map(|ground| f64::from(figure(ground)))
    };
    let build = of("streets", |ground| ground.union_ms + ground.mesh_ms);
    let mut goals = vec![
        Goal { name: "building the streets, ms", measured: build, goal: BUILD_MS },
        Goal {
            name: "field of one goal in the streets, ms",
            measured: of("streets", |ground| ground.field_ms),
            goal: FIELD_MS,
        },
    ];
    let query = |(ground, name, goal)| Goal { name, measured: of(ground, |ground| ground.query_us), goal };
    goals.extend(QUERY_US.map(query));
    goals
}

fn text(details: &Details) -> String {
    let head = "    ground       obstacles  vertices  triangles  union ms  mesh ms    kB  passages (ms)  field ms     kB  \
                query µs  single µs\n";
    let line = |ground: &GroundFigures| {
        format!(
            "    {:<13}{:9}{:10}{:11}{:10.2}{:9.2}{:6.0}{:6} {:>8}{:10.2}{:7.0}{:10.3}{:11.1}\n",
            ground.ground,
            ground.obstacles,
            ground.vertices,
            ground.triangles,
            ground.union_ms,
            ground.mesh_ms,
            ground.mesh_kb,
            ground.closed_passages,
            format!("({:.1})", ground.passages_ms),
            ground.field_ms,
            ground.field_kb,
            ground.query_us,
            ground.single_us,
        )
    };
    head.to_owned() + &details.grounds.iter().map(line).collect::<String>()
}

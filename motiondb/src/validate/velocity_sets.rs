//! The velocity sets are those of the examples (`FbCrowd` §4.1, Eqs. 2–5; [`crate::velocity_sets::velocity_hull`]).
//!
//! A polygon is the convex hull of points exactly where it is convex, its corners are among the points, and it holds
//! them all: no second construction is needed to prove the compiler's. Agent's frame, m/s.

use glam::Vec2;

use crate::motion::motion_db::MotionDb;
use crate::validate::{Outcome, ensure};
use crate::velocity_sets::velocity_hull::{
    Construction, half_planes, holding_point_mps, is_holding, is_turning, turning_point_mps,
};
use crate::velocity_sets::wrapping_polygon;

/// Points may stray this far outside a hull by rounding, m/s.
const TOLERANCE_MPS: f32 = 1e-4;

/// A velocity set: its name, its corners, and the points it was built from, standing among them.
struct Set<'a> {
    name: &'static str,
    corners_mps: &'a [Vec2],
    points_mps: Vec<Vec2>,
}

fn turning_points_mps(db: &MotionDb) -> impl Iterator<Item = Vec2> {
    db.examples.iter().map(|example| &example.parameters).filter(|found| is_turning(found)).map(turning_point_mps)
}

fn sets(db: &MotionDb) -> [Set<'_>; 2] {
    let with_rest = |points: &mut dyn Iterator<Item = Vec2>| points.chain([Vec2::ZERO]).collect::<Vec<Vec2>>();
    let turning = with_rest(&mut turning_points_mps(db));
    let holding = match db.velocity_hull.construction {
        Construction::Paper => turning.clone(),
        Construction::TurningAndHolding => {
            let parameters = db.examples.iter().map(|example| &example.parameters);
            with_rest(&mut parameters.filter(|found| is_holding(found)).map(holding_point_mps))
        }
    };
    [
        Set { name: "turning", corners_mps: &db.velocity_hull.turning_mps, points_mps: turning },
        Set { name: "holding", corners_mps: &db.velocity_hull.holding_mps, points_mps: holding },
    ]
}

/// Both hulls turn right at every corner, and no corner comes twice.
pub(crate) fn hulls_are_clockwise_and_convex(db: &MotionDb) -> Outcome {
    sets(db).iter().try_for_each(|Set { name, corners_mps, .. }| {
        let count = corners_mps.len();
        ensure(count > 0 && corners_mps.iter().all(|corner| corner.is_finite()), || {
            format!("the {name} set is empty")
        })?;
        let corner = |k: usize| corners_mps[k % count].as_dvec2();
        let turns_right = |k: usize| (corner(k + 1) - corner(k)).perp_dot(corner(k + 2) - corner(k + 1)) < 0.0;
        // A polygon that turns right all along its way may still go round several times.
        let goes_once = (0..count).filter(|&k| is_leftmost(corners_mps, k)).count() == 1;
        let convex = count < 3 || (goes_once && (0..count).all(turns_right));
        ensure(convex, || format!("the {name} set does not turn right at every corner, once around"))?;
        ensure(count != 2 || corners_mps[0] != corners_mps[1], || format!("the {name} set has one corner twice"))
    })
}

/// Whether a corner lies behind both of its neighbours; a polygon that goes round once has one such.
fn is_leftmost(corners_mps: &[Vec2], index: usize) -> bool {
    let count = corners_mps.len();
    let key = |k: usize| (corners_mps[k % count].x, corners_mps[k % count].y);
    key(index) < key(index + count - 1) && key(index) < key(index + 1)
}

/// Each set is the convex hull of its examples and of standing: they lie inside, and every corner is one of them.
pub(crate) fn hulls_wrap_their_examples(db: &MotionDb) -> Outcome {
    sets(db).iter().try_for_each(|Set { name, corners_mps, points_mps }| {
        let stray = points_mps.iter().find(|&&point| outside_mps(corners_mps, point) > TOLERANCE_MPS);
        ensure(stray.is_none(), || format!("the {name} set leaves out {}", stray.copied().unwrap_or_default()))?;
        let foreign = corners_mps.iter().find(|corner| !points_mps.contains(corner));
        ensure(foreign.is_none(), || {
            format!("the {name} set's corner {} is no example's", foreign.copied().unwrap_or_default())
        })
    })
}

/// How far a point lies outside a clockwise hull, m/s; sets of one or two corners are a point and a segment.
fn outside_mps(corners_mps: &[Vec2], point: Vec2) -> f32 {
    match *corners_mps {
        [only] => point.distance(only),
        [from, to] => {
            let along = (point - from).dot(to - from) / (to - from).length_squared();
            point.distance(from.lerp(to, along.clamp(0.0, 1.0)))
        }
        _ => violation_mps(corners_mps, point),
    }
}

/// How far a point violates the half-planes of a set, as the runtime does it, m/s.
fn violation_mps(corners_mps: &[Vec2], point: Vec2) -> f32 {
    let violations = half_planes(corners_mps).map(|(corner, direction)| direction.perp_dot(corner - point));
    violations.fold(f32::NEG_INFINITY, f32::max)
}

/// Eqs. 4, 5: every half-plane of a set permits all of the set's examples, and two corners lie on its line.
pub(crate) fn half_planes_agree_with_the_hulls(db: &MotionDb) -> Outcome {
    sets(db).iter().try_for_each(|Set { name, corners_mps, points_mps }| {
        let forbidden = points_mps.iter().find(|&&point| violation_mps(corners_mps, point) > TOLERANCE_MPS);
        ensure(forbidden.is_none(), || {
            format!("the half-planes of the {name} set forbid {}", forbidden.copied().unwrap_or_default())
        })?;
        // A set without area is widened, and its lines run beside its corners.
        let touches = |(point, direction): (Vec2, Vec2)| {
            let on_line = |corner: &&Vec2| direction.perp_dot(point - **corner).abs() <= TOLERANCE_MPS;
            corners_mps.len() < 3 || corners_mps.iter().filter(on_line).count() >= 2
        };
        ensure(half_planes(corners_mps).all(touches), || format!("a half-plane of the {name} set is no edge of it"))
    })
}

/// The sharp-turn edges are those edges of the turning examples' wrapping polygon that have an end beyond ±90°.
pub(crate) fn sharp_turns_wrap_the_turning_examples(db: &MotionDb) -> Outcome {
    let rebuilt = wrapping_polygon::sharp_turn_edges(&turning_points_mps(db).collect::<Vec<Vec2>>());
    let stored = &db.velocity_hull.sharp_turn_edges_mps;
    ensure(*stored == rebuilt, || format!("{stored:?} are stored, the examples give {rebuilt:?}"))
}

//! Invariants of the velocity sets (`FbCrowd` §4.1, Eqs. 2–5; [`crate::velocity_sets::velocity_hull`]).
//!
//! A polygon is the convex hull of points if and only if it is convex, its corners are among the points, and it holds
//! them all. So the check needs no second construction. Agent's frame (x forward, y left), m/s.

use glam::Vec2;

use crate::motion::motion_db::MotionDb;
use crate::validate::{CheckResult, ensure};
use crate::velocity_sets::velocity_hull::{
    Construction, half_planes, holding_point_mps, is_holding, is_turning, turning_point_mps,
};
use crate::velocity_sets::wrapping_polygon;

/// Greatest distance of a point outside a hull that counts as inside, m/s: rounding error.
const TOLERANCE_MPS: f32 = 1e-4;

/// A stored velocity set, with the points from which it must be built.
struct StoredSet<'a> {
    name: &'static str,
    /// Stored corners.
    corners_mps: &'a [Vec2],
    /// Points of the set's examples, and the origin.
    points_mps: Vec<Vec2>,
}

fn turning_points_mps(db: &MotionDb) -> impl Iterator<Item = Vec2> {
    db.parameters().filter(is_turning).map(|found| turning_point_mps(&found))
}

fn stored_sets(db: &MotionDb) -> [StoredSet<'_>; 2] {
    let with_origin = |points: &mut dyn Iterator<Item = Vec2>| points.chain([Vec2::ZERO]).collect::<Vec<Vec2>>();
    let turning = with_origin(&mut turning_points_mps(db));
    let holding = match db.velocity_hull.construction {
        Construction::Paper => turning.clone(),
        Construction::TurningAndHolding => {
            with_origin(&mut db.parameters().filter(is_holding).map(|found| holding_point_mps(&found)))
        }
    };
    [
        StoredSet { name: "turning", corners_mps: &db.velocity_hull.turning_mps, points_mps: turning },
        StoredSet { name: "holding", corners_mps: &db.velocity_hull.holding_mps, points_mps: holding },
    ]
}

/// Both sets turn right at every corner, and no corner occurs twice.
pub(crate) fn hulls_are_clockwise_and_convex(db: &MotionDb) -> CheckResult {
    stored_sets(db).iter().try_for_each(|StoredSet { name, corners_mps, .. }| {
        let count = corners_mps.len();
        ensure(count > 0 && corners_mps.iter().all(|corner| corner.is_finite()), || {
            format!("the {name} set is empty or not finite")
        })?;
        let corner = |k: usize| corners_mps[k % count].as_dvec2();
        let turns_right = |k: usize| (corner(k + 1) - corner(k)).perp_dot(corner(k + 2) - corner(k + 1)) < 0.0;
        // A polygon that turns right at every corner may wind around more than once.
        let runs_once = (0..count).filter(|&k| is_leftmost(corners_mps, k)).count() == 1;
        let convex = count < 3 || (runs_once && (0..count).all(turns_right));
        ensure(convex, || format!("the {name} set does not turn right at every corner, once around"))?;
        ensure(count != 2 || corners_mps[0] != corners_mps[1], || format!("the {name} set has one corner twice"))
    })
}

/// Whether a corner lies behind both of its neighbours. A polygon that winds around once has one such corner.
fn is_leftmost(corners_mps: &[Vec2], index: usize) -> bool {
    let count = corners_mps.len();
    let key = |k: usize| (corners_mps[k % count].x, corners_mps[k % count].y);
    key(index) < key(index + count - 1) && key(index) < key(index + 1)
}

/// Each set is the convex hull of its examples' points and the origin: all lie inside, and every corner is one of them.
pub(crate) fn hulls_wrap_their_examples(db: &MotionDb) -> CheckResult {
    stored_sets(db).iter().try_for_each(|StoredSet { name, corners_mps, points_mps }| {
        let stray = points_mps.iter().find(|&&point| outside_mps(corners_mps, point) > TOLERANCE_MPS);
        ensure(stray.is_none(), || {
            format!("an example at {} m/s is outside the {name} set", stray.copied().unwrap_or_default())
        })?;
        let foreign = corners_mps.iter().find(|corner| !points_mps.contains(corner));
        ensure(foreign.is_none(), || {
            format!("no example is at the corner {} m/s of the {name} set", foreign.copied().unwrap_or_default())
        })
    })
}

/// Distance of a point outside a clockwise hull, m/s. A set of one corner is a point, of two a segment.
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

/// Greatest violation of a set's half-planes by a point, m/s, computed as at run time.
fn violation_mps(corners_mps: &[Vec2], point: Vec2) -> f32 {
    let violations = half_planes(corners_mps).map(|(corner, direction)| direction.perp_dot(corner - point));
    violations.fold(f32::NEG_INFINITY, f32::max)
}

/// Every half-plane of a set (Eqs. 4, 5) permits all of the set's examples, and two corners lie on its line.
pub(crate) fn half_planes_agree_with_the_hulls(db: &MotionDb) -> CheckResult {
    stored_sets(db).iter().try_for_each(|StoredSet { name, corners_mps, points_mps }| {
        let forbidden = points_mps.iter().find(|&&point| violation_mps(corners_mps, point) > TOLERANCE_MPS);
        ensure(forbidden.is_none(), || {
            let point = forbidden.copied().unwrap_or_default();
            format!("the half-planes of the {name} set forbid its example at {point} m/s")
        })?;
        // A point or segment is widened into a thin polygon, so its edges miss the corners.
        let touches = |(point, direction): (Vec2, Vec2)| {
            let on_line = |corner: &&Vec2| direction.perp_dot(point - **corner).abs() <= TOLERANCE_MPS;
            corners_mps.len() < 3 || corners_mps.iter().filter(on_line).count() >= 2
        };
        ensure(half_planes(corners_mps).all(touches), || {
            format!("a half-plane of the {name} set lies on no edge of it")
        })
    })
}

/// The sharp-turn edges are the edges of the turning examples' wrapping polygon with an end beyond ±90°.
pub(crate) fn sharp_turns_wrap_the_turning_examples(db: &MotionDb) -> CheckResult {
    let rebuilt = wrapping_polygon::sharp_turn_edges(&turning_points_mps(db).collect::<Vec<Vec2>>());
    let stored = &db.velocity_hull.sharp_turn_edges_mps;
    ensure(*stored == rebuilt, || format!("edges {stored:?} m/s are stored, but the examples give {rebuilt:?} m/s"))
}

//! What all plans have in common: rings become polygons, far coordinates move to the origin. World, metres.

use crate::geometry::polygon::{CORNERS_MAX, bounds_m, is_simple, signed_area_m2, without_repeats};
use crate::scene::{Point, Scene, Walkable};

/// Greatest coordinate of a scenario, m.
const COORDINATE_MAX_M: f64 = 10_000.0;
/// Greatest coordinate that a plan may have, m: any projection of the Earth.
const PLAN_MAX_M: f64 = 1e8;
/// Least area of a polygon, m².
const AREA_MIN_M2: f64 = 1e-4;

/// What is wrong with a plan, and how to mend it.
pub(crate) type PlanFault = (String, &'static str);

/// A polygon of rings: the outline, then its holes. None where it is empty.
pub(crate) fn walkable(rings_m: &[Vec<Point>], origin: &str) -> Result<Option<Walkable>, PlanFault> {
    let mut rings_m = rings_m.iter().map(|ring_m| ring(ring_m));
    let Some(polygon_m) = rings_m.next().transpose()? else { return Ok(None) };
    let holes_m = rings_m.collect::<Result<_, _>>()?;
    Ok(Some(Walkable { polygon_m, holes_m, origin: origin.to_owned() }))
}

/// The corners of a ring, without repeated ones.
pub(crate) fn ring(corners_m: &[Point]) -> Result<Vec<Point>, PlanFault> {
    if let Some([x, y]) = corners_m.iter().find(|[x, y]| !(x.abs() <= PLAN_MAX_M && y.abs() <= PLAN_MAX_M)) {
        return Err((format!("the position [{x}, {y}] is no position on Earth in metres"), "correct it"));
    }
    let kept = without_repeats(corners_m);
    if !(3..=CORNERS_MAX).contains(&kept.len()) {
        return Err((format!("a ring has {} corners", kept.len()), "give 3 to 5000 corners"));
    }
    if !is_simple(&kept) || signed_area_m2(&kept).abs() < AREA_MIN_M2 {
        let [x, y] = kept[0];
        let message = format!("the ring that begins at [{x}, {y}] crosses or touches itself, or has no area");
        return Err((message, "list its corners in order, each once"));
    }
    Ok(kept)
}

/// Moves a plan that lies more than 10 km from the origin there, and notes it.
pub(crate) fn move_near_origin(scene: &mut Scene) -> Result<(), PlanFault> {
    let outlines = scene.walkable.iter().map(|walkable| &walkable.polygon_m);
    let corners_m: Vec<Point> =
        outlines.chain(scene.obstacles.iter().map(|obstacle| &obstacle.polygon_m)).flatten().copied().collect();
    let [low_m, high_m] = bounds_m(&corners_m);
    let farthest_m = [low_m, high_m].into_iter().flatten().fold(0.0, |far: f64, metres| far.max(metres.abs()));
    if corners_m.is_empty() || farthest_m <= COORDINATE_MAX_M {
        return Ok(());
    }
    let by_m = [0, 1].map(|axis| -(0.5 * (low_m[axis] + high_m[axis])).round());
    if (0..2).any(|axis| high_m[axis] - low_m[axis] > 2.0 * COORDINATE_MAX_M - 2.0) {
        return Err(("the plan is more than 20 km across".into(), "give metres, or cut out a part"));
    }
    // Shifted coordinates keep the source's digits, to the micrometre.
    let shift = |corner_m: &mut Point| {
        *corner_m = [0, 1].map(|axis| ((corner_m[axis] + by_m[axis]) * 1e6).round() / 1e6);
    };
    for walkable in &mut scene.walkable {
        walkable.polygon_m.iter_mut().chain(walkable.holes_m.iter_mut().flatten()).for_each(shift);
    }
    scene.obstacles.iter_mut().flat_map(|obstacle| &mut obstacle.polygon_m).for_each(shift);
    let what = format!("all positions are shifted by [{}, {}] m, to within 10 km of the origin", by_m[0], by_m[1]);
    scene.remarks.push(format!("Here {what}."));
    let source = scene.source.clone();
    scene.notes.add(&source, 0, what, false);
    Ok(())
}

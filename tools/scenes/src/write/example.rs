//! An example of agents, as a comment, for a scene that states none. World, metres.

use crate::geometry::inner_point::RoomyGround;
use crate::geometry::polygon::distance_m;
use crate::scene::{Point, Scene};
use crate::write::words::{number, point};

/// Room around the middle of an agent, m: its disc, and a gap to the wall.
const ROOM_M: f64 = 0.35;
/// Distance that agents walk where there is room, m.
const WALK_M: f64 = 5.0;
/// Distance between positions at which room is tested, m.
const STEP_M: f64 = 0.25;
/// Directions in which agents may walk.
const DIRECTIONS: usize = 16;
/// Agents of a row: as many as there is room for.
const ROWS: [usize; 3] = [3, 2, 1];

/// What a scene without agents needs: a grid with room, and goals to which it walks straight.
pub(crate) fn example(scene: &Scene) -> String {
    let ground = RoomyGround::new(scene);
    let middle_m = ground.innermost_m().map(|at_m| at_m.map(|metres| (metres * 100.0).round() / 100.0));
    let room_m = |rows: usize| 0.5 * (rows as f64 - 1.0) * std::f64::consts::SQRT_2 + ROOM_M;
    let found = middle_m.and_then(|middle_m| {
        let sized = ROWS.iter().map(|&rows| (rows, walk_m(&ground, middle_m, room_m(rows))));
        let mut roomy = sized.filter(|(_, [x, y])| x.abs() + y.abs() > 2.0 * STEP_M);
        roomy.next().map(|(rows, offset_m)| (middle_m, rows, offset_m))
    });
    let Some((middle_m, rows, offset_m)) = found else {
        return "# The source states no agents, and no example has room on its ground; add [[agents]].\n".to_owned();
    };
    let length_m = number((distance_m(offset_m, [0.0; 2]) * 10.0).round() / 10.0);
    format!(
        "# The source states no agents. An example, in which they walk {length_m} m straight on:\n\
         # [[agents]]\n\
         # grid = {{ columns = {rows}, rows = {rows}, spacing_m = 1, centre_m = {} }}\n\
         # goal_offset_m = {}\n",
        point(middle_m),
        point(offset_m),
    )
}

/// The longest displacement, up to 5 m, along which a disc has room; to the right where several are as long.
fn walk_m(ground: &RoomyGround<'_>, from_m: Point, room_m: f64) -> Point {
    let steps_max = (WALK_M / STEP_M) as usize;
    let mut best = (0, [0.0; 2]);
    for index in 0..DIRECTIONS {
        let (sin, cos) = libm::sincos(std::f64::consts::TAU * index as f64 / DIRECTIONS as f64);
        let ahead_m = |step: usize| [cos, sin].map(|part| (part * step as f64 * STEP_M * 100.0).round() / 100.0);
        let is_free = |step: &usize| {
            let [x, y] = ahead_m(*step);
            ground.clearance_m([from_m[0] + x, from_m[1] + y]) >= room_m
        };
        let steps = (0..=steps_max).take_while(is_free).count().saturating_sub(1);
        if steps > best.0 {
            best = (steps, ahead_m(steps));
        }
    }
    best.1
}

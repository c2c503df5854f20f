//! Grounds for the bench of routes: a room, a trade show, streets, a maze, a door, a city. Metres.

use fbcrowd_sim::maths::SplitMix64;
use fbcrowd_sim::route::mesh::{Ground, WalkablePolygon};
use glam::Vec2;

/// A ground that routes are measured on.
pub(crate) struct RouteGround {
    pub(crate) name: &'static str,
    pub(crate) obstacles_m: Vec<Vec<Vec2>>,
    pub(crate) walkable_m: Vec<WalkablePolygon>,
    /// Corners of the area in which agents start and goals lie, m.
    pub(crate) area_m: [Vec2; 2],
}

impl RouteGround {
    pub(crate) fn ground(&self) -> Ground<'_> {
        Ground {
            obstacles_m: &self.obstacles_m,
            enclosures_m: &[],
            walkable_m: &self.walkable_m,
            points_m: &self.area_m,
            one_way: &[],
        }
    }
}

/// All grounds, the city last.
pub(crate) fn grounds() -> Vec<RouteGround> {
    vec![room(), trade_show(), streets("streets", 500, 200.0), maze(), door(), streets("city", 10_000, 900.0)]
}

/// 30 turned boxes in a room of 20 × 20 m.
fn room() -> RouteGround {
    let mut random = SplitMix64::new(1, 0);
    let size_m = Vec2::splat(20.0);
    let obstacles_m = (0..30).map(|_| regular(uniform(&mut random, size_m), 4, 0.7, &mut random)).collect();
    RouteGround { name: "room", obstacles_m, walkable_m: hall(size_m), area_m: [Vec2::ZERO, size_m] }
}

/// 104 stands of 3 × 2 m back to back in a hall of 60 × 36 m; every fourth has a counter.
fn trade_show() -> RouteGround {
    let size_m = Vec2::new(60.0, 36.0);
    let stand = |index: i32| {
        let (column, row) = (index % 13, index / 13);
        let low_m = Vec2::new(3.0 + 4.2 * column as f32, 3.0 + 2.0 * row as f32 + 3.5 * (row / 2) as f32);
        if index % 4 == 0 { counter(low_m) } else { block(low_m, Vec2::new(3.0, 2.0)) }
    };
    let obstacles_m = (0..104).map(stand).collect();
    RouteGround { name: "trade show", obstacles_m, walkable_m: hall(size_m), area_m: [Vec2::ZERO, size_m] }
}

/// Houses of 4 to 7 corners on open ground.
fn streets(name: &'static str, count: usize, side_m: f32) -> RouteGround {
    let mut random = SplitMix64::new(2, count as u64);
    let columns = libm::sqrtf(count as f32) as usize;
    let cell_m = side_m / columns as f32;
    let mut house = |index: usize| {
        let cell = Vec2::new((index % columns) as f32, (index / columns) as f32);
        let shift_m = uniform(&mut random, Vec2::splat(0.2 * cell_m));
        let corners = 4 + random.next_u64() % 4;
        let radius_m = cell_m * (0.3 + 0.1 * random.within(1.0) as f32);
        regular((cell + 0.4) * cell_m + shift_m, corners, radius_m, &mut random)
    };
    let obstacles_m = (0..count).map(&mut house).collect();
    RouteGround { name, obstacles_m, walkable_m: Vec::new(), area_m: [Vec2::ZERO, Vec2::splat(side_m)] }
}

/// A maze of 16 × 16 cells of 2 m: each cell but those of the last column and row opens to the right or upwards.
fn maze() -> RouteGround {
    const CELLS: u32 = 16;
    let (mut random, cell_m, wall_m) = (SplitMix64::new(3, 0), 2.0, 0.2);
    let size_m = Vec2::splat(cell_m * CELLS as f32);
    let mut obstacles_m = Vec::new();
    for (column, row) in (0..CELLS).flat_map(|row| (0..CELLS).map(move |column| (column, row))) {
        let opens_upwards = column + 1 == CELLS || (row + 1 != CELLS && random.next_u64().is_multiple_of(2));
        let low_m = Vec2::new(column as f32, row as f32) * cell_m;
        let (right_m, top_m) = (low_m + Vec2::new(cell_m, 0.0), low_m + Vec2::new(0.0, cell_m));
        if opens_upwards {
            obstacles_m.push(block(right_m - wall_m / 2.0, Vec2::new(wall_m, cell_m + wall_m)));
        } else {
            obstacles_m.push(block(top_m - wall_m / 2.0, Vec2::new(cell_m + wall_m, wall_m)));
        }
    }
    RouteGround { name: "maze", obstacles_m, walkable_m: hall(size_m), area_m: [Vec2::ZERO, size_m] }
}

/// A door of 1 m between two walls on open ground.
fn door() -> RouteGround {
    let obstacles_m =
        vec![block(Vec2::new(0.0, -10.0), Vec2::new(0.2, 9.5)), block(Vec2::new(0.0, 0.5), Vec2::new(0.2, 9.5))];
    RouteGround { name: "door", obstacles_m, walkable_m: Vec::new(), area_m: [Vec2::splat(-10.0), Vec2::splat(10.0)] }
}

fn hall(size_m: Vec2) -> Vec<WalkablePolygon> {
    vec![WalkablePolygon { outline_m: block(Vec2::ZERO, size_m), holes_m: Vec::new() }]
}

fn block(low_m: Vec2, size_m: Vec2) -> Vec<Vec2> {
    [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|at| low_m + Vec2::from(at) * size_m).to_vec()
}

/// A stand that is open in the middle of one side.
fn counter(low_m: Vec2) -> Vec<Vec2> {
    let corners_m = [[0.0, 0.0], [3.0, 0.0], [3.0, 2.0], [2.2, 2.0], [2.2, 0.6], [0.8, 0.6], [0.8, 2.0], [0.0, 2.0]];
    corners_m.map(|corner_m| low_m + Vec2::from(corner_m)).to_vec()
}

/// A regular polygon, turned at random.
fn regular(centre_m: Vec2, corners: u64, radius_m: f32, random: &mut SplitMix64) -> Vec<Vec2> {
    let turn_rad = random.within(std::f64::consts::PI) as f32;
    let corner = |corner: u64| {
        let angle_rad = turn_rad + std::f32::consts::TAU * corner as f32 / corners as f32;
        centre_m + radius_m * Vec2::new(libm::cosf(angle_rad), libm::sinf(angle_rad))
    };
    (0..corners).map(corner).collect()
}

/// A point of the box from the origin to a corner.
pub(crate) fn uniform(random: &mut SplitMix64, size_m: Vec2) -> Vec2 {
    let mut share = || 0.5 + 0.5 * random.within(1.0) as f32;
    Vec2::new(share(), share()) * size_m
}

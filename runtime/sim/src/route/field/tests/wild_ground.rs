//! Grounds drawn at random, of the kinds that break geometry: axis-aligned, collinear, touching, nested, overlapping,
//! thin.

use glam::Vec2;

use crate::maths::random::SplitMix64;
use crate::route::mesh::{Ground, WalkablePolygon};

/// Number of kinds of grounds.
pub(super) const KINDS: u64 = 7;

/// A ground drawn at random.
pub(super) struct WildGround {
    pub(super) obstacles_m: Vec<Vec<Vec2>>,
    pub(super) walkable_m: Vec<WalkablePolygon>,
    pub(super) wall_radius_m: f32,
    /// Half the side of the square from which positions are drawn, m.
    pub(super) reach_m: f64,
}

impl WildGround {
    pub(super) fn new(seed: u64) -> Self {
        let (mut random, kind) = (SplitMix64::new(seed, 1), seed % KINDS);
        let count = 3 + random.next_u64() % 40;
        let radii_m = [0.2, 0.25, 0.1, 0.5, 0.05];
        let wall_radius_m = radii_m[(random.next_u64() % 5) as usize];
        let obstacles_m = (0..count).map(|_| obstacle(kind, &mut random)).collect();
        let walkable_m = if kind == 6 { rooms(&mut random) } else { Vec::new() };
        Self { obstacles_m, walkable_m, wall_radius_m, reach_m: 12.0 }
    }

    pub(super) fn ground(&self) -> Ground<'_> {
        Ground {
            obstacles_m: &self.obstacles_m,
            enclosures_m: &[],
            walkable_m: &self.walkable_m,
            points_m: &[],
            one_way: &[],
        }
    }

    pub(super) fn point(&self, random: &mut SplitMix64) -> Vec2 {
        let point_m = vector(random, self.reach_m);
        // Every fourth lies on lines that obstacles' edges lie on too.
        if random.next_u64().is_multiple_of(4) { (2.0 * point_m).round() / 2.0 } else { point_m }
    }
}

fn vector(random: &mut SplitMix64, reach_m: f64) -> Vec2 {
    Vec2::new(random.within(reach_m) as f32, random.within(reach_m) as f32)
}

fn block(low_m: Vec2, size_m: Vec2) -> Vec<Vec2> {
    [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|at| low_m + Vec2::from(at) * size_m).to_vec()
}

fn obstacle(kind: u64, random: &mut SplitMix64) -> Vec<Vec2> {
    let at_m = vector(random, 10.0);
    match kind {
        // Turned boxes and triangles that overlap.
        0 | 6 => {
            let (long_m, wide_m) = (vector(random, 2.0), 0.1 + random.within(1.0).abs() as f32);
            let across_m = long_m.perp().normalize_or(Vec2::X) * wide_m;
            let corners_m = [at_m, at_m + long_m, at_m + long_m + across_m, at_m + across_m];
            corners_m[..3 + (random.next_u64() % 2) as usize].to_vec()
        }
        // Blocks on half metres: they touch, overlap and nest.
        1 => block((2.0 * at_m).round() / 2.0, Vec2::new(0.5, 0.5) * (1 + random.next_u64() % 5) as f32),
        // Equal blocks in rows and columns.
        2 => block((at_m / 1.5).round() * 1.5, Vec2::splat(0.5)),
        // Walls of a millimetre, and walls without thickness.
        3 => {
            let (along, length_m) = (random.next_u64().is_multiple_of(2), random.within(4.0) as f32);
            let thickness_m = if random.next_u64().is_multiple_of(4) { 0.0 } else { 0.001 };
            let size_m = if along { Vec2::new(length_m, thickness_m) } else { Vec2::new(thickness_m, length_m) };
            block(at_m.round(), size_m)
        }
        // Stars, and outlines that cross themselves.
        4 => {
            let (corners, mut radius_m) = (5 + random.next_u64() % 6, || 0.2 + random.within(1.5).abs() as f32);
            let step_rad = std::f32::consts::TAU / corners as f32;
            (0..corners).map(|corner| at_m + radius_m() * Vec2::from_angle(2.0 * step_rad * corner as f32)).collect()
        }
        // Long walls on whole metres: a maze.
        _ => {
            let (along, length_m) = (random.next_u64().is_multiple_of(2), 2.0 + random.within(6.0).abs() as f32);
            let size_m = if along { Vec2::new(length_m.round(), 0.25) } else { Vec2::new(0.25, length_m.round()) };
            block((at_m / 1.25).round() * 1.25, size_m)
        }
    }
}

/// Rooms that overlap, with pillars left out.
fn rooms(random: &mut SplitMix64) -> Vec<WalkablePolygon> {
    let mut room = || {
        let low_m = (vector(random, 6.0) * 2.0).round() / 2.0 - 4.0;
        let size_m = Vec2::splat(3.0 + random.within(6.0).abs() as f32);
        let hole_m = block(low_m + 1.0, Vec2::splat(0.5));
        WalkablePolygon { outline_m: block(low_m, size_m), holes_m: vec![hole_m] }
    };
    (0..5).map(|_| room()).collect()
}

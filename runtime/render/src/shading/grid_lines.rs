//! The metric grid of the ground, filtered: each pixel shows the share of its footprint that lines cover, so that nothing
//! crawls, and lines finer than the footprint become their mean. World, metres.

use glam::{Vec2, Vec3};

use crate::raster::palette::{GRID_COARSE, GRID_FINE, GROUND};
use crate::visibility::Lens;

/// Distance and width of fine and coarse lines, m.
const LINES_M: [[f32; 2]; 2] = [[1.0, 0.018], [5.0, 0.04]];
/// Footprints, in periods, from which lines begin to fade into their mean, and at which they are it.
const FADE: [f32; 2] = [0.35, 1.0];
/// Factor by which lines are darker than those of the top view, which are for a thin pen.
const DARKER: f32 = 0.72;

/// Share of light that the grid leaves at a point of the ground, for each channel.
pub(crate) fn grid_share(point_m: Vec2, footprint_m: Vec2) -> Vec3 {
    let [fine, coarse] = LINES_M.map(|[period_m, width_m]| {
        let cover = |axis: usize| line_share(point_m[axis], footprint_m[axis], period_m, width_m);
        1.0 - (1.0 - cover(0)) * (1.0 - cover(1))
    });
    let left = |line: Vec3, cover: f32| Vec3::ONE.lerp(DARKER * line * line / (GROUND * GROUND), cover);
    left(GRID_FINE, fine) * left(GRID_COARSE, coarse)
}

/// Share of an interval around a coordinate that lines of a period and width cover.
fn line_share(at_m: f32, footprint_m: f32, period_m: f32, width_m: f32) -> f32 {
    let mean = width_m / period_m;
    if footprint_m >= period_m {
        return mean;
    }
    let half_m = 0.5 * footprint_m.max(1e-4);
    let per_m = 1.0 / period_m;
    // Most points lie between lines.
    let cells = at_m * per_m;
    let near = (cells + if cells < 0.0 { -0.5 } else { 0.5 }) as i32 as f32;
    if (cells - near).abs() * period_m > half_m + 0.5 * width_m && footprint_m < FADE[0] * period_m {
        return 0.0;
    }
    // The integral of the lines, which lie about the multiples of the period.
    let before = |end_m: f32| {
        let shifted_m = end_m + 0.5 * width_m;
        // Without a call of the system's library.
        let cells = shifted_m * per_m;
        let near = cells as i32 as f32;
        let whole = if near > cells { near - 1.0 } else { near };
        whole * width_m + (shifted_m - whole * period_m).min(width_m)
    };
    let covered = (before(at_m + half_m) - before(at_m - half_m)) / (2.0 * half_m);
    // A box filter leaves waves where it is hardly wider than a period.
    let fade = ((footprint_m * per_m - FADE[0]) / (FADE[1] - FADE[0])).clamp(0.0, 1.0);
    covered + fade * (mean - covered)
}

/// Extent along world x and y of a pixel's footprint on the ground, m.
pub(crate) fn footprint_m(lens: &Lens, point_m: Vec3) -> Vec2 {
    let (direction, scale) = if lens.is_perspective {
        let to_point = point_m - lens.eye_m;
        let depth_m = lens.forward.dot(to_point);
        (to_point / depth_m.max(1e-3), depth_m)
    } else {
        (lens.forward, 1.0)
    };
    // A step in the picture moves the ray; on the ground it ends where its height is 0 again.
    let moved = |step: Vec3| {
        let slope = if direction.z.abs() > 1e-6 { step.z / direction.z } else { 0.0 };
        scale * lens.pixel * (step - direction * slope).truncate().abs()
    };
    moved(lens.right) + moved(lens.down)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_are_those_of_many_points() {
        for (at_m, footprint_m) in [(0.3, 0.02), (0.005, 0.02), (4.99, 0.1), (-2.1, 0.3), (7.77, 0.34)] {
            let count = 20_000;
            let inside = (0..count).filter(|index| {
                let point_m = at_m + footprint_m * ((*index as f32 + 0.5) / count as f32 - 0.5);
                (point_m - (point_m / 1.0).round()).abs() <= 0.009
            });
            let expected = inside.count() as f32 / count as f32;
            let found = line_share(at_m, footprint_m, 1.0, 0.018);
            assert!((found - expected).abs() < 3e-3, "{at_m} {footprint_m}: {found} {expected}");
        }
    }

    #[test]
    fn wide_footprints_see_the_mean() {
        for at_m in [0.0, 0.2, 0.5] {
            assert!((line_share(at_m, 3.0, 1.0, 0.018) - 0.018).abs() < 1e-5);
        }
    }

    #[test]
    fn a_footprint_is_the_distance_to_the_next_pixel() {
        let lens = Lens::perspective([640, 360], Vec3::new(1.0, 2.0, 1.65), Vec3::new(4.0, 12.0, 1.0), 1.0);
        let at = |px: Vec2| {
            let ray = lens.ray(lens.to_uv(px));
            lens.eye_m - ray * (lens.eye_m.z / ray.z)
        };
        let px = Vec2::new(300.0, 320.0);
        let [here, right, down] = [px, px + Vec2::X, px + Vec2::Y].map(at);
        let expected = ((right - here).abs() + (down - here).abs()).truncate();
        let found = footprint_m(&lens, here);
        assert!((found / expected - 1.0).abs().max_element() < 0.05, "{found} {expected}");
    }
}

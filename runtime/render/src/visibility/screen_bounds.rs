//! The pixels that a rounded cone can touch: exact bounds of its two balls, whose hull it is.
//!
//! In perspective, the outline of a ball is bounded by the tangents from the eye: with the ball's centre (x, z) and radius
//! r, `u = (x·z ± r·√(x² + z² − r²)) / (z² − r²)`. Its projected centre plus radius is not enough.

use glam::Vec2;

use crate::visibility::lens::{Lens, NEAR_M};
use crate::visibility::rounded_cone::PreparedCone;

/// First and last pixel (inclusive), each as column and row, within the picture.
pub(crate) type PixelBounds = [[u32; 2]; 2];

/// First and last pixel (inclusive) of columns and rows that a cone can touch.
pub(crate) fn cone_bounds(cone: &PreparedCone, lens: &Lens) -> Option<PixelBounds> {
    let (from, to) = (cone.from, cone.from + cone.axis);
    let [first, second] = cone.radii;
    if (from.z + first).max(to.z + second) <= NEAR_M {
        return None;
    }
    if !lens.is_perspective {
        let low = (from.truncate() - first).min(to.truncate() - second);
        let high = (from.truncate() + first).max(to.truncate() + second);
        return clip(low, high, lens);
    }
    let is_cut = (from.z - first).min(to.z - second) < NEAR_M;
    if is_cut {
        // Bounds of the part in front of the near plane: the whole picture, unless it lies beside one of its edges.
        return (!is_beside(cone, lens)).then(|| [[0; 2], lens.size_px.map(|side| side - 1)]);
    }
    let [first, second] = [[from.x, from.y, from.z, first], [to.x, to.y, to.z, second]].map(ball_bounds);
    clip(first[0].min(second[0]), first[1].max(second[1]), lens)
}

/// Least and greatest (u, v) of a ball in front of the eye plane: x, y, z and radius.
fn ball_bounds([x, y, z, radius]: [f32; 4]) -> [Vec2; 2] {
    let below = z * z - radius * radius;
    let side = |at: f32| radius * (at * at + below).max(0.0).sqrt();
    let (across, reach) = (Vec2::new(x, y) * z, Vec2::new(side(x), side(y)));
    [(across - reach) / below, (across + reach) / below]
}

/// Whether both balls lie outside one and the same plane through the eye and an edge of the picture.
fn is_beside(cone: &PreparedCone, lens: &Lens) -> bool {
    let half = 0.5 * lens.size() * lens.pixel;
    let balls = [(cone.from, cone.radii[0]), (cone.from + cone.axis, cone.radii[1])];
    let is_outside = |axis: usize, sign: f32| {
        let length = (1.0 + half[axis] * half[axis]).sqrt();
        balls.iter().all(|(centre, radius)| (sign * centre[axis] - half[axis] * centre.z) / length > *radius)
    };
    [0, 1].into_iter().any(|axis| is_outside(axis, 1.0) || is_outside(axis, -1.0))
}

/// The pixels between two corners in (u, v), with a hundredth of a pixel to spare.
fn clip(low: Vec2, high: Vec2, lens: &Lens) -> Option<PixelBounds> {
    let to_px = |corner: Vec2| corner / lens.pixel + 0.5 * lens.size();
    let (low, high) = (to_px(low) - 0.01, to_px(high) + 0.01);
    if low.cmpge(lens.size()).any() || high.cmplt(Vec2::ZERO).any() || !low.is_finite() || !high.is_finite() {
        return None;
    }
    // Casts saturate.
    let last = lens.size_px.map(|side| side - 1);
    Some([[low.x.max(0.0) as u32, low.y.max(0.0) as u32], [(high.x as u32).min(last[0]), (high.y as u32).min(last[1])]])
}

#[cfg(test)]
mod tests {
    use fbcrowd_sim::maths::SplitMix64;
    use glam::Vec3;

    use super::*;
    use crate::visibility::owner::Owner;
    use crate::visibility::scene_parts::Cone;

    #[test]
    fn bounds_hold_every_point_of_the_surface_and_little_more() {
        let mut random = SplitMix64::new(2, 2);
        let size_px = [200, 150];
        let eye_m = Vec3::new(0.0, 0.0, 1.6);
        let lenses = [
            Lens::perspective(size_px, eye_m, Vec3::new(0.0, 5.0, 1.0), 1.4),
            Lens::orthographic(size_px, eye_m, Vec3::new(0.1, 1.0, -0.5), 9.0),
        ];
        for lens in &lenses {
            for _ in 0..120 {
                let mut within = |range: f64| random.within(range) as f32;
                let from = Vec3::new(within(3.0), 4.0 + within(2.5), 1.0 + within(1.0));
                let ends_m = [from, from + Vec3::new(within(0.8), within(0.8), within(0.8))];
                let radii_m = [0.3 + within(0.25), 0.3 + within(0.25)];
                let cone = Cone { ends_m, radii_m, colour: Vec3::ONE, owner: Owner::SCENE };
                check(&cone, lens, &mut random);
            }
        }
    }

    fn check(cone: &Cone, lens: &Lens, random: &mut SplitMix64) {
        let bounds = cone_bounds(&PreparedCone::new(cone, lens), lens);
        let (mut low, mut high) = (Vec2::INFINITY, Vec2::NEG_INFINITY);
        for _ in 0..3000 {
            let mut within = || random.within(1.0) as f32;
            let direction = Vec3::new(within(), within(), within()).normalize_or_zero();
            let end = usize::from(within() > 0.0);
            let Some(px) = lens.to_px(cone.ends_m[end] + cone.radii_m[end] * direction) else { continue };
            (low, high) = (low.min(px), high.max(px));
            if px.cmplt(Vec2::ZERO).any() || px.cmpge(lens.size()).any() {
                continue;
            }
            let [first, last] = bounds.expect("a visible point has bounds");
            let inside = (0..2).all(|axis| (first[axis]..=last[axis]).contains(&(px[axis] as u32)));
            assert!(inside, "{px} {bounds:?} {cone:?}");
        }
        if let Some([first, last]) = bounds
            && PreparedCone::new(cone, lens).from.z > 1.0
        {
            let [first, last] = [first, last].map(|corner| Vec2::new(corner[0] as f32, corner[1] as f32));
            let spare = (low.max(Vec2::ZERO) - first).max(last - high.min(lens.size())).max_element();
            assert!(spare < 6.0, "{spare} {bounds:?} {low} {high}");
        }
    }
}

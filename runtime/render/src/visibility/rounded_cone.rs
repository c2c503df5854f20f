//! Where a ray first meets a rounded cone: a quadratic for the flank, one for each end ball.
//!
//! Camera space (see `lens`). A ray is shifted to the depth of the first ball, where `origin = (s·u − x, s·v − y, 0)`
//! from that ball's centre and `direction = (p·u, p·v, 1)`; s is the depth and p is 1 in perspective, s is 1 and p is 0
//! in orthographic projection. So all terms stay near the cone, and f32 suffices at any distance. With
//! ba = B − A, o the origin from A, d the direction, r = rA − rB and D = |ba|² − r², a point o + t·d on the flank has
//! `(D·d² − (ba·d)²)·t² + 2·(D·o·d − (ba·o)(ba·d) + (ba·d)·r·rA)·t + D·o² − (ba·o)² + 2·(ba·o)·r·rA − |ba|²·rA² = 0`,
//! and lies between the balls where 0 < ba·(o + t·d) − r·rA < D.

use glam::{Vec2, Vec3};

use crate::visibility::lens::{Lens, NEAR_M};
use crate::visibility::scene_parts::Cone;

/// A rounded cone, prepared for the rays of one lens.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PreparedCone {
    /// Centre of the first ball, camera space, m.
    pub(crate) from: Vec3,
    /// From the first centre to the second, m.
    pub(crate) axis: Vec3,
    /// Radius of both balls, m.
    pub(crate) radii: [f32; 2],
    /// Factor s of the ray's origin.
    origin_scale: f32,
    /// Factor p of the ray's direction.
    direction_scale: f32,
    /// rA − rB, m.
    taper: f32,
    /// |ba|², m².
    axis_squared: f32,
    /// D = |ba|² − r², m²; 0 where one ball holds the other.
    flank: f32,
    /// Whether it reaches before the near plane.
    is_cut: bool,
}

impl PreparedCone {
    pub(crate) fn new(cone: &Cone, lens: &Lens) -> Self {
        let [mut from, mut to] = cone.ends_m.map(|end_m| lens.to_camera(end_m));
        let mut radii = cone.radii_m;
        let mut taper = radii[0] - radii[1];
        if (to - from).length_squared() <= taper * taper * 1.000_01 {
            // Only the larger ball is visible.
            let larger = usize::from(radii[1] > radii[0]);
            (from, radii) = ([from, to][larger], [radii[larger]; 2]);
            (to, taper) = (from, 0.0);
        }
        let axis = to - from;
        let (origin_scale, direction_scale) = if lens.is_perspective { (from.z, 1.0) } else { (1.0, 0.0) };
        let axis_squared = axis.length_squared();
        let is_cut = (from.z - radii[0]).min(to.z - radii[1]) < NEAR_M;
        let flank = axis_squared - taper * taper;
        Self { from, axis, radii, origin_scale, direction_scale, taper, axis_squared, flank, is_cut }
    }

    /// Depth at which the ray through (u, v) meets the cone, m. A cone across the near plane is cut there.
    #[cfg(test)]
    pub(crate) fn depth_m(&self, uv: Vec2) -> Option<f32> {
        if self.direction_scale > 0.0 { self.depth_along_m::<true>(uv) } else { self.depth_along_m::<false>(uv) }
    }

    /// As `depth_m`, for rays through the eye or parallel ones.
    #[inline]
    pub(crate) fn depth_along_m<const IS_PERSPECTIVE: bool>(&self, uv: Vec2) -> Option<f32> {
        let depth_m = self.first_depth_m::<IS_PERSPECTIVE>(uv)?;
        if self.is_cut && depth_m < NEAR_M {
            let at_near = if self.direction_scale > 0.0 { uv * NEAR_M } else { uv }.extend(NEAR_M);
            return self.holds(at_near).then_some(NEAR_M);
        }
        Some(depth_m)
    }

    /// The depth on the whole line, in front of the eye and behind.
    #[inline]
    fn first_depth_m<const IS_PERSPECTIVE: bool>(&self, uv: Vec2) -> Option<f32> {
        let Self { axis, radii, taper, axis_squared, flank, .. } = *self;
        // Parallel rays: s is 1 and p is 0.
        let origin = if IS_PERSPECTIVE { uv * self.origin_scale } else { uv } - self.from.truncate();
        let across = if IS_PERSPECTIVE { uv } else { Vec2::ZERO };
        let along_origin = axis.x * origin.x + axis.y * origin.y;
        let along = axis.x * across.x + axis.y * across.y + axis.z;
        let approach = across.x * origin.x + across.y * origin.y;
        let origin_squared = origin.x * origin.x + origin.y * origin.y;
        let squared = across.x * across.x + across.y * across.y + 1.0;
        let shift = taper * radii[0];

        // The flank.
        let a = flank * squared - along * along;
        let b = flank * approach + along * (shift - along_origin);
        let c =
            flank * origin_squared - along_origin * (along_origin - 2.0 * shift) - axis_squared * radii[0] * radii[0];
        let root = b * b - a * c;
        if root < 0.0 {
            return None;
        }
        let depth = (-b - root.sqrt()) / a;
        let height = along_origin - shift + depth * along;
        if height > 0.0 && height < flank {
            return Some(self.from.z + depth);
        }

        // The balls.
        let first = ball(squared, approach, origin_squared - radii[0] * radii[0]);
        let other_squared = origin_squared - 2.0 * along_origin + axis_squared;
        let second = ball(squared, approach - along, other_squared - radii[1] * radii[1]);
        let depth = first.min(second);
        (depth < f32::INFINITY).then_some(self.from.z + depth)
    }

    /// Whether a point in camera space lies within the cone.
    fn holds(&self, point_m: Vec3) -> bool {
        let offset = point_m - self.from;
        let height = self.axis.dot(offset) - self.taper * self.radii[0];
        if height <= 0.0 || self.flank <= 0.0 {
            return offset.length_squared() <= self.radii[0] * self.radii[0];
        }
        if height >= self.flank {
            return (offset - self.axis).length_squared() <= self.radii[1] * self.radii[1];
        }
        let share = height / self.flank;
        let radius = self.radii[0] - share * self.taper;
        (offset - share * self.axis).length_squared() <= radius * radius
    }

    /// Normal at a point on the surface, camera space.
    pub(crate) fn normal(&self, point_m: Vec3) -> Vec3 {
        let offset = point_m - self.from;
        let share = if self.flank > 0.0 {
            ((self.axis.dot(offset) - self.taper * self.radii[0]) / self.flank).clamp(0.0, 1.0)
        } else {
            0.0
        };
        (offset - share * self.axis).try_normalize().unwrap_or(Vec3::NEG_Z)
    }
}

/// Least root of `squared·t² + 2·approach·t + excess`; infinite where there is none.
#[inline]
fn ball(squared: f32, approach: f32, excess: f32) -> f32 {
    let root = approach * approach - squared * excess;
    if root < 0.0 { f32::INFINITY } else { (-approach - root.sqrt()) / squared }
}

#[cfg(test)]
mod tests {
    use fbcrowd_sim::maths::SplitMix64;

    use super::*;
    use crate::visibility::owner::Owner;

    pub(super) fn random_cone(random: &mut SplitMix64) -> Cone {
        let mut within = |range: f64| random.within(range) as f32;
        let middle = Vec3::new(within(3.0), 6.0 + within(3.0), 1.0 + within(1.0));
        let half = Vec3::new(within(0.6), within(0.6), within(0.6));
        let radii_m = [0.3 + within(0.29), 0.3 + within(0.29)];
        Cone { ends_m: [middle - half, middle + half], radii_m, colour: Vec3::ONE, owner: Owner::SCENE }
    }

    /// Distance to the union of many balls, m: the definition.
    fn distance_m(cone: &Cone, point_m: Vec3) -> f32 {
        let [from, to] = cone.ends_m;
        let balls = (0..=400).map(|step| step as f32 / 400.0);
        let outside = balls.map(|share| {
            point_m.distance(from.lerp(to, share)) - (cone.radii_m[0] + share * (cone.radii_m[1] - cone.radii_m[0]))
        });
        outside.fold(f32::INFINITY, f32::min)
    }

    /// First depth at which marching along a ray meets the balls.
    fn marched_depth_m(cone: &Cone, lens: &Lens, uv: Vec2) -> Option<f32> {
        let mut depth_m = NEAR_M;
        let speed = lens.at_depth(uv, 1.0).distance(lens.at_depth(uv, 0.0));
        for _ in 0..600 {
            let gap_m = distance_m(cone, lens.to_world(lens.at_depth(uv, depth_m)));
            if gap_m < 2e-4 {
                return Some(depth_m);
            }
            depth_m += gap_m / speed;
            if depth_m > 30.0 {
                return None;
            }
        }
        None
    }

    #[test]
    fn rays_meet_cones_where_marching_meets_balls() {
        let mut random = SplitMix64::new(3, 5);
        let size_px = [64, 48];
        let lenses = [
            Lens::perspective(size_px, Vec3::new(0.3, 0.2, 1.6), Vec3::new(0.1, 6.0, 1.0), 1.2),
            Lens::orthographic(size_px, Vec3::new(0.0, -2.0, 4.0), Vec3::new(0.1, 0.9, -0.4), 8.0),
        ];
        let (mut hits, mut edges) = (0, 0);
        for lens in &lenses {
            for _ in 0..60 {
                let cone = random_cone(&mut random);
                let prepared = PreparedCone::new(&cone, lens);
                for _ in 0..40 {
                    let px = Vec2::new(random.unit() as f32 * 64.0, random.unit() as f32 * 48.0);
                    let uv = lens.to_uv(px);
                    match (prepared.depth_m(uv), marched_depth_m(&cone, lens, uv)) {
                        (Some(found), Some(marched)) => {
                            hits += 1;
                            assert!((found - marched).abs() < 0.02, "{found} {marched} {cone:?}");
                        }
                        (None, None) => {}
                        // A ray that grazes the surface.
                        _ => edges += 1,
                    }
                }
            }
        }
        assert!(hits > 100 && edges < 8, "{hits} {edges}");
    }

    #[test]
    fn normals_point_away_from_the_nearest_ball() {
        let mut random = SplitMix64::new(9, 1);
        let lens = Lens::perspective([64, 48], Vec3::new(0.0, 0.0, 1.6), Vec3::new(0.0, 6.0, 1.0), 1.2);
        for _ in 0..300 {
            let cone = random_cone(&mut random);
            let prepared = PreparedCone::new(&cone, &lens);
            let centre = lens.to_camera(cone.ends_m[0].midpoint(cone.ends_m[1]));
            let uv = centre.truncate() / centre.z;
            let Some(depth_m) = prepared.depth_m(uv) else { continue };
            let point = lens.at_depth(uv, depth_m);
            let normal = lens.direction_to_world(prepared.normal(point));
            let world = lens.to_world(point);
            let ahead = distance_m(&cone, world + 0.01 * normal) - distance_m(&cone, world);
            assert!((ahead - 0.01).abs() < 1e-3, "{ahead}");
        }
    }

    #[test]
    fn a_cone_across_the_eye_plane_is_cut_not_dropped() {
        let lens = Lens::perspective([64, 48], Vec3::ZERO, Vec3::Y, 1.0);
        let ends_m = [Vec3::new(0.0, -1.0, -0.4), Vec3::new(0.0, 2.0, -0.4)];
        let cone = Cone { ends_m, radii_m: [0.1; 2], colour: Vec3::ONE, owner: Owner::SCENE };
        let prepared = PreparedCone::new(&cone, &lens);
        let below = prepared.depth_m(Vec2::new(0.0, 0.25)).unwrap();
        assert!((below - 0.3 / 0.25).abs() < 0.01, "{below}");
        assert_eq!(prepared.depth_m(Vec2::new(0.0, -0.25)), None);
    }
}

//! The feasible region: the part of a convex polygon of velocities that all half-planes permit. The planner chooses its
//! velocity in this region (Eq. 14). World axes, m/s.

use fbcrowd_sim::planning::orca::HalfPlane;
use glam::Vec2;

/// Corners of the feasible region within a convex polygon; none if it is empty. Method: the polygon is clipped by each
/// half-plane in turn (Sutherland, Hodgman 1974).
pub(crate) fn feasible_region_mps<'a>(
    corners_mps: &[Vec2],
    half_planes: impl IntoIterator<Item = &'a HalfPlane>,
) -> Vec<Vec2> {
    half_planes.into_iter().fold(corners_mps.to_vec(), |corners_mps, half_plane| clipped(&corners_mps, half_plane))
}

/// Clips a polygon by one half-plane (one step of Sutherland–Hodgman).
fn clipped(corners_mps: &[Vec2], half_plane: &HalfPlane) -> Vec<Vec2> {
    let mut kept_mps = Vec::with_capacity(corners_mps.len() + 1);
    for (index, &corner_mps) in corners_mps.iter().enumerate() {
        let next_mps = corners_mps[(index + 1) % corners_mps.len()];
        let [here, there] = [corner_mps, next_mps].map(|corner_mps| half_plane.violation_mps(corner_mps));
        if here <= 0.0 {
            kept_mps.push(corner_mps);
        }
        if (here < 0.0 && there > 0.0) || (here > 0.0 && there < 0.0) {
            kept_mps.push(corner_mps.lerp(next_mps, here / (here - there)));
        }
    }
    kept_mps
}

#[cfg(test)]
mod tests {
    use fbcrowd_sim::planning::orca::HalfPlaneSource;

    use super::*;

    const SQUARE: [Vec2; 4] = [Vec2::new(-1.0, -1.0), Vec2::new(1.0, -1.0), Vec2::new(1.0, 1.0), Vec2::new(-1.0, 1.0)];

    /// Whether a point is in a convex, counter-clockwise polygon.
    fn is_inside(corners: &[Vec2], point: Vec2) -> bool {
        let edges = corners.iter().zip(corners.iter().cycle().skip(1));
        !corners.is_empty() && edges.into_iter().all(|(from, to)| (to - from).perp_dot(point - from) >= 0.0)
    }

    #[test]
    fn the_region_is_what_no_half_plane_forbids() {
        let half_plane = |angle_rad: f32, distance_mps: f32| {
            let outward = Vec2::from_angle(angle_rad);
            HalfPlane::behind(distance_mps * outward, outward, HalfPlaneSource::Stance)
        };
        for turn in 0..40 {
            let turned = turn as f32 * 0.7;
            let half_planes = [half_plane(turned, 0.5), half_plane(2.4 * turned, 0.1), half_plane(-turned, 0.83)];
            let region = feasible_region_mps(&SQUARE, &half_planes);
            for sample in 0..400 {
                let point = Vec2::new((sample % 20) as f32 / 10.0 - 0.97, (sample / 20) as f32 / 10.0 - 0.96);
                let worst = half_planes.iter().map(|half_plane| half_plane.violation_mps(point)).fold(-1.0, f32::max);
                assert!(worst.abs() < 1e-4 || is_inside(&region, point) == (worst < 0.0), "{turn} {point}");
            }
        }
    }

    #[test]
    fn half_planes_that_exclude_each_other_leave_no_region() {
        let [ahead, back] =
            [1.0, -1.0].map(|x| HalfPlane::behind(-0.2 * x * Vec2::X, x * Vec2::X, HalfPlaneSource::Agent(1)));
        assert!(feasible_region_mps(&SQUARE, &[ahead, back]).is_empty());
    }
}

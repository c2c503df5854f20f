//! What half-planes leave of a convex polygon of velocities (Sutherland, Hodgman 1974): the set in which the paper's
//! Eq. 14 looks for its velocity, as a shape to be filled. World axes, m/s.

use fbcrowd_sim::planning::orca::HalfPlane;
use glam::Vec2;

/// Cuts a convex polygon by each half-plane in turn; no corner is left where nothing is permitted.
pub(crate) fn permitted_mps<'a>(
    corners_mps: &[Vec2],
    half_planes: impl IntoIterator<Item = &'a HalfPlane>,
) -> Vec<Vec2> {
    half_planes.into_iter().fold(corners_mps.to_vec(), |corners_mps, half_plane| cut(&corners_mps, half_plane))
}

/// The corners inside, and those where an edge crosses the line.
fn cut(corners_mps: &[Vec2], half_plane: &HalfPlane) -> Vec<Vec2> {
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

    /// Whether a point lies in a convex polygon, counter-clockwise.
    fn is_inside(corners: &[Vec2], point: Vec2) -> bool {
        let edges = corners.iter().zip(corners.iter().cycle().skip(1));
        !corners.is_empty() && edges.into_iter().all(|(from, to)| (to - from).perp_dot(point - from) >= 0.0)
    }

    #[test]
    fn a_velocity_is_left_exactly_if_no_half_plane_forbids_it() {
        let half_plane = |angle_rad: f32, distance_mps: f32| {
            let outward = Vec2::from_angle(angle_rad);
            HalfPlane::behind(distance_mps * outward, outward, HalfPlaneSource::Stance)
        };
        for turn in 0..40 {
            let turned = turn as f32 * 0.7;
            let half_planes = [half_plane(turned, 0.5), half_plane(2.4 * turned, 0.1), half_plane(-turned, 0.83)];
            let left = permitted_mps(&SQUARE, &half_planes);
            for sample in 0..400 {
                let point = Vec2::new((sample % 20) as f32 / 10.0 - 0.97, (sample / 20) as f32 / 10.0 - 0.96);
                let worst = half_planes.iter().map(|half_plane| half_plane.violation_mps(point)).fold(-1.0, f32::max);
                assert!(worst.abs() < 1e-4 || is_inside(&left, point) == (worst < 0.0), "{turn} {point}");
            }
        }
    }

    #[test]
    fn nothing_is_left_between_two_that_exclude_each_other() {
        let [ahead, back] =
            [1.0, -1.0].map(|x| HalfPlane::behind(-0.2 * x * Vec2::X, x * Vec2::X, HalfPlaneSource::Agent(1)));
        assert!(permitted_mps(&SQUARE, &[ahead, back]).is_empty());
    }
}

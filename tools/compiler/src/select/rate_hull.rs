//! Whether a blend of cycles can come near some rates: the distance of a point from the convex hull of others.
//!
//! Points are (v_f, ω_t, ω_s) in widths of a cell ([`crate::cycle::rate_cells`]). The nearest point of the hull is
//! approached step by step, each towards the corner that lies farthest in the direction of the point (Frank and Wolfe
//! 1956; for hulls Gilbert 1966).

use glam::DVec3;

/// Greatest number of steps. Steps beyond it change distances by less than a hundredth of a cell.
const STEPS_MAX: usize = 300;

/// Whether the convex hull of some corners comes as near to a point as this; never without corners.
pub(crate) fn is_near_hull(point: DVec3, corners: &[DVec3], near: f64) -> bool {
    let Some(&first) = corners.first() else { return false };
    let mut nearest = first;
    for _ in 0..STEPS_MAX {
        let to_point = point - nearest;
        let distance = to_point.length();
        if distance <= near {
            return true;
        }
        let reach = |corner: &DVec3| (*corner - nearest).dot(to_point);
        let Some(&corner) = corners.iter().max_by(|a, b| reach(a).total_cmp(&reach(b))) else { return false };
        // No point of the hull is nearer than the plane through this corner, square to the direction of the point.
        if distance - reach(&corner) / distance > near {
            return false;
        }
        let step = corner - nearest;
        nearest += step * (reach(&corner) / step.length_squared()).clamp(0.0, 1.0);
    }
    false
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn check(point: [f64; 3], corners: &[[f64; 3]], is_near: bool) {
        let corners: Vec<DVec3> = corners.iter().copied().map(DVec3::from_array).collect();
        assert_eq!(is_near_hull(DVec3::from_array(point), &corners, 0.5), is_near, "{point:?} {corners:?}");
    }

    #[test]
    fn hulls_of_any_dimension_are_measured() {
        let line = [[0.0; 3], [8.0, 0.0, 0.0]];
        let triangle = [[0.0; 3], [8.0, 4.0, 0.0], [8.0, -4.0, 0.0]];
        check([0.0; 3], &[], false);
        check([0.4, 0.0, 0.0], &line[..1], true);
        check([3.0, 0.4, 0.0], &line, true);
        check([3.0, 0.6, 0.0], &line, false);
        check([8.6, 0.0, 0.0], &line, false);
        check([7.0, 3.0, 0.4], &triangle, true);
        check([7.0, 3.0, 0.6], &triangle, false);
        check([1.0, 2.0, 0.0], &triangle, false);
        let solid = [triangle[0], triangle[1], triangle[2], [4.0, 0.0, 9.0]];
        check([5.0, 0.1, 2.0], &solid, true);
    }
}

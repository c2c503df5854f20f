//! Where a point of a part is in another frame, and how far it moves in the picture.
//!
//! World, metres. A mesh's point keeps its weights in its triangle. A cone's point keeps its share of the axis and its
//! offset from it, which turns with the axis by the shortest arc. The ground and the walls stand; the sky is infinitely far.

use glam::{Quat, Vec2, Vec3};

use crate::visibility::part::Shape;
use crate::visibility::triangle::weights;
use crate::visibility::{Fragment, Lens, PartId, SceneParts};

/// Distance at which the sky counts, m: the eye's own way is nothing to it.
const SKY_M: f32 = 1e7;

/// Another frame, as motion needs it.
#[derive(Clone, Debug)]
pub(crate) struct OtherFrame {
    pub(crate) places: PartPlaces,
    pub(crate) lens: Lens,
}

/// Where the parts of a scene are in another frame, in their order. World, metres.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct PartPlaces {
    /// Ends of each cone.
    ends_m: Vec<[Vec3; 2]>,
    /// Position of each vertex.
    positions_m: Vec<Vec3>,
}

impl PartPlaces {
    /// The places of a scene's own parts.
    pub(crate) fn of(parts: SceneParts) -> Self {
        Self { ends_m: parts.cones.iter().map(|cone| cone.ends_m).collect(), positions_m: parts.meshes.positions_m }
    }

    /// Appends the places of further parts.
    pub(crate) fn extend(&mut self, other: &Self) {
        self.ends_m.extend_from_slice(&other.ends_m);
        self.positions_m.extend_from_slice(&other.positions_m);
    }
}

/// Displacement of a fragment's point to where it is in another frame, pixels, v up; 0 where it is behind that eye.
pub(crate) fn displacement_px(fragment: &Fragment, scene: &SceneParts, lens: &Lens, other: &OtherFrame) -> Vec2 {
    let (here_m, there_m) = if fragment.part == PartId::SKY {
        let far = SKY_M * lens.ray(fragment.point_m.truncate());
        (lens.eye_m + far, other.lens.eye_m + far)
    } else {
        let point_m = lens.to_world(fragment.point_m);
        (point_m, moved_m(fragment.part, point_m, scene, &other.places))
    };
    let Some((here_px, there_px)) = lens.to_px(here_m).zip(other.lens.to_px(there_m)) else { return Vec2::ZERO };
    (there_px - here_px) * Vec2::new(1.0, -1.0)
}

/// The same point of a part in another frame, m.
fn moved_m(part: PartId, point_m: Vec3, scene: &SceneParts, other: &PartPlaces) -> Vec3 {
    match scene.shape(part) {
        None => point_m,
        Some(Shape::Cone(cone)) => moved_with_axis_m(point_m, scene.cones[cone].ends_m, other.ends_m[cone]),
        Some(Shape::Triangle(triangle)) => {
            let weights = weights(scene.meshes.corners_m(triangle), point_m);
            scene.meshes.blended(triangle, weights, &other.positions_m)
        }
    }
}

/// A point beside an axis, in metres, after the axis has moved.
fn moved_with_axis_m(point_m: Vec3, from_m: [Vec3; 2], to_m: [Vec3; 2]) -> Vec3 {
    let [along_m, other_along_m] = [from_m, to_m].map(|[start_m, end_m]| end_m - start_m);
    let share = (point_m - from_m[0]).dot(along_m) / along_m.length_squared().max(f32::MIN_POSITIVE);
    let offset_m = point_m - from_m[0] - share * along_m;
    let turned_m = match (along_m.try_normalize(), other_along_m.try_normalize()) {
        (Some(along), Some(other_along)) => Quat::from_rotation_arc(along, other_along) * offset_m,
        _ => offset_m,
    };
    to_m[0] + share * other_along_m + turned_m
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::visibility::{Cone, Owner};

    fn cone(ends_m: [Vec3; 2]) -> SceneParts {
        let cone = Cone { ends_m, radii_m: [0.1, 0.1], colour: Vec3::ONE, owner: Owner::SCENE };
        SceneParts { cones: vec![cone], ..SceneParts::default() }
    }

    fn lens(eye_x_m: f32) -> Lens {
        let eye_m = Vec3::new(eye_x_m, -5.0, 1.0);
        Lens::perspective([1000, 500], eye_m, eye_m + Vec3::Y, 1.0)
    }

    /// Displacement of the point of a part that lies at (0, 0, 1).
    fn of_part(part: PartId, scene: &SceneParts, other: &OtherFrame) -> Vec2 {
        let lens = lens(0.0);
        let point_m = if part == PartId::SKY { Vec3::Z } else { lens.to_camera(Vec3::Z) };
        displacement_px(&Fragment { part, samples: 1, depth_m: 5.0, point_m }, scene, &lens, other)
    }

    #[test]
    fn what_moves_right_and_up_has_positive_motion() {
        // A metre at a distance of five is a fifth of the picture's width.
        let scene = cone([Vec3::new(0.0, 0.0, 0.5), Vec3::new(0.0, 0.0, 1.5)]);
        let moved = cone([Vec3::new(1.0, 0.0, 0.75), Vec3::new(1.0, 0.0, 1.75)]);
        let motion = of_part(PartId(0), &scene, &OtherFrame { places: PartPlaces::of(moved), lens: lens(0.0) });
        assert!(motion.distance(Vec2::new(200.0, 50.0)) < 1e-2, "{motion}");
    }

    #[test]
    fn a_cone_that_turns_about_a_point_leaves_it_there() {
        let scene = cone([Vec3::new(0.0, 0.0, 0.5), Vec3::new(0.0, 0.0, 1.5)]);
        let turned = cone([Vec3::new(-0.5, 0.0, 1.0), Vec3::new(0.5, 0.0, 1.0)]);
        let motion = of_part(PartId(0), &scene, &OtherFrame { places: PartPlaces::of(turned), lens: lens(0.0) });
        assert!(motion.length() < 1e-3, "{motion}");
    }

    #[test]
    fn a_triangle_carries_its_points() {
        let mesh = |shift_m: Vec3| {
            let corners_m = [Vec3::ZERO, Vec3::X, Vec3::new(0.0, 0.0, 2.0)].map(|corner_m| corner_m + shift_m);
            let mut scene = SceneParts::default();
            scene.meshes.append(&corners_m, &[Vec3::Y; 3], &[Vec3::ONE; 3], &[[0, 1, 2]], Owner::SCENE);
            scene
        };
        let other = OtherFrame { places: PartPlaces::of(mesh(Vec3::new(-0.5, 0.0, 0.0))), lens: lens(0.0) };
        let motion = of_part(PartId(0), &mesh(Vec3::ZERO), &other);
        assert!(motion.distance(Vec2::new(-100.0, 0.0)) < 1e-2, "{motion}");
    }

    #[test]
    fn an_eye_that_moves_shifts_the_ground_and_not_the_sky() {
        let other = OtherFrame { places: PartPlaces::default(), lens: lens(0.5) };
        let [ground, sky] = [PartId::GROUND, PartId::SKY].map(|part| of_part(part, &SceneParts::default(), &other));
        assert!(ground.distance(Vec2::new(-100.0, 0.0)) < 1e-2 && sky.length() < 1e-2, "{ground} {sky}");
    }
}

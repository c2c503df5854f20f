//! The outline of a character's soles, bind space, m: a foot that rolls to a side stands on an edge, not on its middle line.

use glam::{Vec2, Vec3};

use crate::body::Joint;
use crate::character::model::Character;

/// Height above the ball up to which vertices belong to the sole, divided by the height of the hips.
const SOLE_HEIGHT: f32 = 0.02;
/// Number of directions in which the outline is found.
const DIRECTIONS: u16 = 8;

/// Points of the outline of one foot, those of the foot's role and those of the toes'. `leaders` are the roles that the
/// joints move with.
pub(crate) fn sole_outline_m(character: &Character, leaders: &[Joint], side: usize) -> [Vec<Vec3>; 2] {
    let sole_m = character.feet[side].ball_m.z + SOLE_HEIGHT * character.hips_over_soles_m;
    [Joint::FEET[side], Joint::TOES[side]].map(|role| {
        let mesh = &character.mesh;
        let is_of_role = |vertex: &usize| leaders[usize::from(mesh.joints[*vertex][0])] == role;
        let of_role = (0..mesh.positions_m.len()).filter(is_of_role).map(|vertex| mesh.positions_m[vertex]);
        outermost_m(&of_role.filter(|position_m| position_m.z < sole_m).collect::<Vec<Vec3>>())
    })
}

/// The points that lie farthest in each direction.
fn outermost_m(points_m: &[Vec3]) -> Vec<Vec3> {
    let farthest = |direction: u16| {
        let angle_rad = std::f32::consts::TAU * f32::from(direction) / f32::from(DIRECTIONS);
        let towards = Vec2::new(libm::cosf(angle_rad), libm::sinf(angle_rad));
        let along = |point_m: &&Vec3| point_m.truncate().dot(towards);
        points_m.iter().max_by(|a, b| along(a).total_cmp(&along(b))).copied()
    };
    (0..DIRECTIONS).filter_map(farthest).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_outline_holds_the_corners() {
        let points_m: Vec<Vec3> =
            (0..25).map(|index| Vec3::new((index % 5) as f32, (index / 5) as f32, 0.1 * index as f32)).collect();
        let outline_m = outermost_m(&points_m);
        for corner in [[0, 0], [4, 0], [0, 4], [4, 4]] {
            assert!(outline_m.contains(&points_m[corner[0] + 5 * corner[1]]), "{corner:?} of {outline_m:?}");
        }
        assert!(outermost_m(&[]).is_empty());
    }
}

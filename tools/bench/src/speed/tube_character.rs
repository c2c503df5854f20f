//! A character for measurements: tubes along the segments of the crowd's own skeleton, with as many triangles as figures
//! of the trade have. Bind space, metres.

use std::f32::consts::TAU;

use glam::{Quat, Vec3};
use motiondb::body::{JOINT_COUNT, Joint, Skeleton};
use motiondb::character::{Character, CharacterFoot, CharacterJoint, CharacterMesh, CutOut, Material};

/// Sides and rings of a tube: 7,128 triangles in all.
const TUBE: [usize; 2] = [18, 9];

/// The character of a skeleton.
pub(crate) fn tube_character(skeleton: &Skeleton) -> Character {
    let at_m = rest_m(skeleton);
    let at = |joint: Joint| at_m[joint.index()];
    let joint = |joint: Joint| CharacterJoint {
        name: joint.name().to_owned(),
        parent: joint.parent().map(|parent| parent.index() as u32),
        position_m: at(joint),
        orientation: Quat::IDENTITY,
    };
    let foot = |side: usize| {
        let (ankle_m, toe_m, foot) = (at(Joint::FEET[side]), at(Joint::TOES[side]), &skeleton.feet[side]);
        CharacterFoot {
            heel_m: ankle_m + foot.heel_m,
            ball_m: ankle_m + foot.ball_m,
            toe_tip_m: toe_m + foot.toe_tip_m,
        }
    };
    let mesh = mesh(skeleton, &at_m);
    Character {
        name: "tubes".to_owned(),
        joints: Joint::ALL.map(joint).to_vec(),
        roles: std::array::from_fn(|index| Some(index as u32)),
        feet: [foot(0), foot(1)],
        hips_over_soles_m: at(Joint::THIGHS[0]).z,
        leg_length_m: skeleton.leg_length_m(),
        height_m: mesh.positions_m.iter().map(|position_m| position_m.z).fold(0.0, f32::max),
        radius_m: 0.25,
        segment_radii_m: skeleton.segment_radii_m,
        mesh,
        textures: Vec::new(),
        extra: Vec::new(),
    }
}

/// Joints of the resting body, which stands on the ground.
fn rest_m(skeleton: &Skeleton) -> [Vec3; JOINT_COUNT] {
    let mut at_m = [Vec3::ZERO; JOINT_COUNT];
    for joint in &Joint::ALL[1..] {
        let parent_m = joint.parent().map_or(Vec3::ZERO, |parent| at_m[parent.index()]);
        at_m[joint.index()] = parent_m + skeleton.offsets_m[joint.index()];
    }
    let sole_m = at_m[Joint::FEET[0].index()] + skeleton.feet[0].heel_m;
    at_m.map(|position_m| position_m - sole_m.z * Vec3::Z)
}

fn mesh(skeleton: &Skeleton, at_m: &[Vec3; JOINT_COUNT]) -> CharacterMesh {
    let [sides, rings] = TUBE;
    let mut mesh = CharacterMesh::default();
    for joint in Joint::ALL {
        let index = joint.index();
        let (axis_m, radius_m) = (skeleton.segment_ends_m[index], skeleton.segment_radii_m[index].max(0.02));
        let across = axis_m.try_normalize().unwrap_or(Vec3::Z).any_orthonormal_pair();
        let parent = joint.parent().map_or(index, Joint::index) as u16;
        let first = mesh.positions_m.len() as u32;
        for ring in 0..=rings {
            let share = ring as f32 / rings as f32;
            // Joints bend softly.
            let own = if ring == 0 { 0.6 } else { 1.0 };
            for side in 0..sides {
                let (sin, cos) = libm::sincosf(TAU * side as f32 / sides as f32);
                let normal = cos * across.0 + sin * across.1;
                mesh.positions_m.push(at_m[index] + share * axis_m + radius_m * normal);
                mesh.normals.push(normal);
                mesh.colours.push([0.2 + 0.03 * index as f32, 0.4, 0.5]);
                mesh.joints.push([index as u16, parent, 0, 0]);
                mesh.weights.push([own, 1.0 - own, 0.0, 0.0]);
            }
        }
        for (ring, side) in (0..rings).flat_map(|ring| (0..sides).map(move |side| (ring, side))) {
            let corner = |ring: usize, side: usize| first + (ring * sides + side % sides) as u32;
            let [a, b, c, d] =
                [corner(ring, side), corner(ring, side + 1), corner(ring + 1, side), corner(ring + 1, side + 1)];
            mesh.triangles.extend([[a, b, d], [a, d, c]]);
        }
    }
    let triangle_count = mesh.triangles.len() as u32;
    mesh.materials.push(Material {
        name: "cloth".into(),
        mesh: "body".into(),
        triangle_count,
        is_double_sided: false,
        keeps_hue: false,
        texture: None,
        cut_out: CutOut::Opaque,
    });
    mesh
}

#[cfg(test)]
mod tests {
    use motiondb::character::first_fault;

    use super::*;
    use crate::kit::database::bundled;

    #[test]
    fn the_character_is_a_valid_one() {
        let character = tube_character(&bundled().unwrap().skeleton);
        assert_eq!(first_fault(&character), None);
        assert_eq!(character.mesh.triangles.len(), 7_128);
    }
}

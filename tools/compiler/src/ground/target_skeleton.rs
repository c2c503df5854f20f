//! The body that a database's examples share.
//!
//! One performer keeps his proportions; of several the median is taken, bone by bone, left and right alike so that
//! mirrored cycles fit. Rest pose and frames as in [`motiondb::body::Skeleton`]; metres.

use glam::{DVec3, Vec3};
use motiondb::body::{Foot, JOINT_COUNT, JOINT_RANGES_DEG, Joint, Skeleton};
use motiondb::statistics::median;

use crate::cycle::mean_stride::GaitCycle;
use crate::ground::anthropometry::SEGMENT_RADII_PER_STATURE;
use crate::ground::root_motion::leg_length_m;
use crate::retarget::human_clip::{HumanBody, HumanClip};

/// Thigh plus shank of adults, small woman to tall man; anything else is a toy or a giant and has no say.
const HUMAN_LEG_M: std::ops::RangeInclusive<f64> = 0.65..=1.05;

/// The body of the chosen clip, else the median of the human-sized performers, of all where none is.
pub(crate) fn choose(clips: &[HumanClip]) -> HumanBody {
    let human = |clip: &&HumanClip| HUMAN_LEG_M.contains(&leg_length_m(&clip.body));
    let bodies_of = |counts: &dyn Fn(&&HumanClip) -> bool| -> Vec<&HumanBody> {
        clips.iter().filter(counts).map(|clip| &clip.body).collect()
    };
    let candidates = [bodies_of(&|clip| clip.choices.is_target_skeleton), bodies_of(&human), bodies_of(&|_| true)];
    let bodies = candidates.into_iter().find(|bodies| !bodies.is_empty()).unwrap_or_default();
    let offsets_m = symmetric(&std::array::from_fn(|joint| middle(&bodies, |body| body.offsets_m[joint])));
    let segment_ends_m = symmetric(&std::array::from_fn(|joint| middle(&bodies, |body| body.segment_ends_m[joint])));
    let soles_m = median_feet(&bodies, |body| body.soles_m);
    // One body is measured in one way: on the sole where every clip shows it, else at the joints of those that do not.
    let at_joints: Vec<&HumanBody> = bodies.iter().copied().filter(|body| body.measured_m != body.soles_m).collect();
    let measured_m = if at_joints.is_empty() { soles_m } else { median_feet(&at_joints, |body| body.measured_m) };
    HumanBody { offsets_m, segment_ends_m, soles_m, measured_m }
}

/// Median of each component.
fn middle(bodies: &[&HumanBody], vector: impl Fn(&HumanBody) -> DVec3) -> DVec3 {
    let component = |axis: usize| median(bodies.iter().map(|body| vector(body)[axis]));
    DVec3::from_array([0, 1, 2].map(|axis| component(axis).expect("a set of clips has a body")))
}

const MIRROR: DVec3 = DVec3::new(1.0, -1.0, 1.0);

/// Each vector averaged with its mirror image.
fn symmetric(vectors: &[DVec3; JOINT_COUNT]) -> [DVec3; JOINT_COUNT] {
    std::array::from_fn(|index| 0.5 * (vectors[index] + MIRROR * vectors[Joint::ALL[index].mirrored().index()]))
}

/// Median points of both feet, each averaged with its mirror image.
fn median_feet(bodies: &[&HumanBody], points: impl Fn(&HumanBody) -> [[DVec3; 3]; 2]) -> [[DVec3; 3]; 2] {
    let middle = |side: usize, point: usize| middle(bodies, |body| points(body)[side][point]);
    [0, 1].map(|side| [0, 1, 2].map(|point| 0.5 * (middle(side, point) + MIRROR * middle(1 - side, point))))
}

/// The database's skeleton: bones, girths by stature, joint limits that hold every cycle.
pub(crate) fn skeleton<'a>(body: &HumanBody, cycles: impl Iterator<Item = &'a GaitCycle>) -> Skeleton {
    let rest = rest_positions_m(body);
    let sole_m = rest_soles_m(body, &rest).into_iter().fold(f64::INFINITY, f64::min);
    let crown_m = rest[Joint::Head.index()].z + body.segment_ends_m[Joint::Head.index()].z;
    let stature_m = crown_m - sole_m;
    let mut offsets_m = body.offsets_m.map(|offset| offset.as_vec3());
    offsets_m[0] = Vec3::new(0.0, 0.0, -sole_m as f32);
    Skeleton {
        offsets_m,
        segment_ends_m: body.segment_ends_m.map(|end| end.as_vec3()),
        segment_radii_m: SEGMENT_RADII_PER_STATURE.map(|radius| (radius * stature_m) as f32),
        limits_rad: limits_rad(cycles),
        feet: [0, 1].map(|side| {
            let [heel_m, ball_m, toe_tip_m] = body.soles_m[side].map(|point| point.as_vec3());
            Foot { heel_m, ball_m, toe_tip_m, measured_m: body.measured_m[side].map(|point| point.as_vec3()) }
        }),
    }
}

/// Joints in the rest pose, relative to the pelvis.
fn rest_positions_m(body: &HumanBody) -> [DVec3; JOINT_COUNT] {
    let mut positions = [DVec3::ZERO; JOINT_COUNT];
    for joint in &Joint::ALL[1..] {
        let Some(parent) = joint.parent() else { continue };
        positions[joint.index()] = positions[parent.index()] + body.offsets_m[joint.index()];
    }
    positions
}

fn rest_soles_m(body: &HumanBody, rest: &[DVec3; JOINT_COUNT]) -> Vec<f64> {
    (0..2)
        .flat_map(|side| {
            let (foot, toe) = (rest[Joint::FEET[side].index()].z, rest[Joint::TOES[side].index()].z);
            let [heel, ball, tip] = body.soles_m[side];
            [foot + heel.z, foot + ball.z, toe + tip.z]
        })
        .collect()
}

/// Published ranges, widened where a cycle goes beyond them, so that limits never forbid what the clips do.
fn limits_rad<'a>(cycles: impl Iterator<Item = &'a GaitCycle>) -> [[Vec3; 2]; JOINT_COUNT] {
    let mut limits = JOINT_RANGES_DEG.map(|range| range.map(|degrees| Vec3::from_array(degrees.map(f32::to_radians))));
    for row in cycles.flat_map(|cycle| &cycle.rows) {
        for (range, rotation) in limits.iter_mut().zip(&row.rotations) {
            let vector = (if rotation.w < 0.0 { -*rotation } else { *rotation }).to_scaled_axis().as_vec3();
            *range = [range[0].min(vector), range[1].max(vector)];
        }
    }
    limits
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synthetic::{self, Walk, cycle_of};

    #[test]
    fn one_performer_keeps_his_bones() {
        let clips = [synthetic::walk("a", Walk::default()), synthetic::idle("b", 1.0)];
        let body = choose(&clips);
        assert_eq!(body, clips[0].body);
    }

    #[test]
    fn giants_and_toys_have_no_say() {
        let sizes = [1.0, 1.1, 0.9, 3.0, 0.3];
        let clips = sizes.map(|size| synthetic::walk("walk", Walk { size, duration_s: 0.1, ..Walk::default() }));
        assert!((leg_length_m(&choose(&clips)) - 0.84).abs() < 1e-9);
        assert!((leg_length_m(&choose(&clips[3..4])) - 2.52).abs() < 1e-9);
    }

    #[test]
    fn limits_hold_every_row_and_the_standing_height_is_that_of_the_legs() {
        let clip = synthetic::walk("walk", Walk::default());
        let cycle = cycle_of(&clip);
        let skeleton = skeleton(&clip.body, std::iter::once(&cycle));
        assert!((skeleton.offsets_m[0].z - 0.93).abs() < 1e-6);
        for row in &cycle.rows {
            for (rotation, [least, greatest]) in row.rotations.iter().zip(skeleton.limits_rad) {
                let vector = (if rotation.w < 0.0 { -*rotation } else { *rotation }).to_scaled_axis().as_vec3();
                assert!(vector.cmpge(least).all() && vector.cmple(greatest).all());
            }
        }
    }

    #[test]
    fn published_limits_are_mirror_images() {
        for joint in Joint::ALL {
            let [least, greatest] = JOINT_RANGES_DEG[joint.index()];
            let [mirrored_least, mirrored_greatest] = JOINT_RANGES_DEG[joint.mirrored().index()];
            // A rotation vector's x and z change sign in the mirror y = 0, its y does not.
            assert_eq!([-greatest[0], least[1], -greatest[2]], mirrored_least, "{}", joint.name());
            assert_eq!([-least[0], greatest[1], -least[2]], mirrored_greatest, "{}", joint.name());
            let radius = SEGMENT_RADII_PER_STATURE[joint.index()];
            assert_eq!(radius, SEGMENT_RADII_PER_STATURE[joint.mirrored().index()]);
        }
    }
}

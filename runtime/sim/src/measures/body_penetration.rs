//! How deep bodies reach into each other. The paper measures discs only (App. 11, Eqs. 16, 17), which bodies neither
//! fill nor stay within.
//!
//! A body is a capsule per bone of the recording's skeleton (trunk, head, limbs). The depth of a pair of bodies in a
//! frame is the deepest overlap of a capsule of one with a capsule of the other: the sum of both radii less the
//! distance of the bones. Only frames count, not the motion between them.
//!
//! Bodies are sorted along the crowd's longer side. If the boxes of a pair meet, only capsules whose own boxes meet
//! are compared. World axes, metres; capsules relative to their root, so that the distance from the origin costs no
//! precision.

use glam::{DVec2, Quat, Vec2};
use motiondb::body::{JOINT_COUNT, Joints, Root, Skeleton};

use crate::maths::segment_distance::{Segment, distance_m};
use crate::maths::sweep::sort_along_longer_side;
use crate::measures::bone_capsule::{BoneCapsule, Bounds, bone};

/// Sums depths over all pairs, frame by frame.
#[derive(Debug)]
pub(crate) struct BodyPenetration {
    skeleton: Skeleton,
    /// Agents sorted along the crowd's longer side; hardly changes from frame to frame, so sorting stays cheap.
    order: Vec<usize>,
    bodies: Vec<CapsuleBody>,
    /// Whether each body touches another in the present frame.
    touches: Vec<bool>,
    agent_frames: usize,
    touching_agent_frames: usize,
    touching_pair_frames: usize,
    depth_m: f64,
    greatest_m: f64,
}

/// Penetration of bodies over a whole recording.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Penetration {
    /// Depths of all pairs, summed over frames, per agent and frame, mm: for bodies what Eq. 17 is for discs.
    pub(crate) mean_mm: f64,
    /// Mean depth of the pairs that touch, over the frames in which they do, mm; none where no bodies ever touched.
    pub(crate) touching_mm: Option<f64>,
    /// Greatest depth of any pair in any frame, mm.
    pub(crate) greatest_mm: f64,
    /// Share of agents and frames in which a body touches another.
    pub(crate) touching_share: f64,
}

/// A posed body.
#[derive(Clone, Debug)]
struct CapsuleBody {
    position_m: Vec2,
    /// World axes, relative to the position.
    capsules: [BoneCapsule; JOINT_COUNT],
    bounds: Bounds,
}

/// A body of a frame.
pub(crate) struct PosedBody<'a> {
    /// Its root.
    pub(crate) root: &'a Root,
    /// Its joints in the root's frame, m.
    pub(crate) joints: &'a Joints,
    /// Its size, relative to the skeleton.
    pub(crate) stature: f32,
    /// Radii of the segments of the character that it wears, at the skeleton's size, m; none of a plain body.
    pub(crate) character_radii_m: Option<&'a [f32]>,
}

impl BodyPenetration {
    /// No frames yet.
    pub(crate) fn new(skeleton: &Skeleton) -> Self {
        Self {
            skeleton: skeleton.clone(),
            order: Vec::new(),
            bodies: Vec::new(),
            touches: Vec::new(),
            agent_frames: 0,
            touching_agent_frames: 0,
            touching_pair_frames: 0,
            depth_m: 0.0,
            greatest_m: 0.0,
        }
    }

    /// Adds one frame: the bodies of all present agents.
    pub(crate) fn push<'a>(&mut self, bodies: impl Iterator<Item = PosedBody<'a>>) {
        self.bodies.clear();
        self.bodies.extend(bodies.map(|body| CapsuleBody::new(&self.skeleton, &body)));
        if self.order.len() != self.bodies.len() {
            self.order = (0..self.bodies.len()).collect();
        }
        let positions_m = self.bodies.iter().map(|body| body.position_m);
        let low_m = |index: usize, axis: usize| self.bodies[index].low_m(axis).into();
        let axis = sort_along_longer_side(&mut self.order, positions_m, low_m);
        self.touches.clear();
        self.touches.resize(self.bodies.len(), false);
        for rank in 0..self.order.len() {
            self.compare_with_followers(rank, axis);
        }
        self.agent_frames += self.bodies.len();
        self.touching_agent_frames += self.touches.iter().filter(|&&touches| touches).count();
    }

    /// Compares one body with those that begin before it ends.
    fn compare_with_followers(&mut self, rank: usize, axis: usize) {
        let a = self.order[rank];
        let high_m = self.bodies[a].high_m(axis);
        for &b in &self.order[rank + 1..] {
            if self.bodies[b].low_m(axis) >= high_m {
                break;
            }
            let depth_m = f64::from(depth_m(&self.bodies[a], &self.bodies[b]));
            if depth_m > 0.0 {
                self.touches[a] = true;
                self.touches[b] = true;
                self.touching_pair_frames += 1;
                self.depth_m += depth_m;
                self.greatest_m = self.greatest_m.max(depth_m);
            }
        }
    }

    /// The measures after the last frame.
    pub(crate) fn finish(&self) -> Penetration {
        let touching = self.touching_pair_frames;
        Penetration {
            mean_mm: 1e3 * self.depth_m / self.agent_frames.max(1) as f64,
            touching_mm: (touching > 0).then(|| 1e3 * self.depth_m / touching as f64),
            greatest_mm: 1e3 * self.greatest_m,
            touching_share: self.touching_agent_frames as f64 / self.agent_frames.max(1) as f64,
        }
    }
}

impl CapsuleBody {
    fn new(skeleton: &Skeleton, body: &PosedBody) -> Self {
        let &PosedBody { root, joints, stature, character_radii_m } = body;
        let turn = Quat::from_rotation_z(root.facing_rad);
        let (sized, radii_m) = (skeleton.sized(stature), character_radii_m.unwrap_or(&skeleton.segment_radii_m));
        let capsules = std::array::from_fn(|joint| {
            let Segment { from_m, to_m } = bone(&sized, joints, joint);
            BoneCapsule::new(Segment { from_m: turn * from_m, to_m: turn * to_m }, stature * radii_m[joint])
        });
        let bounds = capsules.iter().map(|capsule: &BoneCapsule| capsule.bounds).fold(Bounds::EMPTY, Bounds::with);
        Self { position_m: root.position_m, capsules, bounds }
    }

    fn low_m(&self, axis: usize) -> f32 {
        self.position_m[axis] + self.bounds.low_m[axis]
    }

    fn high_m(&self, axis: usize) -> f32 {
        self.position_m[axis] + self.bounds.high_m[axis]
    }
}

/// The deepest overlap of a capsule of one body with one of the other, m; 0 where they do not touch.
fn depth_m(a: &CapsuleBody, b: &CapsuleBody) -> f32 {
    let offset_m = (DVec2::from(b.position_m) - DVec2::from(a.position_m)).as_vec2().extend(0.0);
    if !a.bounds.meets(&b.bounds.shifted(offset_m)) {
        return 0.0;
    }
    let mut deepest_m: f32 = 0.0;
    for other in b.capsules.iter().map(|capsule| capsule.shifted(offset_m)) {
        if !a.bounds.meets(&other.bounds) {
            continue;
        }
        for one in a.capsules.iter().filter(|one| one.bounds.meets(&other.bounds)) {
            deepest_m = deepest_m.max(one.radius_m + other.radius_m - distance_m(&one.bone, &other.bone));
        }
    }
    deepest_m
}

#[cfg(test)]
mod tests {
    use glam::Vec3;
    use motiondb::body::Pose;
    use proptest::prelude::*;

    use super::*;
    use crate::test_db::test_db;

    /// A body in a random posture.
    fn body() -> impl Strategy<Value = (Root, Pose)> {
        let root = (-1.5_f32..1.5, -1.5_f32..1.5, -4.0_f32..4.0);
        let turns = proptest::collection::vec((-1.0_f32..1.0, -1.0_f32..1.0, -1.0_f32..1.0), JOINT_COUNT);
        (root, turns).prop_map(|((x, y, facing_rad), turns)| {
            let rotations = std::array::from_fn(|joint| Quat::from_scaled_axis(Vec3::from(turns[joint])).normalize());
            (Root { position_m: Vec2::new(x, y), facing_rad }, Pose { pelvis_m: Vec3::new(0.0, 0.0, 0.9), rotations })
        })
    }

    /// Every capsule against every capsule, in the world.
    fn brute_m(skeleton: &Skeleton, [a, b]: [&(Root, Joints); 2]) -> f32 {
        let capsule = |(root, joints): &(Root, Joints), joint: usize| {
            let end_m = joints.positions_m[joint] + joints.orientations[joint] * skeleton.segment_ends_m[joint];
            Segment { from_m: root.to_world(joints.positions_m[joint]), to_m: root.to_world(end_m) }
        };
        let depth_m = |(i, j): (usize, usize)| {
            skeleton.segment_radii_m[i] + skeleton.segment_radii_m[j] - distance_m(&capsule(a, i), &capsule(b, j))
        };
        (0..JOINT_COUNT).flat_map(|i| (0..JOINT_COUNT).map(move |j| (i, j))).map(depth_m).fold(0.0, f32::max)
    }

    proptest! {
        #[test]
        fn the_sweep_finds_what_brute_force_finds(bodies in proptest::collection::vec(body(), 2..12)) {
            let skeleton = test_db().skeleton;
            let posed: Vec<(Root, Joints)> =
                bodies.iter().map(|(root, pose)| (*root, pose.forward_kinematics(&skeleton))).collect();
            let mut found = BodyPenetration::new(&skeleton);
            found.push(posed.iter().map(|(root, joints)| PosedBody {
                root,
                joints,
                stature: 1.0,
                character_radii_m: None,
            }));
            let pairs = (0..posed.len()).flat_map(|i| (i + 1..posed.len()).map(move |j| (i, j)));
            let depths_m: Vec<f32> = pairs.map(|(i, j)| brute_m(&skeleton, [&posed[i], &posed[j]])).collect();
            let (sum_m, greatest_m) = (depths_m.iter().sum::<f32>(), depths_m.iter().copied().fold(0.0, f32::max));
            let found = found.finish();
            prop_assert!((found.mean_mm * posed.len() as f64 - 1e3 * f64::from(sum_m)).abs() < 0.02);
            prop_assert!((found.greatest_mm - 1e3 * f64::from(greatest_m)).abs() < 0.01);
        }
    }
}

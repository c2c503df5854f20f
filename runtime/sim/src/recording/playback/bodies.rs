//! Bodies at any time of a recording.
//!
//! Between two recorded frames root and pose are blended. Then each leg reaches for its foot, whose path is made of its
//! recorded places, so that planted feet stay planted. Births, removals and teleports are not blended: until the later
//! frame, the earlier one is shown.
//!
//! Roots are in the world, poses in their root frames; metres, seconds.

use std::f32::consts::{PI, TAU};

use glam::{Quat, Vec2, Vec3};
use motiondb::body::{Foot, Joint, Pose, Root, RootFrame, Skeleton};

use crate::maths::angle::yaw;
use crate::planning::plan::PLANTED_CONTACT;
use crate::recording::error::RecordingError;
use crate::recording::frame::AgentFrame;
use crate::recording::playback::times::{Between, between};
use crate::recording::reader::Recording;
use crate::synthesis::pose::{FootPose, PosedLeg, ik};

/// All present agents at a time, s; between two recorded frames, a blend of both. An agent is shown from its frame of
/// birth up to its removal; one that the later frame lacks, or to which it is teleported, is shown as in the earlier one.
///
/// # Errors
/// If a frame cannot be read.
pub fn sample(recording: &Recording, time_s: f64) -> Result<Vec<AgentFrame>, RecordingError> {
    let Between { frame, later } = between(recording, time_s);
    let mut agents = Vec::new();
    recording.read_frame(frame, &mut agents)?;
    let Some((after, share)) = later else { return Ok(agents) };
    let mut later = Vec::new();
    recording.read_frame(after, &mut later)?;
    let skeleton = recording.header().skeleton();
    let lives = &recording.population().agents;
    let jumps = |agent: &AgentFrame| lives.get(agent.id.index()).is_some_and(|life| life.is_teleported(after as u32));
    let next = |agent: &AgentFrame| later.binary_search_by_key(&agent.id, |next| next.id).ok();
    let blended = |agent: &AgentFrame| match next(agent) {
        Some(next) if !jumps(agent) => blend(agent, &later[next], share, skeleton),
        _ => *agent,
    };
    Ok(agents.iter().map(blended).collect())
}

/// A body between two frames. Contacts are those of the nearer frame, all else but root and pose of the earlier one.
fn blend(agent: &AgentFrame, next: &AgentFrame, share: f32, skeleton: &Skeleton) -> AgentFrame {
    let (from, to) = (agent.root.facing_rad, next.root.facing_rad);
    let turn_rad = (to - from + PI).rem_euclid(TAU) - PI;
    let rotation = |joint: usize| agent.pose.rotations[joint].lerp(next.pose.rotations[joint], share);
    let mut blended = AgentFrame {
        root: Root {
            position_m: agent.root.position_m.lerp(next.root.position_m, share),
            facing_rad: from + share * turn_rad,
        },
        pose: Pose {
            pelvis_m: agent.pose.pelvis_m.lerp(next.pose.pelvis_m, share),
            rotations: std::array::from_fn(rotation),
        },
        contacts: if share < 0.5 { agent.contacts } else { next.contacts },
        ..*agent
    };
    for side in [0, 1] {
        hold_foot(&mut blended, [agent, next], share, side, skeleton);
    }
    blended
}

/// Moves a foot to its place between two frames, if it is planted in one of them. A foot that lifts stays for the first
/// half of the step, one that lands has landed for the second half.
fn hold_foot(body: &mut AgentFrame, frames: [&AgentFrame; 2], share: f32, side: usize, skeleton: &Skeleton) {
    let share = match frames.map(|frame| frame.contacts[side] >= PLANTED_CONTACT) {
        [false, false] => return,
        [true, true] => share,
        [true, false] => (2.0 * share - 1.0).max(0.0),
        [false, true] => (2.0 * share).min(1.0),
    };
    // Relative to the body, so that the distance from the origin costs no precision.
    let origin_m = body.root.position_m;
    let [from, to] = frames.map(|frame| PlacedFoot::new(frame, origin_m, side, skeleton));
    let (orientation, toe) = (from.orientation.lerp(to.orientation, share), from.toe.lerp(to.toe, share));
    let from_ankle_m = points_from_ankle_m(skeleton, side, orientation, toe);
    // Each frame's own contact point moves straight; the ankle follows from it.
    let ankle_m = |point: usize| from.points_m[point].lerp(to.points_m[point], share) - from_ankle_m[point];
    let ankle_m = ankle_m(from.lowest).lerp(ankle_m(to.lowest), share);
    let root = RootFrame { position_m: Vec2::ZERO, ..body.root.frame() };
    let back = yaw(body.root.facing_rad).conjugate();
    let target = FootPose { ankle_m: root.to_local(ankle_m), orientation: (back * orientation).normalize() };
    let mut leg = PosedLeg::new(&body.pose, skeleton, side);
    ik::reach(&mut body.pose, &mut leg, skeleton, side, &target);
    body.pose.rotations[Joint::TOES[side].index()] = (orientation.conjugate() * toe).normalize();
}

/// A foot of a recorded frame. World axes; metres.
struct PlacedFoot {
    /// Orientation of the foot.
    orientation: Quat,
    /// Orientation of the toes.
    toe: Quat,
    /// Heel, ball and toe tip where slide is measured, from an origin on the ground.
    points_m: [Vec3; 3],
    /// Index of the lowest of them.
    lowest: usize,
}

impl PlacedFoot {
    fn new(frame: &AgentFrame, origin_m: Vec2, side: usize, skeleton: &Skeleton) -> Self {
        let chain = frame.pose.chain(skeleton, PosedLeg::joints(side));
        let ((ankle_m, foot), (_, toe)) = (chain[2], chain[3]);
        let root = RootFrame { position_m: frame.root.position_m - origin_m, ..frame.root.frame() };
        let turn = yaw(frame.root.facing_rad);
        let (orientation, toe) = (turn * foot, turn * toe);
        let from_ankle_m = points_from_ankle_m(skeleton, side, orientation, toe);
        let Foot { heel_m, ball_m, toe_tip_m, measured_m } = skeleton.feet[side];
        let soles_m = [heel_m, ball_m, toe_tip_m];
        let height_m = |point: usize| from_ankle_m[point].z - (measured_m[point].z - soles_m[point].z);
        let lowest = (1..3).fold(0, |best, point| if height_m(point) < height_m(best) { point } else { best });
        let ankle_m = root.to_world(ankle_m);
        Self { orientation, toe, points_m: from_ankle_m.map(|point_m| ankle_m + point_m), lowest }
    }
}

/// Heel, ball and toe tip where slide is measured, from the ankle, m.
fn points_from_ankle_m(skeleton: &Skeleton, side: usize, orientation: Quat, toe: Quat) -> [Vec3; 3] {
    let [heel_m, ball_m, toe_tip_m] = skeleton.feet[side].measured_m;
    let toe_joint_m = skeleton.offsets_m[Joint::TOES[side].index()];
    [orientation * heel_m, orientation * ball_m, orientation * toe_joint_m + toe * toe_tip_m]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_db::test_db;

    #[test]
    fn a_blended_facing_turns_the_shorter_side() {
        let db = test_db();
        let at = |facing_rad: f32| AgentFrame { root: Root { facing_rad, ..Root::default() }, ..AgentFrame::default() };
        for (from, to, middle) in [(3.0, -3.0, PI), (0.2, -0.2, 0.0), (7.0, 7.2, 7.1)] {
            let found = blend(&at(from), &at(to), 0.5, &db.skeleton).root.facing_rad;
            assert!((found - middle).abs() < 1e-4, "{from} {to} {found}");
        }
    }

    #[test]
    fn a_planted_foot_that_stands_still_keeps_its_place_while_the_body_passes() {
        let db = test_db();
        // The same foot in the world, while the root turns and moves.
        let pose = db.rows.pose(1, 0);
        let from = AgentFrame { pose, ..AgentFrame::default() };
        let root = Root { position_m: Vec2::new(0.05, 0.01), facing_rad: 0.05 };
        let mut to = AgentFrame { root, ..from };
        let skeleton = &db.skeleton;
        let placed = |frame: &AgentFrame| PlacedFoot::new(frame, Vec2::ZERO, 0, skeleton);
        let foot = placed(&from);
        let back = yaw(root.facing_rad).conjugate();
        let mut leg = PosedLeg::new(&to.pose, skeleton, 0);
        let ankle_m = foot.points_m[1] - foot.orientation * skeleton.feet[0].measured_m[1];
        let target = FootPose { ankle_m: root.frame().to_local(ankle_m), orientation: back * foot.orientation };
        ik::reach(&mut to.pose, &mut leg, skeleton, 0, &target);
        assert!(placed(&to).points_m[1].distance(foot.points_m[1]) < 1e-4);
        for share in [0.1, 0.4, 0.8] {
            let moved = placed(&blend(&from, &to, share, skeleton));
            let slide_m = moved.points_m.iter().zip(foot.points_m).map(|(now, then)| now.distance(then));
            assert!(slide_m.fold(0.0, f32::max) < 2e-4, "{share}");
        }
    }
}

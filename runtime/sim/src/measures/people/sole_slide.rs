//! Slide of planted feet at two places: on the sole, and at the joints above it.
//!
//! As [`planted_slide`](crate::measures::planted_slide) measures. A sole that rolls carries the joints over it along, so
//! the slide of joints is greater; captures without points on the sole have nothing else. cm/s.

use glam::Vec3;
use motiondb::body::{Foot, Joint, Joints, Skeleton};
use serde::Serialize;

use crate::measures::planted_slide::PlantedSlide;
use crate::recording::frame::AgentFrame;

/// Slide of planted feet, cm/s; none where no foot is planted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct SoleSlide {
    /// Slide of the lowest of heel, ball and toe tip on the sole, cm/s.
    pub at_soles_cm_s: Option<f64>,
    /// Slide of the lowest of ankle, ball and toe tip at the joints, each over its height when planted, cm/s.
    pub at_joints_cm_s: Option<f64>,
    /// Share of feet and frames that are planted.
    pub planted_share: f64,
}

/// Measures every foot at both places.
#[derive(Debug)]
pub(crate) struct SoleSlideTally {
    soles: PlantedSlide,
    joints: PlantedSlide,
}

impl SoleSlideTally {
    /// No frames yet.
    pub(crate) fn new(dt_s: f32) -> Self {
        let slide = || PlantedSlide::new(0, dt_s);
        Self { soles: slide(), joints: slide() }
    }

    /// Adds one frame of one agent, given its skeleton and its joints in its root's frame.
    pub(crate) fn push(&mut self, agent: &AgentFrame, skeleton: &Skeleton, joints: &Joints) {
        let index = agent.id.index();
        let soles_m = [0, 1].map(|side| joints.sole_points_m(skeleton, side));
        self.soles.push_feet(index, agent, soles_m);
        self.joints.push_feet(index, agent, [0, 1].map(|side| lowered_joints_m(skeleton, joints, side)));
    }

    /// Ends the contacts of an agent that is moved at once.
    pub(crate) fn lift(&mut self, index: usize) {
        self.soles.lift(index);
        self.joints.lift(index);
    }

    /// The measures after the last frame.
    pub(crate) fn finish(self) -> SoleSlide {
        let soles = self.soles.finish();
        SoleSlide {
            at_soles_cm_s: soles.slide_cm_s,
            at_joints_cm_s: self.joints.finish().slide_cm_s,
            planted_share: soles.planted_share,
        }
    }
}

/// Ankle, ball and end of the toe at the joints, each lowered by its height over the sole, m.
fn lowered_joints_m(skeleton: &Skeleton, joints: &Joints, side: usize) -> [Vec3; 3] {
    let Foot { heel_m, ball_m, toe_tip_m, .. } = skeleton.feet[side];
    let (foot, toe) = (Joint::FEET[side], Joint::TOES[side]);
    let (ball, end_m) = (skeleton.offsets_m[toe.index()], skeleton.segment_ends_m[toe.index()]);
    let points_m = [joints.positions_m[foot.index()], joints.positions_m[toe.index()], joints.point_m(toe, end_m)];
    let heights_m = [-heel_m.z, ball.z - ball_m.z, end_m.z - toe_tip_m.z];
    [0, 1, 2].map(|point| points_m[point] - heights_m[point] * Vec3::Z)
}

#[cfg(test)]
mod tests {
    use glam::Quat;

    use super::*;
    use crate::test_db::test_db;

    #[test]
    fn a_rolling_foot_slides_at_its_joints_only() {
        let db = test_db();
        let mut tally = SoleSlideTally::new(1.0 / 60.0);
        // The left foot rolls down about its heel by 0.5 rad/s.
        let heel_m = db.skeleton.feet[0].heel_m;
        for frame in 0..60 {
            let mut agent = AgentFrame { pose: db.rows.pose(0, 0), ..AgentFrame::default() };
            agent.contacts = [1.0, 0.0];
            let mut joints = agent.pose.forward_kinematics(&db.skeleton);
            let (foot, toe) = (Joint::LeftFoot.index(), Joint::LeftToe.index());
            let turn = Quat::from_rotation_y(0.5 * (frame as f32 / 60.0 - 1.0));
            let fixed_m = joints.point_m(Joint::LeftFoot, heel_m);
            joints.orientations[foot] = turn;
            joints.orientations[toe] = turn;
            joints.positions_m[foot] = fixed_m - turn * heel_m;
            joints.positions_m[toe] = joints.positions_m[foot] + turn * db.skeleton.offsets_m[toe];
            tally.push(&agent, &db.skeleton, &joints);
        }
        let found = tally.finish();
        // The ankle is 8 cm over the heel and 5 cm ahead of it.
        assert!(found.at_soles_cm_s.unwrap() < 0.01, "{found:?}");
        assert!((4.0..5.0).contains(&found.at_joints_cm_s.unwrap()), "{found:?}");
        assert_eq!(found.planted_share, 0.5);
    }
}

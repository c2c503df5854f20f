//! A posed skeleton as lines through its joints: the trunk in ink, the left side in green, the right in violet, and
//! under each foot the line of its sole, heel to toe tip.

use glam::{Vec2, Vec3};
use motiondb::body::{Joint, Joints, Pose, Side, Skeleton};
use tiny_skia::{LineCap, LineJoin, PathBuilder, Pixmap, Stroke, Transform};

use crate::plots::chart::mark::PlotMark;
use crate::raster::paint::paint;
use crate::raster::palette::{INK, Rgb, SIDES};

/// Width of bones and of soles, radius of the discs at joints, pixels.
const BONE_PX: f32 = 2.0;
const SOLE_PX: f32 = 1.2;
const JOINT_PX: f32 = 2.2;

/// Joints from the pelvis to the head, and of one side's arm and leg, `[left, right]`; to each end joint comes the far
/// end of its segment.
const TRUNK: [Joint; 6] =
    [Joint::Pelvis, Joint::SpineLower, Joint::SpineMiddle, Joint::SpineUpper, Joint::Neck, Joint::Head];
const ARMS: [[Joint; 5]; 2] = [
    [Joint::SpineUpper, Joint::LeftClavicle, Joint::LeftUpperArm, Joint::LeftForearm, Joint::LeftHand],
    [Joint::SpineUpper, Joint::RightClavicle, Joint::RightUpperArm, Joint::RightForearm, Joint::RightHand],
];
const LEGS: [[Joint; 5]; 2] = [
    [Joint::Pelvis, Joint::LeftThigh, Joint::LeftShank, Joint::LeftFoot, Joint::LeftToe],
    [Joint::Pelvis, Joint::RightThigh, Joint::RightShank, Joint::RightFoot, Joint::RightToe],
];

/// Some joints in a row, or a sole; root frame, metres.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Stick {
    points_m: Vec<Vec3>,
    colour: Rgb,
    is_sole: bool,
}

/// All lines of a pose, the trunk's first.
pub(crate) fn sticks(skeleton: &Skeleton, pose: &Pose) -> Vec<Stick> {
    let joints = pose.forward_kinematics(skeleton);
    let mut sticks = vec![bones(skeleton, &joints, &TRUNK, INK)];
    for side in Side::BOTH.map(Side::index) {
        let points_m = joints.sole_points_m(skeleton, side).to_vec();
        sticks.push(Stick { points_m, colour: SIDES[side], is_sole: true });
        sticks.push(bones(skeleton, &joints, &LEGS[side], SIDES[side]));
        sticks.push(bones(skeleton, &joints, &ARMS[side], SIDES[side]));
    }
    sticks
}

fn bones(skeleton: &Skeleton, joints: &Joints, chain: &[Joint], colour: Rgb) -> Stick {
    let mut points_m: Vec<Vec3> = chain.iter().map(|joint| joints.positions_m[joint.index()]).collect();
    points_m.extend(chain.last().map(|&leaf| joints.point_m(leaf, skeleton.segment_ends_m[leaf.index()])));
    Stick { points_m, colour, is_sole: false }
}

/// Draws one; `to_px` looks at the root frame.
pub(crate) fn draw(pixmap: &mut Pixmap, stick: &Stick, to_px: impl Fn(Vec3) -> Vec2) {
    let points_px: Vec<Vec2> = stick.points_m.iter().map(|&point_m| to_px(point_m)).collect();
    let [first, rest @ ..] = &points_px[..] else { return };
    let mut path = PathBuilder::new();
    path.move_to(first.x, first.y);
    rest.iter().for_each(|point| path.line_to(point.x, point.y));
    let width = if stick.is_sole { SOLE_PX } else { BONE_PX };
    let stroke = Stroke { width, line_cap: LineCap::Round, line_join: LineJoin::Round, ..Stroke::default() };
    if let Some(path) = path.finish() {
        pixmap.stroke_path(&path, &paint(stick.colour, 1.0), &stroke, Transform::identity(), None);
    }
    if !stick.is_sole {
        points_px.iter().for_each(|&point_px| PlotMark::Disc.draw(pixmap, point_px, JOINT_PX, stick.colour));
    }
}

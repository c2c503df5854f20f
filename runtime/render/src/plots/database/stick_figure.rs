//! A stick figure: a posed skeleton as lines through its joints (the trunk in ink, the left side green, the right side
//! violet), and each sole as a line from heel to toe tip. Root frame, metres.

use glam::{Vec2, Vec3};
use motiondb::body::{Joint, Joints, Pose, Side, Skeleton};
use tiny_skia::Pixmap;

use crate::plots::chart::mark::PlotMark;
use crate::raster::paint::{paint, path_through, round_stroke, stroke};
use crate::raster::palette::{INK, Rgb, SIDES};

/// Width of the lines of bones, pixels.
const BONE_PX: f32 = 2.0;
/// Width of the lines of soles, pixels.
const SOLE_PX: f32 = 1.2;
/// Radius of the discs at joints, pixels.
const JOINT_PX: f32 = 2.2;

/// Joints of the trunk, from the pelvis to the head.
const TRUNK: [Joint; 6] =
    [Joint::Pelvis, Joint::SpineLower, Joint::SpineMiddle, Joint::SpineUpper, Joint::Neck, Joint::Head];
/// Joints of both arms, `[left, right]`, from the trunk to the hand.
const ARMS: [[Joint; 5]; 2] = [
    [Joint::SpineUpper, Joint::LeftClavicle, Joint::LeftUpperArm, Joint::LeftForearm, Joint::LeftHand],
    [Joint::SpineUpper, Joint::RightClavicle, Joint::RightUpperArm, Joint::RightForearm, Joint::RightHand],
];
/// Joints of both legs, `[left, right]`, from the pelvis to the toe.
const LEGS: [[Joint; 5]; 2] = [
    [Joint::Pelvis, Joint::LeftThigh, Joint::LeftShank, Joint::LeftFoot, Joint::LeftToe],
    [Joint::Pelvis, Joint::RightThigh, Joint::RightShank, Joint::RightFoot, Joint::RightToe],
];

/// A line of a stick figure: a chain of joints, or a sole.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Stick {
    /// Points along the line, root frame, metres.
    points_m: Vec<Vec3>,
    colour: Rgb,
    is_sole: bool,
}

/// All lines of a pose; the trunk is the first.
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

/// Line through a chain of joints, and to the far end of the last one's segment.
fn bones(skeleton: &Skeleton, joints: &Joints, chain: &[Joint], colour: Rgb) -> Stick {
    let mut points_m: Vec<Vec3> = chain.iter().map(|joint| joints.positions_m[joint.index()]).collect();
    points_m.extend(chain.last().map(|&leaf| joints.point_m(leaf, skeleton.segment_ends_m[leaf.index()])));
    Stick { points_m, colour, is_sole: false }
}

/// Draws a line; `to_px` projects points of the root frame.
pub(crate) fn draw(pixmap: &mut Pixmap, stick: &Stick, to_px: impl Fn(Vec3) -> Vec2) {
    let points_px: Vec<Vec2> = stick.points_m.iter().map(|&point_m| to_px(point_m)).collect();
    let width = if stick.is_sole { SOLE_PX } else { BONE_PX };
    if let Some(path) = path_through(points_px.iter().copied(), false) {
        stroke(pixmap, &path, &paint(stick.colour, 1.0), &round_stroke(width), None);
    }
    if !stick.is_sole {
        points_px.iter().for_each(|&point_px| PlotMark::Disc.draw(pixmap, point_px, JOINT_PX, stick.colour));
    }
}

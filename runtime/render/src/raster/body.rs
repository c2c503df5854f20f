//! A person from above: the limbs of one posed skeleton, from the shoes up to the hair, as swept balls in the world.
//!
//! Bones come from forward kinematics, girths from the skeleton's `segment_radii_m`; what a capsule per bone does not
//! give (a trunk broader than deep, a face, hair) is composed here from several. World metres, z up.

use fbcrowd_sim::recording::AgentFrame;
use glam::Vec3;
use motiondb::body::{Joint, Joints, Side, Skeleton};

use crate::raster::palette::{Look, Rgb, SHOE};

/// Half a shoulder breadth of pixels below which single limbs cannot be told apart: fewer parts are drawn.
const FULL_DETAIL_PX: f32 = 4.5;
/// Half a shoulder breadth of pixels below which only trunk, head and the direction of the face are drawn.
const SOME_DETAIL_PX: f32 = 2.0;
/// Half a shoulder breadth, the yardstick of detail, m (anthropometric mean of adults, 0.40 m shoulder to shoulder).
const HALF_SHOULDERS_M: f32 = 0.20;
/// How much the colour of a part at ground level is darkened: little light falls between legs.
const GROUND_DIMMING: f32 = 0.16;
/// Height at which no dimming is left, m.
const LIT_HEIGHT_M: f32 = 1.2;

/// How much of a body a picture can show.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Detail {
    /// Trunk, head, face.
    Dot,
    /// Legs and arms as one limb each.
    Some,
    /// Every limb, hands, nose, hair.
    Full,
}

impl Detail {
    /// What can be told apart at a scale, pixels a metre.
    pub fn at_scale(scale_px_m: f32) -> Self {
        let half_shoulders_px = HALF_SHOULDERS_M * scale_px_m;
        if half_shoulders_px >= FULL_DETAIL_PX {
            Self::Full
        } else if half_shoulders_px >= SOME_DETAIL_PX {
            Self::Some
        } else {
            Self::Dot
        }
    }
}

/// A part of a body: a ball swept from one end to the other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Part {
    /// World, metres.
    pub ends_m: [Vec3; 2],
    /// Radius at each end, m.
    pub radii_m: [f32; 2],
    /// Colour under full light.
    pub colour: Rgb,
    /// Top of the part: parts are painted in its order, m.
    pub top_m: f32,
}

/// One posed body with its look, ready to be taken apart.
struct Body<'a> {
    skeleton: &'a Skeleton,
    frame: &'a AgentFrame,
    joints: Joints,
    look: Look,
}

/// Appends the parts of one agent's body.
pub(crate) fn append_parts(parts: &mut Vec<Part>, skeleton: &Skeleton, frame: &AgentFrame, look: Look, detail: Detail) {
    let body = Body { skeleton, frame, joints: frame.pose.forward_kinematics(skeleton), look };
    if detail > Detail::Dot {
        for side in Side::BOTH {
            body.append_shoe(parts, side, detail);
            body.append_leg(parts, side, detail);
            body.append_arm(parts, side, detail);
        }
    }
    body.append_trunk(parts, detail);
    body.append_head(parts, detail);
}

impl Body<'_> {
    fn joint_m(&self, joint: Joint) -> Vec3 {
        self.frame.root.to_world(self.joints.positions_m[joint.index()])
    }

    /// A point given relative to a joint, in body axes.
    fn point_m(&self, joint: Joint, offset_m: Vec3) -> Vec3 {
        self.frame.root.to_world(self.joints.point_m(joint, offset_m))
    }

    fn end_m(&self, joint: Joint) -> Vec3 {
        self.point_m(joint, self.skeleton.segment_ends_m[joint.index()])
    }

    fn radius_m(&self, joint: Joint) -> f32 {
        self.skeleton.segment_radii_m[joint.index()]
    }

    fn append_shoe(&self, parts: &mut Vec<Part>, side: Side, detail: Detail) {
        let (foot, toe) = (Joint::FEET[side.index()], Joint::TOES[side.index()]);
        let sole = self.joints.sole_points_m(self.skeleton, side.index()).map(|point| self.frame.root.to_world(point));
        let (heel_m, ball_m) = (0.85 * self.radius_m(foot), self.radius_m(foot).max(self.radius_m(toe)));
        let toe_m = 0.85 * self.radius_m(toe);
        // The sole points lie under the rim of the shoe; the swept ball's centre lies a radius inside and above.
        let inward = (sole[2] - sole[0]).normalize_or_zero();
        let above = |joint: Joint, radius_m: f32| self.point_m(joint, Vec3::Z * radius_m) - self.joint_m(joint);
        let heel = sole[0] + inward * heel_m + above(foot, heel_m);
        let ball = sole[1] + above(foot, ball_m);
        let tip = sole[2] - inward * toe_m + above(toe, toe_m);
        if detail == Detail::Full {
            let ankle_m = 0.9 * self.radius_m(Joint::SHANKS[side.index()]);
            parts.push(part([heel, ball], [heel_m, ball_m], SHOE));
            parts.push(part([ball, tip], [ball_m, toe_m], SHOE * 1.12));
            parts.push(part([self.joint_m(foot), heel.lerp(ball, 0.5)], [ankle_m, heel_m], SHOE));
        } else {
            parts.push(part([heel, tip], [ball_m; 2], SHOE));
        }
    }

    fn append_leg(&self, parts: &mut Vec<Part>, side: Side, detail: Detail) {
        let [hip, knee, ankle] =
            [Joint::THIGHS, Joint::SHANKS, Joint::FEET].map(|pair| self.joint_m(pair[side.index()]));
        let (thigh_m, shank_m) =
            (self.radius_m(Joint::THIGHS[side.index()]), self.radius_m(Joint::SHANKS[side.index()]));
        let colour = self.look.trousers;
        if detail == Detail::Full {
            parts.push(part([knee, ankle], [shank_m * 1.08, shank_m * 0.85], colour));
            parts.push(part([hip, knee], [thigh_m, shank_m * 1.12], colour * 1.06));
        } else {
            parts.push(part([hip, ankle], [thigh_m, shank_m], colour));
        }
    }

    fn append_arm(&self, parts: &mut Vec<Part>, side: Side, detail: Detail) {
        let upper = Joint::UPPER_ARMS[side.index()];
        let [forearm, hand] = match side {
            Side::Left => [Joint::LeftForearm, Joint::LeftHand],
            Side::Right => [Joint::RightForearm, Joint::RightHand],
        };
        let [shoulder, elbow, wrist] = [upper, forearm, hand].map(|joint| self.joint_m(joint));
        let [upper_m, forearm_m, hand_m] = [upper, forearm, hand].map(|joint| self.radius_m(joint));
        let (sleeve, skin) = (self.look.shirt * 0.97, self.look.skin);
        if detail == Detail::Full {
            // A palm is broader than its wrist, fingers hardly narrower.
            let (tip, palm_m) = (self.end_m(hand), hand_m.max(0.9 * forearm_m));
            parts.push(part([wrist.lerp(tip, 0.1), tip.lerp(wrist, 0.2)], [palm_m, 0.75 * palm_m], skin));
            parts.push(part([elbow, wrist], [forearm_m, 0.8 * forearm_m], skin));
            parts.push(part([shoulder, elbow], [1.15 * upper_m, upper_m], sleeve));
        } else {
            parts.push(part([elbow, self.end_m(hand)], [forearm_m, hand_m], skin));
            parts.push(part([shoulder, elbow], [upper_m; 2], sleeve));
        }
    }

    /// Hips, waist and a chest that spans the shoulders: seen from above a tapered shape, broad where it is high.
    fn append_trunk(&self, parts: &mut Vec<Part>, detail: Detail) {
        let shirt = self.look.shirt;
        let [left, right] = Joint::UPPER_ARMS.map(|joint| self.joint_m(joint));
        let chest_m = self.radius_m(Joint::SpineUpper);
        let shoulder_m = 1.3 * self.radius_m(Joint::LeftUpperArm);
        if detail == Detail::Full {
            // Hips are hardly broader than the shoulders' middle: the balls' centres lie well inside the hip joints.
            let [left_hip, right_hip] = Joint::THIGHS.map(|joint| self.joint_m(joint));
            let hips = [right_hip.lerp(left_hip, 0.75), left_hip.lerp(right_hip, 0.75)];
            parts.push(part(hips, [0.92 * self.radius_m(Joint::Pelvis); 2], self.look.trousers * 1.1));
            let waist = [self.joint_m(Joint::SpineLower), self.joint_m(Joint::SpineUpper)];
            parts.push(part(waist, [self.radius_m(Joint::SpineLower), chest_m], shirt * 0.9));
        }
        let breastbone = self.joint_m(Joint::SpineUpper).lerp(0.5 * (left + right), 0.6);
        for shoulder in [left, right] {
            parts.push(part([breastbone, shoulder], [0.95 * chest_m, shoulder_m], shirt));
        }
    }

    /// A face that looks out from under the hair, with a nose: the facing at a glance.
    fn append_head(&self, parts: &mut Vec<Part>, detail: Detail) {
        let head = Joint::Head;
        let radius_m = self.radius_m(head);
        let up_m = self.skeleton.segment_ends_m[head.index()] - Vec3::Z * radius_m;
        let at = |forward: f32, left: f32, up: f32| {
            self.point_m(head, up_m.max(Vec3::ZERO) + Vec3::new(forward, left, up) * radius_m)
        };
        let (skin, hair) = (self.look.skin, self.look.hair);
        if detail == Detail::Full {
            parts.push(part([self.joint_m(Joint::Neck), at(0.0, 0.0, -1.0)], [self.radius_m(Joint::Neck); 2], skin));
            for left in [-0.86, 0.86] {
                parts.push(part([at(-0.05, left, -0.3), at(-0.15, left, -0.1)], [0.2 * radius_m; 2], skin * 0.94));
            }
        }
        parts.push(part([at(0.85, 0.0, -0.35), at(1.18, 0.0, -0.4)], [0.24 * radius_m, 0.16 * radius_m], skin * 0.97));
        parts.push(part([at(-0.1, 0.0, -0.05), at(0.34, 0.0, -0.05)], [0.82 * radius_m; 2], skin));
        parts.push(part([at(-0.32, 0.0, 0.1), at(-0.02, 0.0, 0.14)], [0.85 * radius_m, 0.83 * radius_m], hair));
    }
}

fn part(ends_m: [Vec3; 2], radii_m: [f32; 2], colour: Rgb) -> Part {
    let top_m = 0.5 * (ends_m[0].z + ends_m[1].z) + radii_m[0].max(radii_m[1]);
    let dimming = GROUND_DIMMING * (1.0 - top_m / LIT_HEIGHT_M).clamp(0.0, 1.0);
    Part { ends_m, radii_m, colour: (colour * (1.0 - dimming)).min(Vec3::ONE), top_m }
}

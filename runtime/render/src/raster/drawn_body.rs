//! A drawn body: the parts of one posed skeleton, from the shoes up to the hair, as tapered capsules.
//!
//! Enters: a recorded root and pose, and the skeleton. Leaves: parts in the world, metres, z up. Bones come from
//! forward kinematics, girths from the skeleton's `segment_radii_m`. The trunk (broader than deep), the face and the
//! hair need several capsules each.

use fbcrowd_sim::recording::AgentFrame;
use glam::Vec3;
use motiondb::body::{Joint, Joints, Side, Skeleton};

use crate::raster::palette::{Look, Rgb, SHOE};
use crate::raster::tapered_capsule::TaperedCapsule;

/// Half a shoulder breadth from which every limb is drawn, pixels: below it limbs cannot be distinguished.
const FULL_DETAIL_PX: f32 = 4.5;
/// Half a shoulder breadth from which arms and legs are drawn, pixels.
const LIMB_DETAIL_PX: f32 = 2.0;
/// Half a shoulder breadth, m: half the mean of adults, 0.40 m from shoulder to shoulder.
const HALF_SHOULDERS_M: f32 = 0.20;
/// Share by which a part at ground level is darkened: little light falls between legs.
const GROUND_DIMMING: f32 = 0.16;
/// Height from which a part is not darkened, m.
const LIT_HEIGHT_M: f32 = 1.2;

/// Detail of a drawn body.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Detail {
    /// Trunk, head and face.
    Dot,
    /// Also legs and arms, as one limb each.
    Limbs,
    /// Every limb, hands, nose and hair.
    Full,
}

impl Detail {
    /// Detail that is visible at a scale, pixels per metre.
    pub(crate) fn at_scale(scale_px_m: f32) -> Self {
        let half_shoulders_px = HALF_SHOULDERS_M * scale_px_m;
        if half_shoulders_px >= FULL_DETAIL_PX {
            Self::Full
        } else if half_shoulders_px >= LIMB_DETAIL_PX {
            Self::Limbs
        } else {
            Self::Dot
        }
    }
}

/// A part of a drawn body: a tapered capsule.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct DrawnPart {
    /// Centre of the ball at each end, world, metres.
    pub(crate) ends_m: [Vec3; 2],
    /// Radius at each end, m.
    pub(crate) radii_m: [f32; 2],
    /// Colour under full light.
    pub(crate) colour: Rgb,
    /// Height of the part's top, m: lower parts are painted first.
    pub(crate) top_m: f32,
}

impl DrawnPart {
    /// The part in a picture: `to_px` projects its ends, and a metre is `scale_px_m` pixels.
    pub(crate) fn to_capsule(self, to_px: impl Fn(Vec3) -> Vec3, scale_px_m: f32) -> TaperedCapsule {
        TaperedCapsule { ends_px: self.ends_m.map(to_px), radii_px: self.radii_m.map(|radius| radius * scale_px_m) }
    }
}

/// One posed body and its look.
struct DrawnBody<'a> {
    skeleton: &'a Skeleton,
    frame: &'a AgentFrame,
    joints: Joints,
    look: Look,
}

/// Appends the parts of one agent's body, whose size is `stature` times that of the skeleton.
pub(crate) fn append_parts(
    parts: &mut Vec<DrawnPart>,
    skeleton: &Skeleton,
    frame: &AgentFrame,
    stature: f32,
    look: Look,
    detail: Detail,
) {
    let joints = frame.pose.forward_kinematics(skeleton).sized(stature);
    let body = DrawnBody { skeleton: &skeleton.sized(stature), frame, joints, look };
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

impl DrawnBody<'_> {
    fn joint_m(&self, joint: Joint) -> Vec3 {
        self.frame.root.to_world(self.joints.positions_m[joint.index()])
    }

    /// A point at an offset from a joint, in the joint's own axes; world, metres.
    fn point_m(&self, joint: Joint, offset_m: Vec3) -> Vec3 {
        self.frame.root.to_world(self.joints.point_m(joint, offset_m))
    }

    fn end_m(&self, joint: Joint) -> Vec3 {
        self.point_m(joint, self.skeleton.segment_ends_m[joint.index()])
    }

    fn radius_m(&self, joint: Joint) -> f32 {
        self.skeleton.segment_radii_m[joint.index()]
    }

    fn append_shoe(&self, parts: &mut Vec<DrawnPart>, side: Side, detail: Detail) {
        let (foot, toe) = (Joint::FEET[side.index()], Joint::TOES[side.index()]);
        let sole = self.joints.sole_points_m(self.skeleton, side.index()).map(|point| self.frame.root.to_world(point));
        let (heel_m, ball_m) = (0.85 * self.radius_m(foot), self.radius_m(foot).max(self.radius_m(toe)));
        let toe_m = 0.85 * self.radius_m(toe);
        // Sole points are at the rim of the shoe's sole; the centres of the balls are a radius inside and above.
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

    fn append_leg(&self, parts: &mut Vec<DrawnPart>, side: Side, detail: Detail) {
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

    fn append_arm(&self, parts: &mut Vec<DrawnPart>, side: Side, detail: Detail) {
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

    /// Hips, waist and a chest across the shoulders: seen from above, the highest part is the broadest.
    fn append_trunk(&self, parts: &mut Vec<DrawnPart>, detail: Detail) {
        let shirt = self.look.shirt;
        let [left, right] = Joint::UPPER_ARMS.map(|joint| self.joint_m(joint));
        let chest_m = self.radius_m(Joint::SpineUpper);
        let shoulder_m = 1.3 * self.radius_m(Joint::LeftUpperArm);
        if detail == Detail::Full {
            // The centres of the balls are well inside the hip joints, so that the hips are not too broad.
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

    /// Face, nose and hair: they show the facing.
    fn append_head(&self, parts: &mut Vec<DrawnPart>, detail: Detail) {
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

fn part(ends_m: [Vec3; 2], radii_m: [f32; 2], colour: Rgb) -> DrawnPart {
    let top_m = 0.5 * (ends_m[0].z + ends_m[1].z) + radii_m[0].max(radii_m[1]);
    let dimming = GROUND_DIMMING * (1.0 - top_m / LIT_HEIGHT_M).clamp(0.0, 1.0);
    DrawnPart { ends_m, radii_m, colour: (colour * (1.0 - dimming)).min(Vec3::ONE), top_m }
}

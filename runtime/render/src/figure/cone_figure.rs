//! The figure of the crowd: a few rounded cones, drawn where bodies are small, and by which occlusion is computed.
//! World, metres.

use glam::Vec3;
use motiondb::body::{Joint, Side, Skeleton};

use crate::figure::build::arm;
use crate::figure::style::{CLOTHS, Cloth, Style};
use crate::figure::template::PosedJoint;
use crate::visibility::{Cone, Owner};

/// One posed body.
pub(crate) struct ConeFigure<'a> {
    pub(crate) skeleton: &'a Skeleton,
    pub(crate) joints: &'a [PosedJoint],
    pub(crate) colours: &'a [Vec3; CLOTHS],
    pub(crate) owner: Owner,
    pub(crate) style: Style,
    /// Size of the head relative to the body's.
    pub(crate) head: f32,
}

impl ConeFigure<'_> {
    /// Appends all cones of the body.
    pub(crate) fn append(&self, cones: &mut Vec<Cone>) {
        for side in Side::BOTH {
            self.append_leg(cones, side);
            self.append_arm(cones, side);
        }
        if self.style.has_skirt() {
            self.append_skirt(cones);
        }
        self.append_trunk(cones);
        self.append_head(cones);
    }

    fn at(&self, joint: Joint) -> Vec3 {
        self.joints[joint.index()].position
    }

    /// A point at an offset from a joint, in its own axes.
    fn point(&self, joint: Joint, offset: Vec3) -> Vec3 {
        let posed = &self.joints[joint.index()];
        posed.position + posed.rotation * offset
    }

    fn radius(&self, joint: Joint) -> f32 {
        self.skeleton.segment_radii_m[joint.index()]
    }

    fn push(&self, cones: &mut Vec<Cone>, ends_m: [Vec3; 2], radii_m: [f32; 2], cloth: Cloth) {
        cones.push(Cone { ends_m, radii_m, colour: self.colours[cloth as usize], owner: self.owner });
    }

    fn append_leg(&self, cones: &mut Vec<Cone>, side: Side) {
        let index = side.index();
        let [thigh, shank, foot, toe] =
            [Joint::THIGHS, Joint::SHANKS, Joint::FEET, Joint::TOES].map(|pair| pair[index]);
        let points = &self.skeleton.feet[index];
        let lift = Vec3::Z * 0.036;
        let (heel, tip) = (
            self.point(foot, points.heel_m + lift + Vec3::X * 0.03),
            self.point(toe, points.toe_tip_m + lift * 0.8 - Vec3::X * 0.03),
        );
        self.push(cones, [heel, tip], [0.036, 0.028], Cloth::Shoe);
        let (thick, thin) = (self.radius(thigh), self.radius(shank));
        self.push(cones, [self.at(shank), self.at(foot)], [1.08 * thin, 0.86 * thin], Cloth::Shank);
        self.push(cones, [self.at(thigh), self.at(shank)], [thick, 1.12 * thin], Cloth::Trousers);
    }

    fn append_skirt(&self, cones: &mut Vec<Cone>) {
        let middle = self.at(Joint::Pelvis);
        for index in [0, 1] {
            let [hip, knee] = [Joint::THIGHS[index], Joint::SHANKS[index]].map(|joint| self.at(joint));
            self.push(cones, [hip.lerp(middle, 0.3), hip.lerp(knee, 0.75)], [0.115, 0.125], Cloth::Skirt);
        }
    }

    fn append_arm(&self, cones: &mut Vec<Cone>, side: Side) {
        let joints = arm(side);
        let [shoulder, elbow, wrist] = joints.map(|joint| self.at(joint));
        let [upper, fore, _] = joints.map(|joint| self.radius(joint));
        let fingers = self.point(joints[2], 0.75 * self.skeleton.segment_ends_m[joints[2].index()]);
        self.push(cones, [wrist, fingers], [0.75 * fore, 0.6 * fore], Cloth::Skin);
        self.push(cones, [elbow, wrist], [fore, 0.75 * fore], Cloth::Sleeve);
        self.push(cones, [shoulder, elbow], [1.1 * upper, 0.85 * upper], Cloth::Shirt);
    }

    fn append_trunk(&self, cones: &mut Vec<Cone>) {
        let [left, right] = Joint::THIGHS.map(|joint| self.at(joint));
        let (pelvis, chest) = (self.radius(Joint::Pelvis), self.radius(Joint::SpineUpper));
        self.push(cones, [left.lerp(right, 0.25), right.lerp(left, 0.25)], [0.78 * pelvis; 2], Cloth::Trousers);
        let breast = self.point(Joint::SpineUpper, Vec3::Z * 0.05);
        self.push(cones, [self.at(Joint::SpineLower), breast], [0.88 * chest, 0.95 * chest], Cloth::Shirt);
        let neck = self.at(Joint::Neck);
        for shoulder in Joint::UPPER_ARMS.map(|joint| self.at(joint)) {
            let (from, to) = (breast.lerp(neck, 0.25), shoulder.lerp(breast, 0.12));
            self.push(cones, [from, to], [0.72 * chest, 0.058], Cloth::Shirt);
        }
    }

    fn append_head(&self, cones: &mut Vec<Cone>) {
        let up = self.skeleton.segment_ends_m[Joint::Head.index()].z;
        let at = |x: f32, z: f32| self.point(Joint::Head, Vec3::new(x, 0.0, z) * (up / 0.206));
        let neck = self.radius(Joint::Neck);
        self.push(cones, [self.at(Joint::Neck), at(0.0, 0.03)], [0.9 * neck, 0.85 * neck], Cloth::Skin);
        let [chin, brow, nape, crown] = [0.052, 0.076, 0.082, 0.084].map(|radius| radius * self.head);
        self.push(cones, [at(0.045, 0.03), at(0.02, 0.11)], [chin, brow], Cloth::Skin);
        self.push(cones, [at(-0.03, 0.09), at(-0.005, 0.132)], [nape, crown], Cloth::Hair);
    }
}

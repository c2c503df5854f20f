//! Rotations of extra joints → the transforms of a character's fingers, toes and twist bones.
//!
//! The orientation of a joint's axes is that of its parent's axes (palm, limb, toes, or the finger joint before) times the
//! rotation. Both axes are constant in their joints' frames; the bind pose states them ([`CharacterExtra`]). A joint
//! stays at its bind position below the joint above it in the file, so bones keep their length. Joints without a
//! role below an extra joint move with it. World, metres.

use glam::{Quat, Vec3};

use crate::body::{ExtraJoint, ExtraPart};
use crate::character::fit::CharacterFit;
use crate::character::model::CharacterExtra;
use crate::character::posing::JointTransform;

/// Bend of the joints of an index finger at rest, from the palm, degrees.
const REST_DEG: [f32; 3] = [18.0, 28.0, 14.0];
/// Further bend of each next finger at its knuckle, degrees.
const NEXT_REST_DEG: f32 = 4.0;

impl CharacterFit<'_> {
    /// Rotation of a joint of a hanging hand's finger, for [`pose_extra`](Self::pose_extra) where the motion states none: a
    /// hand is bound flat. None of a thumb, and of a finger that is bound more bent, such as around a handle.
    pub fn resting(&self, extra: ExtraJoint) -> Option<Quat> {
        let ExtraPart::Finger { finger: finger @ 1.., joint } = extra.part() else { return None };
        let known = self.character.extra.iter().find(|known| known.extra == extra)?;
        let next_deg = if joint == 0 { NEXT_REST_DEG * (finger - 1) as f32 } else { 0.0 };
        let bend_rad = (REST_DEG[joint] + next_deg).to_radians();
        let bound = known.parent_axes.conjugate() * known.axes;
        (bound.angle_between(Quat::IDENTITY) < bend_rad).then(|| Quat::from_rotation_x(-extra.side().sign() * bend_rad))
    }

    /// Turns the extra joints of a character that [`pose`](Self::pose) has posed. `rotation` gives the rotation of an extra
    /// joint relative to its parent; a joint without one keeps its bind place below the joint above it.
    ///
    /// # Panics
    /// If there are fewer transforms than joints.
    pub fn pose_extra(&self, rotation: impl Fn(ExtraJoint) -> Option<Quat>, transforms: &mut [JointTransform]) {
        let character = self.character;
        for known in &character.extra {
            let joint = known.joint as usize;
            let above = character.joints[joint].parent.map_or(joint, |above| self.extra_leader(above as usize));
            let parent = character.extra_parent(known.extra).unwrap_or(above);
            transforms[joint] = match rotation(known.extra) {
                Some(rotation) => {
                    let turn = Self::turned(known, transforms[parent].rotation, rotation);
                    transforms[above].about(character.joints[joint].position_m, turn)
                }
                None => transforms[above],
            };
        }
        for joint in 0..character.joints.len() {
            transforms[joint] = transforms[self.extra_leader(joint)];
        }
    }

    /// Rotation from bind of an extra joint whose parent has a rotation from bind.
    fn turned(known: &CharacterExtra, parent: Quat, rotation: Quat) -> Quat {
        (parent * known.parent_axes * rotation * known.axes.conjugate()).normalize()
    }

    /// The joint of the extra joint that a joint moves with: its own, or the nearest above it below any role; else itself.
    fn extra_leader(&self, joint: usize) -> usize {
        self.extra_leaders[joint] as usize
    }
}

impl JointTransform {
    /// The transform of another rotation that moves a point of bind space to the same position.
    fn about(&self, bind_m: Vec3, rotation: Quat) -> Self {
        let translation_m = self.point_m(bind_m) - rotation * (self.scale * bind_m);
        Self { rotation, scale: self.scale, translation_m }
    }
}

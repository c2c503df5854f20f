//! A pose with targets for its feet: the synthesis sets the targets, foot locks move them, and the legs bend once, at
//! the end.
//!
//! Root frame (x forward, y left, z up), metres. Pairs are `[left, right]`.

use glam::{Vec2, Vec3};
use motiondb::body::{Pose, Skeleton};

use crate::synthesis::pose::lean::incline::incline;
use crate::synthesis::pose::leg::{FootPose, PosedLeg, legs};
use crate::synthesis::pose::leg_length::softly_reached_m;
use crate::synthesis::pose::pelvis::WantedHeights;
use crate::synthesis::pose::{heel_rise, ik, pelvis};

/// A pose and the targets of its feet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Posture {
    /// The pose. Its legs may not reach the targets yet.
    pub pose: Pose,
    /// The legs as the pose has them.
    legs: [PosedLeg; 2],
    /// Target of each foot.
    pub feet: [FootPose; 2],
    /// Contact of each foot with the ground, 0 to 1.
    pub contacts: [f32; 2],
}

impl Posture {
    /// A pose whose feet are at their targets.
    pub fn new(pose: Pose, contacts: [f32; 2], skeleton: &Skeleton) -> Self {
        let legs = legs(&pose, skeleton);
        Self { pose, feet: legs.each_ref().map(PosedLeg::foot), legs, contacts }
    }

    /// Takes the feet of the pose as targets, after a change of the pose.
    pub fn retarget_feet(&mut self, skeleton: &Skeleton) {
        self.legs = legs(&self.pose, skeleton);
        self.feet = self.legs.each_ref().map(PosedLeg::foot);
    }

    /// Moves the targets to those of a deformed walk: heels rise, and the pelvis keeps its height above the straighter
    /// leg.
    pub fn move_feet(&mut self, feet: [FootPose; 2], skeleton: &Skeleton) {
        let raised = |side: usize| heel_rise::raised(&mut self.pose, skeleton, side, &self.legs[side], &feet[side]);
        let feet = [0, 1].map(raised);
        self.lower(pelvis::deformed_drop_m(&self.legs, &feet));
        self.feet = feet;
    }

    /// Moves the targets to those of foot locks, some of which are `held`, and the pelvis to the height that `pelvis_m`
    /// returns for what pose and legs want of it, m; legs stretch softly to the feet that are not held.
    pub(crate) fn lock_feet(
        &mut self,
        mut feet: [FootPose; 2],
        held: [bool; 2],
        pelvis_m: impl FnOnce(&WantedHeights) -> f32,
    ) {
        let posed_m = self.pose.pelvis_m.z;
        let [easy_m, greatest_m] =
            pelvis::locked_drops_m(&self.legs, &self.feet, &feet, held).map(|drop_m| posed_m - drop_m);
        self.lower(posed_m - pelvis_m(&WantedHeights { posed_m, easy_m, greatest_m }));
        for ((leg, foot), _) in self.legs.iter().zip(&mut feet).zip(held).filter(|(_, is_held)| !is_held) {
            foot.ankle_m = softly_reached_m(leg, foot.ankle_m);
        }
        self.feet = feet;
    }

    /// Moves the pelvis forward and left, m; the targets of the feet stay.
    pub(crate) fn shift(&mut self, moved_m: Vec2) {
        let moved_m = moved_m.extend(0.0);
        self.pose.pelvis_m += moved_m;
        self.legs.iter_mut().flat_map(|leg| &mut leg.positions_m).for_each(|position_m| *position_m += moved_m);
    }

    /// Tilts the body over its feet, and its trunk by `trunk_rad` in all; the pelvis stays over the root. Returns the
    /// displacement of the feet, forward and left, m, by which the targets are to move.
    pub(crate) fn incline(&mut self, pelvis_rad: Vec2, trunk_rad: Vec2) -> Vec2 {
        let turn = incline(&mut self.pose, pelvis_rad, trunk_rad);
        // The pelvis as it would be turned about the ground under it.
        let before_m = self.pose.pelvis_m;
        let over_m = turn * (Vec3::Z * before_m.z);
        self.pose.pelvis_m.z = over_m.z;
        for leg in &mut self.legs {
            leg.positions_m = leg.positions_m.map(|position_m| self.pose.pelvis_m + turn * (position_m - before_m));
            leg.orientations = leg.orientations.map(|orientation| turn * orientation);
        }
        -over_m.truncate()
    }

    fn lower(&mut self, drop_m: f32) {
        self.pose.pelvis_m.z -= drop_m;
        self.legs.iter_mut().flat_map(|leg| &mut leg.positions_m).for_each(|position_m| position_m.z -= drop_m);
    }

    /// Bends the legs so that the feet reach their targets. A target out of reach moves to the nearest point in reach.
    pub fn bend_legs(&mut self, skeleton: &Skeleton) {
        for (side, (leg, foot)) in self.legs.iter_mut().zip(&mut self.feet).enumerate() {
            ik::reach(&mut self.pose, leg, skeleton, side, foot);
            *foot = leg.foot();
        }
    }

    /// Heel, ball and toe tip on the sole of each foot at its target, m.
    pub fn soles_m(&self, skeleton: &Skeleton) -> [[Vec3; 3]; 2] {
        [0, 1].map(|side| self.feet[side].sole_points_m(&self.pose, skeleton, side))
    }
}

//! A pose, and feet that its legs do not reach yet: synthesis says where feet are to be, holding moves them, and the
//! legs bend once, at the end.
//!
//! All vectors are in the root frame (x forward, y left, z up), metres.

use glam::Vec3;
use motiondb::body::{Pose, Skeleton};

use crate::synthesis::pose::leg::{FootPose, Leg, legs};
use crate::synthesis::pose::{heel_rise, ik, pelvis};

/// A pose, and where its feet are to be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Posture {
    /// The pose.
    pub pose: Pose,
    /// Its legs.
    legs: [Leg; 2],
    /// The feet, which its legs may not reach yet.
    pub feet: [FootPose; 2],
    /// Contact of each.
    pub contacts: [f32; 2],
}

impl Posture {
    /// Feet as the pose has them.
    pub fn new(pose: Pose, contacts: [f32; 2], skeleton: &Skeleton) -> Self {
        let legs = legs(&pose, skeleton);
        Self { pose, feet: legs.each_ref().map(Leg::foot), legs, contacts }
    }

    /// Legs and feet are where the pose has them.
    pub fn take_feet(&mut self, skeleton: &Skeleton) {
        self.legs = legs(&self.pose, skeleton);
        self.feet = self.legs.each_ref().map(Leg::foot);
    }

    /// Moves the feet to where another walk has them; heels rise, and the hips stay as high over the straighter leg.
    pub fn move_feet(&mut self, feet: [FootPose; 2], skeleton: &Skeleton) {
        let risen = |side: usize| heel_rise::raised(&mut self.pose, skeleton, side, &self.legs[side], &feet[side]);
        let feet = [0, 1].map(risen);
        self.lower(pelvis::lower_m(&self.legs, &feet));
        self.feet = feet;
    }

    /// Moves the feet by what holds them; the pelvis comes down where a leg would have to stretch for it, as far as
    /// `descent` makes of what is asked for, m.
    pub fn hold_feet(&mut self, feet: [FootPose; 2], descent: impl FnOnce(f32) -> f32) {
        self.lower(descent(pelvis::drop_m(&self.legs, &self.feet, &feet)));
        self.feet = feet;
    }

    fn lower(&mut self, drop_m: f32) {
        self.pose.pelvis_m.z -= drop_m;
        self.legs.iter_mut().flat_map(|leg| &mut leg.positions_m).for_each(|position_m| position_m.z -= drop_m);
    }

    /// The legs reach their feet.
    pub fn bend_legs(&mut self, skeleton: &Skeleton) {
        for (side, (leg, foot)) in self.legs.iter_mut().zip(&mut self.feet).enumerate() {
            ik::reach(&mut self.pose, leg, skeleton, side, foot);
            *foot = leg.foot();
        }
    }

    /// Heel, ball and toe tip of each sole.
    pub fn soles_m(&self, skeleton: &Skeleton) -> [[Vec3; 3]; 2] {
        [0, 1].map(|side| self.feet[side].sole_points_m(&self.pose, skeleton, side))
    }
}

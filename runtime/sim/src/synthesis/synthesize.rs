//! The second half of a step of synthesis: the pose at the phase and root that the body has come to.
//!
//! It is sampled, what a switch has left is added, head and chest turn, planted feet are held, the pelvis comes down
//! where it must, and the legs reach the feet. Root frame (x forward, y left, z up) where nothing else is said; metres,
//! seconds.

use glam::{Vec2, Vec3};
use motiondb::body::{Root, RootFrame, Skeleton};
use motiondb::motion::wrapped;

use crate::maths::arc::went;
use crate::planning::plan::{PLANTED_CONTACT, Stance};
use crate::synthesis::blending::weight_transition;
use crate::synthesis::hybrid::active_motion::Playing;
use crate::synthesis::pose::foot_lock::{FootHold, LANDING_AHEAD_S, PosedFoot};
use crate::synthesis::pose::leg::FootPose;
use crate::synthesis::pose::posture::Posture;
use crate::synthesis::time_step::TimeStep;
use crate::synthesis::{Body, Motion, Synthesis};

/// A foot that what is left of a switch holds up further than this does not stand: the compiler tells contacts of clips
/// by the same height, m.
const HELD_UP_M: f32 = 0.025;
/// A first pose is given this long to settle on its feet, s.
const SETTLING_S: f32 = 1.0;

impl Body {
    /// Steps 3 to 5: the pose at the present phase and root.
    pub fn synthesize(&mut self, motion: &Motion, step: &TimeStep) -> Synthesis {
        let skeleton = &motion.db.skeleton;
        let playing = self.playing(motion);
        let carries = self.inertia.carries();
        let mut posture = if carries { playing.bent(motion, self.phase) } else { playing.posture(motion, self.phase) };
        let held_up = if carries { self.carry(&mut posture, skeleton) } else { [false; 2] };
        let landing = self.phase + LANDING_AHEAD_S * playing.phase_rate_hz(self.phase);
        let contacts_ahead = playing.contacts(motion, wrapped(landing));
        self.gaze.turn(&mut posture.pose, skeleton);
        let (frame, soles_m) = (self.root.frame(), posture.soles_m(skeleton));

        let held = [0, 1].map(|side| {
            let FootPose { ankle_m, orientation } = posture.feet[side];
            let posed = posed_foot(&frame, ankle_m, soles_m[side]);
            let planted = posture.contacts[side] >= PLANTED_CONTACT && !held_up[side];
            let held = self.feet[side].step(&posed, planted, contacts_ahead[side], step);
            FootPose { ankle_m: frame.to_local(held.ankle_m), orientation: held.twist * orientation }
        });
        posture.hold_feet(held, |asked_m| self.descent.follow(asked_m, step));
        posture.bend_legs(skeleton);

        let soles_m = posture.soles_m(skeleton);
        for (hold, sole_m) in self.feet.iter_mut().zip(soles_m) {
            hold.placed(sole_m.map(|point_m| frame.to_world(point_m)), step);
        }
        self.told(motion, &playing, &posture, &soles_m, frame.forward)
    }

    /// A first pose: its feet stand where it has them, and settle on the ground.
    pub(crate) fn settle(&mut self, motion: &Motion) -> Synthesis {
        let posture = self.playing(motion).posture(motion, self.phase);
        let (frame, soles_m) = (self.root.frame(), posture.soles_m(&motion.db.skeleton));
        let posed = |side: usize| posed_foot(&frame, posture.feet[side].ankle_m, soles_m[side]);
        self.feet = [0, 1].map(|side| FootHold::new(&posed(side)));
        self.synthesize(motion, &TimeStep::new(SETTLING_S))
    }

    /// Blends what the examples have nearest to a step that others have decided, from the root where the body was to
    /// where it is (see [`crate::coupling::decoupled`]); the pose is as blended, no foot is held.
    pub(crate) fn follow(&mut self, motion: &Motion, from: Root, dt_s: f32) -> Synthesis {
        let parameters = went(&from, &self.root, dt_s);
        let shares = motion.space.locate(parameters);
        self.mix.approach(&shares, 1.0, weight_transition::fraction(&self.mix, &shares, motion, dt_s));
        self.seen[0].mix = self.mix;
        self.phase = self.mix.advance_phase(motion.db, self.phase, dt_s);
        let playing = self.playing(motion);
        let posture = playing.posture(motion, self.phase);
        let soles_m = posture.soles_m(&motion.db.skeleton);
        self.told(motion, &playing, &posture, &soles_m, self.root.forward())
    }

    /// What is seen of what the body plays.
    pub(crate) fn playing<'a>(&self, motion: &Motion<'a>) -> Playing<'a> {
        Playing::new(motion, self.mode, &self.seen[0], &self.mix, self.phase)
    }

    /// Puts what a switch has left on top of what is played; tells which feet that holds up.
    fn carry(&self, posture: &mut Posture, skeleton: &Skeleton) -> [bool; 2] {
        let played_m = posture.soles_m(skeleton);
        self.inertia.add_to(&mut posture.pose);
        posture.take_feet(skeleton);
        let carried_m = posture.soles_m(skeleton);
        [0, 1].map(|side| held_up(&played_m[side], &carried_m[side]))
    }

    /// What is told of a posture, of its soles in the root frame, which faces `forward`.
    fn told(
        &self,
        motion: &Motion,
        playing: &Playing,
        posture: &Posture,
        soles_m: &[[Vec3; 3]; 2],
        forward: Vec2,
    ) -> Synthesis {
        Synthesis {
            pose: posture.pose,
            contacts: posture.contacts,
            stance: Stance::on_soles(soles_m, forward, posture.contacts, |swing| {
                playing.time_to_landing_s(motion, self.phase, swing)
            }),
            examples_slide_cm_s: playing.examples_slide_cm_s(motion),
        }
    }
}

/// Whether what is left of a switch keeps a foot off the ground where the new synthesis has it as `played`. To put it
/// down at once would be the jerk that inertia is there to avoid.
fn held_up(played_m: &[Vec3; 3], carried_m: &[Vec3; 3]) -> bool {
    let height_m = |sole_m: &[Vec3; 3]| sole_m.iter().fold(f32::INFINITY, |lowest_m, point_m| lowest_m.min(point_m.z));
    height_m(carried_m) - height_m(played_m).max(0.0) > HELD_UP_M
}

/// A foot of the root frame, in the world.
fn posed_foot(frame: &RootFrame, ankle_m: Vec3, sole_m: [Vec3; 3]) -> PosedFoot {
    PosedFoot { ankle_m: frame.to_world(ankle_m), sole_m: sole_m.map(|point_m| frame.to_world(point_m)) }
}

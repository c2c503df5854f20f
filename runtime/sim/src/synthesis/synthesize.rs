//! The second half of a step: the pose at the phase and root that the body has reached.
//!
//! [`Body::synthesize`] lists the stages. Root frame (x forward, y left, z up); metres, seconds.

use glam::{Vec2, Vec3};
use motiondb::body::{Root, RootFrame, Skeleton};
use motiondb::motion::wrapped;
use motiondb::quality::coverage::RUN_MPS;

use crate::planning::elbow_room::ElbowRoom;
use crate::planning::plan::{PLANTED_CONTACT, Stance};
use crate::synthesis::command::CommandState;
use crate::synthesis::hybrid::{ActiveMotion, Inertialization, Moment, MotionState};
use crate::synthesis::pose::foot_lock::LANDING_AHEAD_S;
use crate::synthesis::pose::{
    BodyClearance, Centring, ContactState, ExcessLean, FootMotion, LookAt, Posture, SecondaryMotion, Squeeze,
    WeightShift,
};
use crate::synthesis::{Body, BodyOutput, Mode, SynthesisContext, TimeStep, Traits};

/// Height above which the pose difference after a switch keeps a foot off the ground, m: the height by which the
/// compiler finds contacts in clips.
const HELD_UP_M: f32 = 0.025;
/// Duration in which the first pose settles on its feet, s.
const SETTLING_S: f32 = 1.0;

impl Body {
    /// A body that stands at `root`, with its cycle at `phase`, and its first output.
    pub fn standing(context: &SynthesisContext, root: Root, phase: f32) -> (Self, BodyOutput) {
        Self::standing_with(context, root, phase, Traits::default())
    }

    /// A body with traits that stands at `root`, with its cycle at `phase`, and its first output.
    pub fn standing_with(context: &SynthesisContext, root: Root, phase: f32, traits: Traits) -> (Self, BodyOutput) {
        let motion = MotionState::standing(context, phase, traits);
        let posture = motion.active(context).posture(context, phase);
        let contact = ContactState::standing(&posture, &root.frame(), &context.db.skeleton);
        let mut body = Self {
            root,
            actual_mps: Default::default(),
            command: CommandState::standing(),
            motion,
            contact,
            look_at: LookAt::default(),
            lean: ExcessLean::default(),
            secondary: SecondaryMotion::default(),
            squeeze: Squeeze::default(),
            room: ElbowRoom::default(),
            clearance: BodyClearance::default(),
            weight_shift: WeightShift::default(),
            centring: Centring::default(),
        };
        let output = body.synthesize(context, &TimeStep::new(SETTLING_S));
        (body, output)
    }

    /// Poses the body at its present phase and root.
    pub fn synthesize(&mut self, context: &SynthesisContext, step: &TimeStep) -> BodyOutput {
        let Self {
            root,
            motion,
            contact,
            look_at,
            lean,
            secondary,
            squeeze,
            room,
            clearance,
            weight_shift,
            centring,
            command,
            ..
        } = self;
        // All is done in the frame of the root under the drawn body.
        let (skeleton, frame) = (&context.db.skeleton, motion.drawn_root(root).frame());
        let room = room.seen_from(frame.position_m, frame.forward);
        let moment = motion.now(context);
        let mut posture = moment_posture(&moment, &motion.inertialization, context);
        inertialize(&mut posture, &motion.inertialization, skeleton);
        motion.traits.pitch(&mut posture.pose);
        look_at.turn(&mut posture.pose, skeleton);
        squeeze.turn(&mut posture.pose, &context.arm_means[context.base], skeleton);
        lean.lean(&mut posture, skeleton);
        let Traits { secondary_motion, secondary_seed, .. } = motion.traits;
        secondary.add_to(&mut posture.pose, secondary_seed, secondary_motion, &context.lacking, skeleton);
        posture.shift(secondary.sway_m(secondary_seed, secondary_motion, &context.lacking));
        let stands = command.step_state.stands && motion.mode == Mode::Blending;
        let moves = motion.current(&context.db);
        let places_m = places_at_rest_m(moves.velocity_mps(), &root.frame(), &frame, context);
        let off_m = contact.off_m(&frame, &places_m);
        posture.shift(centring.follow(stands, &contact.locks, &off_m, step));
        posture.shift(weight_shift.follow(&contact.locks, posture.pose.pelvis_m.y, &frame, step) * Vec2::Y);
        let mut contacts_ahead = contacts_ahead(&moment.active, motion, context);
        contact.settling.follow(stands, &posture.contacts, &contact.locks, &off_m, step.dt_s);
        contact.settling.lift(&mut posture.contacts, &mut contacts_ahead);
        let feet = FootMotion {
            planted: posture.contacts.map(|contact| contact >= PLANTED_CONTACT),
            contacts_ahead,
            places_m,
            turn_rate_rad_s: moves.turn_rate_rad_s,
            runs: moves.velocity_mps().length() > RUN_MPS,
            is_new: motion.has_jumped,
        };
        contact.lock_feet(&mut posture, &feet, &room, &frame, skeleton, step);
        posture.bend_legs(skeleton);
        clearance.bring_in(&mut posture.pose, &room, skeleton, step);
        let soles_m = posture.soles_m(skeleton);
        contact.record_drawn(&soles_m, &frame, step);
        motion.has_jumped = false;
        let (posture, soles_m) = in_root_frame(posture, soles_m, &frame, &root.frame());
        let mut output =
            output(&moment.active, [motion.phase, motion.timing.pace], &posture, &soles_m, &root.frame(), context);
        if let (Some(foot), Some((_, left_s))) = (&mut output.stance.foot, contact.settling.swing()) {
            foot.time_to_landing_s = foot.time_to_landing_s.max(left_s);
        }
        output
    }
}

/// Places of the balls of the feet of a body that has braked from a velocity to rest, in the frame of the drawn body, m.
fn places_at_rest_m(velocity_mps: Vec2, root: &RootFrame, drawn: &RootFrame, context: &SynthesisContext) -> [Vec2; 2] {
    let to_rest_m = velocity_mps.length() / (2.0 * context.params.acceleration_max_mps2) * velocity_mps;
    let in_drawn_frame = |point_m: Vec2| drawn.to_local(root.to_world(point_m.extend(0.0))).truncate();
    context.domain.standing_balls_m.map(|ball_m| in_drawn_frame(ball_m + to_rest_m))
}

/// The posture of the drawn motion; its legs are bent where a pose difference is to be added.
fn moment_posture(moment: &Moment, inertialization: &Inertialization, context: &SynthesisContext) -> Posture {
    if inertialization.is_active() { moment.bent_posture(context) } else { moment.posture(context) }
}

/// Adds the pose difference that a switch has left. Feet that it keeps off the ground have no contact.
fn inertialize(posture: &mut Posture, inertialization: &Inertialization, skeleton: &Skeleton) {
    if !inertialization.is_active() {
        return;
    }
    let before_m = posture.soles_m(skeleton);
    inertialization.add_to(&mut posture.pose);
    posture.retarget_feet(skeleton);
    let after_m = posture.soles_m(skeleton);
    for (side, contact) in posture.contacts.iter_mut().enumerate() {
        if is_held_up(&before_m[side], &after_m[side]) {
            *contact = 0.0;
        }
    }
}

/// Whether the pose difference lifts a foot off the ground. To plant it at once would be a jerk.
fn is_held_up(before_m: &[Vec3; 3], after_m: &[Vec3; 3]) -> bool {
    let height_m = |sole_m: &[Vec3; 3]| sole_m.iter().fold(f32::INFINITY, |lowest_m, point_m| lowest_m.min(point_m.z));
    height_m(after_m) - height_m(before_m).max(0.0) > HELD_UP_M
}

/// Contact of each foot [`LANDING_AHEAD_S`] later.
fn contacts_ahead(active: &ActiveMotion, motion: &MotionState, context: &SynthesisContext) -> [f32; 2] {
    let phase_rate_hz = motion.timing.pace * active.phase_rate_hz(context, motion.phase);
    active.contacts(context, wrapped(motion.phase + LANDING_AHEAD_S * phase_rate_hz))
}

/// A pose and its soles, made in the frame of the drawn body, in the root frame: both face alike.
fn in_root_frame(
    mut posture: Posture,
    soles_m: [[Vec3; 3]; 2],
    drawn: &RootFrame,
    root: &RootFrame,
) -> (Posture, [[Vec3; 3]; 2]) {
    if drawn == root {
        return (posture, soles_m);
    }
    let in_root_frame = |point_m: Vec3| root.to_local(drawn.to_world(point_m));
    let pelvis_m = &mut posture.pose.pelvis_m;
    *pelvis_m = in_root_frame(*pelvis_m);
    (posture, soles_m.map(|sole_m| sole_m.map(in_root_frame)))
}

/// The output for a posture and its soles in the root frame, at a phase and a pace.
pub(crate) fn output(
    active: &ActiveMotion,
    [phase, pace]: [f32; 2],
    posture: &Posture,
    soles_m: &[[Vec3; 3]; 2],
    frame: &RootFrame,
    context: &SynthesisContext,
) -> BodyOutput {
    let time_to_landing_s = |swing| active.time_to_landing_s(context, phase, swing) / pace;
    BodyOutput {
        pose: posture.pose,
        contacts: posture.contacts,
        stance: Stance::on_soles(soles_m, frame.forward, posture.contacts, time_to_landing_s),
        examples_slide_cm_s: active.examples_slide_cm_s(context),
    }
}

//! Invariants of actions: idles and transitions ([`crate::motion::Action`]). Root frame; metres, seconds, radians.

use glam::Vec2;

use crate::body::pose::Root;
use crate::body::skeleton::Joint;
use crate::motion::action::{ACTION_FRAMES_MAX, ACTION_RATE_HZ, Action, ActionEnd, ActionFrame, ActionKind};
use crate::motion::motion_db::MotionDb;
use crate::quality::planted_feet::PLANTED_CONTACT;
use crate::validate::values::{UNIT_TOLERANCE, is_near_root};
use crate::validate::{CheckResult, ensure};

/// Greatest displacement of a root, m: a minute at the speed of a sprinter.
const DISPLACEMENT_MAX_M: f32 = 900.0;
/// Greatest turn of a root, rad: two turns a second for a minute.
const TURN_MAX_RAD: f32 = 800.0;
/// Greatest distance of a joint's rotation in the last frame of an idle from the first, rad: rounding.
const LOOP_GAP_RAD: f32 = 2e-3;
/// The same for the pelvis, m.
const LOOP_GAP_M: f32 = 1e-4;
/// Greatest step of a joint at the seam of an idle, over its own greatest step within.
const SEAM_LIMIT: f32 = 2.0;
/// Step at the seam that is always permitted, rad.
const SEAM_MIN_RAD: f32 = 1e-3;
/// Greatest difference of the root's velocity at an end from that of the example, m/s: a root that accelerates at
/// 6 m/s² gains half of it within a frame.
const VELOCITY_TOLERANCE_MPS: f32 = 0.1;
/// Greatest difference of the root's turn rate at an end from that of the example, rad/s.
const TURN_RATE_TOLERANCE_RAD_S: f32 = 0.25;

/// Least turn of a turn on the spot and of a pivot, rad: 30°.
const TURN_MIN_RAD: f32 = std::f32::consts::PI / 6.0;
/// Least displacement of a step, m.
const STEP_MIN_M: f32 = 0.02;
/// Greatest rotation of a joint from one frame to the next, rad: 3,400 °/s, more than any joint of a sprinter.
const JUMP_MAX_RAD: f32 = 1.0;
/// Greatest displacement of the pelvis in its root frame from one frame to the next, m: 9 m/s.
const JUMP_MAX_M: f32 = 0.15;

/// Checks every action; a fault names it.
fn each_action(db: &MotionDb, check: impl Fn(&Action) -> CheckResult) -> CheckResult {
    let named = |action: &Action| check(action).map_err(|detail| format!("action {}: {detail}", action.name));
    db.actions.iter().try_for_each(named)
}

/// Every action has frames; its source and its examples exist; no name occurs twice; idles come before transitions.
pub(crate) fn actions_are_complete(db: &MotionDb) -> CheckResult {
    each_action(db, |action| {
        let count = action.frames.len();
        ensure((2..=ACTION_FRAMES_MAX).contains(&count), || {
            format!("it has {count} frames, but 2 to {ACTION_FRAMES_MAX} are allowed")
        })?;
        ensure((action.source as usize) < db.sources.len(), || format!("its source {} does not exist", action.source))?;
        let missing = [action.entry, action.exit].into_iter().find(|end| end.example as usize >= db.examples.len());
        ensure(missing.is_none(), || format!("the example at an end does not exist: {missing:?}"))?;
        let others = db.actions.iter().filter(|other| other.name == action.name).count();
        ensure(others == 1, || "another action has the same name".into())
    })?;
    ensure(db.actions.is_sorted_by_key(|action| action.kind), || "actions are not sorted by kind".into())
}

/// Windows are ordered, phases in [0, 1), pelvis positions near the root, contacts in [0, 1], roots finite.
pub(crate) fn action_frames_are_finite(db: &MotionDb) -> CheckResult {
    let leg_m = db.skeleton.leg_length_m();
    each_action(db, |action| {
        let [first_s, last_s] = action.window_s;
        ensure(first_s >= 0.0 && first_s < last_s && last_s.is_finite(), || {
            format!("it is made from {first_s} s to {last_s} s of its source")
        })?;
        ensure([action.entry, action.exit].iter().all(|end| (0.0..1.0).contains(&end.phase)), || {
            format!("a phase is out of range: {:?}, {:?}", action.entry, action.exit)
        })?;
        let fault = |frame: &ActionFrame| {
            let ActionFrame { pose, contacts, root } = frame;
            let is_root = root.position_m.length() <= DISPLACEMENT_MAX_M && root.facing_rad.abs() <= TURN_MAX_RAD;
            !(is_root
                && is_near_root(pose.pelvis_m, leg_m)
                && contacts.iter().all(|contact| (0.0..=1.0).contains(contact)))
        };
        match action.frames.iter().position(fault) {
            Some(index) => {
                let ActionFrame { pose, contacts, root } = &action.frames[index];
                let pelvis_m = pose.pelvis_m;
                Err(format!("frame {index}: pelvis at {pelvis_m} m, contacts {contacts:?}, {root:?}"))
            }
            None => Ok(()),
        }
    })
}

/// Rotations are unit quaternions, each joint in the hemisphere of the first row of the examples.
pub(crate) fn action_rotations_are_unit_and_aligned(db: &MotionDb) -> CheckResult {
    let first = db.rows.rotations(0, 0);
    each_action(db, |action| {
        let rotations = action
            .frames
            .iter()
            .enumerate()
            .flat_map(|(index, frame)| Joint::ALL.map(|joint| (index, joint, frame.pose.rotations[joint.index()])));
        for (index, joint, rotation) in rotations {
            let is_unit = (rotation.length() - 1.0).abs() < UNIT_TOLERANCE;
            ensure(is_unit && rotation.dot(first[joint.index()]) >= -UNIT_TOLERANCE, || {
                let joint = joint.name();
                format!("frame {index}, {joint}: {rotation} has no unit length, or is in the other hemisphere")
            })?;
        }
        Ok(())
    })
}

/// An idle stands all along, its root and both feet at rest. Its last frame is its first, and no joint jumps there.
pub(crate) fn idles_are_loops(db: &MotionDb) -> CheckResult {
    each_action(db, |action| {
        if action.kind != ActionKind::Idle {
            return Ok(());
        }
        let rests = |frame: &ActionFrame| {
            frame.root == Root::default() && frame.contacts.iter().all(|&contact| f64::from(contact) >= PLANTED_CONTACT)
        };
        ensure(action.frames.iter().all(rests), || "a foot lifts, or the root moves".to_owned())?;
        let (first, last) = (&action.frames[0], &action.frames[action.frames.len() - 1]);
        let (gap_rad, gap_m) = (greatest_turn_rad(first, last), first.pose.pelvis_m.distance(last.pose.pelvis_m));
        ensure(gap_rad <= LOOP_GAP_RAD && gap_m <= LOOP_GAP_M, || {
            format!("its last frame is not its first: a joint is off by {gap_rad} rad, the pelvis by {gap_m} m")
        })?;
        let largest_rad =
            action.frames.windows(2).map(|pair| greatest_turn_rad(&pair[0], &pair[1])).fold(0.0, f32::max);
        let second_last = &action.frames[action.frames.len() - 2];
        let seam_rad = 0.5 * greatest_turn_rad(second_last, &action.frames[1]);
        ensure(seam_rad <= SEAM_LIMIT * largest_rad + SEAM_MIN_RAD, || {
            format!("the seam turns a joint by {seam_rad} rad a frame, but the loop by {largest_rad} rad at most")
        })
    })
}

/// Greatest rotation of a joint from one frame to another, rad.
fn greatest_turn_rad(from: &ActionFrame, to: &ActionFrame) -> f32 {
    let pairs = from.pose.rotations.iter().zip(&to.pose.rotations);
    pairs.map(|(from, to)| from.angle_between(*to)).fold(0.0, f32::max)
}

/// The first root is the origin. At each end the body stands or steps as the kind states, and the root moves at the
/// parameters of the example.
pub(crate) fn actions_meet_their_examples(db: &MotionDb) -> CheckResult {
    each_action(db, |action| {
        ensure(action.frames[0].root == Root::default(), || {
            format!("its first root is {:?}, not the origin", action.frames[0].root)
        })?;
        let count = action.frames.len();
        let ends = [(action.entry, [0, 1], "first"), (action.exit, [count - 2, count - 1], "last")];
        for ((end, frames, word), stands) in ends.into_iter().zip(action.kind.stands()) {
            let example = &db.examples[end.example as usize];
            ensure(example.key_times_s.is_none() == stands, || {
                let state = if stands { "stand" } else { "step" };
                format!("{} must {state} at the {word} frame, but {} does not", action.kind.name(), example.name)
            })?;
            meets(db, end, frames.map(|frame| &action.frames[frame].root), word)?;
        }
        Ok(())
    })
}

/// Both feet of a transition stand where its kind states that the body stands. A turn and a pivot turn, a step travels.
pub(crate) fn transitions_move_as_their_kind(db: &MotionDb) -> CheckResult {
    each_action(db, |action| {
        let ends = [(&action.frames[0], "first"), (&action.frames[action.frames.len() - 1], "last")];
        for ((frame, word), stands) in ends.into_iter().zip(action.kind.stands()) {
            let is_planted = frame.contacts.iter().all(|&contact| f64::from(contact) >= PLANTED_CONTACT);
            ensure(!stands || is_planted, || format!("it stands at the {word} frame, but a foot is lifted there"))?;
        }
        let (turn_rad, moved_m) = (action.turn_rad().abs(), action.displacement_m().length());
        match action.kind {
            ActionKind::Turn | ActionKind::Pivot => ensure(turn_rad >= TURN_MIN_RAD, || {
                format!("a {} turns by {turn_rad} rad, less than {TURN_MIN_RAD}", action.kind.name())
            }),
            ActionKind::Step => {
                ensure(moved_m >= STEP_MIN_M, || format!("a step travels {moved_m} m, less than {STEP_MIN_M}"))
            }
            ActionKind::Idle | ActionKind::Start | ActionKind::Stop => Ok(()),
        }
    })
}

/// From one frame of a transition to the next no joint and no pelvis jumps; rotations stay in one hemisphere, so that
/// times between frames can be interpolated.
pub(crate) fn transitions_have_no_jumps(db: &MotionDb) -> CheckResult {
    each_action(db, |action| {
        if action.kind == ActionKind::Idle {
            return Ok(());
        }
        let least_dot = libm::cosf(0.5 * JUMP_MAX_RAD);
        for (index, pair) in action.frames.windows(2).enumerate() {
            let [from, to] = [&pair[0].pose, &pair[1].pose];
            let step_m = from.pelvis_m.distance(to.pelvis_m);
            ensure(step_m <= JUMP_MAX_M, || format!("the pelvis jumps by {step_m} m after frame {index}"))?;
            let jumps = |joint: &Joint| from.rotations[joint.index()].dot(to.rotations[joint.index()]) < least_dot;
            if let Some(joint) = Joint::ALL.iter().find(|joint| jumps(joint)) {
                return Err(format!("{} jumps after frame {index}", joint.name()));
            }
        }
        Ok(())
    })
}

/// Whether the root moves from one frame to the next as the example at an end does.
fn meets(db: &MotionDb, end: ActionEnd, [from, to]: [&Root; 2], word: &str) -> CheckResult {
    let wanted = db.examples[end.example as usize].parameters;
    let middle_rad = 0.5 * (from.facing_rad + to.facing_rad);
    let velocity_mps = Vec2::from_angle(-middle_rad).rotate(to.position_m - from.position_m) * ACTION_RATE_HZ;
    let off_mps = velocity_mps.distance(wanted.velocity_mps());
    let off_rad_s = ((to.facing_rad - from.facing_rad) * ACTION_RATE_HZ - wanted.turn_rate_rad_s).abs();
    ensure(off_mps <= VELOCITY_TOLERANCE_MPS && off_rad_s <= TURN_RATE_TOLERANCE_RAD_S, || {
        format!("at the {word} frame the root differs from its example by {off_mps} m/s and {off_rad_s} rad/s")
    })
}

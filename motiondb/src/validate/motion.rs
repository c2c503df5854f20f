//! What the stored motion itself says of an example: where its cycle closes, when its feet land and leave, how fast its
//! root goes ([`crate::quality::planted_feet`]).

use crate::body::skeleton::{JOINT_COUNT, Side};
use crate::diagnostic::Unfit;
use crate::motion::motion_db::{MotionDb, PHASE_COUNT};
use crate::motion::parameters::Parameters;
use crate::quality::planted_feet::{CycleFeet, foot_slide, implied};
use crate::validate::{Outcome, each, ensure};

/// A seam between the last row and the first this many times the cycle's own greatest step is a jump …
const SEAM_LIMIT: f32 = 2.0;
/// … unless it is nothing at all, radians.
const SEAM_MIN_RAD: f32 = 1e-3;
/// A landmark lies in its contact and this near to its middle, over the cycle: real clips' landmarks are taken of the
/// whole step, contacts of what stands still, which in a jog is its later part (0.1).
const LANDMARK_TOLERANCE: f64 = 0.125;
/// Key times and shares are off by the rounding of `f32`, over the period and the cycle.
const KEY_TIME_TOLERANCE: f64 = 1e-5;
const SHARE_TOLERANCE: f64 = 1e-6;
/// So are slides, cm/s; where two points of a foot are equally low, rounding also chooses between them.
const SLIDE_TOLERANCE_CM_S: f64 = 0.2;
/// How far planted feet may move in the mean though the root moves as stored, m/s: this, and, as squares of misfits add
/// up, the root of the squares of a share of the body's speed and of how fast they move with no root motion explaining
/// it. Recorded people: up to 76 % of it. Of 524 speeds that were stored a quarter too high or low, of 12 sources, all
/// but 6 exceed it; those are of feet that slide by more than a tenth of the body's speed.
const MISFIT_MPS: f64 = 0.02;
const MISFIT_SHARE: f64 = 0.1;

/// The step from the last row to the first is no larger than twice the largest within the cycle.
pub(crate) fn cycles_close(db: &MotionDb) -> Outcome {
    each(db, |index, _| {
        let step = |phase: usize| {
            let (here, next) = (db.rows.rotations(index, phase), db.rows.rotations(index, (phase + 1) % PHASE_COUNT));
            (0..JOINT_COUNT).map(|joint| here[joint].angle_between(next[joint])).fold(0.0, f32::max)
        };
        let largest = (0..PHASE_COUNT - 1).map(step).fold(0.0, f32::max);
        let seam = step(PHASE_COUNT - 1);
        ensure(seam <= SEAM_LIMIT * largest + SEAM_MIN_RAD, || {
            format!("the seam turns a joint by {seam} rad, the cycle by at most {largest} a row")
        })
    })
}

/// Phase 0 lies in the middle of a right contact, phase ½ in the middle of a left one; who stands never lifts a foot
/// and never moves.
pub(crate) fn landmarks_are_mid_stances(db: &MotionDb) -> Outcome {
    each(db, |index, example| {
        let feet = CycleFeet::of(db, index, &[]);
        if example.key_times_s.is_some() {
            return landmarks_agree(&feet).map_err(|unfit| unfit.to_string());
        }
        let stands = example.parameters == Parameters::default() && feet.always_planted();
        ensure(stands, || "it has no key times, but does not stand".into())
    })
}

/// Why the motion of a cycle that steps contradicts its landmarks or its parameters, if so: what a compiler must not
/// put into a database.
pub fn contradiction(feet: &CycleFeet, parameters: Parameters) -> Option<Unfit> {
    landmarks_agree(feet).and_then(|()| parameters_agree(feet, parameters)).err()
}

fn landmarks_agree(feet: &CycleFeet) -> Result<(), Unfit> {
    for (foot, landmark) in [(Side::Right, 0.0), (Side::Left, 0.5)] {
        let [landing_s, leaving_s] = stance_s(feet, foot)?;
        let off_s = 0.5 * (landing_s + leaving_s) - f64::from(feet.phase_map.time_s(landmark));
        let off = off_s.abs() / f64::from(feet.phase_map.period_s);
        ensure(off <= LANDMARK_TOLERANCE, || Unfit::MidStanceOff { foot, share: off as f32 })?;
    }
    Ok(())
}

/// When the contact about a foot's landmark begins and ends, seconds from phase 0.
fn stance_s(feet: &CycleFeet, foot: Side) -> Result<[f64; 2], Unfit> {
    let stance = feet.stance(foot).ok_or(Unfit::NoMidStance { foot })?;
    Ok(stance.map(|phase| f64::from(feet.phase_map.time_s(phase as f32))))
}

/// Key times are when the contact rows pass ½ at both ends of the contacts that hold the landmarks.
pub(crate) fn key_times_end_contacts(db: &MotionDb) -> Outcome {
    each(db, |index, example| {
        let Some(key_times_s) = example.key_times_s else { return Ok(()) };
        let feet = CycleFeet::of(db, index, &[]);
        let stance_s = |foot: Side| stance_s(&feet, foot).map_err(|unfit| unfit.to_string());
        let ([right_landing_s, right_leaving_s], [left_landing_s, left_leaving_s]) =
            (stance_s(Side::Right)?, stance_s(Side::Left)?);
        let period_s = f64::from(example.phase_map.period_s);
        let found_s = [right_leaving_s, right_landing_s, left_leaving_s, left_landing_s];
        let agrees = |(stored_s, found_s): (&f32, f64)| {
            let off = (f64::from(*stored_s) - found_s) / period_s;
            (0.0..example.phase_map.period_s).contains(stored_s) && (off - libm::round(off)).abs() <= KEY_TIME_TOLERANCE
        };
        ensure(key_times_s.iter().zip(found_s).all(agrees), || {
            format!("{key_times_s:?} s are stored, contacts end at {found_s:?} s, but for periods of {period_s} s")
        })
    })
}

/// Slide and planted share, measured on the stored rows, are those that are stored.
pub(crate) fn planted_feet_slide_as_stored(db: &MotionDb) -> Outcome {
    each(db, |index, example| {
        let feet = CycleFeet::of(db, index, &db.posed_rows(index));
        let found = foot_slide(&feet, example.parameters.to_vec3().as_dvec3());
        let slide_off = found.slide_cm_s - f64::from(example.planted_slide_cm_s);
        let share_off = found.planted_share - f64::from(example.planted_share);
        ensure(slide_off.abs() <= SLIDE_TOLERANCE_CM_S && share_off.abs() <= SHARE_TOLERANCE, || {
            let (slide, share) = (example.planted_slide_cm_s, example.planted_share);
            format!("{slide} cm/s over {share} are stored, the rows give {found:?}")
        })
    })
}

/// The root motion for which the planted feet stand best is the stored one, as far as they stand at all.
pub(super) fn parameters_follow_from_the_motion(db: &MotionDb) -> Outcome {
    each(db, |index, example| {
        let feet = CycleFeet::of(db, index, &db.posed_rows(index));
        parameters_agree(&feet, example.parameters).map_err(|unfit| unfit.to_string())
    })
}

fn parameters_agree(feet: &CycleFeet, root: Parameters) -> Result<(), Unfit> {
    let velocity = root.to_vec3().as_dvec3();
    let Some(implied) = implied(feet) else { return Ok(()) };
    let misfit_mps = implied.misfit_mps(feet, velocity);
    let speed_mps = libm::hypot(velocity.x, velocity.z);
    let limit_mps = MISFIT_MPS + libm::hypot(MISFIT_SHARE * speed_mps, implied.rest_mps);
    ensure(misfit_mps <= limit_mps, || Unfit::RootContradicted {
        root,
        feet: implied.parameters,
        misfit_mps: misfit_mps as f32,
        limit_mps: limit_mps as f32,
    })
}

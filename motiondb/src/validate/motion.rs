//! Invariants that follow from the stored motion of an example: its cycle closes; key times, slide and parameters agree
//! with its feet ([`crate::quality::planted_feet`]). Root frame, metres and seconds.

use crate::body::skeleton::{JOINT_COUNT, Side};
use crate::diagnostic::Unfit;
use crate::motion::motion_db::{MotionDb, PHASE_COUNT};
use crate::motion::parameters::Parameters;
use crate::quality::planted_feet::{CycleFeet, foot_slide, implied_root_motion};
use crate::validate::{CheckResult, each, ensure};

/// Greatest turn of a joint from the last row to the first, divided by the cycle's own greatest step.
const SEAM_LIMIT: f32 = 2.0;
/// Turn at the seam that is always permitted, radians.
const SEAM_MIN_RAD: f32 = 1e-3;
/// Greatest distance of a landmark from the middle of its contact, divided by the cycle. In a jog it is 0.1: the
/// landmark is the middle of the step, the contact only its later part.
const LANDMARK_TOLERANCE: f64 = 0.125;
/// Tolerance of key times, divided by the period: the rounding of `f32`.
const KEY_TIME_TOLERANCE: f64 = 1e-5;
/// Tolerance of planted shares: the rounding of `f32`.
const SHARE_TOLERANCE: f64 = 1e-6;
/// Tolerance of slides, cm/s: rounding may choose another of two equally low points of a foot.
const SLIDE_TOLERANCE_CM_S: f64 = 0.2;
/// Greatest misfit of planted feet and root at rest, m/s (`docs/tuning.md`).
const MISFIT_MPS: f64 = 0.02;
/// Increase of the greatest misfit with the body's speed (`docs/tuning.md`).
const MISFIT_SHARE: f64 = 0.1;

/// The turn of each joint from the last row to the first is at most twice the largest within the cycle.
pub(crate) fn cycles_close(db: &MotionDb) -> CheckResult {
    each(db, |index, _| {
        let step = |phase: usize| {
            let (here, next) = (db.rows.rotations(index, phase), db.rows.rotations(index, (phase + 1) % PHASE_COUNT));
            (0..JOINT_COUNT).map(|joint| here[joint].angle_between(next[joint])).fold(0.0, f32::max)
        };
        let largest = (0..PHASE_COUNT - 1).map(step).fold(0.0, f32::max);
        let seam = step(PHASE_COUNT - 1);
        ensure(!is_open(seam, largest), || {
            format!("the seam turns a joint by {seam} rad, but rows of the cycle by {largest} rad at most")
        })
    })
}

/// Whether a cycle is open whose joints turn by so much from the last row to the first, and from row to row within it,
/// rad. A compiler must leave such a cycle out.
pub fn is_open(seam_rad: f32, largest_rad: f32) -> bool {
    seam_rad > SEAM_LIMIT * largest_rad + SEAM_MIN_RAD
}

/// Phase 0 is the middle of a right contact, phase ½ the middle of a left one. A standing body lifts no foot and does
/// not move.
pub(crate) fn landmarks_are_mid_stances(db: &MotionDb) -> CheckResult {
    each(db, |index, example| {
        let feet = CycleFeet::of(db, index, &[]);
        if example.key_times_s.is_some() {
            return landmarks_agree(&feet).map_err(|unfit| unfit.to_string());
        }
        let stands = example.parameters == Parameters::default() && feet.is_always_planted();
        ensure(stands, || "it has no key times, but does not stand".into())
    })
}

/// Contradiction between the motion of a stepping cycle and its landmarks or parameters; `None` if they agree. A
/// compiler must leave such a cycle out.
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

/// Start and end of the contact at a foot's landmark, seconds from phase 0.
fn stance_s(feet: &CycleFeet, foot: Side) -> Result<[f64; 2], Unfit> {
    let stance = feet.stance(foot).ok_or(Unfit::NoMidStance { foot })?;
    Ok(stance.map(|phase| f64::from(feet.phase_map.time_s(phase as f32))))
}

/// Key times are the times at which the contact rows cross ½, at both ends of the contacts at the landmarks.
pub(crate) fn key_times_end_contacts(db: &MotionDb) -> CheckResult {
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
            format!("key times {key_times_s:?} s are stored, but contacts end at {found_s:?} s, modulo {period_s} s")
        })
    })
}

/// The stored slide and planted share are those of the stored rows.
pub(crate) fn planted_feet_slide_as_stored(db: &MotionDb) -> CheckResult {
    each(db, |index, example| {
        let feet = CycleFeet::of(db, index, &db.posed_rows(index));
        let found = foot_slide(&feet, example.parameters.to_vec3().as_dvec3());
        let slide_off = found.slide_cm_s - f64::from(example.planted_slide_cm_s);
        let share_off = found.planted_share - f64::from(example.planted_share);
        ensure(slide_off.abs() <= SLIDE_TOLERANCE_CM_S && share_off.abs() <= SHARE_TOLERANCE, || {
            let (slide, share) = (example.planted_slide_cm_s, example.planted_share);
            format!(
                "a slide of {slide} cm/s and a planted share of {share} are stored, but the rows give {} cm/s and {}",
                found.slide_cm_s, found.planted_share
            )
        })
    })
}

/// The stored root motion is the one that the planted feet imply, as far as they are at rest at all.
pub(crate) fn parameters_follow_from_the_motion(db: &MotionDb) -> CheckResult {
    each(db, |index, example| {
        let feet = CycleFeet::of(db, index, &db.posed_rows(index));
        parameters_agree(&feet, example.parameters).map_err(|unfit| unfit.to_string())
    })
}

fn parameters_agree(feet: &CycleFeet, root: Parameters) -> Result<(), Unfit> {
    let velocity = root.to_vec3().as_dvec3();
    let Some(implied) = implied_root_motion(feet) else { return Ok(()) };
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

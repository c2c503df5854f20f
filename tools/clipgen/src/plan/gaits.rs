//! The plans of gaits by speed: cadence, contact timing, foot angles, amplitudes of pelvis and arms.
//!
//! Cadence and stride lie within one standard deviation of adults' means (18–29 years): at 1.1 m/s those of men walking
//! slowly (86–101 steps/min, 1.18–1.48 m), at 1.4 of women walking normally (107–124, 1.31–1.53), at 1.8 of women
//! walking fast (129–156, 1.56–1.84). Toe-off is half of the stride plus half of the double support, which is 25, 23
//! and 19 % there (bands 25–34, 20–28, 14–22). Slower, it lies at and beside that of Schwartz's very slow walkers
//! (`docs/tuning.md`). Foot angles and pelvis amplitudes by v*: Schwartz et al. 2008. Shoulders swing farther back than
//! forward: 24° back, 8° forward at free speed (Perry, *Gait Analysis*, ch. 8).
//!
//! A clip is a whole number of frames and of strides, but a stride is not a whole number of frames: each stride is
//! sampled at other moments, so that the mean over strides holds what lies between frames.

use crate::plan::gait_plan::{FootRoll, GaitPlan, PelvisAmplitudes, UpperBodyAmplitudes};
use crate::plan::published_curves::{GRAVITY_MPS2, PublishedGait};
use crate::plan::root_motion::RootMotion;

/// Advance of the toe-off in turns, share of the stride per rad/s: a turning foot leaves the ground more slowly.
const TURN_TOE_OFF_S: f64 = 0.013;
/// Speeds at which the values of a walk are given, m/s.
const WALK_SPEEDS_MPS: [f64; 5] = [0.5, 0.8, 1.1, 1.4, 1.8];
/// Speeds at which the values of a run are given, m/s.
const RUN_SPEEDS_MPS: [f64; 2] = [2.4, 3.5];
/// Least sway of a body that steps sideways or about itself, m.
const STEP_SWAY_M: f64 = 0.025;

/// A forward walk, straight or turning.
pub(crate) fn walk(root: RootMotion, stride_frames: f64) -> GaitPlan {
    let speed = root.pace_mps();
    let by_speed = |values: [f64; 5]| interpolated(speed, &WALK_SPEEDS_MPS, &values);
    // A turning foot leaves the ground more slowly and counts as planted for longer.
    let toe_off = by_speed([0.656, 0.640, 0.626, 0.616, 0.594]) - TURN_TOE_OFF_S * root.turn_rate_rad_s.abs();
    GaitPlan {
        root,
        stride_frames,
        toe_off,
        style: PublishedGait::walk(speed),
        style_share: interpolated(speed, &[0.1, 0.4], &[0.0, 1.0]),
        lift_m: 0.05,
        half_width_m: by_speed([0.060, 0.056, 0.052, 0.050, 0.046]),
        toe_out_rad: by_speed([7.0, 7.0, 6.5, 6.0, 5.0]).to_radians(),
        // Published minima: 3 to 7°.
        least_knee_rad: 4_f64.to_radians(),
        roll: FootRoll {
            strike_pitch_rad: by_speed([9.0, 13.0, 17.0, 20.0, 22.0]).to_radians(),
            flat_from: by_speed([0.13, 0.13, 0.12, 0.11, 0.10]),
            heel_off: toe_off * by_speed([0.58, 0.54, 0.50, 0.47, 0.44]),
            heel_rise_power: by_speed([2.3, 2.6, 2.8, 2.8, 2.8]),
            toe_off_pitch_rad: -by_speed([37.0, 47.0, 54.0, 59.0, 62.0]).to_radians(),
            toe_off_toe_pitch_rad: -by_speed([12.0, 15.0, 18.0, 20.0, 22.0]).to_radians(),
        },
        running: false,
        yaw_peak: 0.02,
        pelvis: PelvisAmplitudes {
            sway_m: by_speed([0.034, 0.032, 0.026, 0.021, 0.018]),
            surge_m: by_speed([0.008, 0.010, 0.012, 0.014, 0.015]),
            list_rad: by_speed([2.2, 3.0, 3.7, 4.4, 5.5]).to_radians(),
            rotation_rad: by_speed([4.0, 3.7, 4.0, 5.0, 6.8]).to_radians(),
        },
        upper_body: walking_upper_body(&root),
    }
}

/// A jog or a run.
pub(crate) fn run(root: RootMotion, stride_frames: f64) -> GaitPlan {
    let speed = root.pace_mps();
    let by_speed = |values: [f64; 2]| interpolated(speed, &RUN_SPEEDS_MPS, &values);
    let toe_off = by_speed([0.365, 0.315]);
    GaitPlan {
        toe_off,
        style: PublishedGait::Jog,
        style_share: 1.0,
        half_width_m: 0.032,
        roll: FootRoll {
            strike_pitch_rad: by_speed([9.0, 11.0]).to_radians(),
            flat_from: 0.07,
            heel_off: 0.16,
            heel_rise_power: by_speed([1.7, 1.5]),
            toe_off_pitch_rad: -by_speed([57.0, 62.0]).to_radians(),
            toe_off_toe_pitch_rad: -by_speed([20.0, 24.0]).to_radians(),
        },
        running: true,
        yaw_peak: -0.13,
        pelvis: PelvisAmplitudes {
            sway_m: 0.010,
            surge_m: 0.010,
            list_rad: by_speed([4.5, 5.5]).to_radians(),
            rotation_rad: by_speed([6.0, 8.0]).to_radians(),
        },
        upper_body: UpperBodyAmplitudes {
            lean_rad: by_speed([7.0, 10.0]).to_radians(),
            chest_yaw_rad: by_speed([12.0, 16.0]).to_radians(),
            arm_mean_rad: by_speed([-8.0, -4.0]).to_radians(),
            arm_swing_rad: by_speed([26.0, 35.0]).to_radians(),
            arm_out_rad: 14_f64.to_radians(),
            elbow_rad: by_speed([80.0, 88.0]).to_radians(),
            elbow_swing_rad: by_speed([9.0, 14.0]).to_radians(),
            ..walking_upper_body(&root)
        },
        ..walk(root, stride_frames)
    }
}

/// Steps sideways or about itself, for which no curves are published: flat feet, a little lift, knees that give.
pub(crate) fn step_about(root: RootMotion, stride_frames: f64, half_width_m: f64) -> GaitPlan {
    let toe_off = 0.55;
    // Slow steps hardly leave the ground. Haste is the speed of the feet; those of a turning body are 0.3 m off its
    // axis.
    let haste = (root.pace_mps() + 0.1 * root.turn_rate_rad_s.abs()).min(1.0);
    let walk = walk(root, stride_frames);
    GaitPlan {
        toe_off,
        style_share: 0.0,
        lift_m: 0.012 + 0.010 * haste,
        half_width_m,
        least_knee_rad: (8.0 + 8.0 * haste).to_radians(),
        roll: FootRoll {
            strike_pitch_rad: -(2.0 + 2.0 * haste).to_radians(),
            flat_from: 0.10,
            heel_off: toe_off * 0.55,
            heel_rise_power: 2.2,
            toe_off_pitch_rad: -(6.0 + 8.0 * haste).to_radians(),
            toe_off_toe_pitch_rad: -(1.0 + 1.0 * haste).to_radians(),
        },
        pelvis: PelvisAmplitudes {
            sway_m: STEP_SWAY_M.max(side_step_sway_m(&root, walk.period_s())),
            surge_m: 0.0,
            list_rad: 0.035,
            rotation_rad: 0.0,
        },
        upper_body: UpperBodyAmplitudes {
            chest_yaw_rad: 0.02,
            lean_rad: (2.5 + 4.0 * haste * haste).to_radians(),
            side_lag_rad: 6_f64.to_radians() * (root.strafe_mps / 0.35).clamp(-1.0, 1.0) * (1.0 - 0.5 * haste),
            arm_swing_rad: (1.5 + 3.0 * haste).to_radians(),
            arm_out_rad: 12_f64.to_radians(),
            elbow_rad: (18.0 + 25.0 * haste * haste).to_radians(),
            elbow_swing_rad: 0.05 * haste,
            ..walk.upper_body
        },
        ..walk
    }
}

/// Sway of a side-step, m. Human side-steps start with every stride and nearly stop with the feet together; the faster,
/// the more even they are. The pelvis sways to the leading foot, so that a greater sway has this effect.
fn side_step_sway_m(root: &RootMotion, period_s: f64) -> f64 {
    let halting = interpolated(root.strafe_mps.abs(), &[0.35, 0.6, 1.2], &[0.85, 0.6, 0.25]);
    halting * root.strafe_mps.abs() * period_s / std::f64::consts::TAU
}

/// A walk forward and sideways at once; its feet stand wider, so that they do not cross.
pub(crate) fn diagonal(root: RootMotion, stride_frames: f64) -> GaitPlan {
    let walk = walk(root, stride_frames);
    let side_step_m = 0.5 * root.strafe_mps.abs() * walk.period_s();
    GaitPlan { half_width_m: (0.5 * side_step_m + 0.045).max(walk.half_width_m), ..walk }
}

/// The forward gait that is backward walking when played in reverse: shorter steps, wider, flatter feet, quieter arms.
///
/// The joint curves of backward walking are nearly those of forward walking in reversed time.
pub(crate) fn reversed_backward_walk(backward: RootMotion, stride_frames: f64) -> GaitPlan {
    let walk = walk(backward.reversed(), stride_frames);
    GaitPlan {
        // Slow feet count as planted shortly before and after they are: the measured share is 3 to 5 % greater.
        toe_off: (walk.toe_off - 0.02).min(0.615),
        style: PublishedGait::walk(0.75 * walk.root.pace_mps()),
        half_width_m: 0.068,
        roll: FootRoll {
            strike_pitch_rad: 0.55 * walk.roll.strike_pitch_rad,
            toe_off_pitch_rad: 0.66 * walk.roll.toe_off_pitch_rad,
            toe_off_toe_pitch_rad: 0.5 * walk.roll.toe_off_toe_pitch_rad,
            ..walk.roll
        },
        upper_body: UpperBodyAmplitudes {
            lean_rad: 0.035,
            // Over the shoulder on the inside of the turn, towards the direction of travel.
            look_rad: 2.0 * walk.upper_body.look_rad,
            arm_swing_rad: 0.55 * walk.upper_body.arm_swing_rad,
            chest_yaw_rad: 0.6 * walk.upper_body.chest_yaw_rad,
            elbow_rad: 24_f64.to_radians(),
            ..walk.upper_body
        },
        ..walk
    }
}

/// Trunk, head and arms of a walk.
fn walking_upper_body(root: &RootMotion) -> UpperBodyAmplitudes {
    let by_speed = |values: [f64; 5]| interpolated(root.pace_mps(), &WALK_SPEEDS_MPS, &values).to_radians();
    UpperBodyAmplitudes {
        lean_rad: by_speed([2.0, 2.2, 2.6, 3.2, 5.0]),
        bank_rad: libm::atan(root.speed_mps * root.turn_rate_rad_s / GRAVITY_MPS2),
        side_lag_rad: 0.0,
        look_rad: look_rad(root),
        chest_yaw_rad: by_speed([2.0, 2.6, 3.4, 4.2, 5.5]),
        arm_mean_rad: by_speed([-2.0, -3.5, -5.5, -7.0, -8.0]),
        arm_swing_rad: by_speed([6.0, 10.0, 15.0, 19.0, 24.0]),
        arm_out_rad: by_speed([9.0, 9.0, 9.0, 9.0, 10.0]),
        elbow_rad: by_speed([14.0, 16.0, 19.0, 23.0, 34.0]),
        elbow_swing_rad: by_speed([3.0, 5.0, 7.0, 9.0, 13.0]),
    }
}

/// Yaw of the head, rad: into a turn, and half-way towards a sideways direction of travel.
fn look_rad(root: &RootMotion) -> f64 {
    let aside_rad = libm::atan2(root.strafe_mps, root.speed_mps.abs());
    (0.22 * root.turn_rate_rad_s).clamp(-0.45, 0.45) + (0.5 * aside_rad).clamp(-0.4, 0.4)
}

/// A value interpolated linearly between knots, constant beyond them.
fn interpolated(x: f64, knots: &[f64], values: &[f64]) -> f64 {
    let above = knots.partition_point(|knot| *knot < x).clamp(1, knots.len() - 1);
    let share = ((x - knots[above - 1]) / (knots[above] - knots[above - 1])).clamp(0.0, 1.0);
    values[above - 1] * (1.0 - share) + values[above] * share
}

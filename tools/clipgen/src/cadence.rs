//! What a speed makes of a gait: cadence, contact timing, foot angles, pelvis and arm amplitudes.
//!
//! Cadence and stride lie within one standard deviation of adults' means (18–29 years): at 1.1 m/s those of men walking
//! slowly (86–101 steps/min, 1.18–1.48 m), at 1.4 of women walking normally (107–124, 1.31–1.53), at 1.8 of women
//! walking fast (129–156, 1.56–1.84). Double support is 25, 23 and 19 % of the stride (bands 25–34, 20–28, 14–22);
//! toe-off = 50 % + half of it; at 0.5 m/s it is planned as 31 and measured as 35 %, that of Schwartz's very slow
//! walkers (36), at 0.8 m/s 28 and 30 %, between theirs and the slow ones' (24). Foot angles and pelvis amplitudes by
//! v*: Schwartz et al. 2008. Shoulders swing farther back than forward (24° back, 8° forward at free speed: Perry,
//! *Gait Analysis*, ch. 8).
//!
//! A clip is a whole number of frames and of strides, but a stride is not one of frames: each is sampled at other
//! moments, so that the mean over strides knows what lies between frames.

use crate::footsteps::RootMotion;
use crate::published_curves::Style;

/// Frames a second of every clip.
pub(crate) const FRAME_RATE_HZ: f64 = 30.0;
const GRAVITY_MPS2: f64 = 9.81;
/// In a turn the body leans inward: the feet go outward by this height times the lean's tangent, m. Less than the hips'
/// .92 m, for the trunk banks over them; so much less that in the tightest jog no ankle everts beyond its 20° (AAOS
/// 1965).
const LEAN_ARM_M: f64 = 0.56;
/// How much earlier a foot leaves the ground in turns, share of the stride per rad/s.
const TURN_TOE_OFF_S: f64 = 0.013;

/// The least sway of a body that steps about, m.
const STEP_SWAY_M: f64 = 0.025;

/// One steady gait: everything that the generator needs to make its cycle. Angles in radians, shares of the stride.
#[derive(Clone, Debug)]
pub(crate) struct Gait {
    /// How the root moves.
    pub(crate) root: RootMotion,
    /// Frames a stride; need not be whole.
    pub(crate) stride_frames: f64,
    /// When a foot leaves the ground, from its strike.
    pub(crate) toe_off: f64,
    /// The published curves it takes after, and how much of their swing (1 forward, 0 where nobody published any).
    pub(crate) style: Style,
    /// See [`Gait::style`].
    pub(crate) style_share: f64,
    /// Lift of the foot where the style has no say, m.
    pub(crate) lift_m: f64,
    /// Ankle from the root's path at mid-stance, m.
    pub(crate) half_width_m: f64,
    /// Toes outward.
    pub(crate) toe_out_rad: f64,
    /// The hips are kept so low that no knee need straighten beyond this.
    pub(crate) least_knee_rad: f64,
    /// The foot's motion on the ground.
    pub(crate) roll: FootRoll,
    /// With a flight phase; the hips then fall freely.
    pub(crate) running: bool,
    /// When pelvis and chest are turned farthest, the striking side's hip ahead: share of the stride after that strike.
    /// People's trunks and arms keep time with the thighs; walkers strike with the thigh just past its foremost,
    /// runners well after.
    pub(crate) yaw_peak: f64,
    /// The pelvis about its path.
    pub(crate) pelvis: PelvisSwing,
    /// Trunk, head and arms.
    pub(crate) upper_body: UpperBodySwing,
}

/// Pitch of the sole through stance; toes up is positive.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FootRoll {
    /// At the strike.
    pub(crate) strike_pitch_rad: f64,
    /// When the sole is flat.
    pub(crate) flat_from: f64,
    /// When the heel rises.
    pub(crate) heel_off: f64,
    /// The heel rises as this power of time: late and fast (published free walk: −15° at 50 %, −55° at toe-off).
    pub(crate) heel_rise_power: f64,
    /// At toe-off (negative).
    pub(crate) toe_off_pitch_rad: f64,
    /// Of the toes at toe-off (negative).
    pub(crate) toe_off_toe_pitch_rad: f64,
}

/// Amplitudes of the pelvis's motion about its path.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PelvisSwing {
    /// Towards the stance foot, m.
    pub(crate) sway_m: f64,
    /// Ahead and behind, twice a stride, m.
    pub(crate) surge_m: f64,
    /// Scale of the published obliquity (free class ±4.1°).
    pub(crate) list_rad: f64,
    /// Scale of the published rotation (free class ±4.4°).
    pub(crate) rotation_rad: f64,
}

/// Trunk, head and arms.
#[derive(Clone, Copy, Debug)]
pub(crate) struct UpperBodySwing {
    /// Of the trunk, forward.
    pub(crate) lean_rad: f64,
    /// Into the turn, from the centripetal acceleration; left positive.
    pub(crate) bank_rad: f64,
    /// Of the trunk behind a side-step, as the leading foot lands; left side up.
    pub(crate) side_lag_rad: f64,
    /// Of the head, into the way it goes; left positive.
    pub(crate) look_rad: f64,
    /// Yaw of the chest against the pelvis's.
    pub(crate) chest_yaw_rad: f64,
    /// Mean flexion of the shoulder.
    pub(crate) arm_mean_rad: f64,
    /// Amplitude of the arm swing (half the arc).
    pub(crate) arm_swing_rad: f64,
    /// Arms out from the body.
    pub(crate) arm_out_rad: f64,
    /// Mean bend of the elbow.
    pub(crate) elbow_rad: f64,
    /// Amplitude of the elbow's bend.
    pub(crate) elbow_swing_rad: f64,
}

impl Gait {
    /// Seconds a stride.
    pub(crate) fn period_s(&self) -> f64 {
        self.stride_frames / FRAME_RATE_HZ
    }

    /// Mid-stance from the strike, share of the stride.
    pub(crate) fn mid_stance(&self) -> f64 {
        0.5 * self.toe_off
    }

    /// How far the footprints lie outward of the root's path in a turn, to the left, m.
    pub(crate) fn footprint_shift_m(&self) -> f64 {
        -LEAN_ARM_M * libm::tan(self.upper_body.bank_rad)
    }
}

/// Forward walking, straight or turning.
pub(crate) fn walk(root: RootMotion, stride_frames: f64) -> Gait {
    let speed = root.pace_mps();
    let by_speed = |values: [f64; 5]| between(speed, &[0.5, 0.8, 1.1, 1.4, 1.8], &values);
    // A turning foot leaves the ground more slowly and counts as planted for longer.
    let toe_off = by_speed([0.656, 0.640, 0.626, 0.616, 0.594]) - TURN_TOE_OFF_S * root.turn_rate_rad_s.abs();
    Gait {
        root,
        stride_frames,
        toe_off,
        style: Style::walk(speed),
        style_share: between(speed, &[0.1, 0.4], &[0.0, 1.0]),
        lift_m: 0.05,
        half_width_m: by_speed([0.060, 0.056, 0.052, 0.050, 0.046]),
        toe_out_rad: by_speed([7.0, 7.0, 6.5, 6.0, 5.0]).to_radians(),
        // Published minima are 3 to 7°.
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
        pelvis: PelvisSwing {
            sway_m: by_speed([0.034, 0.032, 0.026, 0.021, 0.018]),
            surge_m: by_speed([0.008, 0.010, 0.012, 0.014, 0.015]),
            list_rad: by_speed([2.2, 3.0, 3.7, 4.4, 5.5]).to_radians(),
            rotation_rad: by_speed([4.0, 3.7, 4.0, 5.0, 6.8]).to_radians(),
        },
        upper_body: walking_upper_body(&root),
    }
}

/// Jogging and running.
pub(crate) fn run(root: RootMotion, stride_frames: f64) -> Gait {
    let speed = root.pace_mps();
    let by_speed = |values: [f64; 2]| between(speed, &[2.4, 3.5], &values);
    let toe_off = by_speed([0.365, 0.315]);
    Gait {
        toe_off,
        style: Style::Jog,
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
        pelvis: PelvisSwing {
            sway_m: 0.010,
            surge_m: 0.010,
            list_rad: by_speed([4.5, 5.5]).to_radians(),
            rotation_rad: by_speed([6.0, 8.0]).to_radians(),
        },
        upper_body: UpperBodySwing {
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

/// Stepping where nobody published curves (sideways, about oneself): flat feet, a little lift, knees that give.
pub(crate) fn step_about(root: RootMotion, stride_frames: f64, half_width_m: f64) -> Gait {
    let toe_off = 0.55;
    // Slow steps hardly leave the ground; haste is the speed of the feet, those of a turning body 0.3 m from its axis.
    let haste = (root.pace_mps() + 0.1 * root.turn_rate_rad_s.abs()).min(1.0);
    let walk = walk(root, stride_frames);
    Gait {
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
        pelvis: PelvisSwing {
            sway_m: STEP_SWAY_M.max(side_step_sway_m(&root, walk.period_s())),
            surge_m: 0.0,
            list_rad: 0.035,
            rotation_rad: 0.0,
        },
        upper_body: UpperBodySwing {
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

/// People who side-step start with every stride and all but stop with their feet together; the faster, the more evenly
/// they go. The leading foot being the one that the pelvis then sways to, a greater sway does this.
fn side_step_sway_m(root: &RootMotion, period_s: f64) -> f64 {
    let halting = between(root.strafe_mps.abs(), &[0.35, 0.6, 1.2], &[0.85, 0.6, 0.25]);
    halting * root.strafe_mps.abs() * period_s / std::f64::consts::TAU
}

/// Walking forward and sideways at once: a walk whose feet stand wider, so that they do not cross.
pub(crate) fn diagonal(root: RootMotion, stride_frames: f64) -> Gait {
    let walk = walk(root, stride_frames);
    let side_step_m = 0.5 * root.strafe_mps.abs() * walk.period_s();
    Gait { half_width_m: (0.5 * side_step_m + 0.045).max(walk.half_width_m), ..walk }
}

/// The film of this gait, run backward, is backward walking (its joint curves are nearly those of forward walking in
/// reversed time): shorter steps, wider, flatter feet, quieter arms.
pub(crate) fn backward_film(backward: RootMotion, stride_frames: f64) -> Gait {
    let walk = walk(backward.reversed(), stride_frames);
    Gait {
        // Slow feet count as planted for a while before and after they are: what is measured is 3 to 5 % more.
        toe_off: (walk.toe_off - 0.02).min(0.615),
        style: Style::walk(0.75 * walk.root.pace_mps()),
        half_width_m: 0.068,
        roll: FootRoll {
            strike_pitch_rad: 0.55 * walk.roll.strike_pitch_rad,
            toe_off_pitch_rad: 0.66 * walk.roll.toe_off_pitch_rad,
            toe_off_toe_pitch_rad: 0.5 * walk.roll.toe_off_toe_pitch_rad,
            ..walk.roll
        },
        upper_body: UpperBodySwing {
            lean_rad: 0.035,
            // Over the shoulder on the inside of the turn: that is where they go.
            look_rad: 2.0 * walk.upper_body.look_rad,
            arm_swing_rad: 0.55 * walk.upper_body.arm_swing_rad,
            chest_yaw_rad: 0.6 * walk.upper_body.chest_yaw_rad,
            elbow_rad: 24_f64.to_radians(),
            ..walk.upper_body
        },
        ..walk
    }
}

fn walking_upper_body(root: &RootMotion) -> UpperBodySwing {
    let by_speed = |values: [f64; 5]| between(root.pace_mps(), &[0.5, 0.8, 1.1, 1.4, 1.8], &values).to_radians();
    UpperBodySwing {
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

/// Into a turn, and half-way towards where a sideways way leads.
fn look_rad(root: &RootMotion) -> f64 {
    let aside_rad = libm::atan2(root.strafe_mps, root.speed_mps.abs());
    (0.22 * root.turn_rate_rad_s).clamp(-0.45, 0.45) + (0.5 * aside_rad).clamp(-0.4, 0.4)
}

/// Linear between knots, constant beyond them.
fn between(x: f64, knots: &[f64], values: &[f64]) -> f64 {
    let above = knots.partition_point(|knot| *knot < x).clamp(1, knots.len() - 1);
    let share = ((x - knots[above - 1]) / (knots[above] - knots[above - 1])).clamp(0.0, 1.0);
    values[above - 1] * (1.0 - share) + values[above] * share
}

//! Strides → GaitCycle: the phase-aligned mean stride, closed without a seam, at 64 uniform phases.
//!
//! 1. Each stride is read along its own arc, at the times t(φ) of [`motiondb::motion::PhaseMap`], through both of its
//!    landmarks.
//! 2. The gap between its ends is closed (`loop_closure`). Both ends fade into what the clip does just outside the
//!    stride, so that velocities close as well.
//! 3. The mean over all strides is put on the ground: where feet are averaged or closed, a sole may sink.
//!
//! Definitions "Example" and "Phase" of `docs/definitions.md`. Clip: world frame, frames. Cycle: root frame (x forward,
//! y left, z up), metres, seconds.

use motiondb::motion::{PHASE_COUNT, PhaseMap};

use crate::cycle::gait_cycle::GaitCycle;
use crate::cycle::loop_closure::StrideGap;
use crate::gait::foot_stance::{FootStance, depth_s};
use crate::gait::stride::Stride;
use crate::ground::foot_grounding;
use crate::ground::grounded_clip::GroundedClip;
use crate::ground::pose_mean::pose_mean;
use crate::ground::root_arc::Rates;
use crate::retarget::human_clip::{HumanBody, HumanPose};

/// Rows over which each end of a stride fades, where the clip reaches that far: an eighth of a cycle.
const FADE_ROWS: usize = PHASE_COUNT / 8;
/// Number of frames beside a fractional frame that interpolation reads.
const INTERPOLATED_FRAMES: usize = 3;
/// Duration in which the contact of a foot goes from 0 to 1, s: one frame of the slowest clips.
const CONTACT_RAMP_S: f64 = 1.0 / 30.0;
/// Greatest depth in a stance that counts, s: deeper inside, the other end of the stance does not matter.
const DEPTH_MAX_S: f64 = 0.1;

/// The mean of whole strides of a clip; `stances` are those of both feet, `[left, right]`.
pub fn mean_stride(
    clip: &GroundedClip,
    body: &HumanBody,
    stances: &[Vec<FootStance>; 2],
    strides: &[Stride],
) -> GaitCycle {
    let frames: f64 = strides.iter().map(|stride| stride.period_frames).sum();
    let weighted_mean =
        |value: fn(&Stride) -> f64| strides.iter().map(|s| value(s) * s.period_frames).sum::<f64>() / frames;
    let rates = Rates {
        speed_mps: weighted_mean(|s| s.arc.rates.speed_mps),
        turn_rate_rad_s: weighted_mean(|s| s.arc.rates.turn_rate_rad_s),
        strafe_mps: weighted_mean(|s| s.arc.rates.strafe_mps),
    };
    let period_s = frames / strides.len() as f64 / clip.frame_rate_hz;
    let phase_map = PhaseMap { period_s: period_s as f32, left_share: weighted_mean(|s| s.left_share) as f32 };
    let (mut parts, mut depths_s) = (vec![Vec::new(); PHASE_COUNT], vec![[0.0; 2]; PHASE_COUNT]);
    for stride in strides {
        let reader = StrideReader { clip, body, stances, stride };
        add_stride(&mut parts, &mut depths_s, &reader, 1.0 / strides.len() as f64);
    }
    let rows = parts.iter().map(|parts| pose_mean(parts, body)).collect();
    let contacts = depths_s.iter().map(|depths_s| depths_s.map(contact)).collect();
    let mut cycle = GaitCycle { rows, contacts, phase_map, rates, steps: true };
    lower_to_mean_ground(&mut cycle, body);
    foot_grounding::keep_soles_above_ground(&mut cycle.rows, body, PHASE_COUNT as f64 / period_s, true);
    cycle
}

/// Greatest number of frames before and after a stride of so many frames that its mean reads.
pub(crate) fn frames_beside(period_frames: usize) -> usize {
    (period_frames * FADE_ROWS).div_ceil(PHASE_COUNT) + INTERPOLATED_FRAMES
}

/// Contact of a foot at a depth in a stance (s): ½ at the end of the stance.
pub(crate) fn contact(depth_s: f64) -> f64 {
    (0.5 + depth_s / CONTACT_RAMP_S).clamp(0.0, 1.0)
}

/// Reads one stride of a clip by phase.
struct StrideReader<'a> {
    clip: &'a GroundedClip<'a>,
    body: &'a HumanBody,
    stances: &'a [Vec<FootStance>; 2],
    stride: &'a Stride,
}

impl StrideReader<'_> {
    /// Frame of the clip at a phase, which may lie beyond the stride's ends.
    fn frame(&self, phase: f64) -> f64 {
        let ripple = 0.5 * (self.stride.left_share - 0.5) * (1.0 - libm::cos(std::f64::consts::TAU * phase));
        self.stride.zero_frame + self.stride.period_frames * (phase + ripple)
    }

    fn pose(&self, phase: f64) -> HumanPose {
        let frame = self.frame(phase);
        let time_s = (frame - self.stride.zero_frame) / self.clip.frame_rate_hz;
        self.stride.arc.relative(&self.clip.pose_at(frame, self.body), time_s)
    }

    /// Depth of each foot in a stance: seconds to its nearer end, negative outside.
    ///
    /// The mean of this over strides ends each contact at the mean of its ends. A mean of planted or not would stretch
    /// contacts to where only half of the strides have them.
    fn contact_depths_s(&self, phase: f64) -> [f64; 2] {
        let frame = self.frame(phase);
        self.stances
            .each_ref()
            .map(|stances| depth_s(stances, frame, self.clip.frame_rate_hz).clamp(-DEPTH_MAX_S, DEPTH_MAX_S))
    }

    /// Share of the cycle by which the fades reach beyond both ends.
    fn fade_share(&self) -> f64 {
        let (start, last) = (self.stride.start_phase, (self.clip.frame_count() - 1) as f64);
        let fits = |rows: usize| {
            let fade = rows as f64 / PHASE_COUNT as f64;
            self.frame(start - fade) >= 0.0 && self.frame(start + 1.0 + fade) <= last
        };
        (0..=FADE_ROWS).rev().find(|rows| fits(*rows)).unwrap_or(0) as f64 / PHASE_COUNT as f64
    }
}

/// Adds one stride, closed, to the parts of the mean; `share` is its weight.
fn add_stride(rows: &mut [Vec<(f64, HumanPose)>], depths_s: &mut [[f64; 2]], reader: &StrideReader, share: f64) {
    let start = reader.stride.start_phase;
    let contacts = |along: f64| reader.contact_depths_s(start + along).map(contact);
    let gap = StrideGap::between(&reader.pose(start), &reader.pose(start + 1.0), reader.body, contacts);
    let fade = reader.fade_share();
    for (row, (parts, depth_s)) in rows.iter_mut().zip(depths_s).enumerate() {
        let phase = row as f64 / PHASE_COUNT as f64;
        for phase in [phase - 1.0, phase, phase + 1.0, phase + 2.0] {
            let weight = share * fade_weight(phase - start, fade);
            if weight == 0.0 {
                continue;
            }
            parts.push((weight, gap.closed_pose(&reader.pose(phase), phase - start, reader.body)));
            let depths_s = reader.contact_depths_s(phase);
            depth_s[0] += weight * depths_s[0];
            depth_s[1] += weight * depths_s[1];
        }
    }
}

/// Weight of a phase counted from the stride's start: 1 within, faded over both ends. Weights a cycle apart sum to 1.
fn fade_weight(phase: f64, fade: f64) -> f64 {
    if fade == 0.0 {
        return if (0.0..1.0).contains(&phase) { 1.0 } else { 0.0 };
    }
    let ramp = |from_edge: f64| {
        let t = (0.5 + 0.5 * from_edge / fade).clamp(0.0, 1.0);
        t * t * (3.0 - 2.0 * t)
    };
    ramp(phase) - ramp(phase - 1.0)
}

/// Shifts the cycle so that planted soles lie at z = 0 in the mean.
fn lower_to_mean_ground(cycle: &mut GaitCycle, body: &HumanBody) {
    let (mut sum_m, mut weight) = (0.0, 0.0);
    for (row, contacts) in cycle.rows.iter().zip(&cycle.contacts) {
        let joints = row.forward_kinematics(body);
        for (side, contact) in contacts.iter().enumerate() {
            sum_m += contact * foot_grounding::lowest_sole_m(&joints, body, side);
            weight += contact;
        }
    }
    if weight > 0.0 {
        for row in &mut cycle.rows {
            row.pelvis_m.z -= sum_m / weight;
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::{DQuat, DVec3};
    use motiondb::body::Joint;

    use super::*;
    use crate::ground::leg_ik::place_ankle;
    use crate::synthetic::{self, SyntheticWalk, cycle_of};

    #[test]
    fn drifting_clips_give_cycles_without_a_seam() {
        let mut clip = synthetic::walk("walk", SyntheticWalk { duration_s: 1.9, ..SyntheticWalk::default() });
        for (frame, pose) in clip.frames.iter_mut().enumerate() {
            pose.rotations[Joint::SpineLower.index()] = DQuat::from_rotation_y(0.003 * frame as f64);
            pose.pelvis_m.z -= 0.0002 * frame as f64;
        }
        let cycle = cycle_of(&clip);
        let step = |row: usize| {
            let (here, next) = (&cycle.rows[row], &cycle.rows[(row + 1) % PHASE_COUNT]);
            let turns = here.rotations.iter().zip(&next.rotations).map(|(a, b)| a.angle_between(*b));
            turns.fold(here.pelvis_m.distance(next.pelvis_m), f64::max)
        };
        let largest = (0..PHASE_COUNT).map(step).fold(0.0, f64::max);
        let spine = |row: usize| cycle.rows[row % PHASE_COUNT].rotations[Joint::SpineLower.index()];
        let spine_step = |row: usize| spine(row).angle_between(spine(row + 1));
        assert!(largest < 0.2, "{largest}");
        assert!((0..PHASE_COUNT).all(|row| spine_step(row) < 0.004), "the drift is left at one row");
    }

    #[test]
    fn no_sole_sinks_where_one_foot_stands_higher() {
        let mut clip = synthetic::walk("walk", SyntheticWalk::default());
        for pose in &mut clip.frames {
            let ankle_m = pose.forward_kinematics(&clip.body).positions_m[Joint::LeftFoot.index()];
            place_ankle(pose, &clip.body, 0, ankle_m + 0.04 * DVec3::Z);
        }
        let cycle = cycle_of(&clip);
        let soles_m = cycle.rows.iter().flat_map(|row| {
            let joints = row.forward_kinematics(&clip.body);
            [0, 1].map(|side| foot_grounding::lowest_sole_m(&joints, &clip.body, side))
        });
        let lowest_m = soles_m.fold(f64::INFINITY, f64::min);
        assert!(lowest_m > -0.011, "{lowest_m} m");
    }

    #[test]
    fn weights_a_cycle_apart_sum_to_one() {
        for fade in [0.0, 0.03, 0.125] {
            for step in 0..100 {
                let phase = f64::from(step) / 100.0;
                let sum: f64 = [-1.0, 0.0, 1.0].iter().map(|turn| fade_weight(phase + turn, fade)).sum();
                assert!((sum - 1.0).abs() < 1e-12, "{fade} {phase} {sum}");
            }
        }
    }
}

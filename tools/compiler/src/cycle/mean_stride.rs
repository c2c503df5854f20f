//! Strides → GaitCycle: the phase-aligned mean stride, closed without a seam, at 64 uniform phases.
//!
//! Each stride is read along its own arc, at the times t(φ) of [`motiondb::motion::PhaseMap`], through both of its landmarks.
//! What is left open between its ends is taken out (`closing`), and both ends are faded into what the clip does just
//! outside the stride, so that velocities close as well. At last the cycle is put on the ground (`footing`): strides
//! differ, and where their feet are averaged or closed a sole may sink. Root frame: x forward, y left, metres, seconds.

use motiondb::motion::{PHASE_COUNT, PhaseMap};

use crate::cycle::loop_closure::Gap;
use crate::cycle::pose_mean::pose_mean;
use crate::gait::gait_events::Stance;
use crate::gait::stride::Stride;
use crate::ground::arc::Rates;
use crate::ground::foot_grounding;
use crate::ground::root_motion::GroundedClip;
use crate::retarget::human_clip::{Choices, HumanBody, HumanPose};

/// Rows that a stride is faded over at each end, where the clip reaches that far: an eighth of a cycle.
const FADE_ROWS: usize = PHASE_COUNT / 8;
/// Time in which a foot's contact goes from 0 to 1: one frame of the slowest clips, which know it no better.
const CONTACT_RAMP_S: f64 = 1.0 / 30.0;
/// Ends farther away count as this far, so that a contact's other end has no say.
const DEPTH_MAX_S: f64 = 0.1;

/// One closed cycle of 64 rows.
#[derive(Clone, Debug)]
pub struct GaitCycle {
    /// Poses in the root frame at uniform phases.
    pub rows: Vec<HumanPose>,
    /// Contact of each foot, `[left, right]`, 0 to 1, ½ at both ends.
    pub contacts: Vec<[f64; 2]>,
    /// Phase to time.
    pub phase_map: PhaseMap,
    /// The root's rates.
    pub rates: Rates,
    /// The body steps; otherwise it stands.
    pub steps: bool,
}

/// A cycle on its way to an example.
#[derive(Clone, Debug)]
pub struct NamedCycle {
    /// The example's name.
    pub name: String,
    /// Index of its source.
    pub source: u32,
    /// First and last second of the source that it was made from.
    pub window_s: [f64; 2],
    /// Left and right were exchanged.
    pub mirrored: bool,
    /// What a manifest makes of it.
    pub choices: Choices,
    /// How far from a clean cycle the window was that it was made from; the least is the best (`selection`).
    pub flaws: f64,
    /// The cycle.
    pub cycle: GaitCycle,
}

/// The mean of whole strides.
pub fn mean_stride(clip: &GroundedClip, body: &HumanBody, stances: &[Vec<Stance>; 2], strides: &[Stride]) -> GaitCycle {
    let frames: f64 = strides.iter().map(|stride| stride.period_frames).sum();
    let mean = |value: fn(&Stride) -> f64| strides.iter().map(|s| value(s) * s.period_frames).sum::<f64>() / frames;
    let rates = Rates {
        speed_mps: mean(|s| s.arc.rates.speed_mps),
        turn_rate_rad_s: mean(|s| s.arc.rates.turn_rate_rad_s),
        strafe_mps: mean(|s| s.arc.rates.strafe_mps),
    };
    let period_s = frames / strides.len() as f64 / clip.frame_rate_hz;
    let phase_map = PhaseMap { period_s: period_s as f32, left_share: mean(|s| s.left_share) as f32 };
    let (mut parts, mut depths_s) = (vec![Vec::new(); PHASE_COUNT], vec![[0.0; 2]; PHASE_COUNT]);
    for stride in strides {
        let reader = StrideReader { clip, body, stances, stride };
        add_stride(&mut parts, &mut depths_s, &reader, 1.0 / strides.len() as f64);
    }
    let rows = parts.iter().map(|parts| pose_mean(parts, body)).collect();
    let contacts = depths_s.iter().map(|depths_s| depths_s.map(contact)).collect();
    let mut cycle = GaitCycle { rows, contacts, phase_map, rates, steps: true };
    lower_to_ground(&mut cycle, body);
    foot_grounding::lift_soles(&mut cycle.rows, body);
    cycle
}

impl GaitCycle {
    /// Seconds from phase 0 at a row, which may lie in a neighbouring cycle.
    pub fn row_time_s(&self, row: isize) -> f64 {
        f64::from(self.phase_map.time_s(row as f32 / PHASE_COUNT as f32))
    }

    /// Index of a row that may lie in a neighbouring cycle.
    pub fn wrap(row: isize) -> usize {
        row.rem_euclid(PHASE_COUNT as isize) as usize
    }
}

/// Contact of a foot at a depth: ½ at the end of a contact.
fn contact(depth_s: f64) -> f64 {
    (0.5 + depth_s / CONTACT_RAMP_S).clamp(0.0, 1.0)
}

/// Reads one stride of a clip by phase.
struct StrideReader<'a> {
    clip: &'a GroundedClip,
    body: &'a HumanBody,
    stances: &'a [Vec<Stance>; 2],
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

    /// How deep each foot is in a stance: seconds to its nearer end, negative outside. The mean of this over strides
    /// ends each contact at the mean of its ends; a mean of planted or not would stretch contacts to where only half of
    /// the strides have them.
    fn contact_depths_s(&self, phase: f64) -> [f64; 2] {
        let frame = self.frame(phase);
        self.stances.each_ref().map(|stances| {
            // Of stances in order of time none is nearer than the last that has begun and the next.
            let next = stances.partition_point(|stance| stance.strike_frame <= frame);
            let nearest = &stances[next.saturating_sub(1)..(next + 1).min(stances.len())];
            let depths = nearest.iter().map(|stance| stance.depth_frames(frame));
            let deepest_s = depths.fold(f64::NEG_INFINITY, f64::max) / self.clip.frame_rate_hz;
            deepest_s.clamp(-DEPTH_MAX_S, DEPTH_MAX_S)
        })
    }

    /// How far the fades reach beyond both ends, as a share of the cycle.
    fn fade(&self) -> f64 {
        let (start, last) = (self.stride.start_phase, (self.clip.poses.len() - 1) as f64);
        let fits = |rows: usize| {
            let fade = rows as f64 / PHASE_COUNT as f64;
            self.frame(start - fade) >= 0.0 && self.frame(start + 1.0 + fade) <= last
        };
        (0..=FADE_ROWS).rev().find(|rows| fits(*rows)).unwrap_or(0) as f64 / PHASE_COUNT as f64
    }
}

/// Adds one stride, closed, to the parts of the mean of all.
fn add_stride(rows: &mut [Vec<(f64, HumanPose)>], depths_s: &mut [[f64; 2]], reader: &StrideReader, share: f64) {
    let start = reader.stride.start_phase;
    let contacts = |along: f64| reader.contact_depths_s(start + along).map(contact);
    let gap = Gap::between(&reader.pose(start), &reader.pose(start + 1.0), reader.body, contacts);
    let fade = reader.fade();
    for (row, (parts, depth_s)) in rows.iter_mut().zip(depths_s).enumerate() {
        let phase = row as f64 / PHASE_COUNT as f64;
        for phase in [phase - 1.0, phase, phase + 1.0, phase + 2.0] {
            let weight = share * window(phase - start, fade);
            if weight == 0.0 {
                continue;
            }
            parts.push((weight, gap.taken_out(&reader.pose(phase), phase - start, reader.body)));
            let depths_s = reader.contact_depths_s(phase);
            depth_s[0] += weight * depths_s[0];
            depth_s[1] += weight * depths_s[1];
        }
    }
}

/// Weight of a phase counted from the stride's start: 1 within, faded over both ends; weights a cycle apart add up to
/// 1.
fn window(phase: f64, fade: f64) -> f64 {
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
fn lower_to_ground(cycle: &mut GaitCycle, body: &HumanBody) {
    let (mut sum_m, mut weight) = (0.0, 0.0);
    for (row, contacts) in cycle.rows.iter().zip(&cycle.contacts) {
        let joints = row.forward_kinematics(body);
        for (side, contact) in contacts.iter().enumerate() {
            let lowest =
                joints.sole_points_m(body, side).map(|point| point.z).into_iter().fold(f64::INFINITY, f64::min);
            sum_m += contact * lowest;
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
    use crate::synthetic::{self, Walk, cycle_of};

    #[test]
    fn a_clip_that_drifts_still_gives_a_cycle_without_a_seam() {
        let mut clip = synthetic::walk("walk", Walk { duration_s: 1.9, ..Walk::default() });
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
        assert!((0..PHASE_COUNT).all(|row| spine_step(row) < 0.004), "the drift is left in one place");
    }

    #[test]
    fn no_sole_sinks_though_one_foot_stands_higher_than_the_other() {
        let mut clip = synthetic::walk("walk", Walk::default());
        for pose in &mut clip.frames {
            let ankle_m = pose.forward_kinematics(&clip.body).positions_m[Joint::LeftFoot.index()];
            place_ankle(pose, &clip.body, 0, ankle_m + 0.04 * DVec3::Z);
        }
        let cycle = cycle_of(&clip);
        let soles = cycle.rows.iter().flat_map(|row| {
            let joints = row.forward_kinematics(&clip.body);
            [0, 1].map(|side| joints.sole_points_m(&clip.body, side))
        });
        let lowest_m = soles.flatten().map(|point| point.z).fold(f64::INFINITY, f64::min);
        assert!(lowest_m > -0.011, "{lowest_m} m");
    }

    #[test]
    fn windows_a_cycle_apart_add_up_to_one() {
        for fade in [0.0, 0.03, 0.125] {
            for step in 0..100 {
                let phase = f64::from(step) / 100.0;
                let sum: f64 = [-1.0, 0.0, 1.0].iter().map(|turn| window(phase + turn, fade)).sum();
                assert!((sum - 1.0).abs() < 1e-12, "{fade} {phase} {sum}");
            }
        }
    }
}

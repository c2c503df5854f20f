//! In-place (treadmill) speed: the velocity of ground that passes under a clip in place, so that stance feet stand
//! still.
//!
//! The balls of the feet stand: each is flat on the ground from just after heel strike to toe-off, so in a walk one
//! always stands. A low ball votes for the ground velocity that holds it. A ball in the air is low too, shortly before
//! it lands and after it leaves, but at ever other speeds. The ground velocity is where votes are densest (mean shift
//! with Epanechnikov's kernel; Comaniciu and Meer 2002); lower balls weigh more. Votes near it without a break are a
//! contact. The result is the mean over the middle 80 % of every contact, the part over which slide is defined.
//!
//! Drawn characters do not roll over their feet. For a body without human hips or without toes, the result is the
//! median over the lower ankle's lowest frames.
//!
//! Clips are in metres, z up. Velocities are in the body's frame (along the facing, to its left), m/s, and reversed:
//! those of the body over the ground.

use std::ops::Range;

use glam::DVec2;
use motiondb::body::Joint;
use motiondb::statistics::{lower_quantile, median};

use crate::frame_runs::frame_runs;
use crate::read::source_clip::SourceClip;
use crate::retarget::facing_frame::{facing_rad, heading, in_body_frame};
use crate::retarget::units::{HUMAN_LEG_M, leg_length};
use crate::rig::roles::Roles;

/// Greatest height of a ball that votes, above its planted height, m for a person's leg: twice that of a contact.
const VOTE_HEIGHT_M: f64 = 0.05;
/// Reach of the kernel, m/s for a person's leg: the speed limit of a contact (0.25) plus the hips' surge (0.15).
const REACH_MPS: f64 = 0.4;
/// Further reach of the kernel over the ground's speed: as in the definition of a contact.
const REACH_SHARE: f64 = 0.15;
/// Number of votes, spread over the clip, from whose densest one the mean shift starts.
const STARTS: usize = 64;
/// Greatest number of mean shifts; it converges long before.
const SHIFTS_MAX: usize = 32;
/// Shift at which the mean shift has converged, m/s.
const CONVERGED_MPS: f64 = 1e-6;
/// Greatest distance of human hip joints, divided by the leg length. People: 0.14 to 0.25; drawn characters: 0.8 and
/// more.
const HIPS_OVER_LEG_MAX: f64 = 0.45;
/// Share of a contact at each end that is left out: the foot may still land or already leave.
const CONTACT_END_SHARE: f64 = 0.1;
/// Share of the frames, lowest first, in which the lower ankle counts as standing.
const ANKLE_STANCE_SHARE: f64 = 0.6;
/// Share of a joint's heights below its planted height, as in [`crate::gait::contacts`].
const PLANTED_QUANTILE: f64 = 0.05;
/// Half the time over which speeds are measured, s, so that noise weighs the same at 24 and at 120 Hz.
const SPEED_SPAN_S: f64 = 1.0 / 30.0;

/// v_f and ω_s of a clip in place.
pub(crate) fn ground_velocity(clip: &SourceClip, roles: &Roles) -> DVec2 {
    let treadmill = TreadmillClip::new(clip, roles);
    let toes = Joint::TOES.map(|toe| roles.joints[toe.index()]);
    match toes {
        [Some(left), Some(right)] if has_human_hips(clip, roles) => treadmill.contact_slide([left, right]),
        _ => treadmill.ankle_slide(Joint::FEET.map(|foot| roles.required(foot))),
    }
}

/// Share of the time that a ball stands on ground of velocity `ground`, mean of both feet; none without toes. The speed
/// of the body widens the limit.
pub(crate) fn planted_share(clip: &SourceClip, roles: &Roles, ground: DVec2, body_mps: f64) -> Option<f64> {
    let treadmill = TreadmillClip::new(clip, roles);
    let reach = reach_mps(ground, treadmill.scale) + REACH_SHARE * body_mps;
    let stands = |vote: &&SlideVote| vote.velocity.distance(ground) < reach;
    let of_toe = |toe: Joint| Some(treadmill.votes(roles.joints[toe.index()]?).iter().flatten().filter(stands).count());
    let [left, right] = Joint::TOES.map(of_toe);
    Some((left? + right?) as f64 / (2 * clip.frame_count()) as f64)
}

fn has_human_hips(clip: &SourceClip, roles: &Roles) -> bool {
    let [left, right] = Joint::THIGHS.map(|hip| roles.required(hip));
    let distance_m: f64 =
        (0..clip.frame_count()).map(|f| clip.position(f, left).distance(clip.position(f, right))).sum();
    distance_m < HIPS_OVER_LEG_MAX * leg_length(clip, roles) * clip.frame_count() as f64
}

/// A clip as one on a treadmill.
struct TreadmillClip<'a> {
    clip: &'a SourceClip,
    /// Facing in each frame, rad.
    facings: Vec<f64>,
    /// Leg length over a person's.
    scale: f64,
}

/// The ground velocity that would hold a low ball still, and its weight.
#[derive(Clone, Copy)]
struct SlideVote {
    velocity: DVec2,
    weight: f64,
}

impl<'a> TreadmillClip<'a> {
    fn new(clip: &'a SourceClip, roles: &Roles) -> Self {
        let facings = (0..clip.frame_count()).map(|frame| facing_rad(clip, roles, frame)).collect();
        Self { clip, facings, scale: leg_length(clip, roles) / HUMAN_LEG_M }
    }

    /// Mean slide of the balls over the middle of their contacts.
    fn contact_slide(&self, balls: [usize; 2]) -> DVec2 {
        let of_balls = balls.map(|ball| self.votes(ball));
        let all: Vec<SlideVote> = of_balls.iter().flatten().flatten().copied().collect();
        let ground = densest(&all, self.scale);
        let reach = reach_mps(ground, self.scale);
        let mut slides: Vec<DVec2> = Vec::new();
        for votes in &of_balls {
            let agrees = |vote: &SlideVote| vote.velocity.distance(ground) < reach;
            let stands: Vec<bool> = votes.iter().map(|vote| vote.as_ref().is_some_and(agrees)).collect();
            for Range { start, end } in frame_runs(&stands, true) {
                slides
                    .extend(votes[contact_middle(start, end, votes.len())].iter().flatten().map(|vote| vote.velocity));
            }
        }
        if slides.is_empty() { ground } else { slides.iter().sum::<DVec2>() / slides.len() as f64 }
    }

    /// A ball's vote in each frame; none where the ball is high.
    fn votes(&self, ball: usize) -> Vec<Option<SlideVote>> {
        let planted_m = self.planted_height_m(ball);
        let vote = |frame: usize| {
            let lift = (self.clip.position(frame, ball).z - planted_m).max(0.0) / (VOTE_HEIGHT_M * self.scale);
            (lift < 1.0).then(|| SlideVote { velocity: self.slide(ball, frame), weight: 1.0 - lift * lift })
        };
        (0..self.clip.frame_count()).map(vote).collect()
    }

    /// Median slide of the lower ankle over its lowest frames.
    fn ankle_slide(&self, ankles: [usize; 2]) -> DVec2 {
        let height = |frame: usize, ankle: usize| self.clip.position(frame, ankle).z;
        let lower = |frame: usize| {
            let [left, right] = ankles;
            let ankle = if height(frame, right) < height(frame, left) { right } else { left };
            (height(frame, ankle), frame, ankle)
        };
        let mut stance: Vec<(f64, usize, usize)> = (0..self.clip.frame_count()).map(lower).collect();
        stance.sort_by(|a, b| a.0.total_cmp(&b.0));
        stance.truncate(1 + ((stance.len() - 1) as f64 * ANKLE_STANCE_SHARE) as usize);
        let slides: Vec<DVec2> = stance.iter().map(|&(_, frame, ankle)| self.slide(ankle, frame)).collect();
        let middle = |axis: usize| median(slides.iter().map(|slide| slide[axis])).unwrap_or_default();
        DVec2::new(middle(0), middle(1))
    }

    fn planted_height_m(&self, joint: usize) -> f64 {
        let heights = (0..self.clip.frame_count()).map(|frame| self.clip.position(frame, joint).z);
        lower_quantile(heights, PLANTED_QUANTILE).unwrap_or_default()
    }

    /// Reversed velocity of a joint, one-sided at the clip's ends.
    fn slide(&self, joint: usize, frame: usize) -> DVec2 {
        let span = ((SPEED_SPAN_S * self.clip.frame_rate_hz + 0.5) as usize).max(1);
        let (before, after) = (frame.saturating_sub(span), (frame + span).min(self.clip.frame_count() - 1));
        let step = (self.clip.position(before, joint) - self.clip.position(after, joint)).truncate();
        in_body_frame(step * self.clip.frame_rate_hz / (after - before) as f64, heading(self.facings[frame]))
    }
}

/// Frames of a contact without its ends. An end that the clip cuts off stays.
fn contact_middle(start: usize, end: usize, frames: usize) -> Range<usize> {
    let cut = ((end - start) as f64 * CONTACT_END_SHARE + 0.5) as usize;
    let first = if start == 0 { start } else { start + cut };
    let past = if end == frames { end } else { end - cut };
    first..past.max(first)
}

/// Reach of the kernel about a ground velocity, m/s. Legs swing as pendulums do: speeds scale with the root of the
/// size.
fn reach_mps(ground: DVec2, scale: f64) -> f64 {
    REACH_MPS * scale.sqrt() + REACH_SHARE * ground.length()
}

/// The velocity about which votes are densest; zero without votes.
fn densest(votes: &[SlideVote], scale: f64) -> DVec2 {
    let density = |at: DVec2| {
        let reach = reach_mps(at, scale);
        let near = |vote: &SlideVote| {
            let share = vote.velocity.distance(at) / reach;
            vote.weight * (1.0 - share * share).max(0.0)
        };
        votes.iter().map(near).sum::<f64>()
    };
    let starts =
        votes.iter().step_by((votes.len() / STARTS).max(1)).map(|vote| (density(vote.velocity), vote.velocity));
    let mut at = starts.max_by(|a, b| a.0.total_cmp(&b.0)).map_or(DVec2::ZERO, |(_, velocity)| velocity);
    for _ in 0..SHIFTS_MAX {
        let reach = reach_mps(at, scale);
        let near = votes.iter().filter(|vote| vote.velocity.distance(at) < reach);
        let sums = near
            .fold((DVec2::ZERO, 0.0), |(sum, weight), vote| (sum + vote.velocity * vote.weight, weight + vote.weight));
        let shifted = if sums.1 > 0.0 { sums.0 / sums.1 } else { at };
        if shifted.distance(at) < CONVERGED_MPS {
            break;
        }
        at = shifted;
    }
    at
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stance_feet_outvote_feet_in_the_air() {
        let vote = |x: f64, y: f64, weight: f64| SlideVote { velocity: DVec2::new(x, y), weight };
        let stance = (0..20).map(|k| vote(3.0 + 0.02 * f64::from(k % 5 - 2), 0.1, 1.0));
        let swing = (0..60).map(|k| vote(2.5 - 0.15 * f64::from(k), 0.0, 0.5));
        let found = densest(&stance.chain(swing).collect::<Vec<SlideVote>>(), 1.0);
        assert!(found.distance(DVec2::new(3.0, 0.1)) < 0.1, "{found}");
        assert_eq!(densest(&[], 1.0), DVec2::ZERO);
    }
}

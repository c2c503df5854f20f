//! The ground speed of a clip that treads on the spot: how fast the ground would have to pass under the body for its
//! stance feet to stand still.
//!
//! The balls of the feet are what stands: flat on the ground from just after the heel's strike to toe-off, so that in a
//! walk one of both always does. While they are low they vote for the ground velocity that would hold them; in the air
//! they are low too, shortly before they land and after they leave, but at ever other speeds. The ground velocity is
//! where the votes are densest (mean shift, Epanechnikov's kernel; Comaniciu and Meer 2002), each counting the more,
//! the lower the ball is. What votes near it without a break is a contact, and the speeds are the mean over the middle
//! 80 % of every contact, as the definitions judge slide. The mean, not the median: where the hips are held in every
//! frame, feet slide slowest in mid-stance, which is where most of the frames are, and the median of a walk is 8 % low.
//!
//! Drawn characters do not roll over their feet as people do. Of a body of no human proportions, or without toes, the
//! lower ankle tells, while it is low, by the median.
//!
//! Body frame (along the facing, to its left), metres, seconds.

use std::ops::Range;

use glam::DVec2;
use motiondb::body::Joint;
use motiondb::statistics::median;

use crate::frame_runs::frame_runs;
use crate::read::source_clip::SourceClip;
use crate::retarget::source_parameters::{facing_rad, heading, in_body};
use crate::retarget::units::{HUMAN_LEG_M, leg_length};
use crate::rig::roles::Roles;

/// A ball higher than this over where it stands has no vote, m for a person's leg. Twice the definition's height of
/// contact: the toes of captured runs sink by 4 cm between landing and leaving.
const VOTE_HEIGHT_M: f64 = 0.05;
/// Reach of the kernel: the slide of a stance foot when the hips do not travel as the ground does, m/s, and share of
/// the speed. (Contacts of the definition: 0.25 m/s and 15 %; hips surge by ± 0.15 m/s more.)
const REACH_MPS: f64 = 0.4;
const REACH_SHARE: f64 = 0.15;
/// So many votes, spread over the clip, are tried as the densest place.
const STARTS: usize = 64;
/// The mean shift stands still long before; changes under this do not matter, m/s.
const SHIFTS_MAX: usize = 32;
const SETTLED_MPS: f64 = 1e-6;
/// Hip joints farther apart than this, over the leg, are no person's (0.14 to 0.25; drawn characters 0.8 and more).
const HIPS_OVER_LEG_MAX: f64 = 0.45;
/// The share of a contact at either end in which the foot may still land or already leave: slide is measured without
/// it, too.
const CONTACT_END_SHARE: f64 = 0.1;
/// Share of the frames, by height of the lower ankle, that count as its stance.
const ANKLE_STANCE_SHARE: f64 = 0.6;
/// A foot stands at this part of its heights, in order: the lowest twentieth, as in [`crate::gait::contacts`].
const PLANTED_PERCENTILE: usize = 20;
/// Speeds are taken over ± this time, so that noise weighs the same at 24 and at 120 frames a second.
const SPEED_SPAN_S: f64 = 1.0 / 30.0;

/// The velocity of the ground under a body whose hips stay in place, reversed: v_f and ω_s.
pub(crate) fn ground_velocity(clip: &SourceClip, roles: &Roles) -> DVec2 {
    let tread = Tread::new(clip, roles);
    let toes = Joint::TOES.map(|toe| roles.joints[toe.index()]);
    match toes {
        [Some(left), Some(right)] if has_human_hips(clip, roles) => tread.contact_slide([left, right]),
        _ => tread.ankle_slide(Joint::FEET.map(|foot| roles.required(foot))),
    }
}

/// Share of the time that a ball stands on ground of that velocity under a body of that speed, mean of both feet; none
/// without toes.
pub(crate) fn planted_share(clip: &SourceClip, roles: &Roles, ground: DVec2, body_mps: f64) -> Option<f64> {
    let tread = Tread::new(clip, roles);
    let reach = reach_mps(ground, tread.scale) + REACH_SHARE * body_mps;
    let stands = |vote: &&Vote| vote.velocity.distance(ground) < reach;
    let of_toe = |toe: Joint| Some(tread.votes(roles.joints[toe.index()]?).iter().flatten().filter(stands).count());
    let [left, right] = Joint::TOES.map(of_toe);
    Some((left? + right?) as f64 / (2 * clip.frame_count()) as f64)
}

fn has_human_hips(clip: &SourceClip, roles: &Roles) -> bool {
    let [left, right] = Joint::THIGHS.map(|hip| roles.required(hip));
    let apart: f64 = (0..clip.frame_count()).map(|f| clip.position(f, left).distance(clip.position(f, right))).sum();
    apart < HIPS_OVER_LEG_MAX * leg_length(clip, roles) * clip.frame_count() as f64
}

/// A clip as it is looked at here.
struct Tread<'a> {
    clip: &'a SourceClip,
    facings: Vec<f64>,
    /// Over a person's size.
    scale: f64,
}

/// What would hold a low ball still, and how much that counts.
#[derive(Clone, Copy)]
struct Vote {
    velocity: DVec2,
    weight: f64,
}

impl<'a> Tread<'a> {
    fn new(clip: &'a SourceClip, roles: &Roles) -> Self {
        let facings = (0..clip.frame_count()).map(|frame| facing_rad(clip, roles, frame)).collect();
        Self { clip, facings, scale: leg_length(clip, roles) / HUMAN_LEG_M }
    }

    /// The mean slide of the balls over the middle of their contacts.
    fn contact_slide(&self, balls: [usize; 2]) -> DVec2 {
        let of_balls = balls.map(|ball| self.votes(ball));
        let all: Vec<Vote> = of_balls.iter().flatten().flatten().copied().collect();
        let ground = densest(&all, self.scale);
        let reach = reach_mps(ground, self.scale);
        let mut slides: Vec<DVec2> = Vec::new();
        for votes in &of_balls {
            let agrees = |vote: &Vote| vote.velocity.distance(ground) < reach;
            let stands: Vec<bool> = votes.iter().map(|vote| vote.as_ref().is_some_and(agrees)).collect();
            for Range { start, end } in frame_runs(&stands, true) {
                slides.extend(votes[middle(start, end, votes.len())].iter().flatten().map(|vote| vote.velocity));
            }
        }
        if slides.is_empty() { ground } else { slides.iter().sum::<DVec2>() / slides.len() as f64 }
    }

    /// A ball's vote in every frame; none where it is in the air.
    fn votes(&self, ball: usize) -> Vec<Option<Vote>> {
        let stands_m = self.planted_height(ball);
        let vote = |frame: usize| {
            let lift = (self.clip.position(frame, ball).z - stands_m).max(0.0) / (VOTE_HEIGHT_M * self.scale);
            (lift < 1.0).then(|| Vote { velocity: self.slide(ball, frame), weight: 1.0 - lift * lift })
        };
        (0..self.clip.frame_count()).map(vote).collect()
    }

    /// Minus the median velocity of the lower ankle, while that is low.
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

    fn planted_height(&self, joint: usize) -> f64 {
        let mut heights: Vec<f64> = (0..self.clip.frame_count()).map(|f| self.clip.position(f, joint).z).collect();
        heights.sort_by(f64::total_cmp);
        heights[(heights.len() - 1) / PLANTED_PERCENTILE]
    }

    /// A joint's velocity in the body's frame, reversed; one-sided at the clip's ends.
    fn slide(&self, joint: usize, frame: usize) -> DVec2 {
        let span = ((SPEED_SPAN_S * self.clip.frame_rate_hz + 0.5) as usize).max(1);
        let (before, after) = (frame.saturating_sub(span), (frame + span).min(self.clip.frame_count() - 1));
        let step = (self.clip.position(before, joint) - self.clip.position(after, joint)).truncate();
        in_body(step * self.clip.frame_rate_hz / (after - before) as f64, heading(self.facings[frame]))
    }
}

/// The middle of a contact; what the clip cuts off is no end of it.
fn middle(start: usize, end: usize, frames: usize) -> Range<usize> {
    let cut = ((end - start) as f64 * CONTACT_END_SHARE + 0.5) as usize;
    let first = if start == 0 { start } else { start + cut };
    let past = if end == frames { end } else { end - cut };
    first..past.max(first)
}

/// Legs swing as pendulums do: speeds go with the root of the size.
fn reach_mps(ground: DVec2, scale: f64) -> f64 {
    REACH_MPS * scale.sqrt() + REACH_SHARE * ground.length()
}

/// The place about which votes lie densest; zero where there is none.
fn densest(votes: &[Vote], scale: f64) -> DVec2 {
    let density = |at: DVec2| {
        let reach = reach_mps(at, scale);
        let near = |vote: &Vote| vote.weight * (1.0 - (vote.velocity.distance(at) / reach).powi(2)).max(0.0);
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
        if shifted.distance(at) < SETTLED_MPS {
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
    fn feet_in_the_air_are_outvoted() {
        let vote = |x: f64, y: f64, weight: f64| Vote { velocity: DVec2::new(x, y), weight };
        let stance = (0..20).map(|k| vote(3.0 + 0.02 * f64::from(k % 5 - 2), 0.1, 1.0));
        let swing = (0..60).map(|k| vote(2.5 - 0.15 * f64::from(k), 0.0, 0.5));
        let found = densest(&stance.chain(swing).collect::<Vec<Vote>>(), 1.0);
        assert!(found.distance(DVec2::new(3.0, 0.1)) < 0.1, "{found}");
        assert_eq!(densest(&[], 1.0), DVec2::ZERO);
    }
}

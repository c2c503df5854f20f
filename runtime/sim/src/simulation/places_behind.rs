//! Places behind agents that stand: an agent whose door is closed, or whose goal is taken, brakes and stands behind others.
//! World, metres, m/s.
//!
//! The agents at the front have rank 1; one that stands behind an agent of rank n has rank n + 1. Ranks are read as the
//! last step left them, so the order of agents changes nothing.

use glam::Vec2;

use crate::route::braking::{braking_speed_mps, coasted_m};

/// Distance between the discs of an agent that stands and one that stands behind it, m.
const GAP_M: f32 = 0.25;
/// Distance from its place within which an agent begins to stand, m, beside the distance that it coasts.
const STOPS_M: f32 = 0.08;
/// Distance from its place beyond which an agent that stands moves up, m: a step.
const MOVES_UP_M: f32 = 0.5;
/// Cosine of the angle to the direction of an agent within which another stands before it, 45°; 60° for an agent that
/// stands, which does not go on when it is pushed a little aside.
const BEFORE_COS: [f32; 2] = [0.71, 0.5];
/// Distance within which an agent brakes behind another that stands, m.
const BRAKES_M: f32 = 1.2;
/// Greatest number of agents that stand one behind the other: crowds that face each other do not hold each other.
const RANK_MAX: u32 = 100;

/// An agent that stands.
#[derive(Clone, Copy, Debug)]
pub(super) struct Standing {
    pub(super) index: usize,
    pub(super) position_m: Vec2,
    pub(super) radius_m: f32,
    pub(super) rank: u32,
}

/// The agents that stand, by x.
pub(super) struct StandingCrowd {
    agents: Vec<Standing>,
    radius_max_m: f32,
}

/// An agent that looks for its place.
pub(super) struct Newcomer {
    index: usize,
    pub(super) position_m: Vec2,
    pub(super) radius_m: f32,
    /// Unit direction of v_pref.
    direction: Vec2,
    /// Distance from its place within which it stands, m.
    slack_m: f32,
    /// Distance that it coasts, m.
    coast_m: f32,
    /// Cosine of the angle within which others stand before it.
    before_cos: f32,
}

/// The place of an agent.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    /// Free path to it, m.
    left_m: f32,
    /// Rank there; 0 where the agent walks on.
    pub(super) rank: u32,
}

impl StandingCrowd {
    pub(super) fn new(mut agents: Vec<Standing>) -> Self {
        agents.sort_by(|a, b| a.position_m.x.total_cmp(&b.position_m.x).then(a.index.cmp(&b.index)));
        let radius_max_m = agents.iter().map(|agent| agent.radius_m).fold(0.0, f32::max);
        Self { agents, radius_max_m }
    }

    /// The agents before which another may have to brake.
    pub(super) fn near(&self, newcomer: &Newcomer) -> impl Iterator<Item = &Standing> {
        let reach_m = newcomer.radius_m + self.radius_max_m + GAP_M + BRAKES_M + newcomer.coast_m;
        let x_m = newcomer.position_m.x;
        let from = self.agents.partition_point(|other| other.position_m.x < x_m - reach_m);
        self.agents[from..].iter().take_while(move |other| other.position_m.x <= x_m + reach_m)
    }
}

impl Newcomer {
    /// An agent by its index, its position, v_pref and the velocity that it keeps while it coasts, and its radius;
    /// `last_rank` is its rank in the last step.
    pub(super) fn new(
        index: usize,
        [position_m, preferred_mps, coasting_mps]: [Vec2; 3],
        radius_m: f32,
        last_rank: u32,
    ) -> Self {
        let direction = preferred_mps.normalize_or_zero();
        let coast_m = coasted_m(coasting_mps, direction);
        let stands = last_rank > 0;
        let slack_m = if stands { MOVES_UP_M } else { (STOPS_M + coast_m).min(MOVES_UP_M) };
        Self { index, position_m, radius_m, direction, slack_m, coast_m, before_cos: BEFORE_COS[usize::from(stands)] }
    }

    /// Its place at the front, given the free path to there, m; none where it is not there yet.
    pub(super) fn place_at_front(&self, to_front_m: f32) -> Option<Place> {
        (to_front_m < self.slack_m).then_some(Place { left_m: to_front_m, rank: 1 })
    }

    /// Its place behind the agents that stand before it; `to_front_m` is the free path to the front, m.
    pub(super) fn place_behind<'a>(&self, to_front_m: f32, standing: impl Iterator<Item = &'a Standing>) -> Place {
        let (mut left_m, mut rank) = (to_front_m, u32::MAX);
        for other in standing.filter(|other| other.index != self.index && other.rank < RANK_MAX) {
            let offset_m = other.position_m - self.position_m;
            let distance_m = offset_m.length();
            if self.direction.dot(offset_m) <= self.before_cos * distance_m {
                continue;
            }
            let free_m = distance_m - self.radius_m - other.radius_m - GAP_M;
            left_m = left_m.min(free_m);
            if free_m < self.slack_m {
                rank = rank.min(other.rank + 1);
            }
        }
        Place { left_m, rank: if rank == u32::MAX { 0 } else { rank } }
    }

    /// v_pref before its place, m/s.
    pub(super) fn preferred_mps(&self, place: Place, preferred_mps: Vec2) -> Vec2 {
        if place.rank > 0 {
            return Vec2::ZERO;
        }
        preferred_mps.clamp_length_max(braking_speed_mps((place.left_m - self.coast_m).max(0.0)))
    }
}

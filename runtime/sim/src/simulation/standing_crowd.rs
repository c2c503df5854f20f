//! Standing behind others: an agent whose door is closed, or whose goal is taken, brakes and stands behind others. World,
//! metres, m/s.
//!
//! The agents at the front have rank 1; one that stands behind an agent of rank n has rank n + 1. An agent that brakes has
//! a standing position before it stands there, so that those who follow it brake as evenly as it does. Of two agents that
//! brake, the one nearer to the front comes first (of two equally near, that with the lower index). Positions are read as
//! the last step left them, so threads change nothing.

use std::num::NonZeroU32;

use glam::Vec2;

use crate::route::braking::{braking_distance_m, braking_speed_mps, coasted_m};
use crate::route::standing_position::StandingPosition;

/// Distance between the discs of an agent that stands and one that comes to stand behind it, m; it stops short of that.
const GAP_M: f32 = 0.2;
/// Distance from its standing position within which an agent begins to stand, m, beside the distance that it coasts
/// (docs/tuning.md).
const STOPS_M: f32 = 0.14;
/// Distance from its standing position beyond which an agent that stands moves up, m: a step.
const MOVES_UP_M: f32 = 0.5;
/// Cosine of the angle to the direction of an agent within which another stands before it, 35°; 53° for an agent that
/// stands, which does not go on when it is pushed a little aside (docs/tuning.md).
const BEFORE_COS: [f32; 2] = [0.82, 0.6];
/// Greatest number of agents that stand one behind the other: crowds that face each other do not hold each other.
const RANK_MAX: u32 = 100;

/// An agent that stands, or brakes in order to stand.
#[derive(Clone, Copy, Debug)]
pub(super) struct StandingAgent {
    pub(super) index: usize,
    pub(super) radius_m: f32,
    /// Where it stands, or will stand.
    pub(super) standing: StandingPosition,
    /// Its free path to the front, m.
    pub(super) to_front_m: f32,
}

/// The agents that stand or brake, by the x of their standing positions.
pub(super) struct StandingCrowd {
    agents: Vec<StandingAgent>,
    radius_max_m: f32,
}

/// An agent that looks for its standing position.
pub(super) struct Newcomer {
    pub(super) index: usize,
    pub(super) position_m: Vec2,
    pub(super) radius_m: f32,
    /// v_pref, m/s.
    pub(super) preferred_mps: Vec2,
    /// The velocity that it keeps while it coasts, m/s.
    pub(super) coasting_mps: Vec2,
    /// Its free path to the front, m.
    pub(super) to_front_m: f32,
    /// Whether it stood in the last step.
    pub(super) stood: bool,
}

/// How an agent goes on.
#[derive(Clone, Copy, Debug)]
pub(super) struct Approach {
    /// Where it stands, or will stand; none where it does not brake yet.
    pub(super) standing: Option<StandingPosition>,
    /// v_pref, m/s.
    pub(super) preferred_mps: Vec2,
}

impl StandingCrowd {
    pub(super) fn new(mut agents: Vec<StandingAgent>) -> Self {
        let x_m = |agent: &StandingAgent| agent.standing.position_m.x;
        agents.sort_by(|a, b| x_m(a).total_cmp(&x_m(b)).then(a.index.cmp(&b.index)));
        let radius_max_m = agents.iter().map(|agent| agent.radius_m).fold(0.0, f32::max);
        Self { agents, radius_max_m }
    }

    /// The agents behind which another may have to stand.
    pub(super) fn near(&self, newcomer: &Newcomer) -> impl Iterator<Item = &StandingAgent> {
        let reach_m = newcomer.radius_m + self.radius_max_m + GAP_M + newcomer.brakes_m();
        let x_m = newcomer.position_m.x;
        let from = self.agents.partition_point(|other| other.standing.position_m.x < x_m - reach_m);
        self.agents[from..].iter().take_while(move |other| other.standing.position_m.x <= x_m + reach_m)
    }
}

impl Newcomer {
    /// It stands at the front; none where it is not there yet.
    pub(super) fn at_front(&self) -> Option<Approach> {
        (self.to_front_m < self.stops_m()).then(|| self.stands(NonZeroU32::MIN))
    }

    /// How it goes on, behind the agents that stand before it or will stand there, and no farther than `up_to_m`.
    pub(super) fn approach<'a>(&self, up_to_m: f32, others: impl Iterator<Item = &'a StandingAgent>) -> Approach {
        let (direction, stops_m, before_cos) = (self.direction(), self.stops_m(), BEFORE_COS[usize::from(self.stood)]);
        let (mut remaining_m, mut rank): (f32, Option<NonZeroU32>) = (up_to_m, None);
        for other in others.filter(|other| self.comes_after(other)) {
            let offset_m = other.standing.position_m - self.position_m;
            let distance_m = offset_m.length();
            if direction.dot(offset_m) <= before_cos * distance_m {
                continue;
            }
            let free_m = distance_m - self.radius_m - other.radius_m - GAP_M;
            remaining_m = remaining_m.min(free_m);
            if let Some(before) = other.standing.rank.filter(|_| free_m < stops_m) {
                let behind = before.saturating_add(1);
                rank = Some(rank.map_or(behind, |rank| rank.min(behind)));
            }
        }
        rank.map_or_else(|| self.brakes(remaining_m), |rank| self.stands(rank))
    }

    /// Distance from its standing position within which it brakes, m.
    pub(super) fn brakes_m(&self) -> f32 {
        // Of an agent that brakes already, by v_pref, the distance that it needs is just what is left.
        STOPS_M + self.coast_m() + braking_distance_m(self.preferred_mps.length())
    }

    /// Distance from its standing position within which it stands, m.
    fn stops_m(&self) -> f32 {
        if self.stood { MOVES_UP_M } else { (STOPS_M + self.coast_m()).min(MOVES_UP_M) }
    }

    /// Distance that it coasts, m.
    fn coast_m(&self) -> f32 {
        coasted_m(self.coasting_mps, self.direction())
    }

    /// Unit direction of v_pref.
    fn direction(&self) -> Vec2 {
        self.preferred_mps.normalize_or_zero()
    }

    /// Whether another stands, or brakes and comes to the front before this agent.
    fn comes_after(&self, other: &StandingAgent) -> bool {
        let nearer = other.to_front_m.total_cmp(&self.to_front_m).then(other.index.cmp(&self.index)).is_lt();
        let stands_before = other.standing.rank.map_or(nearer, |rank| rank.get() < RANK_MAX);
        other.index != self.index && stands_before
    }

    fn stands(&self, rank: NonZeroU32) -> Approach {
        let standing = StandingPosition { position_m: self.position_m, rank: Some(rank) };
        Approach { standing: Some(standing), preferred_mps: Vec2::ZERO }
    }

    fn brakes(&self, remaining_m: f32) -> Approach {
        if remaining_m >= self.brakes_m() {
            return Approach { standing: None, preferred_mps: self.preferred_mps };
        }
        let standing = StandingPosition { position_m: self.position_m + remaining_m * self.direction(), rank: None };
        let speed_mps = braking_speed_mps((remaining_m - self.coast_m()).max(0.0));
        Approach { standing: Some(standing), preferred_mps: self.preferred_mps.clamp_length_max(speed_mps) }
    }
}

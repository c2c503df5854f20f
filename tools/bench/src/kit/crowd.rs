//! Crowds of any size, whose agents all cross each other. World, metres.

use fbcrowd_sim::maths::SplitMix64;
use fbcrowd_sim::scenario::{AgentSpec, Scenario, WALL_RADIUS_M};
use glam::Vec2;

/// Agents per square metre.
const DENSITY_PER_M2: f32 = 0.3;
/// Greatest distance of an agent from its point of the lattice, as a share of the spacing.
const JITTER: f64 = 0.2;
/// Radius of an agent, m.
const RADIUS_M: f32 = 0.25;
/// Preferred speed of an agent, m/s.
const SPEED_MPS: f32 = 1.33;
/// Time step of Table 1 (§7), s.
const DT_S: f32 = 0.1;

/// A jittered lattice of agents in a disc. The goal of each is the opposite point.
pub(crate) fn disc(agents: usize) -> Scenario {
    let spacing_m = DENSITY_PER_M2.sqrt().recip();
    let half = ((agents as f32).sqrt() * 0.6) as i32 + 3;
    let coordinate_m = |index: i32| spacing_m * (index as f32 + 0.5);
    let mut points_m: Vec<Vec2> =
        (-half..half).flat_map(|x| (-half..half).map(move |y| Vec2::new(coordinate_m(x), coordinate_m(y)))).collect();
    points_m.sort_by(|a, b| a.length_squared().total_cmp(&b.length_squared()));
    let mut random = SplitMix64::new(1, agents as u64);
    let mut jitter_m = || spacing_m * random.within(JITTER) as f32;
    let agents =
        points_m.into_iter().take(agents).map(|point_m| agent_across(point_m + Vec2::new(jitter_m(), jitter_m())));
    Scenario { dt_s: DT_S, ..Scenario::of(agents.collect()) }
}

/// An agent with its goal at the opposite point.
pub(crate) fn agent_across(position_m: Vec2) -> AgentSpec {
    AgentSpec {
        position_m,
        facing_rad: (-position_m).to_angle(),
        goals_m: vec![-position_m],
        radius_m: RADIUS_M,
        wall_radius_m: WALL_RADIUS_M,
        preferred_speed_mps: SPEED_MPS,
        ..AgentSpec::default()
    }
}

//! The way to the goal: v_pref along ordered waypoints (`FbCrowd` §3, stage 2; the navigation mesh comes later).
//!
//! An agent heads for its next waypoint at its preferred speed, rounds it on its way to the one after, brakes
//! evenly before the last and then stays there. Crowds shove: whoever is shoved past a waypoint goes on, and whoever is
//! shoved behind a wall after it goes round by the waypoint again. World, metres, seconds.

use glam::Vec2;

use crate::scenario::AgentSpec;
use crate::world::obstacles::Obstacles;

/// Within this distance a waypoint is passed by who is beyond it: two people abreast fill the way about it, and a third
/// who rounds a corner beside them would come back for it.
const BESIDE_M: f32 = 1.0;
/// Within this distance aside it is rounded in full; at [`BESIDE_M`], not at all.
const ROUNDED_M: f32 = 0.5;
/// Rounding begins this long before a waypoint, s: 0.9 m at a walk. Were v_pref to jump to the next leg instead, a
/// right angle would nearly stop a walker (0.1 m/s; so, 0.6). Beginning at 1 s, bodies are slower through lanes of 1 m.
const ROUNDING_S: f32 = 0.7;
/// Cosine of the sharpest turn that is rounded, 120°: to turn back, a waypoint is walked to …
const ROUNDED_COS: f32 = -0.5;
/// … within this distance: the arrival radius of the definitions.
const WAYPOINT_RADIUS_M: f32 = 0.5;
/// A passed waypoint is gone back to from no farther than this: a crowd shoves its people by a few bodies' widths.
const SHOVED_M: f32 = 3.0;
/// The last goal is reached within this distance, half a step …
const GOAL_RADIUS_M: f32 = 0.2;
/// … and sought again only when an agent is pushed away further than this: with 0.4 m the bodies of slow databases,
/// whose least step is long, shuffled about their goals for ever.
const GOAL_LEFT_RADIUS_M: f32 = 0.6;
/// Even braking before the goal, a third of what a person can do at most, m/s².
const BRAKING_MPS2: f32 = 1.0;
/// Over the last stretch the speed falls with the distance: this much time is left, s.
const STOPPING_TIME_S: f32 = 0.5;

/// How an agent slows down before its last goal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Braking {
    /// As a body can: evenly, then it stays, until it is pushed away.
    Evenly,
    /// As a disc can, which stops at once: at full speed, until the goal lies within this time, s; it never rests. The
    /// protocol under which RVO2 is measured (`fbcrowd bench table1 --discs`).
    Within(f32),
}

/// How far an agent has got on its way.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Progress {
    /// Index of the waypoint that it heads for.
    pub next: u32,
    /// It has reached the last one and stays.
    pub arrived: bool,
}

impl Progress {
    /// Counts the waypoints that it has passed where it is now; whether it heads for the last one.
    pub fn pass(&mut self, agent: &AgentSpec, position_m: Vec2) -> bool {
        let last = agent.goals_m.len().saturating_sub(1);
        while (self.next as usize) < last && Corner::new(agent, self.next as usize).is_passed(position_m) {
            self.next += 1;
        }
        self.next as usize == last
    }
}

/// v_pref at a position, m/s.
pub fn preferred_mps(
    agent: &AgentSpec,
    position_m: Vec2,
    obstacles: &Obstacles,
    braking: Braking,
    progress: &mut Progress,
) -> Vec2 {
    if agent.goals_m.is_empty() {
        return Vec2::ZERO;
    }
    let to_last = progress.pass(agent, position_m);
    let next = progress.next as usize;
    let to_goal_m = agent.goals_m[next] - position_m;
    progress.arrived = to_last && to_goal_m.length() < arrival_radius_m(progress.arrived);
    if let Some(round_m) = way_round_m(agent, next, position_m, obstacles) {
        return (round_m - position_m).normalize_or_zero() * agent.preferred_speed_mps;
    }
    if !to_last {
        return Corner::new(agent, next).heading(position_m) * agent.preferred_speed_mps;
    }
    let speed_mps = match braking {
        Braking::Evenly if progress.arrived => 0.0,
        Braking::Evenly => braking_speed_mps(to_goal_m.length()),
        Braking::Within(time_s) => to_goal_m.length() / time_s,
    };
    to_goal_m.normalize_or_zero() * speed_mps.min(agent.preferred_speed_mps)
}

/// A waypoint that is not the last one.
struct Corner {
    waypoint_m: Vec2,
    after_m: Vec2,
    /// Unit vector across the line that halves the angle of the ways to and from it, onwards; none where it is a turn
    /// back.
    onwards: Option<Vec2>,
    /// Rounding begins this far before that line, m.
    rounding_m: f32,
}

impl Corner {
    fn new(agent: &AgentSpec, waypoint: usize) -> Self {
        let [waypoint_m, after_m] = [agent.goals_m[waypoint], agent.goals_m[waypoint + 1]];
        let before_m = waypoint.checked_sub(1).map_or(agent.position_m, |before| agent.goals_m[before]);
        let [to, from] = [waypoint_m - before_m, after_m - waypoint_m].map(Vec2::normalize_or_zero);
        let onwards = (to + from).try_normalize().filter(|_| to.dot(from) > ROUNDED_COS);
        let rounding_m = ROUNDING_S * agent.preferred_speed_mps * onwards.map_or(0.0, |onwards| onwards.dot(to));
        Self { waypoint_m, after_m, onwards, rounding_m }
    }

    /// Whether it lies behind, and no more than a little aside; where it is a turn back, whether it is near.
    fn is_passed(&self, position_m: Vec2) -> bool {
        let beyond_m = position_m - self.waypoint_m;
        match self.onwards {
            Some(onwards) => beyond_m.dot(onwards) >= 0.0 && beyond_m.length() < BESIDE_M,
            None => beyond_m.length() < WAYPOINT_RADIUS_M,
        }
    }

    /// Unit direction of v_pref: to the waypoint, turning to the one after as the line through it comes near.
    fn heading(&self, position_m: Vec2) -> Vec2 {
        let [to, after] = [self.waypoint_m, self.after_m].map(|goal_m| (goal_m - position_m).normalize_or_zero());
        let Some(onwards) = self.onwards else { return to };
        let beyond_m = position_m - self.waypoint_m;
        let before_m = -beyond_m.dot(onwards);
        let near = if before_m > 0.0 { (1.0 - before_m / self.rounding_m).max(0.0) } else { 0.0 };
        let abreast = ((BESIDE_M - beyond_m.perp_dot(onwards).abs()) / (BESIDE_M - ROUNDED_M)).clamp(0.0, 1.0);
        to.lerp(after, near * abreast).normalize_or(to)
    }
}

/// The waypoint passed last, for who has been shoved to where a wall hides the next one. Where a wall hides it from the
/// waypoint too, the ways were meant so.
fn way_round_m(agent: &AgentSpec, next: usize, position_m: Vec2, obstacles: &Obstacles) -> Option<Vec2> {
    let (passed_m, next_m) = (agent.goals_m[next.checked_sub(1)?], agent.goals_m[next]);
    let sees = |from_m, to_m| obstacles.is_free(from_m, to_m);
    let shoved = position_m.distance(passed_m) < SHOVED_M && !sees(position_m, next_m);
    (shoved && sees(position_m, passed_m) && sees(passed_m, next_m)).then_some(passed_m)
}

fn arrival_radius_m(arrived: bool) -> f32 {
    if arrived { GOAL_LEFT_RADIUS_M } else { GOAL_RADIUS_M }
}

/// The speed from which even braking, then the last stretch, stop at the goal; both meet with the same slope.
fn braking_speed_mps(distance_m: f32) -> f32 {
    let last_stretch_m = BRAKING_MPS2 * STOPPING_TIME_S * STOPPING_TIME_S;
    if distance_m < last_stretch_m {
        return distance_m / STOPPING_TIME_S;
    }
    libm::sqrtf(2.0 * BRAKING_MPS2 * (distance_m - 0.5 * last_stretch_m))
}

#[cfg(test)]
mod tests {
    use super::*;

    const DT_S: f32 = 1.0 / 30.0;

    fn agent(goals_m: &[Vec2]) -> AgentSpec {
        AgentSpec {
            position_m: Vec2::ZERO,
            facing_rad: 0.0,
            goals_m: goals_m.to_vec(),
            radius_m: 0.25,
            preferred_speed_mps: 1.3,
        }
    }

    fn open() -> Obstacles {
        Obstacles::default()
    }

    /// v_pref at each step of a disc that follows it for a time, and how near to its first waypoint that leads it.
    fn walked(agent: &AgentSpec, time_s: f32) -> (Vec<Vec2>, f32, Progress) {
        let (mut position_m, mut progress, mut nearest_m) = (agent.position_m, Progress::default(), f32::INFINITY);
        let mut step = || {
            let preferred_mps = preferred_mps(agent, position_m, &open(), Braking::Evenly, &mut progress);
            position_m += preferred_mps * DT_S;
            nearest_m = nearest_m.min(position_m.distance(agent.goals_m[0]));
            preferred_mps
        };
        let preferred_mps = (0..(time_s / DT_S) as usize).map(|_| step()).collect();
        (preferred_mps, nearest_m, progress)
    }

    #[test]
    fn waypoints_are_rounded_in_order_and_the_last_one_is_stayed_at() {
        for turn_deg in [0.0_f32, 45.0, -90.0, 118.0] {
            let after_m = Vec2::new(3.0, 0.0) + 4.0 * Vec2::from_angle(turn_deg.to_radians());
            let (preferred_mps, nearest_m, progress) = walked(&agent(&[Vec2::new(3.0, 0.0), after_m]), 10.0);
            assert!(nearest_m < 0.6 && progress.arrived, "{turn_deg}° {nearest_m} m");
            for pair in preferred_mps.windows(2).take_while(|pair| pair[1] != Vec2::ZERO) {
                assert!(pair[0].angle_to(pair[1]).abs() < 0.3, "{turn_deg}° {pair:?}");
            }
        }
    }

    #[test]
    fn who_starts_on_a_waypoint_goes_on() {
        let (_, _, progress) = walked(&agent(&[Vec2::ZERO, Vec2::ZERO, Vec2::new(5.0, 0.0)]), 10.0);
        assert!(progress.arrived);
    }

    #[test]
    fn to_turn_back_a_waypoint_is_walked_to() {
        let (preferred_mps, nearest_m, progress) = walked(&agent(&[Vec2::new(3.0, 0.0), Vec2::new(-2.0, 0.3)]), 10.0);
        assert!(nearest_m < WAYPOINT_RADIUS_M && progress.arrived);
        assert!(preferred_mps.iter().all(|preferred_mps| preferred_mps.y.abs() < 0.2));
    }

    #[test]
    fn speed_falls_evenly_before_the_goal() {
        let agent = agent(&[Vec2::new(5.0, 0.0)]);
        let (mut position_m, mut progress, mut speed_mps, dt_s) = (Vec2::ZERO, Progress::default(), 1.3, 0.01);
        while !progress.arrived {
            let next_mps = preferred_mps(&agent, position_m, &open(), Braking::Evenly, &mut progress).length();
            assert!(progress.arrived || speed_mps - next_mps <= 1.02 * BRAKING_MPS2 * dt_s, "{speed_mps} {next_mps}");
            position_m.x += next_mps * dt_s;
            speed_mps = next_mps;
        }
    }

    #[test]
    fn an_agent_without_goals_stays() {
        assert_eq!(
            preferred_mps(&agent(&[]), Vec2::ONE, &open(), Braking::Evenly, &mut Progress::default()),
            Vec2::ZERO
        );
    }

    #[test]
    fn who_rounds_a_corner_beside_its_waypoint_goes_on_and_who_is_not_round_it_does_not() {
        let agent = agent(&[Vec2::new(11.0, 1.0), Vec2::new(11.0, 12.0)]);
        for (position_m, next) in
            [([10.8, 1.8], 1), ([11.8, 1.3], 1), ([10.2, 1.3], 0), ([10.2, 2.2], 0), ([1.0, 3.0], 0)]
        {
            let mut progress = Progress::default();
            preferred_mps(&agent, Vec2::from(position_m), &open(), Braking::Evenly, &mut progress);
            assert_eq!(progress.next, next, "{position_m:?}");
        }
    }

    #[test]
    fn who_is_shoved_aside_after_the_waypoint_in_a_door_goes_through_the_door() {
        let post_m = [(0.0, 0.5), (0.4, 0.5), (0.4, 5.0), (0.0, 5.0)].map(Vec2::from).to_vec();
        let (obstacles, agent) = (Obstacles::new(&[post_m]), agent(&[Vec2::new(-0.4, 0.0), Vec2::new(60.0, 0.0)]));
        let mut progress = Progress { next: 1, arrived: false };
        let mut heading_for = |x_m, y_m| {
            preferred_mps(&agent, Vec2::new(x_m, y_m), &obstacles, Braking::Evenly, &mut progress).normalize()
        };
        assert!(heading_for(-0.5, 1.5).distance(Vec2::new(0.1, -1.5).normalize()) < 1e-6);
        assert!(heading_for(-0.5, 0.3).x > 0.99 && heading_for(0.6, 1.5).x > 0.99);
    }
}

//! Collisions of discs over whole steps, and the least distance of their centres (`FbCrowd` App. 11, Eqs. 16 and 17,
//! corrected). World, metres; computed in f64.

use glam::{DVec2, Vec2};

use crate::maths::sweep::sort_along_longer_side;

/// Sums the penetration depths of all pairs, step by step.
#[derive(Debug)]
pub struct Collisions {
    /// Agents sorted along the crowd's longer side; hardly changes from step to step, so sorting stays cheap.
    order: Vec<usize>,
    penetration: f64,
    /// Sum of the numbers of agents over all steps.
    agent_steps: usize,
    least_distance_m: f64,
}

impl Default for Collisions {
    /// No steps yet.
    fn default() -> Self {
        Self { order: Vec::new(), penetration: 0.0, agent_steps: 0, least_distance_m: f64::INFINITY }
    }
}

/// The area that a disc sweeps in one step, world, m.
#[derive(Clone, Copy, Debug)]
struct SweptDisc {
    start_m: DVec2,
    displacement_m: DVec2,
    radius_m: f64,
}

impl Collisions {
    /// Adds one step, given the radius and the roots before and after it of every agent that is present in both frames,
    /// world, metres.
    pub fn push(&mut self, radii_m: &[f32], before_m: &[Vec2], after_m: &[Vec2]) {
        let sweep = |(i, &radius_m): (usize, &f32)| SweptDisc {
            start_m: DVec2::from(before_m[i]),
            displacement_m: DVec2::from(after_m[i]) - DVec2::from(before_m[i]),
            radius_m: radius_m.into(),
        };
        let sweeps: Vec<SweptDisc> = radii_m.iter().enumerate().map(sweep).collect();
        self.agent_steps += sweeps.len();
        if self.order.len() != sweeps.len() {
            self.order = (0..sweeps.len()).collect();
        }
        let low_m = |index: usize, axis: usize| sweeps[index].low_m(axis);
        let axis = sort_along_longer_side(&mut self.order, before_m.iter().copied(), low_m);
        for (rank, &a) in self.order.iter().enumerate() {
            for &b in &self.order[rank + 1..] {
                // All later discs are farther away than the least distance so far.
                if sweeps[b].low_m(axis) - sweeps[a].high_m(axis) >= self.least_distance_m {
                    break;
                }
                let distance_m = least_distance_m(&sweeps[a], &sweeps[b]);
                let reach_m = sweeps[a].radius_m + sweeps[b].radius_m;
                self.penetration += (1.0 - distance_m / reach_m).max(0.0); // Eq. 17: PD
                self.least_distance_m = self.least_distance_m.min(distance_m);
            }
        }
    }

    /// Least distance of two centres so far, m; none of a single agent or before the first step.
    pub fn least_distance_m(&self) -> Option<f64> {
        self.least_distance_m.is_finite().then_some(self.least_distance_m)
    }

    /// Eq. 17: C, the mean over all steps and their agents of the pairs' penetration depths.
    pub fn rate(&self) -> f64 {
        self.penetration / self.agent_steps.max(1) as f64
    }
}

impl SweptDisc {
    fn low_m(&self, axis: usize) -> f64 {
        self.start_m[axis] + self.displacement_m[axis].min(0.0) - self.radius_m
    }

    fn high_m(&self, axis: usize) -> f64 {
        self.start_m[axis] + self.displacement_m[axis].max(0.0) + self.radius_m
    }
}

/// Eq. 16: least distance of two centres that move straight and evenly, m.
fn least_distance_m(a: &SweptDisc, b: &SweptDisc) -> f64 {
    let position_m = a.start_m - b.start_m;
    let displacement_m = a.displacement_m - b.displacement_m;
    let length_squared = displacement_m.length_squared();
    let share =
        if length_squared > 0.0 { (-position_m.dot(displacement_m) / length_squared).clamp(0.0, 1.0) } else { 0.0 };
    (position_m + share * displacement_m).length() // Eq. 16: d_min
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn rate(radii_m: &[f32], before_m: &[Vec2], after_m: &[Vec2]) -> f64 {
        let mut collisions = Collisions::default();
        collisions.push(radii_m, before_m, after_m);
        collisions.rate()
    }

    #[test]
    fn discs_that_pass_through_each_other_collide_fully() {
        let rate = rate(
            &[0.25; 2],
            &[Vec2::new(-1.0, 0.0), Vec2::new(1.0, 0.0)],
            &[Vec2::new(1.0, 0.0), Vec2::new(-1.0, 0.0)],
        );
        assert_eq!(rate, 0.5);
    }

    #[test]
    fn the_least_distance_counts_within_steps() {
        let mut collisions = Collisions::default();
        assert_eq!(collisions.least_distance_m(), None);
        let far = Vec2::new(50.0, 50.0);
        let mut push = |before_m: [Vec2; 3], after_m: [Vec2; 3]| {
            collisions.push(&[0.1; 3], &before_m, &after_m);
            assert_eq!(collisions.least_distance_m(), Some(3.0));
        };
        let aside = Vec2::new(0.0, 3.0);
        push([Vec2::new(-1.0, 0.0), aside, far], [Vec2::new(1.0, 0.0), aside, far]);
        push([Vec2::ZERO, Vec2::new(0.0, 4.0), far], [Vec2::ZERO, Vec2::new(0.0, 4.0), far]);
    }

    #[test]
    fn the_rate_counts_present_agents_only() {
        let mut collisions = Collisions::default();
        let near = [Vec2::ZERO, Vec2::new(0.25, 0.0)];
        collisions.push(&[0.25; 2], &near, &near);
        collisions.push(&[0.25], &near[..1], &near[..1]);
        collisions.push(&[], &[], &[]);
        // Half a depth in three agent-steps.
        assert_eq!(collisions.rate(), 0.5 / 3.0);
    }

    #[test]
    fn discs_at_rest_collide_by_their_overlap() {
        let near = [Vec2::ZERO, Vec2::new(0.25, 0.0)];
        assert_eq!(rate(&[0.25; 2], &near, &near), 0.25);
        let apart = [Vec2::ZERO, Vec2::new(0.5, 0.0)];
        assert_eq!(rate(&[0.25; 2], &apart, &apart), 0.0);
    }

    proptest! {
        /// Brute force samples 2001 instants of every pair.
        #[test]
        fn the_sweep_finds_what_brute_force_finds(
            agents in proptest::collection::vec((-2.0_f32..2.0, -2.0_f32..2.0, -0.5_f32..0.5, -0.5_f32..0.5, 0.1_f32..0.6), 1..24),
        ) {
            let before: Vec<Vec2> = agents.iter().map(|a| Vec2::new(a.0, a.1)).collect();
            let after: Vec<Vec2> = agents.iter().map(|a| Vec2::new(a.0 + a.2, a.1 + a.3)).collect();
            let radii: Vec<f32> = agents.iter().map(|a| a.4).collect();
            let (mut brute, mut brute_m) = (0.0, f32::INFINITY);
            for i in 0..agents.len() {
                for j in i + 1..agents.len() {
                    let at = |k: usize, share: f32| before[k].lerp(after[k], share);
                    let distance = |moment: u32| at(i, moment as f32 / 2000.0).distance(at(j, moment as f32 / 2000.0));
                    let least = (0..=2000).map(distance).fold(f32::INFINITY, f32::min);
                    brute += f64::from((1.0 - least / (radii[i] + radii[j])).max(0.0));
                    brute_m = brute_m.min(least);
                }
            }
            let mut collisions = Collisions::default();
            collisions.push(&radii, &before, &after);
            let found = collisions.rate() * agents.len() as f64;
            prop_assert!((found - brute).abs() < 1e-3 * (1.0 + brute), "{found} against {brute}");
            let found_m = collisions.least_distance_m().map_or(f32::INFINITY, |found_m| found_m as f32);
            prop_assert!(found_m == brute_m || (found_m - brute_m).abs() < 1e-3, "{found_m} m against {brute_m} m");
        }
    }
}

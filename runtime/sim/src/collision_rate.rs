//! Collisions of discs over whole steps (`FbCrowd` App. 11, Eqs. 16 and 17, corrected).

use glam::{DVec2, Vec2};

use crate::scenario_check::longer_side;

/// Sums the penetration depths of all pairs, step by step.
#[derive(Debug)]
pub struct Collisions {
    radii_m: Vec<f64>,
    /// Agents by where along the crowd's longer side begins what they sweep in a step; hardly changes from one step to the next, so sorting stays cheap.
    order: Vec<usize>,
    penetration: f64,
}

/// What a disc sweeps in one step, world, metres.
#[derive(Clone, Copy, Debug)]
struct Sweep {
    start_m: DVec2,
    displacement_m: DVec2,
    radius_m: f64,
}

impl Collisions {
    /// No steps yet; radii in index order, metres.
    pub fn new(radii_m: impl Iterator<Item = f32>) -> Self {
        let radii_m: Vec<f64> = radii_m.map(f64::from).collect();
        Self { order: (0..radii_m.len()).collect(), radii_m, penetration: 0.0 }
    }

    /// Adds one step, given every root before and after it, world, metres.
    pub fn push(&mut self, before_m: &[Vec2], after_m: &[Vec2]) {
        let sweep = |(i, &radius_m): (usize, &f64)| Sweep {
            start_m: DVec2::from(before_m[i]),
            displacement_m: DVec2::from(after_m[i]) - DVec2::from(before_m[i]),
            radius_m,
        };
        let sweeps: Vec<Sweep> = self.radii_m.iter().enumerate().map(sweep).collect();
        let axis = longer_side(before_m.iter().copied());
        self.order.sort_by(|&a, &b| sweeps[a].low_m(axis).total_cmp(&sweeps[b].low_m(axis)).then(a.cmp(&b)));
        for (rank, &a) in self.order.iter().enumerate() {
            let high_m = sweeps[a].high_m(axis);
            let near = self.order[rank + 1..].iter().take_while(|&&b| sweeps[b].low_m(axis) < high_m);
            self.penetration += near.map(|&b| penetration(&sweeps[a], &sweeps[b])).sum::<f64>();
        }
    }

    /// Eq. 17: C, the mean over T steps and N agents of the pairs' penetration depths.
    pub fn rate(&self, steps: usize) -> f64 {
        self.penetration / (steps * self.radii_m.len()).max(1) as f64
    }
}

impl Sweep {
    fn low_m(&self, axis: usize) -> f64 {
        self.start_m[axis] + self.displacement_m[axis].min(0.0) - self.radius_m
    }

    fn high_m(&self, axis: usize) -> f64 {
        self.start_m[axis] + self.displacement_m[axis].max(0.0) + self.radius_m
    }
}

/// PD, 0 to 1: how deep two discs come into each other while both move straight and evenly.
fn penetration(a: &Sweep, b: &Sweep) -> f64 {
    let position_m = a.start_m - b.start_m;
    let displacement_m = a.displacement_m - b.displacement_m;
    let length_squared = displacement_m.length_squared();
    let share =
        if length_squared > 0.0 { (-position_m.dot(displacement_m) / length_squared).clamp(0.0, 1.0) } else { 0.0 };
    let least_m = (position_m + share * displacement_m).length(); // Eq. 16
    (1.0 - least_m / (a.radius_m + b.radius_m)).max(0.0)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn rate(radii_m: &[f32], before_m: &[Vec2], after_m: &[Vec2]) -> f64 {
        let mut collisions = Collisions::new(radii_m.iter().copied());
        collisions.push(before_m, after_m);
        collisions.rate(1)
    }

    #[test]
    fn discs_that_pass_through_each_other_within_a_step_collide_fully() {
        let rate = rate(
            &[0.25; 2],
            &[Vec2::new(-1.0, 0.0), Vec2::new(1.0, 0.0)],
            &[Vec2::new(1.0, 0.0), Vec2::new(-1.0, 0.0)],
        );
        assert_eq!(rate, 0.5);
    }

    #[test]
    fn discs_at_rest_collide_by_their_overlap() {
        let places = [Vec2::ZERO, Vec2::new(0.25, 0.0)];
        assert_eq!(rate(&[0.25; 2], &places, &places), 0.25);
        let apart = [Vec2::ZERO, Vec2::new(0.5, 0.0)];
        assert_eq!(rate(&[0.25; 2], &apart, &apart), 0.0);
    }

    proptest! {
        /// The shortest distance is sought among 2001 moments instead of computed, over every pair instead of a sweep.
        #[test]
        fn the_sweep_finds_what_brute_force_finds(
            agents in proptest::collection::vec((-2.0_f32..2.0, -2.0_f32..2.0, -0.5_f32..0.5, -0.5_f32..0.5, 0.1_f32..0.6), 1..24),
        ) {
            let before: Vec<Vec2> = agents.iter().map(|a| Vec2::new(a.0, a.1)).collect();
            let after: Vec<Vec2> = agents.iter().map(|a| Vec2::new(a.0 + a.2, a.1 + a.3)).collect();
            let radii: Vec<f32> = agents.iter().map(|a| a.4).collect();
            let mut brute = 0.0;
            for i in 0..agents.len() {
                for j in i + 1..agents.len() {
                    let at = |k: usize, share: f32| before[k].lerp(after[k], share);
                    let distance = |moment: u32| at(i, moment as f32 / 2000.0).distance(at(j, moment as f32 / 2000.0));
                    let least = (0..=2000).map(distance).fold(f32::INFINITY, f32::min);
                    brute += f64::from((1.0 - least / (radii[i] + radii[j])).max(0.0));
                }
            }
            let found = rate(&radii, &before, &after) * agents.len() as f64;
            prop_assert!((found - brute).abs() < 1e-3 * (1.0 + brute), "{found} against {brute}");
        }
    }
}

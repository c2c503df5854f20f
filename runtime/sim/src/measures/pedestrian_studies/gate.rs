//! A line on the ground that agents pass, and the flow over it.
//!
//! An agent passes the gate from its right to its left, seen from its first end to its second. The first passage of
//! each agent counts, at the instant between two frames at which its root is on the line. World, metres, seconds.

use glam::Vec2;

/// A line, and when each agent first passed it.
#[derive(Clone, Debug)]
pub struct Gate {
    ends_m: [Vec2; 2],
    /// Time of the first passage of each agent, s.
    passed_s: Vec<Option<f64>>,
}

impl Gate {
    /// No passages yet.
    pub fn new(ends_m: [Vec2; 2], agent_count: usize) -> Self {
        Self { ends_m, passed_s: vec![None; agent_count] }
    }

    /// Adds one step that ends at a time, given every root before and after it.
    pub fn push(&mut self, before_m: &[Vec2], after_m: &[Vec2], end_s: f64, dt_s: f64) {
        for ((passed_s, &from_m), &to_m) in self.passed_s.iter_mut().zip(before_m).zip(after_m) {
            if let Some(share) = crossing_share(self.ends_m, from_m, to_m) {
                passed_s.get_or_insert(end_s - (1.0 - f64::from(share)) * dt_s);
            }
        }
    }

    /// Time of an agent's first passage, s.
    pub fn passed_s(&self, agent: usize) -> Option<f64> {
        self.passed_s[agent]
    }

    /// Times of all first passages, ascending, s.
    pub fn passages_s(&self) -> Vec<f64> {
        let mut passages_s: Vec<f64> = self.passed_s.iter().copied().flatten().collect();
        passages_s.sort_by(f64::total_cmp);
        passages_s
    }

    /// Passages a second between the first and the last; none of fewer than two.
    pub fn flow_per_s(&self) -> Option<f64> {
        let passages_s = self.passages_s();
        let lasted_s = passages_s.last()? - passages_s.first()?;
        (lasted_s > 0.0).then(|| (passages_s.len() - 1) as f64 / lasted_s)
    }

    /// Longest time between two passages that follow each other; none of fewer than two.
    pub fn longest_gap_s(&self) -> Option<f64> {
        self.passages_s().windows(2).map(|pair| pair[1] - pair[0]).reduce(f64::max)
    }
}

/// Share of a displacement at which it crosses the line to its left, 0 to 1.
pub(crate) fn crossing_share([first_m, second_m]: [Vec2; 2], from_m: Vec2, to_m: Vec2) -> Option<f32> {
    let along_m = second_m - first_m;
    let [from, to] = [from_m, to_m].map(|point_m| along_m.perp_dot(point_m - first_m));
    if from > 0.0 || to <= 0.0 {
        return None;
    }
    let share = from / (from - to);
    let at = along_m.dot(from_m.lerp(to_m, share) - first_m);
    (0.0..=along_m.length_squared()).contains(&at).then_some(share)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A gate from x = −1 to 1 at y = 0, passed in +y.
    fn gate(agent_count: usize) -> Gate {
        Gate::new([Vec2::new(-1.0, 0.0), Vec2::new(1.0, 0.0)], agent_count)
    }

    #[test]
    fn passages_are_timed_between_frames_and_count_once() {
        let mut gate = gate(2);
        let walk_m = |y: f32| [Vec2::new(0.0, y - 1.0), Vec2::new(0.5, y)];
        gate.push(&walk_m(-0.25), &walk_m(0.75), 1.0, 1.0);
        gate.push(&walk_m(0.75), &walk_m(-0.5), 2.0, 1.0);
        gate.push(&walk_m(-0.5), &walk_m(1.5), 3.0, 1.0);
        assert_eq!([gate.passed_s(0), gate.passed_s(1)], [Some(2.75), Some(0.25)]);
        assert_eq!((gate.flow_per_s(), gate.longest_gap_s()), (Some(0.4), Some(2.5)));
    }

    #[test]
    fn the_opposite_direction_and_a_detour_do_not_count() {
        let mut gate = gate(2);
        let [before_m, after_m] = [[Vec2::new(0.0, 0.5), Vec2::new(1.5, -1.0)], [Vec2::NEG_Y, Vec2::new(1.5, 1.0)]];
        gate.push(&before_m, &after_m, 1.0, 1.0);
        assert_eq!((gate.passages_s(), gate.flow_per_s(), gate.longest_gap_s()), (vec![], None, None));
    }
}

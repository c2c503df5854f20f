//! Passages over a line, in both directions: N–t, flow, specific flow.
//!
//! A passage is the instant between two frames at which the root of an agent is on the line; an agent that comes back
//! passes again. Forward is from the right of the line to its left, seen from its first end to its second. World,
//! metres, seconds.

use glam::Vec2;
use serde::Serialize;

use crate::measures::frame_pairs::FramePairs;
use crate::measures::pedestrian_studies::gate::crossing_share;

/// The measures of a line.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LineMeasures {
    /// Length of the line, m.
    pub width_m: f64,
    /// Passages from the right of the line to its left.
    pub forward: Passages,
    /// Passages from the left of the line to its right.
    pub backward: Passages,
}

/// The passages in one direction.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Passages {
    /// Number of passages.
    pub count: usize,
    /// Passages per second between the first and the last; none of fewer than two.
    pub flow_per_s: Option<f64>,
    /// Flow over the length of the line, 1/(m s).
    pub specific_flow_per_m_s: Option<f64>,
    /// Times of all passages, ascending, s: N–t.
    pub times_s: Vec<f64>,
}

/// A line while frames come.
#[derive(Debug)]
pub(crate) struct MeasuredLine {
    ends_m: [Vec2; 2],
    /// Times of the passages forward and backward, s.
    times_s: [Vec<f64>; 2],
}

impl MeasuredLine {
    pub(crate) fn new(ends_m: [Vec2; 2]) -> Self {
        Self { ends_m, times_s: [Vec::new(), Vec::new()] }
    }

    /// Adds the step that ends at a time.
    pub(crate) fn push(&mut self, end_s: f64, dt_s: f64, pairs: &FramePairs<'_>) {
        let [first_m, second_m] = self.ends_m;
        for (times_s, ends_m) in self.times_s.iter_mut().zip([[first_m, second_m], [second_m, first_m]]) {
            let shares = pairs
                .common
                .iter()
                .filter_map(|(before, after)| crossing_share(ends_m, before.root.position_m, after.root.position_m));
            times_s.extend(shares.map(|share| end_s - (1.0 - f64::from(share)) * dt_s));
        }
    }

    pub(crate) fn finish(self) -> LineMeasures {
        let width_m = f64::from(self.ends_m[0].distance(self.ends_m[1]));
        let [forward, backward] = self.times_s.map(|times_s| Passages::of(times_s, width_m));
        LineMeasures { width_m, forward, backward }
    }
}

impl Passages {
    fn of(mut times_s: Vec<f64>, width_m: f64) -> Self {
        times_s.sort_by(f64::total_cmp);
        let lasted_s = times_s.last().zip(times_s.first()).map(|(last_s, first_s)| last_s - first_s);
        let flow_per_s =
            lasted_s.filter(|lasted_s| *lasted_s > 0.0).map(|lasted_s| (times_s.len() - 1) as f64 / lasted_s);
        let specific_flow_per_m_s = flow_per_s.map(|flow_per_s| flow_per_s / width_m);
        Self { count: times_s.len(), flow_per_s, specific_flow_per_m_s, times_s }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::population::AgentId;
    use crate::recording::frame::AgentFrame;

    fn frame(id: u32, y: f32) -> AgentFrame {
        let mut frame = AgentFrame { id: AgentId(id), ..AgentFrame::default() };
        frame.root.position_m = Vec2::new(id as f32, y);
        frame
    }

    #[test]
    fn passages_count_in_both_directions() {
        let mut line = MeasuredLine::new([Vec2::new(-1.0, 0.0), Vec2::new(3.0, 0.0)]);
        // Agents 0 to 2 pass forward, one after the other; agent 1 comes back; agent 7 passes beside the line.
        for step in 0..6 {
            let at = |step: i32| {
                let ahead = |id: i32| step as f32 - id as f32 - 0.5;
                let back = if step < 4 { ahead(1) } else { 6.0 - step as f32 - 1.5 };
                [frame(0, ahead(0)), frame(1, back), frame(2, ahead(2)), frame(7, ahead(0))]
            };
            let (before, after) = (at(step), at(step + 1));
            line.push(f64::from(step + 1), 1.0, &FramePairs::new(&before, &after));
        }
        let LineMeasures { width_m, forward, backward } = line.finish();
        assert_eq!((width_m, forward.times_s, forward.flow_per_s), (4.0, vec![0.5, 1.5, 2.5], Some(1.0)));
        assert_eq!(forward.specific_flow_per_m_s, Some(0.25));
        assert_eq!((backward.times_s, backward.flow_per_s), (vec![4.5], None));
    }
}

//! Phase order: whether a crowd marches in step after a common start.
//!
//! R = |mean e^(i·2πφ)| over the agents that are faster than 0.5 m/s: 1 where all are in phase, about √(π/4N) for N
//! phases at random. Time counts from the start of the recording, s.

use std::f64::consts::{PI, TAU};

use serde::Serialize;

use crate::measures::people::body_track::BodyTrack;

/// Times after the start at which the order is taken, s.
const ORDER_TIMES_S: [f64; 3] = [1.0, 3.0, 8.0];
/// Least speed of an agent that counts, m/s.
const WALKING_MPS: f32 = 0.5;

/// Phase order at one time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct PhaseOrder {
    /// Time after the start, s.
    pub time_s: f64,
    /// Number of agents that are faster than 0.5 m/s.
    pub agents: usize,
    /// R; none where fewer than two agents count.
    pub order: Option<f64>,
    /// R of as many phases at random, √(π/4N).
    pub random: Option<f64>,
}

/// Sums phases at each time.
#[derive(Clone, Debug, Default)]
pub(crate) struct PhaseOrders {
    agents: [usize; 3],
    /// Sums of e^(i·2πφ).
    sums: [[f64; 2]; 3],
}

impl PhaseOrders {
    /// Adds a body.
    pub(crate) fn add(&mut self, track: &BodyTrack) {
        let velocities_mps = track.velocities_mps();
        for (which, time_s) in ORDER_TIMES_S.into_iter().enumerate() {
            let index = ((time_s - track.start_s) / track.dt_s).round();
            let Some(sample) = (index >= 0.0).then(|| track.samples.get(index as usize)).flatten() else { continue };
            if velocities_mps[index as usize].length() > WALKING_MPS {
                let (sine, cosine) = libm::sincos(TAU * f64::from(sample.phase));
                self.agents[which] += 1;
                self.sums[which][0] += cosine;
                self.sums[which][1] += sine;
            }
        }
    }

    /// The order at each time.
    pub(crate) fn finish(&self) -> Vec<PhaseOrder> {
        let order = |which: usize| {
            let (agents, [cosine, sine]) = (self.agents[which], self.sums[which]);
            let number = agents as f64;
            let enough = agents >= 2;
            PhaseOrder {
                time_s: ORDER_TIMES_S[which],
                agents,
                order: enough.then(|| libm::hypot(cosine, sine) / number),
                random: enough.then(|| (PI / (4.0 * number)).sqrt()),
            }
        };
        (0..ORDER_TIMES_S.len()).map(order).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measures::people::body_track::tests::track;

    /// R at 3 s of agents that walk with these phases.
    fn order_at_3_s(phases: &[f32], speed_mps: f32) -> PhaseOrder {
        let mut orders = PhaseOrders::default();
        for &phase in phases {
            orders.add(&track(4.0, |time_s, sample| {
                sample.phase = phase;
                sample.root_m.x = speed_mps * time_s as f32;
            }));
        }
        orders.finish()[1]
    }

    #[test]
    fn equal_phases_have_order_1_and_opposite_ones_0() {
        assert!((order_at_3_s(&[0.3, 0.3, 0.3], 1.0).order.unwrap() - 1.0).abs() < 1e-6);
        assert!(order_at_3_s(&[0.0, 0.25, 0.5, 0.75], 1.0).order.unwrap() < 1e-6);
        assert!((order_at_3_s(&[0.0, 0.25], 1.0).order.unwrap() - 0.5_f64.sqrt()).abs() < 1e-6);
    }

    #[test]
    fn slow_agents_have_no_phase() {
        let slow = order_at_3_s(&[0.3, 0.3], 0.4);
        assert_eq!((slow.agents, slow.order), (0, None));
    }
}

//! Which synthesis moves a body (`FbCrowd` §3.4.1, Eq. 1 as its text has it: printed with ttc ≤ t_trans): motion
//! blending unless there may be a collision.
//!
//! ```text
//! motion blending   if  ttc ≥ t_trans  and  d ≤ d_thresh            (1)
//! semi-procedural   otherwise
//! ```
//!
//! With hysteresis: the way back needs both with a margin, and each choice lasts for a while, so that a body does not
//! flip at the boundary. A body that stands, or is to stand, blends: m_sp only walks.

use crate::planning::plan::Plan;

/// On the way back to blending the time to collision must be this much longer than t_trans …
const TIME_MARGIN: f32 = 1.3;
/// … and the density this much lower than d_thresh.
const DENSITY_MARGIN: f32 = 0.8;
/// A choice lasts at least this long, s: a step.
const DWELL_S: f32 = 0.6;

/// Which synthesis made a pose (`FbCrowd` §3.4.1).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u8)]
pub enum Mode {
    /// Motion blending.
    #[default]
    Blending = 0,
    /// Semi-procedural locomotion.
    SemiProcedural = 1,
}

/// What was chosen, and how long ago.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Choice {
    /// The synthesis wanted.
    pub mode: Mode,
    since_s: f32,
}

/// What may be chosen, and where the thresholds of Eq. 1 lie.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Thresholds {
    /// Semi-procedural locomotion alone, for who walks.
    pub alone: bool,
    /// t_trans, s.
    pub transition_s: f32,
    /// d_thresh, in the units of [`Plan::density`].
    pub density: f32,
}

impl Choice {
    /// At the start: a body that stands.
    pub const BLENDING: Self = Self { mode: Mode::Blending, since_s: DWELL_S };

    /// Follows a plan; `walks` tells whether the body walks and is to go on.
    pub fn follow(&mut self, plan: &Plan, walks: bool, thresholds: &Thresholds, dt_s: f32) {
        self.since_s += dt_s;
        let wanted = match (walks, thresholds.alone) {
            (false, _) => Mode::Blending,
            (true, true) => Mode::SemiProcedural,
            (true, false) => self.by_threat(plan, thresholds),
        };
        if wanted != self.mode && (self.since_s >= DWELL_S || !walks) {
            *self = Self { mode: wanted, since_s: 0.0 };
        }
    }

    /// Eq. 1.
    fn by_threat(&self, plan: &Plan, thresholds: &Thresholds) -> Mode {
        let [time_margin, density_margin] = match self.mode {
            Mode::Blending => [1.0, 1.0],
            Mode::SemiProcedural => [TIME_MARGIN, DENSITY_MARGIN],
        };
        let free = plan.time_to_collision_s >= time_margin * thresholds.transition_s
            && plan.density <= density_margin * thresholds.density;
        if free { Mode::Blending } else { Mode::SemiProcedural }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const THRESHOLDS: Thresholds = Thresholds { alone: false, transition_s: 1.0, density: 0.5 };

    fn plan(time_to_collision_s: f32, density: f32) -> Plan {
        Plan { time_to_collision_s, density, ..Plan::default() }
    }

    /// How often the choice changes while plans and walking alternate.
    fn changes(plans: &[Plan], walks: bool) -> (usize, Mode) {
        let (mut choice, mut changes) = (Choice::BLENDING, 0);
        for step in 0..60 {
            let before = choice.mode;
            choice.follow(&plans[step % plans.len()], walks, &THRESHOLDS, 0.1);
            changes += usize::from(choice.mode != before);
        }
        (changes, choice.mode)
    }

    #[test]
    fn a_threat_or_a_crowd_asks_for_semi_procedural_locomotion_and_a_free_way_for_blending() {
        assert_eq!(changes(&[plan(0.5, 0.1)], true), (1, Mode::SemiProcedural));
        assert_eq!(changes(&[plan(f32::INFINITY, 0.7)], true), (1, Mode::SemiProcedural));
        assert_eq!(changes(&[plan(f32::INFINITY, 0.1)], true), (0, Mode::Blending));
    }

    #[test]
    fn at_the_boundary_nothing_flips() {
        assert_eq!(changes(&[plan(0.95, 0.1), plan(1.05, 0.1)], true), (1, Mode::SemiProcedural));
        assert!(changes(&[plan(0.5, 0.1), plan(9.0, 0.1)], true).0 <= 10);
    }

    #[test]
    fn who_stands_blends() {
        assert_eq!(changes(&[plan(0.1, 2.0)], false), (0, Mode::Blending));
    }
}

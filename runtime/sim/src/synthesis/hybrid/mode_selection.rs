//! Mode selection: which synthesis is to move a body (`FbCrowd` §3.4.1, Eq. 1).
//!
//! Motion blending is preferred unless a collision may come. Eq. 1 is printed with ttc ≤ t_trans; its text requires
//!
//! ```text
//! motion blending   if  ttc ≥ t_trans  and  d ≤ d_thresh            (1)
//! semi-procedural   otherwise
//! ```
//!
//! Hysteresis keeps a body from changing to and fro: the return to blending needs both with a margin, and each
//! selection has a least duration. A body that stands, or is to stand, blends, since m_sp only walks; it does
//! so at once when both feet are planted (`switching`).

use crate::planning::plan::Plan;
use crate::synthesis::{Mode, Modes};

/// Factor on t_trans for the return to blending.
const TIME_MARGIN: f32 = 1.3;
/// Factor on d_thresh for the return to blending.
const DENSITY_MARGIN: f32 = 0.8;
/// Least duration of a selection, s: a step.
const DURATION_MIN_S: f32 = 0.6;

/// The selected synthesis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ModeSelection {
    /// The synthesis that is to move the body.
    pub mode: Mode,
    /// Time since the selection, s.
    duration_s: f32,
}

/// What Eq. 1 depends on besides the plan.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ModeThresholds {
    /// Syntheses that the body may use.
    pub(crate) modes: Modes,
    /// t_trans, s.
    pub(crate) transition_s: f32,
    /// d_thresh, in the units of [`Plan::density`].
    pub(crate) density: f32,
}

impl ModeSelection {
    /// The selection of a body that stands.
    pub(crate) const BLENDING: Self = Self { mode: Mode::Blending, duration_s: DURATION_MIN_S };

    /// Follows a plan. `walks_on` is true if the body walks and is to continue.
    pub(crate) fn follow(&mut self, plan: &Plan, walks_on: bool, thresholds: &ModeThresholds, dt_s: f32) {
        self.duration_s += dt_s;
        let mode = match (walks_on, thresholds.modes) {
            (false, _) => Mode::Blending,
            (true, Modes::SemiProcedural) => Mode::SemiProcedural,
            (true, _) => self.by_threat(plan, thresholds),
        };
        if mode != self.mode && (self.duration_s >= DURATION_MIN_S || !walks_on) {
            *self = Self { mode, duration_s: 0.0 };
        }
    }

    /// Eq. 1.
    fn by_threat(&self, plan: &Plan, thresholds: &ModeThresholds) -> Mode {
        let [time_margin, density_margin] = match self.mode {
            Mode::Blending | Mode::Transition => [1.0, 1.0],
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

    const THRESHOLDS: ModeThresholds = ModeThresholds { modes: Modes::Hybrid, transition_s: 1.0, density: 0.5 };

    fn plan(time_to_collision_s: f32, density: f32) -> Plan {
        Plan { time_to_collision_s, density, ..Plan::default() }
    }

    /// Number of changes while plans alternate, and the last mode.
    fn changes(plans: &[Plan], walks_on: bool) -> (usize, Mode) {
        let (mut selection, mut changes) = (ModeSelection::BLENDING, 0);
        for step in 0..60 {
            let before = selection.mode;
            selection.follow(&plans[step % plans.len()], walks_on, &THRESHOLDS, 0.1);
            changes += usize::from(selection.mode != before);
        }
        (changes, selection.mode)
    }

    #[test]
    fn a_threat_or_a_crowd_selects_semi_procedural_locomotion() {
        assert_eq!(changes(&[plan(0.5, 0.1)], true), (1, Mode::SemiProcedural));
        assert_eq!(changes(&[plan(f32::INFINITY, 0.7)], true), (1, Mode::SemiProcedural));
        assert_eq!(changes(&[plan(f32::INFINITY, 0.1)], true), (0, Mode::Blending));
    }

    #[test]
    fn the_mode_does_not_alternate_at_the_boundary() {
        assert_eq!(changes(&[plan(0.95, 0.1), plan(1.05, 0.1)], true), (1, Mode::SemiProcedural));
        assert!(changes(&[plan(0.5, 0.1), plan(9.0, 0.1)], true).0 <= 10);
    }

    #[test]
    fn a_standing_body_blends() {
        assert_eq!(changes(&[plan(0.1, 2.0)], false), (0, Mode::Blending));
    }
}

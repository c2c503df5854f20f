//! RecordedTransitions → those that a set keeps: of near-equal ones the one that fits the examples best, and the mirror
//! images of those without a counterpart.
//!
//! Metres, radians.

use std::f64::consts::PI;

use glam::DVec2;
use motiondb::motion::ActionKind;

use crate::transition::recorded_transition::RecordedTransition;

/// Greatest number of recorded transitions of one kind.
const KIND_MAX: usize = 12;
/// Greatest difference in displacement of near-equal transitions, m.
const SAME_DISPLACEMENT_M: f64 = 0.25;
/// Greatest difference in turn of near-equal transitions, rad: 20°.
const SAME_TURN_RAD: f64 = PI / 9.0;
/// Greatest difference in speed of the examples at the ends of near-equal transitions, m/s.
const SAME_SPEED_MPS: f64 = 0.25;

/// What tells one transition from another.
#[derive(Clone, Copy, Debug)]
struct Character {
    kind: ActionKind,
    displacement_m: DVec2,
    turn_rad: f64,
    first_foot: usize,
    /// Velocity of the example at each end, m/s.
    velocities_mps: [DVec2; 2],
}

impl Character {
    fn of(found: &RecordedTransition) -> Self {
        let (displacement_m, turn_rad) = found.travel();
        let velocity_mps = |end: usize| {
            let rates = found.ends[end].rates;
            DVec2::new(rates.speed_mps, rates.strafe_mps)
        };
        let (kind, first_foot) = (found.kind, found.first_foot);
        Self { kind, displacement_m, turn_rad, first_foot, velocities_mps: [0, 1].map(velocity_mps) }
    }

    fn mirrored(&self) -> Self {
        let mirrored = |vector: DVec2| DVec2::new(vector.x, -vector.y);
        Self {
            displacement_m: mirrored(self.displacement_m),
            turn_rad: -self.turn_rad,
            first_foot: 1 - self.first_foot,
            velocities_mps: self.velocities_mps.map(mirrored),
            ..*self
        }
    }

    fn is_near(&self, other: &Self) -> bool {
        self.kind == other.kind
            && self.first_foot == other.first_foot
            && self.displacement_m.distance(other.displacement_m) <= SAME_DISPLACEMENT_M
            && (self.turn_rad - other.turn_rad).abs() <= SAME_TURN_RAD
            && self.velocities_mps.iter().zip(&other.velocities_mps).all(|(a, b)| a.distance(*b) <= SAME_SPEED_MPS)
    }
}

/// Keeps the best of near-equal transitions, and at most [`KIND_MAX`] of each kind; those that a
/// manifest states first, all of them, then the best.
pub(crate) fn best_transitions(mut found: Vec<RecordedTransition>) -> Vec<RecordedTransition> {
    found.sort_by(|a, b| {
        let by_place = (a.source, a.cut[0].to_bits()).cmp(&(b.source, b.cut[0].to_bits()));
        b.is_stated.cmp(&a.is_stated).then(a.flaws_m().total_cmp(&b.flaws_m())).then(by_place)
    });
    let mut kept: Vec<RecordedTransition> = Vec::new();
    for candidate in found {
        let own = Character::of(&candidate);
        let is_known = kept.iter().any(|other| Character::of(other).is_near(&own));
        let same_kind = kept.iter().filter(|other| other.kind == candidate.kind).count();
        if candidate.is_stated || !is_known && same_kind < KIND_MAX {
            kept.push(candidate);
        }
    }
    kept
}

/// Whether a set has no counterpart of the mirror image of a transition.
pub(crate) fn needs_mirror(found: &RecordedTransition, set: &[RecordedTransition]) -> bool {
    let mirrored = Character::of(found).mirrored();
    !set.iter().any(|other| Character::of(other).is_near(&mirrored))
}

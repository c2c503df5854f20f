//! Recorded starts of a database, and which of them a body plays when it begins to walk.
//!
//! A start is a transition ([`ActionKind::Start`]) from standing to an example. It fits a body whose command points where
//! the example goes, and whose free foot is the one that the start lifts first.
//!
//! Root frame (x forward, y left); sides are 0 left, 1 right.

use motiondb::motion::{Action, ActionKind, MotionDb, Parameters};

use crate::planning::plan::PLANTED_CONTACT;

/// Least cosine of the angle between the command and the velocity in which a start ends: 45°.
const SAME_DIRECTION: f32 = std::f32::consts::FRAC_1_SQRT_2;
/// Greatest difference between the turn rates of a command and of the example in which a start ends, rad/s.
const TURN_RATE_MAX_RAD_S: f32 = 1.5;

/// A recorded start, as a body chooses it.
#[derive(Clone, Copy, Debug, PartialEq)]
struct RecordedStart {
    /// Index of the action.
    action: u32,
    /// The foot that leaves the ground first.
    first_foot: usize,
    /// Parameters of the example in which it ends.
    exit: Parameters,
}

/// The recorded starts of a database.
#[derive(Clone, Debug, Default)]
pub(crate) struct Starts(Vec<RecordedStart>);

impl Starts {
    /// The starts in which a foot leaves the ground.
    pub(crate) fn of(db: &MotionDb) -> Self {
        let starts = db.actions.iter().enumerate().filter(|(_, action)| action.kind == ActionKind::Start);
        let start = |(index, action): (usize, &Action)| {
            let exit = db.examples[action.exit.example as usize].parameters;
            Some(RecordedStart { action: index as u32, first_foot: first_foot(action)?, exit })
        };
        Self(starts.filter_map(start).collect())
    }

    /// The action of the start that fits a command, given the foot that is to leave the ground first.
    pub(crate) fn fitting(&self, command: Parameters, first_foot: usize) -> Option<u32> {
        let direction = command.velocity_mps().normalize_or_zero();
        let cosine = |start: &RecordedStart| start.exit.velocity_mps().normalize_or_zero().dot(direction);
        let fits = |start: &&RecordedStart| {
            start.first_foot == first_foot
                && cosine(start) >= SAME_DIRECTION
                && (start.exit.turn_rate_rad_s - command.turn_rate_rad_s).abs() <= TURN_RATE_MAX_RAD_S
        };
        let best = self.0.iter().filter(fits).max_by(|a, b| cosine(a).total_cmp(&cosine(b)));
        best.map(|start| start.action)
    }
}

/// The foot that leaves the ground first in an action.
fn first_foot(action: &Action) -> Option<usize> {
    let off = |side: usize| action.frames.iter().position(|frame| frame.contacts[side] < PLANTED_CONTACT);
    match [off(0), off(1)] {
        [None, None] => None,
        [Some(left), Some(right)] => Some(usize::from(right < left)),
        [left, _] => Some(usize::from(left.is_none())),
    }
}

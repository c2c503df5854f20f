//! Pose weights: the weights of examples at one phase, and the pose and contacts that they blend.
//!
//! Poses are weighted sums of stored rows, linear between two rows. Frames: [`motiondb::body`].

use glam::Quat;
use motiondb::body::Pose;
use motiondb::motion::{MotionDb, PHASE_COUNT};

/// Greatest number of examples in a mix: a simplex of four, and others that fade out.
pub(super) const MIX_MAX: usize = 12;

/// Weights of examples at one phase.
#[derive(Clone, Copy, Debug)]
pub struct PoseWeights {
    /// (example, weight); the first `count` entries are in use, and sum to 1.
    pub(super) entries: [(u32, f32); MIX_MAX],
    pub(super) count: usize,
    /// φ', 1/s.
    pub phase_rate_hz: f32,
}

impl PoseWeights {
    /// (example, weight).
    pub(crate) fn entries(&self) -> &[(u32, f32)] {
        &self.entries[..self.count]
    }

    /// The blended pose.
    pub fn pose(&self, db: &MotionDb, phase: f32) -> Pose {
        let (rows, shares) = rows_at(phase);
        db.rows.blended(
            self.entries()
                .iter()
                .flat_map(|&(example, weight)| [0, 1].map(|row| (example as usize, rows[row], weight * shares[row]))),
        )
    }

    /// The blended pose, in which the pose of an idle takes the place of the examples that stand; `idle` gives it where
    /// any does.
    pub(crate) fn pose_with_idle(&self, db: &MotionDb, phase: f32, idle: impl FnOnce() -> Option<Pose>) -> Pose {
        let standing: f32 = self.entries().iter().filter(|entry| stands(db, entry.0)).map(|&(_, weight)| weight).sum();
        let Some(idle) = (standing > 0.0).then(idle).flatten() else { return self.pose(db, phase) };
        let (rows, shares) = rows_at(phase);
        let steps = self.entries().iter().filter(|entry| !stands(db, entry.0));
        let rows =
            steps.flat_map(|&(example, weight)| [0, 1].map(|row| (example as usize, rows[row], weight * shares[row])));
        db.rows.blended_with(&idle, standing, rows)
    }

    /// Rows of the extra joints and their weights; the frames of an idle take the place of the examples that stand.
    pub(crate) fn extra_rows<'a>(
        &'a self,
        db: &'a MotionDb,
        phase: f32,
        idle: Option<[(&'a [Quat], f32); 4]>,
    ) -> impl Iterator<Item = (&'a [Quat], f32)> {
        let (rows, shares) = rows_at(phase);
        self.entries().iter().flat_map(move |&(example, weight)| {
            let row = |index: usize| (db.extra.row(example as usize, rows[index]), shares[index]);
            let idle = idle.filter(|_| stands(db, example));
            let rows = idle.is_none().then(|| [0, 1].map(row));
            let parts = idle.into_iter().flatten().chain(rows.into_iter().flatten());
            parts.map(move |(rotations, share)| (rotations, weight * share))
        })
    }

    /// The blended contact Σ w_i·c_i of each foot, `[left, right]`.
    pub(crate) fn contacts(&self, db: &MotionDb, phase: f32) -> [f32; 2] {
        let (rows, shares) = rows_at(phase);
        let mut contacts = [0.0; 2];
        for &(example, weight) in self.entries() {
            for (row, share) in rows.into_iter().zip(shares) {
                let row = db.rows.contacts[example as usize * PHASE_COUNT + row];
                contacts[0] += weight * share * row[0];
                contacts[1] += weight * share * row[1];
            }
        }
        contacts
    }

    /// Time until the blended contact of a swinging foot rises to `threshold`, at constant weights and phase rate, s;
    /// the duration of a cycle where it never does.
    pub(crate) fn time_to_landing_s(&self, db: &MotionDb, phase: f32, side: usize, threshold: f32) -> f32 {
        let first_row = libm::ceilf(phase * PHASE_COUNT as f32) as usize;
        let contact = |row: usize| -> f32 {
            let row = row % PHASE_COUNT;
            let terms = self.entries().iter();
            terms.map(|&(example, weight)| weight * db.rows.contacts[example as usize * PHASE_COUNT + row][side]).sum()
        };
        let landing = (first_row..first_row + PHASE_COUNT).find(|&row| contact(row) >= threshold);
        let phases = landing.unwrap_or(first_row + PHASE_COUNT) as f32 / PHASE_COUNT as f32 - phase;
        phases.max(0.0) / self.phase_rate_hz
    }

    /// Weighted mean of the planted-foot slide of the examples, cm/s.
    pub(crate) fn examples_slide_cm_s(&self, db: &MotionDb) -> f32 {
        self.entries().iter().map(|&(example, weight)| weight * db.examples[example as usize].planted_slide_cm_s).sum()
    }
}

/// Whether an example stands.
fn stands(db: &MotionDb, example: u32) -> bool {
    db.examples[example as usize].key_times_s.is_none()
}

/// The two stored rows next to a phase, and their shares.
pub(crate) fn rows_at(phase: f32) -> ([usize; 2], [f32; 2]) {
    let position = phase * PHASE_COUNT as f32;
    let row = position as usize;
    let share = position - row as f32;
    let row = row % PHASE_COUNT;
    ([row, (row + 1) % PHASE_COUNT], [1.0 - share, share])
}

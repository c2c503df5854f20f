//! Motion blending (`FbCrowd` §5): shares of time, pose weights, phase, pose.
//!
//! The asked (v_f, ω_t, ω_s) has barycentric coordinates u among the examples, and u are shares of *time*: over a
//! stretch of it, example i plays for u_i. So
//!
//! ```text
//! root velocity    Σ u_i·(v_f, ω_t, ω_s)_i
//! phase rate φ'    Σ u_i·r_i(φ)
//! pose weights w_i u_i·r_i(φ) / φ'
//! ```
//!
//! and a planted foot, which moves back through the root frame by v_i/r_i a phase in example i, moves by Σ
//! w_i·v_i/r_i·φ' = Σ u_i·v_i a second in the blend: with the ground. Poses are weighted sums of rows (frames:
//! [`motiondb::body::pose`]), between two rows linear.

use glam::Vec3;
use motiondb::blend_space::Shares;
use motiondb::body::Pose;
use motiondb::motion::{MotionDb, PHASE_COUNT, Parameters, PhaseMap, wrapped};

/// Examples that one body may mix: a simplex of four, and others that fade out.
pub(crate) const MIX_MAX: usize = 12;
/// Shares under this are let go, so that an example that has faded out is no longer sampled.
const SHARE_MIN: f32 = 1e-4;

/// The examples that a body plays, with their shares of time, and how fast; sparse, without heap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mix {
    entries: [(u32, f32); MIX_MAX],
    count: usize,
    /// Of the examples' own time, 1 but for the slowest steps ([`crate::synthesis::command::stand_or_step`]): root and phase are slowed alike, so
    /// planted feet hold.
    pace: f32,
}

impl Mix {
    /// Exactly these shares.
    pub fn new(shares: &Shares) -> Self {
        let mut mix = Self { entries: Default::default(), count: 0, pace: 1.0 };
        mix.add(entries_of(shares), 1.0);
        mix
    }

    /// (example, share), shares summing to 1.
    pub fn entries(&self) -> &[(u32, f32)] {
        &self.entries[..self.count]
    }

    /// Share of one example.
    pub fn share(&self, example: u32) -> f32 {
        self.entries().iter().find(|entry| entry.0 == example).map_or(0.0, |entry| entry.1)
    }

    /// Moves the given fraction of the way to target shares and pace.
    pub fn approach(&mut self, target: &Shares, pace: f32, fraction: f32) {
        self.move_towards(entries_of(target), pace, fraction);
    }

    /// Moves the given fraction of the way to another mix.
    pub fn ease(&mut self, target: &Self, fraction: f32) {
        self.move_towards(target.entries().iter().copied(), target.pace, fraction);
    }

    fn move_towards(&mut self, entries: impl Iterator<Item = (u32, f32)>, pace: f32, fraction: f32) {
        self.entries[..self.count].iter_mut().for_each(|entry| entry.1 *= 1.0 - fraction);
        self.add(entries, fraction);
        self.prune();
        self.pace += fraction * (pace - self.pace);
    }

    /// Sum of the shares that change hands on the way to the target.
    pub fn change_to(&self, target: &Shares) -> f32 {
        let of_target = |example| entries_of(target).find(|entry| entry.0 == example).map_or(0.0, |entry| entry.1);
        self.entries().iter().map(|&(example, share)| (share - of_target(example)).max(0.0)).sum()
    }

    /// (example, change of its share) on the way to the target.
    pub fn changes_to(&self, target: &Shares) -> impl Iterator<Item = (u32, f32)> {
        let leaving = self.entries().iter().map(|&(example, share)| (example, -share));
        leaving.chain(entries_of(target))
    }

    /// Adds shares times a factor; where there is no room, the least share gives way.
    fn add(&mut self, entries: impl Iterator<Item = (u32, f32)>, factor: f32) {
        for (example, share) in entries {
            let share = share * factor;
            if let Some(entry) = self.entries[..self.count].iter_mut().find(|entry| entry.0 == example) {
                entry.1 += share;
            } else if self.count < MIX_MAX {
                self.entries[self.count] = (example, share);
                self.count += 1;
            } else if let Some(least) = self.entries.iter_mut().min_by(|a, b| a.1.total_cmp(&b.1)) {
                *least = (example, share);
            }
        }
    }

    /// Lets go what has faded out and makes the shares sum to 1 again.
    fn prune(&mut self) {
        let mut kept = 0;
        for index in 0..self.count {
            if self.entries[index].1 >= SHARE_MIN {
                self.entries[kept] = self.entries[index];
                kept += 1;
            }
        }
        self.count = kept;
        let sum: f32 = self.entries().iter().map(|entry| entry.1).sum();
        self.entries[..kept].iter_mut().for_each(|entry| entry.1 /= sum);
    }

    /// Root velocity: Σ u_i·(v_f, ω_t, ω_s)_i, at the pace.
    pub fn parameters(&self, db: &MotionDb) -> Parameters {
        let sum =
            self.entries().iter().map(|&(example, share)| share * db.examples[example as usize].parameters.to_vec3());
        Parameters::from_vec3(self.pace * sum.fold(Vec3::ZERO, |sum, term| sum + term))
    }

    /// φ' = Σ u_i·r_i(φ), at the pace, 1/s.
    pub fn phase_rate_hz(&self, db: &MotionDb, phase: f32) -> f32 {
        let sine = PhaseMap::sine(phase);
        let rate_hz = |example: u32| db.examples[example as usize].phase_map.rate_at_hz(sine);
        self.pace * self.entries().iter().map(|&(example, share)| share * rate_hz(example)).sum::<f32>()
    }

    /// The phase in [0, 1) after a step, by the midpoint rule.
    pub fn advance_phase(&self, db: &MotionDb, phase: f32, dt_s: f32) -> f32 {
        let middle = phase + 0.5 * dt_s * self.phase_rate_hz(db, phase);
        wrapped(phase + dt_s * self.phase_rate_hz(db, middle))
    }

    /// Pose weights: w_i = u_i·r_i(φ) / φ'.
    pub fn weights(&self, db: &MotionDb, phase: f32) -> Weights {
        let (mut entries, mut sum_hz, sine) = (self.entries, 0.0, PhaseMap::sine(phase));
        for entry in &mut entries[..self.count] {
            entry.1 *= db.examples[entry.0 as usize].phase_map.rate_at_hz(sine);
            sum_hz += entry.1;
        }
        entries[..self.count].iter_mut().for_each(|entry| entry.1 /= sum_hz);
        Weights { entries, count: self.count, phase_rate_hz: self.pace * sum_hz }
    }
}

/// The entries of located shares that count.
fn entries_of(shares: &Shares) -> impl Iterator<Item = (u32, f32)> {
    shares.examples.into_iter().zip(shares.shares).filter(|entry| entry.1 > 0.0)
}

/// Pose weights at one phase.
#[derive(Clone, Copy, Debug)]
pub struct Weights {
    entries: [(u32, f32); MIX_MAX],
    count: usize,
    /// φ', 1/s.
    pub phase_rate_hz: f32,
}

impl Weights {
    /// (example, weight), weights summing to 1.
    pub fn entries(&self) -> &[(u32, f32)] {
        &self.entries[..self.count]
    }

    /// The blended pose.
    pub fn pose(&self, db: &MotionDb, phase: f32) -> Pose {
        let (rows, shares) = two_rows(phase);
        db.rows.blended(
            self.entries()
                .iter()
                .flat_map(|&(example, weight)| [0, 1].map(|row| (example as usize, rows[row], weight * shares[row]))),
        )
    }

    /// The blended contact Σ w_i·c_i of each foot.
    pub fn contacts(&self, db: &MotionDb, phase: f32) -> [f32; 2] {
        let (rows, shares) = two_rows(phase);
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

    /// Seconds until the blended contact of a foot that swings rises to `threshold`, at the present weights and phase
    /// rate; a whole cycle where it never does.
    pub fn time_to_landing_s(&self, db: &MotionDb, phase: f32, side: usize, threshold: f32) -> f32 {
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

    /// Weight-averaged planted-foot slide of the examples in use, cm/s.
    pub fn examples_slide_cm_s(&self, db: &MotionDb) -> f32 {
        self.entries().iter().map(|&(example, weight)| weight * db.examples[example as usize].planted_slide_cm_s).sum()
    }
}

/// The stored rows beside a phase, and their shares.
pub(crate) fn two_rows(phase: f32) -> ([usize; 2], [f32; 2]) {
    let position = phase * PHASE_COUNT as f32;
    let row = position as usize;
    let share = position - row as f32;
    let row = row % PHASE_COUNT;
    ([row, (row + 1) % PHASE_COUNT], [1.0 - share, share])
}

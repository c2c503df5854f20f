//! Motion blending (`FbCrowd` §5): from shares of time to root velocity, phase rate and pose weights.
//!
//! Barycentric coordinates u of (v_f, ω_t, ω_s) among the examples are shares of *time*: over an interval, example i is
//! in play for the share u_i of it. Hence
//!
//! ```text
//! root velocity      Σ u_i·(v_f, ω_t, ω_s)_i
//! phase rate φ'      Σ u_i·r_i(φ)
//! pose weights w_i   u_i·r_i(φ) / φ'
//! ```
//!
//! Planted feet then hold: per phase a planted foot of example i moves back by v_i/r_i in the root frame. In the blend
//! it moves by Σ w_i·v_i/r_i·φ' = Σ u_i·v_i per second, which is the speed of the root.

use glam::Vec3;
use motiondb::blend_space::Shares;
use motiondb::motion::{MotionDb, Parameters, PhaseMap, wrapped};

use crate::synthesis::blending::pose_weights::{MIX_MAX, PoseWeights};

/// Share below which an example leaves the mix and is no longer sampled.
const SHARE_MIN: f32 = 1e-4;

/// The examples of the active motion, their shares of time, and the rate at which they play. Sparse, without heap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExampleMix {
    /// (example, share); the first `count` entries are in use.
    entries: [(u32, f32); MIX_MAX],
    count: usize,
    /// Playback rate over the examples' own time: that of the body's traits, but less for the slowest steps
    /// ([`crate::synthesis::command::step_state`]). Root and phase slow down alike, so planted feet hold.
    playback_rate: f32,
}

impl ExampleMix {
    /// A mix of exactly these shares, in the examples' own time.
    pub fn new(shares: &Shares) -> Self {
        Self::played(shares, 1.0)
    }

    /// A mix of exactly these shares, played at a rate.
    pub(crate) fn played(shares: &Shares, playback_rate: f32) -> Self {
        let mut mix = Self { entries: Default::default(), count: 0, playback_rate };
        mix.add(entries_of(shares), 1.0);
        mix
    }

    /// (example, share); shares sum to 1.
    pub fn entries(&self) -> &[(u32, f32)] {
        &self.entries[..self.count]
    }

    /// Moves shares and playback rate by a fraction of the distance to their targets.
    pub(crate) fn approach(&mut self, target: &Shares, playback_rate: f32, fraction: f32) {
        self.move_towards(entries_of(target), playback_rate, fraction);
    }

    /// Moves by a fraction of the distance to another mix.
    pub(crate) fn approach_mix(&mut self, target: &Self, fraction: f32) {
        self.move_towards(target.entries().iter().copied(), target.playback_rate, fraction);
    }

    fn move_towards(&mut self, entries: impl Iterator<Item = (u32, f32)>, playback_rate: f32, fraction: f32) {
        self.entries[..self.count].iter_mut().for_each(|entry| entry.1 *= 1.0 - fraction);
        self.add(entries, fraction);
        self.prune();
        self.playback_rate += fraction * (playback_rate - self.playback_rate);
    }

    /// Sum of the shares that move to other examples between this mix and the target.
    pub(crate) fn changed_share(&self, target: &Shares) -> f32 {
        let of_target = |example| entries_of(target).find(|entry| entry.0 == example).map_or(0.0, |entry| entry.1);
        self.entries().iter().map(|&(example, share)| (share - of_target(example)).max(0.0)).sum()
    }

    /// (example, change of its share) between this mix and the target; an example may appear twice.
    pub(crate) fn changes_to(&self, target: &Shares) -> impl Iterator<Item = (u32, f32)> {
        let leaving = self.entries().iter().map(|&(example, share)| (example, -share));
        leaving.chain(entries_of(target))
    }

    /// Adds shares times a factor. In a full mix a new example replaces that of the least share.
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

    /// Removes examples that have faded out; the other shares sum to 1 again.
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

    /// Root velocity Σ u_i·(v_f, ω_t, ω_s)_i, times the playback rate.
    pub fn parameters(&self, db: &MotionDb) -> Parameters {
        let terms =
            self.entries().iter().map(|&(example, share)| share * db.examples[example as usize].parameters.to_vec3());
        Parameters::from_vec3(self.playback_rate * terms.fold(Vec3::ZERO, |sum, term| sum + term))
    }

    /// Mean phase rate over a cycle, times the playback rate, 1/s.
    pub(crate) fn strides_hz(&self, db: &MotionDb) -> f32 {
        let strides_hz = |example: u32| 1.0 / db.examples[example as usize].phase_map.period_s;
        self.playback_rate * self.entries().iter().map(|&(example, share)| share * strides_hz(example)).sum::<f32>()
    }

    /// φ' = Σ u_i·r_i(φ), times the playback rate, 1/s.
    pub fn phase_rate_hz(&self, db: &MotionDb, phase: f32) -> f32 {
        let sine = PhaseMap::sine(phase);
        let rate_hz = |example: u32| db.examples[example as usize].phase_map.rate_at_hz(sine);
        self.playback_rate * self.entries().iter().map(|&(example, share)| share * rate_hz(example)).sum::<f32>()
    }

    /// The phase in [0, 1) after a duration of the mix's own time.
    pub fn advanced_phase(&self, db: &MotionDb, phase: f32, duration_s: f32) -> f32 {
        advanced_phase(phase, duration_s, |phase| self.phase_rate_hz(db, phase))
    }

    /// Pose weights w_i = u_i·r_i(φ) / φ'.
    pub fn weights(&self, db: &MotionDb, phase: f32) -> PoseWeights {
        let (mut entries, mut sum_hz, sine) = (self.entries, 0.0, PhaseMap::sine(phase));
        for entry in &mut entries[..self.count] {
            entry.1 *= db.examples[entry.0 as usize].phase_map.rate_at_hz(sine);
            sum_hz += entry.1;
        }
        entries[..self.count].iter_mut().for_each(|entry| entry.1 /= sum_hz);
        PoseWeights { entries, count: self.count, phase_rate_hz: self.playback_rate * sum_hz }
    }
}

/// The phase in [0, 1) after a duration, by the midpoint rule; `rate_hz` gives φ' at a phase, 1/s.
pub(crate) fn advanced_phase(phase: f32, duration_s: f32, rate_hz: impl Fn(f32) -> f32) -> f32 {
    let middle = phase + 0.5 * duration_s * rate_hz(phase);
    wrapped(phase + duration_s * rate_hz(middle))
}

/// The entries of located shares that are not zero.
fn entries_of(shares: &Shares) -> impl Iterator<Item = (u32, f32)> {
    shares.examples.into_iter().zip(shares.shares).filter(|entry| entry.1 > 0.0)
}

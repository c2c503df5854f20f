//! What hybrid synthesis derives from a database (`FbCrowd` §5, App. 10): the base walk m_sp, the phases T at which
//! synthesis may switch, and t_trans, the greatest duration of a switch.
//!
//! Of T only the pairs near mid-stance are used. There one foot rests flat on the ground in both syntheses, and the
//! other passes it in the air. Neither lands nor leaves while the difference of poses is greatest. A foot that lands
//! with a difference meets the ground at another time and pitch than its pose does, which jerks the knee.

use motiondb::motion::{MotionDb, Parameters};

use crate::synthesis::semi_procedural::BaseWalk;
use crate::synthesis::semi_procedural::base_walk::CADENCE_RANGE;
use crate::synthesis::{INERTIA_DURATION_S, Mode, Modes};

/// Greatest distance of a switch from mid-stance, where T allows, in phases. The other foot leaves and lands about 0.2
/// from it (12 and 50 % of the cycle, mid-stance at 31 %: Perry, *Gait Analysis*), so a tenth of a stride is left.
const MID_STANCE_DISTANCE: f32 = 0.1;

/// Data of hybrid synthesis from one database.
#[derive(Clone, Debug)]
pub struct HybridData {
    /// m_sp.
    pub base_walk: BaseWalk,
    /// Parameters of m_mb, the blending partner of m_sp.
    pub partner: Parameters,
    /// T as phases [φ_sp, φ_mb], in order.
    phase_pairs: Vec<[f32; 2]>,
    /// t_trans, s: the longest wait for a pair at the slowest cadence, and the time until the difference has decayed.
    pub transition_s: f32,
}

impl HybridData {
    /// `None` where bodies are only to blend, or the database has no m_sp that can be deformed.
    pub fn new(db: &MotionDb, modes: Modes) -> Option<Self> {
        let found = db.correspondence.as_ref().filter(|_| modes != Modes::Blending)?;
        let examples = [found.semi_procedural, found.blending].map(|example| example as usize);
        let maps = examples.map(|example| &db.examples[example].phase_map);
        let pairs = found.pairs_s.iter().map(|times_s| [0, 1].map(|of| maps[of].phase(times_s[of])));
        let phase_pairs = near_mid_stance(pairs.collect());
        let period_s = maps[0].period_s.max(maps[1].period_s) / CADENCE_RANGE[0];
        Some(Self {
            base_walk: BaseWalk::new(db, examples[0])?,
            partner: db.examples[examples[1]].parameters,
            transition_s: longest_gap(&phase_pairs)? * period_s + INERTIA_DURATION_S,
            phase_pairs,
        })
    }

    /// Eqs. 10 and 15: jump of the phase at the first pair that the cycle of `from` has passed between two phases;
    /// `None` if it has passed none.
    pub fn phase_jump(&self, from: Mode, before: f32, now: f32) -> Option<f32> {
        let passed = (now - before).rem_euclid(1.0);
        let at = if from == Mode::SemiProcedural { 0 } else { 1 };
        let pair = self.phase_pairs.iter().find(|pair| {
            let ahead = (pair[at] - before).rem_euclid(1.0);
            ahead > 0.0 && ahead <= passed
        })?;
        Some(pair[1 - at] - pair[at])
    }
}

/// The pairs near mid-stance; all pairs if there are none.
fn near_mid_stance(pairs: Vec<[f32; 2]>) -> Vec<[f32; 2]> {
    let distance = |phase: f32| (2.0 * phase - libm::roundf(2.0 * phase)).abs() / 2.0;
    let near: Vec<[f32; 2]> = pairs.iter().copied().filter(|pair| distance(pair[0]) <= MID_STANCE_DISTANCE).collect();
    if near.is_empty() { pairs } else { near }
}

/// The longest distance from one pair to the next, in phases of m_sp; `None` without pairs.
fn longest_gap(pairs: &[[f32; 2]]) -> Option<f32> {
    let next = pairs.iter().cycle().skip(1);
    let gaps = pairs.iter().zip(next).map(|(pair, next)| 1.0 - (pair[0] - next[0]).rem_euclid(1.0));
    gaps.reduce(f32::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_db::test_db;

    #[test]
    fn a_cycle_passes_each_pair_once() {
        let hybrid = HybridData::new(&test_db(), Modes::Hybrid).unwrap();
        let steps = 400;
        let jumps: Vec<f32> = (0..steps)
            .filter_map(|step| hybrid.phase_jump(Mode::Blending, step as f32 / 400.0, (step + 1) as f32 / 400.0))
            .collect();
        assert_eq!(jumps.len(), hybrid.phase_pairs.len());
        assert!(jumps.iter().all(|jump| ((jump + 0.5).rem_euclid(1.0) - 0.5).abs() < 0.1));
        let wait_s = hybrid.transition_s - INERTIA_DURATION_S;
        assert!(wait_s > 0.0 && wait_s < 1.3 / CADENCE_RANGE[0]);
    }

    #[test]
    fn bodies_that_only_blend_need_no_hybrid_data() {
        assert!(HybridData::new(&test_db(), Modes::Blending).is_none());
    }

    #[test]
    fn pairs_near_mid_stance_are_preferred() {
        let [early, left, late, right] = [[0.2, 0.2], [0.55, 0.5], [0.7, 0.7], [0.95, 0.9]];
        assert_eq!(near_mid_stance(vec![early, left, late, right]), [left, right]);
        assert_eq!(near_mid_stance(vec![early, late]), [early, late]);
    }

    #[test]
    fn the_last_gap_leads_over_phase_0() {
        assert!((longest_gap(&[[0.1, 0.1], [0.3, 0.3]]).unwrap() - 0.8).abs() < 1e-6);
        assert_eq!(longest_gap(&[[0.1, 0.1]]), Some(1.0));
        assert_eq!(longest_gap(&[]), None);
    }
}

//! What a database gives to hybrid synthesis (`FbCrowd` §5, App. 10): m_sp taken apart, the phases at which synthesis
//! may switch, and how long a switch may take.
//!
//! Of T, the pairs about mid-stance are taken: one foot rests flat on the ground in both syntheses, the other passes it
//! in the air, and neither lands nor leaves while the difference of poses is greatest. A foot that has to land on top
//! of a difference meets the ground at another time and pitch than its pose does, and jerks the knee.

use motiondb::motion::{MotionDb, Parameters};

use crate::synthesis::hybrid::inertialization::CARRIED_S;
use crate::synthesis::hybrid::mode::Mode;
use crate::synthesis::params::Modes;
use crate::synthesis::semi_procedural::base_walk::{CADENCE, SemiProcedural};

/// Furthest from a mid-stance that synthesis switches, where T allows, in phases: the other foot leaves and lands about
/// 0.2 from it (at 12 and 50 % of the cycle, mid-stance at 31: Perry, *Gait Analysis*), which leaves a tenth of a
/// stride to either.
const OFF_MID_STANCE: f32 = 0.1;

/// Hybrid synthesis from one database.
#[derive(Clone, Debug)]
pub struct Hybrid {
    /// m_sp.
    pub semi_procedural: SemiProcedural,
    /// How m_mb walks.
    pub blending: Parameters,
    /// T as phases [φ_sp, φ_mb], in order.
    pairs: Vec<[f32; 2]>,
    /// t_trans, s: the longest wait for a pair, at the slowest cadence, and the time in which the difference of poses
    /// dies out.
    pub transition_s: f32,
}

impl Hybrid {
    /// None where bodies are only to blend, or the database has no m_sp that could be deformed.
    pub fn new(db: &MotionDb, modes: Modes) -> Option<Self> {
        let found = db.correspondence.as_ref().filter(|_| modes != Modes::Blending)?;
        let examples = [found.semi_procedural, found.blending].map(|example| example as usize);
        let maps = examples.map(|example| &db.examples[example].phase_map);
        let pairs = found.pairs_s.iter().map(|times_s| [0, 1].map(|side| maps[side].phase(times_s[side])));
        let pairs = about_mid_stances(pairs.collect());
        let period_s = maps[0].period_s.max(maps[1].period_s) / CADENCE[0];
        Some(Self {
            semi_procedural: SemiProcedural::new(db, examples[0])?,
            blending: db.examples[examples[1]].parameters,
            transition_s: longest_gap(&pairs)? * period_s + CARRIED_S,
            pairs,
        })
    }

    /// Eqs. 10 and 15: how far the phase jumps where the cycle of `from` has just passed a pair; none where it has
    /// passed none between these two phases.
    pub fn jump(&self, from: Mode, before: f32, now: f32) -> Option<f32> {
        let passed = (now - before).rem_euclid(1.0);
        let at = if from == Mode::SemiProcedural { 0 } else { 1 };
        let pair = self.pairs.iter().find(|pair| {
            let ahead = (pair[at] - before).rem_euclid(1.0);
            ahead > 0.0 && ahead <= passed
        })?;
        Some(pair[1 - at] - pair[at])
    }
}

/// The pairs where legs pass each other; all, where there are none such.
fn about_mid_stances(pairs: Vec<[f32; 2]>) -> Vec<[f32; 2]> {
    let off = |phase: f32| (2.0 * phase - libm::roundf(2.0 * phase)).abs() / 2.0;
    let near: Vec<[f32; 2]> = pairs.iter().copied().filter(|pair| off(pair[0]) <= OFF_MID_STANCE).collect();
    if near.is_empty() { pairs } else { near }
}

/// The longest way from one pair to the next, in phases of m_sp; none without pairs.
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
    fn synthesis_switches_where_poses_are_alike_and_nowhere_else() {
        let hybrid = Hybrid::new(&test_db(), Modes::Hybrid).unwrap();
        let steps = 400;
        let jumps: Vec<f32> = (0..steps)
            .filter_map(|step| hybrid.jump(Mode::Blending, step as f32 / 400.0, (step + 1) as f32 / 400.0))
            .collect();
        assert_eq!(jumps.len(), hybrid.pairs.len());
        assert!(jumps.iter().all(|jump| ((jump + 0.5).rem_euclid(1.0) - 0.5).abs() < 0.1));
        assert!(hybrid.transition_s > CARRIED_S && hybrid.transition_s < CARRIED_S + 1.3 / CADENCE[0]);
    }

    #[test]
    fn who_is_only_to_blend_has_no_hybrid() {
        assert!(Hybrid::new(&test_db(), Modes::Blending).is_none());
    }

    #[test]
    fn pairs_about_mid_stances_are_preferred() {
        let [early, left, late, right] = [[0.2, 0.2], [0.55, 0.5], [0.7, 0.7], [0.95, 0.9]];
        assert_eq!(about_mid_stances(vec![early, left, late, right]), [left, right]);
        assert_eq!(about_mid_stances(vec![early, late]), [early, late]);
    }

    #[test]
    fn the_way_from_the_last_pair_leads_over_phase_0() {
        assert!((longest_gap(&[[0.1, 0.1], [0.3, 0.3]]).unwrap() - 0.8).abs() < 1e-6);
        assert_eq!(longest_gap(&[[0.1, 0.1]]), Some(1.0));
        assert_eq!(longest_gap(&[]), None);
    }
}

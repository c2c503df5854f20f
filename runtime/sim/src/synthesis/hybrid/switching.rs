//! How synthesis changes hands (`FbCrowd` §3.4.1, App. 10): when, at which phase, and what it leaves to inertia.

use glam::Vec3;
use motiondb::body::Pose;
use motiondb::motion::wrapped;

use crate::planning::plan::Plan;
use crate::synthesis::blending::mix::Mix;
use crate::synthesis::command::stand_or_step;
use crate::synthesis::hybrid::active_motion::Playing;
use crate::synthesis::hybrid::mode::{Mode, Thresholds};
use crate::synthesis::hybrid::switch_points::Hybrid;
use crate::synthesis::params::{HmsParams, Modes};
use crate::synthesis::time_step::TimeStep;
use crate::synthesis::{Body, Motion};

/// One synthesis gives way where the other can take over within this, m/s and rad/s.
const SWITCH_SLACK: f32 = 0.05;
/// Phases about a pair of T among which the one is taken where both syntheses are most alike.
const NEAR_PHASES: [f32; 7] = [0.0, -0.02, 0.02, -0.04, 0.04, -0.06, 0.06];

impl Body {
    /// §3.4.1: which synthesis is wanted, where what is asked holds so much standing.
    pub(crate) fn choose(&mut self, motion: &Motion, hybrid: &Hybrid, plan: &Plan, idle_share: f32, dt_s: f32) {
        let HmsParams { modes, density_threshold, .. } = *motion.params;
        let alone = modes == Modes::SemiProcedural;
        let thresholds = Thresholds { alone, transition_s: hybrid.transition_s, density: density_threshold };
        let walks = !self.gait.stands && idle_share < stand_or_step::IDLE_SHARE_MAX;
        self.choice.follow(plan, walks, &thresholds, dt_s);
    }

    /// App. 10: at a pair of T, synthesis changes hands at the velocity that the body has, and the difference of poses
    /// is left to inertia. The paper moves its weights to m_mb alone first
    /// ([`ThroughMMb`](crate::synthesis::params::Transition::ThroughMMb)), since it cannot begin at another velocity: at the very
    /// moment that a collision threatens, its body walks at m_mb's.
    pub(crate) fn switch(&mut self, motion: &Motion, hybrid: &Hybrid, before: f32, step: &TimeStep) {
        let (from, to) = (self.mode, self.choice.mode);
        if from == to {
            return;
        }
        let Some(jump) = hybrid.jump(from, before, self.phase) else { return };
        if !self.may_switch(motion, hybrid) {
            return;
        }
        let soles_m = self.playing(motion).posture(motion, self.phase).soles_m(&motion.db.skeleton);
        self.jump(motion, step, |body| {
            match to {
                Mode::SemiProcedural => {
                    body.walking = body.mix.parameters(motion.db);
                    body.seen.iter_mut().for_each(|seen| seen.walking = seen.mix.parameters(motion.db));
                }
                Mode::Blending => {
                    let mix = Mix::new(&motion.space.locate(body.walking));
                    body.mix = mix;
                    // Nothing lags behind it yet: how the old pose was easing is left to inertia as well.
                    body.seen.iter_mut().for_each(|seen| seen.mix = mix);
                }
            }
            body.mode = to;
            body.phase = body.most_alike(motion, &soles_m, body.phase + jump);
        });
    }

    /// The phase near another at which what is played has its feet nearest to these soles: T knows how m_mb is like
    /// m_sp, and a mix or a run is so a little before or after.
    fn most_alike(&self, motion: &Motion, soles_m: &[[Vec3; 3]; 2], near: f32) -> f32 {
        let off_m2 = |phase: f32| {
            let playing = Playing::new(motion, self.mode, &self.seen[0], &self.mix, phase);
            let there_m = playing.posture(motion, phase).soles_m(&motion.db.skeleton);
            let points = soles_m.as_flattened().iter().zip(there_m.as_flattened());
            points.map(|(here_m, there_m)| here_m.distance_squared(*there_m)).sum::<f32>()
        };
        let phases = NEAR_PHASES.map(|off| wrapped(near + off));
        let off_m2 = phases.map(off_m2);
        let nearest = (1..phases.len()).fold(0, |best, at| if off_m2[at] < off_m2[best] { at } else { best });
        phases[nearest]
    }

    /// Changes what is played at once, and leaves the difference of poses to inertia.
    pub(crate) fn jump(&mut self, motion: &Motion, step: &TimeStep, change: impl FnOnce(&mut Self)) {
        let old = self.poses(motion, step);
        change(self);
        let new = self.poses(motion, step);
        self.inertia.begin(old.each_ref(), new.each_ref(), step.look_back_s);
    }

    /// Whether the body walks as the other synthesis can.
    fn may_switch(&self, motion: &Motion, hybrid: &Hybrid) -> bool {
        let now = self.parameters(motion.db);
        let there = self.detour(motion).unwrap_or_else(|| match self.mode {
            Mode::Blending => hybrid.semi_procedural.reachable(now),
            Mode::SemiProcedural => motion.space.nearest(now).parameters,
        });
        now.to_vec3().distance(there.to_vec3()) <= SWITCH_SLACK
    }

    /// What is played, now and a moment ago.
    fn poses(&self, motion: &Motion, step: &TimeStep) -> [Pose; 2] {
        let playing = self.playing(motion);
        let before = wrapped(self.phase - step.look_back_s * playing.phase_rate_hz(self.phase));
        let [seen, last] = &self.seen;
        let lately = Playing::new(motion, self.mode, &seen.lately(last, step), &self.mix, before);
        [playing.bent(motion, self.phase).pose, lately.bent(motion, before).pose]
    }
}

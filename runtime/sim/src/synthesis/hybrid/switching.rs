//! Switching (`FbCrowd` §3.4.1, App. 10): when one synthesis replaces the other, at which phase, and what it leaves to
//! inertialization; and where a recorded transition begins and ends. A body that stands leaves m_sp at once.
//!
//! Root frame (x forward, y left, z up), metres; parameters in m/s and rad/s.

use glam::Vec3;
use motiondb::motion::{Parameters, wrapped};

use crate::planning::plan::Plan;
use crate::synthesis::blending::ExampleMix;
use crate::synthesis::command::step_state::StepState;
use crate::synthesis::hybrid::extra_state::ExtraState;
use crate::synthesis::hybrid::mode_selection::{ModeSelection, ModeThresholds};
use crate::synthesis::hybrid::motion_state::{Moment, MotionState};
use crate::synthesis::hybrid::played_transition::PlayedTransition;
use crate::synthesis::library::HybridData;
use crate::synthesis::{HmsParams, Mode, SynthesisContext, TimeStep, Transition};

/// Distance between the current parameters and those that the other synthesis reaches, below which it can take over,
/// m/s and rad/s.
const SWITCH_TOLERANCE: f32 = 0.05;
/// Offsets from a pair of T among which a switch takes the phase of the most similar poses.
const PHASE_OFFSETS: [f32; 7] = [0.0, -0.02, 0.02, -0.04, 0.04, -0.06, 0.06];
/// Number of phases, all over the cycle, among which a body that leaves a recorded transition early takes the most similar.
const CYCLE_PHASES: u8 = 32;

impl MotionState {
    /// m_mb's parameters while the body changes synthesis by the paper's transition: it is committed to them.
    pub(crate) fn committed(&self, context: &SynthesisContext) -> Option<Parameters> {
        let changes = self.changes_mode() && context.params.transition == Transition::ThroughMMb;
        context.hybrid.as_ref().filter(|_| changes).map(|hybrid| hybrid.partner)
    }

    /// Whether the selected synthesis is to replace the active one. A recorded transition is played to its end first.
    fn changes_mode(&self) -> bool {
        self.mode != self.selection.mode && self.mode != Mode::Transition
    }

    /// §3.4.1: selects the synthesis. `walks_on` is true if the body walks and is to continue.
    pub(crate) fn select(&mut self, plan: &Plan, walks_on: bool, context: &SynthesisContext, dt_s: f32) {
        let Some(hybrid) = &context.hybrid else { return };
        let HmsParams { modes, density_threshold, .. } = context.params;
        let thresholds = ModeThresholds { modes, transition_s: hybrid.transition_s, density: density_threshold };
        self.selection.follow(plan, walks_on, &thresholds, dt_s);
    }

    /// App. 10, Eqs. 10 and 15: switches to the selected synthesis at a pair of T that the step from `phase_before` has
    /// passed.
    ///
    /// The body keeps its velocity, and inertialization carries the difference of poses. The paper first moves the
    /// weights to m_mb alone ([`Transition::ThroughMMb`]), so at the very moment that a collision threatens its body
    /// walks at the velocity of m_mb.
    pub(crate) fn switch(
        &mut self,
        extra: &mut ExtraState,
        phase_before: f32,
        step_state: &StepState,
        context: &SynthesisContext,
        step: &TimeStep,
    ) {
        let (from, to) = (self.mode, self.selection.mode);
        let Some(hybrid) = context.hybrid.as_ref().filter(|_| self.changes_mode()) else { return };
        let Some(phase_jump) = hybrid.phase_jump(from, phase_before, self.phase) else { return };
        if !self.may_switch(hybrid, context) {
            return;
        }
        let soles_m = self.active(context).posture(context, self.phase).soles_m(&context.db.skeleton);
        self.jump(extra, context, step, |motion| {
            motion.take_over(to, step_state, context);
            let phases = PHASE_OFFSETS.map(|offset| wrapped(motion.phase + phase_jump + offset));
            motion.phase = motion.most_similar_phase(&soles_m, phases, context);
        });
    }

    /// Whether the other synthesis reaches the current parameters, or those to which the body is committed.
    fn may_switch(&self, hybrid: &HybridData, context: &SynthesisContext) -> bool {
        let current = self.current(&context.db);
        let reached = self.committed(context).unwrap_or_else(|| match self.mode {
            Mode::Blending | Mode::Transition => hybrid.base_walk.reachable(current),
            Mode::SemiProcedural => context.domain.reachable_with(current, self.traits.cadence).parameters,
        });
        current.to_vec3().distance(reached.to_vec3()) <= SWITCH_TOLERANCE
    }

    /// Whether the body blends, or could at its current parameters.
    pub(crate) fn may_blend(&self, context: &SynthesisContext) -> bool {
        let reached = || context.domain.reachable_with(self.parameters, self.traits.cadence).parameters;
        self.mode != Mode::SemiProcedural || self.parameters.to_vec3().distance(reached().to_vec3()) <= SWITCH_TOLERANCE
    }

    /// Lets a body that stands blend at once, without a pair of T: m_sp would take one more step before it passes one.
    pub(crate) fn stand(
        &mut self,
        extra: &mut ExtraState,
        step_state: &StepState,
        context: &SynthesisContext,
        step: &TimeStep,
    ) {
        if self.mode == Mode::SemiProcedural {
            self.selection = ModeSelection::BLENDING;
            self.jump(extra, context, step, |motion| motion.take_over(Mode::Blending, step_state, context));
        }
    }

    /// Makes a mode active at the current parameters. A body that walks on takes the least steps, if not longer ones: a foot in
    /// the air stays there. A body that stops takes the mix that its speed has by itself: the foot lands, and the root stops.
    fn take_over(&mut self, mode: Mode, step_state: &StepState, context: &SynthesisContext) {
        match mode {
            Mode::SemiProcedural => {
                self.parameters = self.mix.parameters(&context.db);
                for smoothed in &mut self.smoothed {
                    smoothed.parameters = smoothed.mix.parameters(&context.db);
                }
            }
            Mode::Blending | Mode::Transition => {
                let reachable = context.domain.reachable_with(self.parameters, self.traits.cadence);
                let (shares, slowing) = if step_state.is_stopping() {
                    (reachable.shares, 1.0)
                } else {
                    step_state.playback(&reachable, &context.domain)
                };
                self.mix = ExampleMix::played(&shares, slowing * reachable.playback_rate);
                // Smoothing starts without a lag: inertialization carries what the old pose still lagged.
                self.smoothed.iter_mut().for_each(|smoothed| smoothed.mix = self.mix);
            }
        }
        self.mode = mode;
    }

    /// The one of some phases at which the soles are nearest to `soles_m`. T compares m_sp with m_mb; a mix, or another
    /// speed, is most similar a little earlier or later.
    fn most_similar_phase(
        &self,
        soles_m: &[[Vec3; 3]; 2],
        phases: impl IntoIterator<Item = f32>,
        context: &SynthesisContext,
    ) -> f32 {
        let distance_m2 = |phase: f32| {
            let active = self.drawn(context, &self.smoothed[0], self.idle, phase);
            let there_m = active.posture(context, phase).soles_m(&context.db.skeleton);
            let points = soles_m.as_flattened().iter().zip(there_m.as_flattened());
            points.map(|(here_m, there_m)| here_m.distance_squared(*there_m)).sum::<f32>()
        };
        let distances_m2 = phases.into_iter().map(|phase| (phase, distance_m2(phase)));
        distances_m2.min_by(|a, b| a.1.total_cmp(&b.1)).map_or(self.phase, |(phase, _)| phase)
    }

    /// Begins a recorded transition, which gives the pose from now on.
    pub(crate) fn begin_transition(
        &mut self,
        extra: &mut ExtraState,
        action: u32,
        context: &SynthesisContext,
        step: &TimeStep,
    ) {
        let played = PlayedTransition::begin(action);
        self.jump(extra, context, step, |motion| {
            (motion.mode, motion.transition) = (Mode::Transition, Some(played));
            motion.phase = played.phase(&context.db);
        });
    }

    /// Ends the recorded transition: at its end, where the body would be drawn too far from its root, and where the body
    /// stands. The cycle goes on, at the phase of the clip or, before its end, of the most similar pose.
    pub(crate) fn end_transition(
        &mut self,
        extra: &mut ExtraState,
        stands: bool,
        context: &SynthesisContext,
        step: &TimeStep,
    ) {
        let Some(played) = self.transition else { return };
        let is_over = played.is_over(&context.db);
        if !(is_over || stands || self.timing.leads_too_far()) {
            return;
        }
        let soles_m = self.active(context).posture(context, self.phase).soles_m(&context.db.skeleton);
        self.jump(extra, context, step, |motion| {
            (motion.mode, motion.transition) = (Mode::Blending, None);
            if !is_over {
                let phases = (0..CYCLE_PHASES).map(|index| f32::from(index) / f32::from(CYCLE_PHASES));
                motion.phase = motion.most_similar_phase(&soles_m, phases, context);
            }
        });
    }

    /// Reverses the gait: it plays backward in time from now on.
    pub(crate) fn reverse(&mut self) {
        if self.mode != Mode::Transition {
            self.phase = wrapped(1.0 - self.phase);
        }
        self.smoothed[0].reverse();
    }

    /// Makes a change at once and leaves the difference of poses to inertialization, that of the extra joints to `extra`.
    pub(crate) fn jump(
        &mut self,
        extra: &mut ExtraState,
        context: &SynthesisContext,
        step: &TimeStep,
        change: impl FnOnce(&mut Self),
    ) {
        let old = self.moments(context, step);
        change(self);
        self.has_jumped = true;
        let new = self.moments(context, step);
        let [old_poses, new_poses] =
            [&old, &new].map(|moments| moments.each_ref().map(|moment| moment.bent_posture(context).pose));
        self.inertialization.begin(old_poses.each_ref(), new_poses.each_ref(), step.look_back_s);
        extra.begin(&old, &new, context, step.look_back_s);
    }

    /// The drawn motion, now and [`TimeStep::look_back_s`] before.
    fn moments<'a>(&self, context: &'a SynthesisContext, step: &TimeStep) -> [Moment<'a>; 2] {
        let now = self.now(context);
        let rate_hz = now.active.phase_rate_hz(context, self.phase);
        let phase = wrapped(self.phase - step.look_back_s * self.timing.pace * rate_hz);
        let [smoothed, before] = &self.smoothed;
        let smoothed = smoothed.earlier(before, step);
        let earlier_idle = self.idle.earlier(&context.db, step.look_back_s);
        let earlier = Moment { active: self.drawn(context, &smoothed, earlier_idle, phase), phase, ..now };
        [now, earlier]
    }
}

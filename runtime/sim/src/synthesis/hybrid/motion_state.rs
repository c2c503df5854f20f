//! The motion group of a body's state: the active motion.
//!
//! Parameters (v_f, ω_t, ω_s) are in the body's frame (x forward, y left), m/s and rad/s.

use glam::Vec2;
use motiondb::body::{Root, RootFrame};
use motiondb::motion::{MotionDb, Parameters};

use crate::synthesis::blending::example_mix::advanced_phase;
use crate::synthesis::blending::{ExampleMix, Reachable};
use crate::synthesis::command::acceleration_limit::limited_by_axis;
use crate::synthesis::command::phase_catch_up::PhaseCatchUp;
use crate::synthesis::command::{CommandState, weight_transition};
use crate::synthesis::hybrid::active_motion::ActiveMotion;
use crate::synthesis::hybrid::idle_clock::IdleClock;
use crate::synthesis::hybrid::inertialization::Inertialization;
use crate::synthesis::hybrid::mode_selection::ModeSelection;
use crate::synthesis::hybrid::played_transition::PlayedTransition;
use crate::synthesis::hybrid::pose_smoothing::SmoothedMotion;
use crate::synthesis::hybrid::step_timing::{GaitTiming, StepTiming};
use crate::synthesis::pose::Posture;
use crate::synthesis::pose::lean::balance::{balanced_lean_rad, lean_in_curve_rad};
use crate::synthesis::semi_procedural::deformation::Tempo;
use crate::synthesis::semi_procedural::{BaseWalk, Deformation};
use crate::synthesis::{Mode, SynthesisContext, TimeStep, Traits};

/// The active motion, the drawn motion that follows it, and the pose offset of the last switch.
#[derive(Clone, Copy, Debug)]
pub struct MotionState {
    /// Active mode.
    pub mode: Mode,
    /// Synthesis that is to move the body.
    pub(crate) selection: ModeSelection,
    /// Examples of the active motion while the body blends.
    pub mix: ExampleMix,
    /// Parameters of m_sp in semi-procedural locomotion.
    pub(crate) parameters: Parameters,
    /// φ.
    pub phase: f32,
    /// Correction of the phase rate that spares planted feet.
    pub(crate) phase_catch_up: PhaseCatchUp,
    /// What is drawn of the motion: after this step, and after the last.
    pub smoothed: [SmoothedMotion; 2],
    /// Pace of the steps, and the body's lead over its root.
    pub(crate) timing: StepTiming,
    /// The idle in which the body stands.
    pub(crate) idle: IdleClock,
    /// The recorded transition of [`Mode::Transition`], otherwise none.
    pub(crate) transition: Option<PlayedTransition>,
    /// Whether the motion has jumped since the last pose, which inertialization carries.
    pub(crate) has_jumped: bool,
    /// What the body does unlike others; it never changes.
    pub(crate) traits: Traits,
    /// Difference of poses that a switch has left.
    pub(crate) inertialization: Inertialization,
}

/// The drawn motion at one time.
pub(crate) struct Moment<'a> {
    /// The active motion.
    pub(crate) active: ActiveMotion<'a>,
    /// φ.
    pub(crate) phase: f32,
    /// Swing of each arm, `[left, right]`, divided by that of the clips.
    pub(crate) arm_swing: [f32; 2],
}

impl Moment<'_> {
    /// The pose and the targets of its feet; the arms swing as this body's. The legs may not have bent yet.
    pub(crate) fn posture(&self, context: &SynthesisContext) -> Posture {
        let mut posture = self.active.posture(context, self.phase);
        self.active.swing_arms(&mut posture.pose, self.arm_swing, context);
        posture
    }

    /// The posture with its legs bent to the targets of the feet.
    pub(crate) fn bent_posture(&self, context: &SynthesisContext) -> Posture {
        let mut posture = self.posture(context);
        if let ActiveMotion::SemiProcedural(_) = self.active {
            posture.bend_legs(&context.db.skeleton);
        }
        posture
    }
}

impl MotionState {
    /// The motion of a body that stands. The phase, in [0, 1), is also the draw of its idle.
    pub(crate) fn standing(context: &SynthesisContext, phase: f32, traits: Traits) -> Self {
        let standing = context.domain.reachable_with(Parameters::default(), traits.cadence);
        let mix = ExampleMix::played(&standing.shares, standing.playback_rate);
        Self {
            mode: Mode::Blending,
            selection: ModeSelection::BLENDING,
            mix,
            parameters: Parameters::default(),
            phase,
            phase_catch_up: PhaseCatchUp::default(),
            smoothed: [SmoothedMotion::standing(mix); 2],
            timing: StepTiming::default(),
            idle: IdleClock::drawn(&context.db, phase),
            transition: None,
            has_jumped: false,
            traits,
            inertialization: Inertialization::default(),
        }
    }

    /// What the motion does now.
    pub(crate) fn current(&self, db: &MotionDb) -> Parameters {
        match self.mode {
            Mode::Blending | Mode::Transition => self.mix.parameters(db),
            Mode::SemiProcedural => self.parameters,
        }
    }

    /// The base walk and its current parameters in semi-procedural locomotion; `None` while the body blends.
    pub(crate) fn deformed<'a>(&self, context: &'a SynthesisContext) -> Option<(&'a BaseWalk, Parameters)> {
        let hybrid = context.hybrid.as_ref().filter(|_| self.mode == Mode::SemiProcedural);
        hybrid.map(|hybrid| (&hybrid.base_walk, self.parameters))
    }

    /// The active motion at the present phase, as it is drawn.
    pub(crate) fn active<'a>(&self, context: &'a SynthesisContext) -> ActiveMotion<'a> {
        self.drawn(context, &self.smoothed[0], self.idle, self.phase)
    }

    /// The drawn motion now.
    pub(crate) fn now<'a>(&self, context: &'a SynthesisContext) -> Moment<'a> {
        Moment { active: self.active(context), phase: self.phase, arm_swing: self.traits.arm_swing }
    }

    /// The active motion, drawn from a mix, an idle and a phase.
    pub(crate) fn drawn<'a>(
        &self,
        context: &'a SynthesisContext,
        smoothed: &SmoothedMotion,
        idle: IdleClock,
        phase: f32,
    ) -> ActiveMotion<'a> {
        match (self.mode, &context.hybrid, self.transition) {
            (Mode::SemiProcedural, Some(hybrid), _) => {
                let SmoothedMotion { parameters, travel, .. } = *smoothed;
                let cadence = self.traits.cadence;
                let deformation = Deformation::travelling(&hybrid.base_walk, parameters, travel, cadence);
                ActiveMotion::SemiProcedural(deformation)
            }
            (_, _, Some(played)) => ActiveMotion::Transition(played),
            _ => ActiveMotion::Blending {
                drawn: smoothed.mix.weights(&context.db, phase),
                current: self.mix.weights(&context.db, phase),
                idle,
            },
        }
    }

    /// The target toward which the motion moves: the command, as far as the active mode and the selected one reach
    /// it.
    pub(crate) fn target(
        &self,
        command: &CommandState,
        reachable: &Reachable,
        context: &SynthesisContext,
    ) -> Parameters {
        match (self.mode, self.selection.mode, &context.hybrid) {
            (Mode::SemiProcedural, Mode::SemiProcedural, _) => command.filter.command,
            (Mode::SemiProcedural, _, _) => self.committed(context).unwrap_or(reachable.parameters),
            (Mode::Blending | Mode::Transition, selected, hybrid) => {
                let steps =
                    || command.step_state.target(reachable, self.current(&context.db), &context.domain, &self.traits);
                let target = self.committed(context).unwrap_or_else(steps);
                let hybrid = hybrid.as_ref().filter(|_| selected == Mode::SemiProcedural);
                hybrid.map_or(target, |hybrid| hybrid.base_walk.reachable(target))
            }
        }
    }

    /// Changes the motion by one step towards a target, at limited accelerations.
    pub(crate) fn approach(
        &mut self,
        target: Parameters,
        reachable: &Reachable,
        command: &CommandState,
        context: &SynthesisContext,
        dt_s: f32,
    ) {
        match self.mode {
            Mode::Blending | Mode::Transition => {
                let (step_state, traits) = (command.step_state, &self.traits);
                weight_transition::follow(&mut self.mix, target, reachable, step_state, traits, context, dt_s);
            }
            Mode::SemiProcedural => {
                self.parameters = limited_by_axis(self.parameters, target, &context.params, dt_s);
            }
        }
    }

    /// Advances the phase over one step, at a factor on its rate, while the motion moves toward a target; the pace and
    /// the lead of the steps follow. `stops` states whether the body stops where its swinging foot lands.
    pub(crate) fn take_steps(
        &mut self,
        root: &Root,
        target: Parameters,
        rate_factor: f32,
        stops: bool,
        context: &SynthesisContext,
        step: &TimeStep,
    ) {
        match self.transition {
            Some(played) => self.play(played, &root.frame(), &context.db, step),
            None => {
                self.time_steps(root, target, stops, context, step);
                self.advance_phase(step.dt_s * rate_factor * self.timing.pace, context);
            }
        }
    }

    /// Plays a recorded transition over one step, under a root of some frame.
    fn play(&mut self, mut played: PlayedTransition, root: &RootFrame, db: &MotionDb, step: &TimeStep) {
        let velocity_mps = self.current(db).velocity_mps();
        let pace = played.pace(velocity_mps, root.vector_to_local(self.timing.lead_m), db);
        let ahead_m = played.advance(step.dt_s * pace, db) - step.dt_s * velocity_mps;
        self.timing.follow_clip(pace, root.forward.rotate(ahead_m));
        (self.phase, self.transition) = (played.phase(db), Some(played));
    }

    /// Lets the pace of the steps follow the motion, which moves toward a target, over one step.
    fn time_steps(
        &mut self,
        root: &Root,
        target: Parameters,
        stops: bool,
        context: &SynthesisContext,
        step: &TimeStep,
    ) {
        let mean_hz = match self.deformed(context) {
            Some((base_walk, parameters)) => 1.0 / self.tempo(base_walk, parameters).phase_map().period_s,
            None => self.mix.strides_hz(&context.db),
        };
        let gait = GaitTiming {
            mean_hz,
            base_hz: self.traits.cadence * context.base_hz,
            velocity_mps: root.forward().rotate(self.drawn_mps(&context.db)),
            speed_to_come: target.velocity_mps().length() / context.base_mps,
            stops,
        };
        self.timing.follow(self.phase, &gait, step);
    }

    /// The root under the body as it is drawn, for a body at `root`: ahead of it or behind by the lead.
    pub(crate) fn drawn_root(&self, root: &Root) -> Root {
        Root { position_m: root.position_m + self.timing.lead_m, ..*root }
    }

    /// Parameters of the drawn motion.
    pub(crate) fn drawn_parameters(&self, db: &MotionDb) -> Parameters {
        match self.mode {
            Mode::Blending | Mode::Transition => self.smoothed[0].mix.parameters(db),
            Mode::SemiProcedural => self.smoothed[0].parameters,
        }
    }

    /// Velocity of the drawn motion in the body's frame, m/s.
    fn drawn_mps(&self, db: &MotionDb) -> Vec2 {
        self.drawn_parameters(db).velocity_mps()
    }

    /// Lean of the drawn motion by itself, forward and left, rad: of the whole body and, as a share of it, of the trunk.
    /// The body of a recorded transition leans as in the clip, which steps where the body does.
    pub(crate) fn played_leans_rad(&self, context: &SynthesisContext) -> [Vec2; 2] {
        let [smoothed, _] = &self.smoothed;
        match (self.mode, self.transition) {
            (Mode::SemiProcedural, _) => [lean_in_curve_rad(&smoothed.parameters); 2],
            (_, Some(played)) => {
                let in_curve_rad = lean_in_curve_rad(&smoothed.mix.parameters(&context.db));
                [in_curve_rad, balanced_lean_rad(played.acceleration_mps2(&context.db))]
            }
            _ => [context.domain.lean_rad(&smoothed.mix); 2],
        }
    }

    fn tempo<'a>(&self, base_walk: &'a BaseWalk, parameters: Parameters) -> Tempo<'a> {
        Tempo::new(base_walk, parameters, self.smoothed[0].travel, self.traits.cadence)
    }

    /// Advances the phase by a duration of the motion's own time, s.
    fn advance_phase(&mut self, duration_s: f32, context: &SynthesisContext) {
        self.phase = match self.deformed(context) {
            Some((base_walk, parameters)) => {
                let map = self.tempo(base_walk, parameters).phase_map();
                advanced_phase(self.phase, duration_s, |phase| map.rate_hz(phase))
            }
            None => self.mix.advanced_phase(&context.db, self.phase, duration_s),
        };
    }

    /// Lets the drawn motion follow the active motion. Returns whether the body reverses.
    pub(crate) fn smooth(&mut self, db: &MotionDb, step: &TimeStep) -> bool {
        self.smoothed[1] = self.smoothed[0];
        self.smoothed[0].follow(self.mode, &self.mix, self.parameters, db, step)
    }
}

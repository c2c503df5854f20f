//! The first half of a step of synthesis: a body follows its plan.
//!
//! What is played changes towards what the plan asks for, root and phase move, the pose eases into both, and synthesis
//! changes hands where it is to. World and agent frame; metres, seconds, radians.

use glam::Vec2;
use motiondb::body::Root;
use motiondb::motion::{MotionDb, Parameters, wrapped};

use crate::maths::arc::moved;
use crate::planning::plan::Plan;
use crate::synthesis::blending::blend_space::Nearest;
use crate::synthesis::blending::weight_transition;
use crate::synthesis::command::{blend_query, stand_or_step};
use crate::synthesis::hybrid::mode::Mode;
use crate::synthesis::params::Transition;
use crate::synthesis::pose::foot_lock::FootHold;
use crate::synthesis::semi_procedural::base_walk::SemiProcedural;
use crate::synthesis::semi_procedural::deformation::Tempo;
use crate::synthesis::time_step::TimeStep;
use crate::synthesis::{Body, Motion};

/// Feet this near to where a standing body has them are under it, m: half a small step.
const GATHERED_M: f32 = 0.18;
/// Phase of the first step before the swinging foot's passing of the other: it is lifted there, and passes when
/// stepping has faded in.
const LIFT_OFF_PHASE: f32 = 0.15;
/// A first step aside, or into a turn, is made by the foot on that side, unless that foot is ahead of the other by
/// this, m.
const OPEN_SIDE_M: f32 = 0.1;

impl Body {
    /// Steps 1 and 2: what is played, phase and root follow the plan. The root may then be kept out of walls, by
    /// [`Self::end_step`], before [`Self::synthesize`].
    pub fn advance(&mut self, motion: &Motion, plan: &Plan, step: &TimeStep) {
        let plan = self.owed.settle(plan, self.walked_mps, step);
        let (nearest, before) = match (self.mode, motion.hybrid) {
            (Mode::SemiProcedural, Some(hybrid)) => self.deform(motion, &hybrid.semi_procedural, &plan, step),
            _ => self.blend(motion, &plan, step),
        };
        self.seen[1] = self.seen[0];
        let turns_back = self.seen[0].follow(self.mode, &self.mix, self.walking, motion.db, step);
        // What is played has come to the end of the step; a switch leaves what it leaves there.
        self.inertia.pass(step);
        if let Some(hybrid) = motion.hybrid {
            self.choose(motion, hybrid, &plan, nearest.idle_share, step.dt_s);
            self.switch(motion, hybrid, before, step);
        }
        if turns_back {
            self.jump(motion, step, Self::turn_back);
        }
        self.gaze.follow(&plan, &self.root, step);
        self.committed_mps = self
            .detour(motion)
            .map(|way| Vec2::from_angle(self.root.facing_rad).rotate(Vec2::new(way.speed_mps, way.strafe_mps)));
    }

    /// What the paper's way from one synthesis to the other leads through: m_mb.
    pub(crate) fn detour(&self, motion: &Motion) -> Option<Parameters> {
        let changes = self.mode != self.choice.mode && motion.params.transition == Transition::ThroughMMb;
        motion.hybrid.filter(|_| changes).map(|hybrid| hybrid.blending)
    }

    /// Motion blending: shares, phase and root. On the way to semi-procedural locomotion it makes for what m_sp can do.
    /// Returns what the examples have nearest to what is asked, and the phase from which the step was walked.
    fn blend(&mut self, motion: &Motion, plan: &Plan, step: &TimeStep) -> (Nearest, f32) {
        let asked = blend_query::asked(plan, self.root.facing_rad, motion.space, motion.params);
        self.intention.follow(asked, self.gait.stands, step);
        let now = self.mix.parameters(motion.db);
        let (intended, ahead) = (self.intention.parameters, self.intention.ahead(stand_or_step::PASSING_TIME_S));
        let nearest = self.gait.nearest(intended, ahead, motion.space);
        let mut gait = self.gait;
        let starts = gait.follow(&nearest, || self.feet_gathered(motion), step.dt_s);
        self.gait = gait;
        if starts {
            self.jump(motion, step, |body| body.phase = body.first_step_phase(motion));
        }
        let goal = self.detour(motion).unwrap_or_else(|| stand_or_step::goal(nearest, now, self.gait, motion.space));
        let goal = match (self.choice.mode, motion.hybrid) {
            (Mode::SemiProcedural, Some(hybrid)) => hybrid.semi_procedural.reachable(goal),
            _ => goal,
        };
        weight_transition::follow(&mut self.mix, goal, &nearest, self.gait, motion, step.dt_s);
        let before = self.phase;
        let hurried_s = self.move_root(self.mix.parameters(motion.db), step);
        self.phase = self.mix.advance_phase(motion.db, before, hurried_s);
        (nearest, before)
    }

    /// Semi-procedural locomotion: parameters, phase and root. On the way back to blending it makes for what the
    /// examples can do. Returns what [`Self::blend`] does.
    fn deform(
        &mut self,
        motion: &Motion,
        semi_procedural: &SemiProcedural,
        plan: &Plan,
        step: &TimeStep,
    ) -> (Nearest, f32) {
        let dt_s = step.dt_s;
        let turning_rad = dt_s * self.walking.turn_rate_rad_s;
        self.intention.turned(turning_rad);
        let facing_rad = self.root.facing_rad;
        let asked = blend_query::asked_exactly(plan, facing_rad, turning_rad, semi_procedural, motion.params);
        self.intention.follow(asked, false, step);
        let intended = self.intention.parameters;
        let nearest = motion.space.nearest(intended);
        let goal = match self.choice.mode {
            Mode::SemiProcedural => intended,
            Mode::Blending => self.detour(motion).unwrap_or(nearest.parameters),
        };
        self.walking = blend_query::step_apart(self.walking, goal, motion.params, dt_s);
        let before = self.phase;
        let hurried_s = self.move_root(self.walking, step);
        let map = Tempo::new(semi_procedural, self.walking, self.seen[0].way).phase_map();
        let middle = before + 0.5 * hurried_s * map.rate_hz(before);
        self.phase = wrapped(before + hurried_s * map.rate_hz(middle));
        (nearest, before)
    }

    /// Plays the gait backward in time from now on.
    fn turn_back(&mut self) {
        self.phase = wrapped(1.0 - self.phase);
        self.seen[0].turn_back();
    }

    /// Puts the root where a step that began at `from` really ends, whoever keeps it there.
    pub fn end_step(&mut self, from_m: Vec2, root: Root, dt_s: f32) {
        self.walked_mps = (root.position_m - from_m) / dt_s;
        self.root = root;
    }

    /// Moves the root; returns the time that passes for the phase, s.
    fn move_root(&mut self, parameters: Parameters, step: &TimeStep) -> f32 {
        let moved = moved(&self.root, &parameters, step.dt_s);
        self.walked_mps = (moved.position_m - self.root.position_m) / step.dt_s;
        self.root = moved;
        let carried_mps = |foot: &FootHold| {
            let from_root_m = foot.ball_m().truncate() - self.root.position_m;
            self.walked_mps + parameters.turn_rate_rad_s * from_root_m.perp()
        };
        step.dt_s * self.hurry.follow(&self.feet, carried_mps, step)
    }

    /// The root's motion in the body's frame, as what is played has it.
    pub(crate) fn parameters(&self, db: &MotionDb) -> Parameters {
        match self.mode {
            Mode::Blending => self.mix.parameters(db),
            Mode::SemiProcedural => self.walking,
        }
    }

    /// A standing body is free in its phase (standing hardly moves): its first step begins with the lift of the foot
    /// that is further behind, or on the side to which it goes, so that the other foot is under it and not a step away.
    fn first_step_phase(&self, motion: &Motion) -> f32 {
        let Parameters { speed_mps, turn_rate_rad_s, strafe_mps } = self.intention.parameters;
        let (way, frame) = (Vec2::new(speed_mps, strafe_mps).normalize_or_zero(), self.root.frame());
        let ahead_m = [0, 1].map(|side| {
            let ball_m = frame.to_local(self.feet[side].ball_m()) - motion.space.standing_balls_m[side];
            ball_m.truncate().dot(way)
        });
        let to_left = way.y + turn_rate_rad_s / motion.space.turn_rate_max_rad_s;
        let passing = if ahead_m[0] - ahead_m[1] < OPEN_SIDE_M * to_left { 1.0 } else { 0.5 };
        passing - LIFT_OFF_PHASE
    }

    /// Whether both feet are on the ground, and near enough to where a standing body has them.
    fn feet_gathered(&self, motion: &Motion) -> bool {
        let frame = self.root.frame();
        let gathered = |side: usize| {
            let standing_m = frame.to_world(motion.space.standing_balls_m[side]);
            let off_m = (self.feet[side].ball_m() - standing_m).truncate();
            self.feet[side].planted() && off_m.length() < GATHERED_M
        };
        gathered(0) && gathered(1)
    }
}

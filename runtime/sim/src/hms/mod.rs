//! Human motion synthesis (`FbCrowd` §5): a plan becomes the next pose, and the next root, of a body.
//!
//! One step of a body, in this order:
//!
//! 1. [`owed`], [`asked`], [`gait`]: the plan as (v_f, ω_t, ω_s), smoothed; what of it the body can do, standing or
//!    stepping; and how far it gets in one step;
//! 2. [`blending`] or [`semi_procedural`]: what is played follows ([`pursuit`]); phase and root move, the root exactly along
//!    its arc; the pose eases into both ([`seen`]); [`mode`] tells which synthesis is wanted, and at the next pair of
//!    [`hybrid`] it changes hands (`switching`);
//! 3. the pose is sampled at the new phase ([`playing`]); [`inertialization`] carries away what a switch left; head and
//!    chest turn first ([`gaze`]);
//! 4. [`feet`]: planted feet are held;
//! 5. [`posture`], [`pelvis`], [`ik`]: the pelvis comes down where a leg would not reach its foot, and the legs reach them.
//!
//! The root frame has x forward, y left, z up, its origin on the ground under the ripple-free root; metres,
//! seconds, radians.

pub mod asked;
pub mod blending;
pub mod deformation;
pub mod feet;
pub mod foot_path;
pub mod gait;
pub mod gaze;
pub mod hybrid;
pub mod ik;
pub mod inertialization;
pub mod intention;
pub mod leg;
pub mod mode;
pub mod owed;
pub mod params;
pub mod pelvis;
pub mod playing;
pub mod posture;
pub mod pursuit;
pub mod repertoire;
pub mod seen;
pub mod semi_procedural;
pub mod space;
pub mod standing;
mod switching;
pub mod time_step;

use glam::{Vec2, Vec3};
use motiondb::motion_db::MotionDb;
use motiondb::parameters::Parameters;
use motiondb::pose::{Pose, Root, RootFrame};

use self::blending::Mix;
use self::deformation::Tempo;
use self::feet::{FootHold, LANDING_AHEAD_S, PosedFoot};
use self::gait::Gait;
use self::gaze::Gaze;
use self::hybrid::Hybrid;
use self::inertialization::Inertia;
use self::intention::Intention;
use self::leg::FootPose;
use self::mode::Choice;
use self::owed::Owed;
use self::params::{HmsParams, Transition};
use self::pelvis::Descent;
use self::playing::Playing;
use self::posture::Posture;
use self::seen::Seen;
use self::semi_procedural::SemiProcedural;
use self::space::{Nearest, Space};
use self::time_step::TimeStep;
use crate::angle::{direction, wrap_rad};
use crate::plan::{Plan, Stance};
use crate::recording_frame::{Mode, PLANTED_CONTACT};

/// Feet this near to where a standing body has them are under it, m: half a small step.
const GATHERED_M: f32 = 0.18;
/// Time in which the phase catches up with a planted foot, s: about half a stance.
const CATCH_UP_TIME_S: f32 = 0.2;
/// Greatest change of the phase rate for it.
const HURRY_MAX: f32 = 0.4;
/// A body slower than this hardly moves its feet by its phase, m/s.
const HURRY_SPEED_MIN_MPS: f32 = 0.4;
/// Phase of the first step before the swinging foot's passing of the other: it is lifted there, and passes when
/// stepping has faded in.
const LIFT_OFF_PHASE: f32 = 0.15;
/// A first step aside, or into a turn, is made by the foot on that side, unless that foot is ahead of the other by
/// this, m.
const OPEN_SIDE_M: f32 = 0.1;
/// A foot that what is left of a switch holds up further than this does not stand: contacts of clips are told by the same
/// height (`definitions.md`, "Planted-foot slide"), m.
const HELD_UP_M: f32 = 0.025;
/// A first pose is given this long to settle on its feet, s.
const SETTLING_S: f32 = 1.0;

/// A database, ready for synthesis.
#[derive(Clone, Copy, Debug)]
pub struct Motion<'a> {
    /// Poses, parameters and phase maps.
    pub db: &'a MotionDb,
    /// Its blend space.
    pub space: &'a Space,
    /// What hybrid synthesis needs of it; without, bodies only blend.
    pub hybrid: Option<&'a Hybrid>,
    /// Tunables.
    pub params: &'a HmsParams,
}

/// The synthesis of one body, from step to step.
#[derive(Clone, Copy, Debug)]
pub struct Body {
    /// Where it is.
    pub root: Root,
    /// φ.
    pub phase: f32,
    /// Synthesis in force.
    pub mode: Mode,
    /// Examples in play, while it blends.
    pub mix: Mix,
    /// What m_sp is deformed to, otherwise.
    walking: Parameters,
    /// What is seen of either, and what was a moment ago.
    pub seen: [Seen; 2],
    choice: Choice,
    inertia: Inertia,
    gait: Gait,
    gaze: Gaze,
    owed: Owed,
    /// What the plans of the last moments asked for.
    intention: Intention,
    /// Velocity of the last step, world, m/s.
    walked_mps: Vec2,
    /// The velocity that it will have whatever is planned, world, m/s: on the paper's way from one synthesis to the other.
    pub committed_mps: Option<Vec2>,
    feet: [FootHold; 2],
    descent: Descent,
}

/// A synthesised body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Synthesis {
    /// After IK, in the root frame.
    pub pose: Pose,
    /// Blended contact of each foot.
    pub contacts: [f32; 2],
    /// For the planner's next step (§4.2).
    pub stance: Stance,
    /// Weight-averaged planted-foot slide of the examples in use, cm/s.
    pub examples_slide_cm_s: f32,
}

impl Body {
    /// A body that stands at `root`, its cycle at `phase`.
    pub fn standing(motion: &Motion, root: Root, phase: f32) -> (Self, Synthesis) {
        let mix = Mix::new(&motion.space.standing.shares);
        let mut body = Self {
            root,
            phase,
            mode: Mode::Blending,
            mix,
            walking: Parameters::default(),
            seen: [Seen::going(mix, Parameters::default(), Vec2::X); 2],
            choice: Choice::BLENDING,
            inertia: Inertia::default(),
            gait: Gait::STANDING,
            gaze: Gaze::default(),
            owed: Owed::default(),
            intention: Intention::default(),
            walked_mps: Vec2::ZERO,
            committed_mps: None,
            feet: Default::default(),
            descent: Descent::default(),
        };
        let playing = body.playing(motion);
        let posture = playing.posture(motion, phase);
        let (frame, soles_m) = (root.frame(), posture.soles_m(&motion.db.skeleton));
        let posed = |side: usize| posed_foot(&frame, posture.feet[side].ankle_m, soles_m[side]);
        body.feet = [0, 1].map(|side| FootHold::new(&posed(side)));
        let synthesis = body.synthesize(motion, &TimeStep::new(SETTLING_S));
        (body, synthesis)
    }

    /// Steps 1 and 2: what is played, phase and root follow the plan. The root may then be kept out of walls, before
    /// [`Self::synthesize`].
    pub fn advance(&mut self, motion: &Motion, plan: &Plan, step: &TimeStep) {
        let plan = self.owed.settle(plan, self.walked_mps, step);
        let before = self.phase;
        let nearest = match (self.mode, motion.hybrid) {
            (Mode::SemiProcedural, Some(hybrid)) => self.deform(motion, &hybrid.semi_procedural, &plan, step),
            _ => self.blend(motion, &plan, step),
        };
        self.seen[1] = self.seen[0].follow(self.mode, &self.mix, self.walking, step);
        // What is played has come to the end of the step; a switch leaves what it leaves there.
        self.inertia.pass(step);
        if let Some(hybrid) = motion.hybrid {
            self.choose(motion, hybrid, &plan, nearest.idle_share, step.dt_s);
            self.switch(motion, hybrid, before);
        }
        self.gaze.follow(&plan, &self.root, step);
        self.committed_mps = self
            .detour(motion)
            .map(|way| Vec2::from_angle(self.root.facing_rad).rotate(Vec2::new(way.speed_mps, way.strafe_mps)));
    }

    /// What the paper's way from one synthesis to the other leads through: m_mb.
    fn detour(&self, motion: &Motion) -> Option<Parameters> {
        let changes = self.mode != self.choice.mode && motion.params.transition == Transition::ThroughMMb;
        motion.hybrid.filter(|_| changes).map(|hybrid| hybrid.blending)
    }

    /// Motion blending: shares, phase and root. On the way to semi-procedural locomotion it makes for what m_sp can do.
    /// Returns what the examples have nearest to what is asked.
    fn blend(&mut self, motion: &Motion, plan: &Plan, step: &TimeStep) -> Nearest {
        let asked = asked::asked(plan, self.root.facing_rad, motion.space, motion.params);
        self.intention.follow(asked, self.gait.stands, step);
        let now = self.mix.parameters(motion.db);
        let nearest = motion.space.nearest(self.intention.parameters);
        let mut gait = self.gait;
        let starts = gait.follow(nearest.idle_share, || self.feet_gathered(motion), step.dt_s);
        self.gait = gait;
        if starts {
            self.jump(motion, |body| body.phase = body.first_step_phase(motion));
        }
        let goal = self.detour(motion).unwrap_or_else(|| gait::goal(nearest, now, self.gait, motion.space));
        let goal = match (self.choice.mode, motion.hybrid) {
            (Mode::SemiProcedural, Some(hybrid)) => hybrid.semi_procedural.reachable(goal),
            _ => goal,
        };
        pursuit::follow(&mut self.mix, goal, &nearest, self.gait, motion, step.dt_s);
        self.move_root(self.mix.parameters(motion.db), step.dt_s);
        self.phase = self.mix.advance_phase(motion.db, self.phase, self.hurry() * step.dt_s);
        nearest
    }

    /// Semi-procedural locomotion: parameters, phase and root. On the way back to blending it makes for what the
    /// examples can do. Returns what they have nearest to what is asked.
    fn deform(&mut self, motion: &Motion, semi_procedural: &SemiProcedural, plan: &Plan, step: &TimeStep) -> Nearest {
        let dt_s = step.dt_s;
        let turning_rad = dt_s * self.walking.turn_rate_rad_s;
        self.intention.turned(turning_rad);
        let facing_rad = self.root.facing_rad;
        let asked = asked::asked_exactly(plan, facing_rad, turning_rad, semi_procedural, motion.params);
        self.intention.follow(asked, false, step);
        let intended = self.intention.parameters;
        let nearest = motion.space.nearest(intended);
        let goal = match self.choice.mode {
            Mode::SemiProcedural => intended,
            Mode::Blending => self.detour(motion).unwrap_or(nearest.parameters),
        };
        self.walking = asked::step_apart(self.walking, goal, motion.params, dt_s);
        self.move_root(self.walking, dt_s);
        let map = Tempo::new(semi_procedural, self.walking, self.seen[0].way).phase_map();
        let hurried_s = self.hurry() * dt_s;
        let middle = self.phase + 0.5 * hurried_s * map.rate_hz(self.phase);
        let next = self.phase + hurried_s * map.rate_hz(middle);
        self.phase = next - libm::floorf(next);
        nearest
    }

    /// Blends what the examples have nearest to a step that others have decided, from the root where the body was to where
    /// it is (see [`crate::decoupled`]); the pose is as blended, no foot is held.
    pub(crate) fn follow(&mut self, motion: &Motion, from: Root, dt_s: f32) -> Synthesis {
        let parameters = went(&from, &self.root, dt_s);
        let shares = motion.space.locate(parameters);
        self.mix.approach(&shares, 1.0, pursuit::fraction(&self.mix, &shares, motion, dt_s));
        self.seen[0].mix = self.mix;
        self.phase = self.mix.advance_phase(motion.db, self.phase, dt_s);
        let playing = self.playing(motion);
        let posture = playing.posture(motion, self.phase);
        let soles_m = posture.soles_m(&motion.db.skeleton);
        self.told(motion, &playing, &posture, &soles_m, self.root.forward())
    }

    fn move_root(&mut self, parameters: Parameters, dt_s: f32) {
        let moved = moved(&self.root, &parameters, dt_s);
        self.walked_mps = (moved.position_m - self.root.position_m) / dt_s;
        self.root = moved;
    }

    /// The root's motion in the body's frame, as what is played has it.
    fn parameters(&self, db: &MotionDb) -> Parameters {
        match self.mode {
            Mode::Blending => self.mix.parameters(db),
            Mode::SemiProcedural => self.walking,
        }
    }

    fn playing<'a>(&self, motion: &Motion<'a>) -> Playing<'a> {
        Playing::new(motion, self.mode, &self.seen[0], self.phase)
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

    /// Factor on the phase rate. A body that speeds up within a step has its foot further back than the faster steps have it
    /// at this phase: the phase catches up, and the foot meets the pose again before the leg must stretch;
    /// likewise when it slows down.
    fn hurry(&self) -> f32 {
        let speed_squared = self.walked_mps.length_squared().max(HURRY_SPEED_MIN_MPS * HURRY_SPEED_MIN_MPS);
        let planted = self.feet.iter().filter_map(FootHold::planted_shift_m);
        let (sum_m, count) = planted.fold((Vec2::ZERO, 0.0), |(sum_m, count), shift_m| (sum_m + shift_m, count + 1.0));
        let behind_s = -sum_m.dot(self.walked_mps) / (speed_squared * f32::max(count, 1.0));
        1.0 + (behind_s / CATCH_UP_TIME_S).clamp(-HURRY_MAX, HURRY_MAX)
    }

    /// Steps 3 to 5: the pose at the present phase and root.
    pub fn synthesize(&mut self, motion: &Motion, step: &TimeStep) -> Synthesis {
        let skeleton = &motion.db.skeleton;
        let playing = self.playing(motion);
        let due = self.due(motion);
        let (mut posture, held_up) = self.carried(motion, &playing);
        if let Some(due) = &due {
            posture.contacts = due.contacts(motion, self.phase);
        }
        let due = due.as_ref().unwrap_or(&playing);
        let landing = self.phase + LANDING_AHEAD_S * playing.phase_rate_hz(self.phase);
        let contacts_ahead = due.contacts(motion, landing - libm::floorf(landing));
        self.gaze.turn(&mut posture.pose, skeleton);
        let (frame, soles_m) = (self.root.frame(), posture.soles_m(skeleton));

        let held = [0, 1].map(|side| {
            let FootPose { ankle_m, orientation } = posture.feet[side];
            let posed = posed_foot(&frame, ankle_m, soles_m[side]);
            let planted = posture.contacts[side] >= PLANTED_CONTACT && !held_up[side];
            let held = self.feet[side].step(&posed, planted, contacts_ahead[side], step);
            FootPose { ankle_m: frame.to_local(held.ankle_m), orientation: held.twist * orientation }
        });
        posture.move_feet_below(held, |asked_m| self.descent.follow(asked_m, step));
        posture.bend_legs(skeleton);

        let soles_m = posture.soles_m(skeleton);
        for (hold, sole_m) in self.feet.iter_mut().zip(soles_m) {
            hold.placed(sole_m.map(|point_m| frame.to_world(point_m)), step);
        }
        self.told(motion, due, &posture, &soles_m, frame.forward)
    }

    /// The mix that the root has come to, whose time the contacts keep; m_sp's root does as it is seen to.
    fn due<'a>(&self, motion: &Motion<'a>) -> Option<Playing<'a>> {
        (self.mode == Mode::Blending).then(|| Playing::Blend(self.mix.weights(motion.db, self.phase)))
    }

    /// What is played, and what a switch has left on top of it; which feet that holds up.
    fn carried(&self, motion: &Motion, playing: &Playing) -> (Posture, [bool; 2]) {
        if !self.inertia.carries() {
            return (playing.posture(motion, self.phase), [false; 2]);
        }
        let skeleton = &motion.db.skeleton;
        let mut posture = playing.bent(motion, self.phase);
        let played_m = posture.soles_m(skeleton);
        self.inertia.add_to(&mut posture.pose);
        let carried = Posture::new(posture.pose, posture.contacts, skeleton);
        let carried_m = carried.soles_m(skeleton);
        (carried, [0, 1].map(|side| held_up(&played_m[side], &carried_m[side])))
    }

    /// What is told of a posture, of its soles in the root frame, which faces `forward`.
    fn told(
        &self,
        motion: &Motion,
        playing: &Playing,
        posture: &Posture,
        soles_m: &[[Vec3; 3]; 2],
        forward: Vec2,
    ) -> Synthesis {
        Synthesis {
            pose: posture.pose,
            contacts: posture.contacts,
            stance: Stance::on_soles(soles_m, forward, posture.contacts, |swing| {
                playing.time_to_landing_s(motion, self.phase, swing)
            }),
            examples_slide_cm_s: playing.examples_slide_cm_s(motion),
        }
    }
}

/// Whether what is left of a switch keeps a foot off the ground where the new synthesis has it as `played`. To put it down
/// at once would be the jerk that inertia is there to avoid.
fn held_up(played_m: &[Vec3; 3], carried_m: &[Vec3; 3]) -> bool {
    let height_m = |sole_m: &[Vec3; 3]| sole_m.iter().fold(f32::INFINITY, |lowest_m, point_m| lowest_m.min(point_m.z));
    height_m(carried_m) - height_m(played_m).max(0.0) > HELD_UP_M
}

/// A foot of the root frame, in the world.
fn posed_foot(frame: &RootFrame, ankle_m: Vec3, sole_m: [Vec3; 3]) -> PosedFoot {
    PosedFoot { ankle_m: frame.to_world(ankle_m), sole_m: sole_m.map(|point_m| frame.to_world(point_m)) }
}

/// The root after a step at constant parameters: exactly along its arc, whose chord lies at half the turn.
fn moved(root: &Root, parameters: &Parameters, dt_s: f32) -> Root {
    let half_turn_rad = 0.5 * dt_s * parameters.turn_rate_rad_s;
    let local_m = Vec2::new(parameters.speed_mps, parameters.strafe_mps) * dt_s * chord(half_turn_rad);
    Root {
        position_m: root.position_m + direction(root.facing_rad + half_turn_rad).rotate(local_m),
        facing_rad: wrap_rad(root.facing_rad + 2.0 * half_turn_rad),
    }
}

/// The parameters whose arc leads from one root to another in a step: the inverse of [`moved`].
fn went(from: &Root, to: &Root, dt_s: f32) -> Parameters {
    let half_turn_rad = 0.5 * wrap_rad(to.facing_rad - from.facing_rad);
    let local_m = Vec2::from_angle(-from.facing_rad - half_turn_rad).rotate(to.position_m - from.position_m);
    let local_mps = local_m / (dt_s * chord(half_turn_rad));
    Parameters { speed_mps: local_mps.x, turn_rate_rad_s: 2.0 * half_turn_rad / dt_s, strafe_mps: local_mps.y }
}

/// Chord over arc, by half the angle between its ends.
fn chord(half_turn_rad: f32) -> f32 {
    if half_turn_rad.abs() > 1e-3 { direction(half_turn_rad).y / half_turn_rad } else { 1.0 }
}

#[cfg(test)]
mod tests;

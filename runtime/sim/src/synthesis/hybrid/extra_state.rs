//! Extra joints of a body: their rotations after a step, and the difference that switches have left.
//!
//! The rows and frames that make a pose have rotations of the extra joints too; the same weights blend both. The
//! difference of a switch decays as that of the pose ([`inertialization`](crate::synthesis::hybrid::inertialization)).
//! The state lies beside the body, because only some databases have extra joints, and each has a number of its own.
//!
//! Rotations are relative to the parent, as in [`ExtraMotion`](motiondb::motion::ExtraMotion); radians, seconds.

use glam::{Quat, Vec3};

use crate::maths::angle::rotation;
use crate::synthesis::hybrid::inertialization::{NEGLIGIBLE, rotation_vector};
use crate::synthesis::hybrid::motion_state::{Moment, MotionState};
use crate::synthesis::{SynthesisContext, TimeStep};

/// Rotations of the extra joints of a body. By default the body has none.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ExtraState {
    /// Rotations relative to the parents, in the order of the database's extra joints.
    rotations: Vec<Quat>,
    /// Difference of each joint that switches have left, as a rotation vector, and its rate of change per second; empty
    /// where nothing is left.
    differences: Vec<[Vec3; 2]>,
}

impl ExtraState {
    /// The extra joints of a body with this motion.
    pub(crate) fn of(motion: &MotionState, context: &SynthesisContext) -> Self {
        let mut state = Self { rotations: vec![Quat::IDENTITY; context.db.extra.bones.len()], differences: Vec::new() };
        state.follow(motion, context);
        state
    }

    /// Rotations relative to the parents, in the order of the database's extra joints.
    pub fn rotations(&self) -> &[Quat] {
        &self.rotations
    }

    /// Memory of the joints, bytes.
    pub(crate) fn size_bytes(&self) -> usize {
        self.rotations.capacity() * size_of::<Quat>() + self.differences.capacity() * size_of::<[Vec3; 2]>()
    }

    /// Takes up the difference of a switch. `old` and `new` are the motion in both syntheses, now and `interval_s`
    /// before.
    pub(crate) fn begin(&mut self, old: &[Moment; 2], new: &[Moment; 2], context: &SynthesisContext, interval_s: f32) {
        if self.rotations.is_empty() {
            return;
        }
        let [now, before] = [0, 1].map(|time| differences(&old[time], &new[time], context));
        self.differences.resize(now.len(), [Vec3::ZERO; 2]);
        for (left, (now_rad, before_rad)) in self.differences.iter_mut().zip(now.into_iter().zip(before)) {
            let [left_rad, rate_rad_s] = *left;
            let both_rad = rotation_vector(rotation(left_rad) * rotation(now_rad));
            *left = [both_rad, rate_rad_s + (now_rad - before_rad) / interval_s];
        }
    }

    /// Lets the difference decay over one step.
    pub(crate) fn decay(&mut self, step: &TimeStep) {
        for [left_rad, rate_rad_s] in &mut self.differences {
            (*left_rad, *rate_rad_s) = step.inertia.decayed(*left_rad, *rate_rad_s);
        }
        let is_over = |vector: &Vec3| vector.abs().max_element() <= NEGLIGIBLE;
        if self.differences.as_flattened().iter().all(is_over) {
            self.differences.clear();
        }
    }

    /// Takes the rotations of the drawn motion, and adds the difference that is left.
    pub(crate) fn follow(&mut self, motion: &MotionState, context: &SynthesisContext) {
        if self.rotations.is_empty() {
            return;
        }
        motion.active(context).blend_extra(context, motion.phase, &mut self.rotations);
        for (rotated, [left_rad, _]) in self.rotations.iter_mut().zip(&self.differences) {
            *rotated = rotation(*left_rad) * *rotated;
        }
    }
}

/// The rotation vector of each joint from one motion to another, rad.
fn differences(old: &Moment, new: &Moment, context: &SynthesisContext) -> Vec<Vec3> {
    let [old, new] = [old, new].map(|moment| {
        let mut rotations = Vec::new();
        moment.active.blend_extra(context, moment.phase, &mut rotations);
        rotations
    });
    old.iter().zip(&new).map(|(old, new)| rotation_vector(*old * new.conjugate())).collect()
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use glam::Vec2;
    use motiondb::body::Root;
    use motiondb::motion::{Action, ActionEnd, ActionFrame, ActionKind, MotionDb, PHASE_COUNT};

    use super::*;
    use crate::planning::plan::Plan;
    use crate::synthesis::{Body, HmsParams, Mode, Modes};
    use crate::test_db::{curl_rad, curled, db_with_fingers, test_db};

    const DT_S: f32 = 1.0 / 60.0;
    /// Greatest distance of a played curl from that of the example, rad: 1 degree.
    const ERROR_MAX_RAD: f32 = 0.0175;
    /// Index of the example `idle`.
    const IDLE: usize = 0;
    /// Index of the example `walk`, of 1 m/s.
    const WALK: usize = 2;
    /// Index of the example `walk_fast`, of 1.5 m/s.
    const WALK_FAST: usize = 3;
    /// Curl of a fist, rad.
    const FIST_RAD: f32 = -1.6;

    /// A body after a step.
    struct Step {
        mode: Mode,
        phase: f32,
        /// Curl of both finger joints, rad.
        curls_rad: [f32; 2],
    }

    /// A body that stands for a second, then walks forward at a speed for seven.
    fn walk(db: MotionDb, speed_mps: f32, modes: Modes) -> Vec<Step> {
        let context = SynthesisContext::new(Arc::new(db), HmsParams { modes, ..HmsParams::default() });
        let (mut body, _) = Body::standing(&context, Root::default(), 0.3);
        let (mut extra, step) = (body.extra(&context), TimeStep::new(DT_S));
        let walk = |index: usize| {
            let share = (2.0 * (index as f32 * DT_S - 1.0)).clamp(0.0, 1.0);
            let velocity_mps = share * speed_mps * Vec2::X;
            let plan = Plan { velocity_mps, time_to_collision_s: f32::INFINITY, ..Plan::default() };
            body.advance_with(&mut extra, &context, &plan, &step);
            body.synthesize(&context, &step);
            body.pose_extra(&mut extra, &context);
            let curls_rad = [0, 1].map(|joint| extra.rotations()[joint].to_scaled_axis().x);
            Step { mode: body.motion.mode, phase: body.motion.phase, curls_rad }
        };
        (0..480).map(walk).collect()
    }

    /// The database with an action for each foot, in which the hand is a fist and the foot may leave the ground.
    fn with_fist(kind: ActionKind, last: usize) -> MotionDb {
        let mut db = db_with_fingers();
        let end = |stands: bool| ActionEnd { example: if stands { IDLE } else { WALK } as u32, phase: 0.0 };
        let [entry, exit] = kind.stands().map(end);
        let frame = |side: usize, frame: usize| {
            let (share, duration_s) = (frame as f32 / last as f32, last as f32 / 60.0);
            let forward_m = if kind == ActionKind::Idle { 0.0 } else { duration_s * 0.5 * share * share };
            let root = Root { position_m: Vec2::X * forward_m, facing_rad: 0.0 };
            let mut contacts = [1.0; 2];
            contacts[side] = if kind == ActionKind::Start && (10..40).contains(&frame) { 0.0 } else { 1.0 };
            ActionFrame { pose: db.rows.pose(IDLE, 0), contacts, root }
        };
        let action = |side: usize| {
            let frames = (0..=last).map(|index| frame(side, index)).collect();
            let (name, window_s) = (format!("{} {side}", kind.name()), [0.0, 1.0]);
            Action { name, kind, source: 0, window_s, mirrored: false, entry, exit, frames }
        };
        db.actions = [0, 1].map(action).to_vec();
        db.extra.actions = vec![curled(FIST_RAD).repeat(last + 1); 2];
        db
    }

    fn are_near(step: &Step, expected_rad: f32) -> bool {
        step.curls_rad.iter().all(|curl_rad| (curl_rad - expected_rad).abs() < ERROR_MAX_RAD)
    }

    #[test]
    fn fingers_curl_as_in_the_example_at_each_phase() {
        for (modes, mode) in [(Modes::Blending, Mode::Blending), (Modes::SemiProcedural, Mode::SemiProcedural)] {
            let steps = walk(db_with_fingers(), 1.0, modes);
            for step in &steps[300..] {
                let expected_rad = curl_rad(WALK, step.phase);
                assert!(are_near(step, expected_rad), "{mode:?}: {:?}, not {expected_rad}", step.curls_rad);
                assert_eq!(step.mode, mode);
            }
        }
    }

    #[test]
    fn in_a_blend_fingers_curl_between_both_examples() {
        for step in &walk(db_with_fingers(), 1.25, Modes::Blending)[300..] {
            let [slow_rad, fast_rad] = [WALK, WALK_FAST].map(|example| curl_rad(example, step.phase));
            assert!(step.curls_rad.iter().all(|curl_rad| (fast_rad + 0.02..slow_rad - 0.02).contains(curl_rad)));
        }
    }

    #[test]
    fn a_body_at_rest_curls_its_fingers_as_in_its_idle() {
        let steps = walk(with_fist(ActionKind::Idle, 120), 0.0, Modes::Hybrid);
        assert!(steps.iter().all(|step| are_near(step, FIST_RAD)));
    }

    #[test]
    fn fingers_curl_as_in_a_recorded_start_and_never_jump() {
        let steps = walk(with_fist(ActionKind::Start, 75), 1.0, Modes::Blending);
        let curls_rad = || steps.iter().map(|step| step.curls_rad[0]);
        assert!(steps.iter().any(|step| step.mode == Mode::Transition && are_near(step, FIST_RAD)));
        let jump_rad = curls_rad().zip(curls_rad().skip(1)).map(|(from, to)| (to - from).abs()).fold(0.0, f32::max);
        // At 12/s a difference of 1.4 rad decays by at most 12/e of itself a second.
        assert!(jump_rad < 1.6 * 12.0 / std::f32::consts::E * DT_S, "{jump_rad} rad in a step");
        assert!(are_near(steps.last().unwrap(), curl_rad(WALK, steps.last().unwrap().phase)));
    }

    #[test]
    fn examples_that_are_made_in_memory_have_fingers() {
        let mut db = db_with_fingers();
        // The walk alone: a standing body and turns are missing.
        let [rows, joints] = [WALK * PHASE_COUNT, PHASE_COUNT];
        let kept = |per_row: usize| rows * per_row..(rows + joints) * per_row;
        db.rows.rotations = db.rows.rotations[kept(motiondb::body::JOINT_COUNT)].to_vec();
        db.rows.pelvis_m = db.rows.pelvis_m[kept(1)].to_vec();
        db.rows.contacts = db.rows.contacts[kept(1)].to_vec();
        db.extra.rotations = db.extra.rotations[kept(2)].to_vec();
        db.examples = vec![db.examples[WALK].clone()];
        db.blend_space = motiondb::blend_space::triangulation::build(&db.parameters().collect::<Vec<_>>());
        db.correspondence = None;
        let context = SynthesisContext::new(Arc::new(db.clone()), HmsParams::default());
        assert!(context.db.examples.len() > 4);
        assert_eq!(context.db.extra.rotations.len(), 2 * PHASE_COUNT * context.db.examples.len());
        // The mean over the cycle.
        assert!(are_near(&walk(db, 0.0, Modes::Hybrid)[60], -0.2 - 0.1 * WALK as f32));
    }

    #[test]
    fn a_database_without_extra_joints_gives_none() {
        let context = SynthesisContext::new(Arc::new(test_db()), HmsParams::default());
        let (body, _) = Body::standing(&context, Root::default(), 0.3);
        assert_eq!(body.extra(&context), ExtraState::default());
    }
}

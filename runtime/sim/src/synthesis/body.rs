//! A simulated body: its state from step to step, grouped by the stage that changes it, and its output for a step.

use glam::Vec2;
use motiondb::body::{Pose, Root};

use crate::planning::elbow_room::ElbowRoom;
use crate::planning::plan::Stance;
use crate::synthesis::SynthesisContext;
use crate::synthesis::command::CommandState;
use crate::synthesis::hybrid::{ExtraState, MotionState};
use crate::synthesis::pose::{
    BodyClearance, Centring, ContactState, ExcessLean, LookAt, SecondaryMotion, Squeeze, WeightShift,
};

/// A simulated body.
///
/// Each step it follows a plan ([`advance`](Self::advance)), may be kept out of walls
/// ([`place_root`](Self::place_root)), and is posed ([`synthesize`](Self::synthesize)).
///
/// ```no_run
/// use std::path::Path;
/// use std::sync::Arc;
///
/// use fbcrowd_sim::planning::Plan;
/// use fbcrowd_sim::synthesis::{Body, HmsParams, SynthesisContext, TimeStep};
/// use glam::Vec2;
/// use motiondb::body::{Joint, Root};
/// use motiondb::files::database_file;
///
/// let (db, _checksum) = database_file::read(Path::new("motion.fbdb"))?;
/// let context = SynthesisContext::new(Arc::new(db), HmsParams::default());
/// let (mut body, _first_output) = Body::standing(&context, Root::default(), 0.0);
/// let step = TimeStep::new(1.0 / 30.0);
/// let plan = Plan { velocity_mps: Vec2::new(1.2, 0.0), ..Plan::default() };
/// for _ in 0..90 {
///     body.advance(&context, &plan, &step);
///     let output = body.synthesize(&context, &step);
///     let joints = output.pose.forward_kinematics(&context.db.skeleton);
///     println!("head: {} m", body.root.to_world(joints.positions_m[Joint::Head.index()]));
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Body {
    /// Root, in the world.
    pub root: Root,
    /// Velocity of the root in the last step, after walls, world, m/s.
    pub(crate) actual_mps: Vec2,
    /// What the body is to do.
    pub(crate) command: CommandState,
    /// The active motion.
    pub motion: MotionState,
    /// What holds the feet on the ground.
    pub(crate) contact: ContactState,
    /// Where head and chest turn.
    pub(crate) look_at: LookAt,
    /// Lean beyond that of the played motion.
    pub(crate) lean: ExcessLean,
    /// Turn of the shoulders in a narrow gap.
    pub(crate) squeeze: Squeeze,
    /// How far it may reach to each side, world frame, m.
    pub(crate) room: ElbowRoom,
    /// Turns that keep it within that room.
    pub(crate) clearance: BodyClearance,
    /// Small motion of head, forearms and hands.
    pub(crate) secondary: SecondaryMotion,
    /// Shift of the weight before a first step.
    pub(crate) weight_shift: WeightShift,
    /// Displacement of the pelvis over the feet of a standing body.
    pub(crate) centring: Centring,
}

/// The output of a body for a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyOutput {
    /// The pose after inverse kinematics, in the root frame.
    pub pose: Pose,
    /// Blended contact of each foot, `[left, right]`, 0 to 1.
    pub contacts: [f32; 2],
    /// Stance for the planner's next step (§4.2).
    pub stance: Stance,
    /// Weighted mean of the planted-foot slide of the examples of the active motion, cm/s.
    pub examples_slide_cm_s: f32,
}

impl Body {
    /// Places the root after a step that began at `from_m`, where walls or a disc determine it, world.
    pub fn place_root(&mut self, from_m: Vec2, root: Root, dt_s: f32) {
        self.actual_mps = (root.position_m - from_m) / dt_s;
        self.root = root;
    }

    /// The joints beside the 22 roles, as the body stands or moves now; none where the database has none.
    pub fn extra(&self, context: &SynthesisContext) -> ExtraState {
        ExtraState::of(&self.motion, context)
    }

    /// Poses the extra joints at the present phase.
    pub fn pose_extra(&self, extra: &mut ExtraState, context: &SynthesisContext) {
        extra.follow(&self.motion, context);
    }

    /// Velocity that replaces the planned one, world, m/s: that of m_mb in the paper's transition between the
    /// syntheses.
    pub fn committed_mps(&self, context: &SynthesisContext) -> Option<Vec2> {
        let committed = self.motion.committed(context)?;
        Some(Vec2::from_angle(self.root.facing_rad).rotate(committed.velocity_mps()))
    }
}

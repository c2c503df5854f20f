//! CutAction → JoinedAction: the examples at both ends, and the root between them.
//!
//! The root of an idle rests where that of a standing example does ([`crate::cycle::standing_cycle`]). World frame in, root
//! frame out: metres, radians.

use glam::DVec2;
use motiondb::motion::ActionKind;

use crate::action::cut_action::CutAction;
use crate::cycle::standing_cycle::resting_arc;
use crate::input::unique_names;
use crate::retarget::human_clip::{HumanBody, HumanJoints, HumanPose};
use crate::select::named_cycles::{NamedCycle, standing};

/// An action as the database stores it, in f64.
#[derive(Clone, Debug)]
pub(crate) struct JoinedAction {
    /// Unique name.
    pub(crate) name: String,
    /// What the body does.
    pub(crate) kind: ActionKind,
    /// Index of the clip.
    pub(crate) source: u32,
    /// First and last second of the clip's part, from the file's first frame.
    pub(crate) window_s: [f64; 2],
    /// Left and right are exchanged.
    pub(crate) mirrored: bool,
    /// Index of the example at both ends, and its phase there.
    pub(crate) ends: [(usize, f64); 2],
    /// Frames, uniform in time.
    pub(crate) frames: Vec<JoinedFrame>,
}

/// A frame of an action.
#[derive(Clone, Debug)]
pub(crate) struct JoinedFrame {
    /// The pose in the root frame.
    pub(crate) pose: HumanPose,
    /// Contact of each foot, `[left, right]`.
    pub(crate) contacts: [f64; 2],
    /// Position (m) and facing (rad) of the root relative to that of the first frame.
    pub(crate) root: (DVec2, f64),
}

/// The idles of the set in their order; none where it has no standing example.
pub(crate) fn joined_idles(cut: Vec<CutAction>, cycles: &[NamedCycle], body: &HumanBody) -> Vec<JoinedAction> {
    let Some(standing) = standing(cycles) else { return Vec::new() };
    cut.into_iter().map(|cut| joined_idle(cut, standing, body)).collect()
}

/// All actions of a set, each with its own name: the idles in their order, then the transitions by kind and name.
pub(crate) fn in_order(idles: Vec<JoinedAction>, transitions: Vec<JoinedAction>) -> Vec<JoinedAction> {
    let mut actions = idles;
    let idle_count = actions.len();
    actions.extend(transitions);
    unique_names::make_unique(actions.iter_mut().map(|action| &mut action.name));
    actions[idle_count..].sort_by(|a, b| (a.kind, &a.name).cmp(&(b.kind, &b.name)));
    actions
}

/// An idle about its resting root.
fn joined_idle(cut: CutAction, standing: usize, body: &HumanBody) -> JoinedAction {
    let joints: Vec<HumanJoints> = cut.poses.iter().map(|pose| pose.forward_kinematics(body)).collect();
    let arc = resting_arc(&joints);
    let frame = |(pose, contacts): (&HumanPose, &[f64; 2])| JoinedFrame {
        pose: arc.relative(pose, 0.0),
        contacts: *contacts,
        root: (DVec2::ZERO, 0.0),
    };
    JoinedAction {
        frames: cut.poses.iter().zip(&cut.contacts).map(frame).collect(),
        name: cut.name,
        kind: cut.kind,
        source: cut.source,
        window_s: cut.window_s,
        mirrored: false,
        ends: [(standing, 0.0); 2],
    }
}

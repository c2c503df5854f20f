//! JoinedActions → the database's actions: f32, every rotation in the hemisphere of the rows, so that an action blends
//! with examples.
//!
//! Root frame: metres; f64 in, f32 out.

use motiondb::body::{Pose, Root};
use motiondb::motion::{Action, ActionEnd, ActionFrame};

use crate::action::joined_action::{JoinedAction, JoinedFrame};
use crate::ground::rotations::align_hemispheres;
use crate::retarget::human_clip::HumanPose;

/// The actions in their order; `reference` is the first row of the examples.
pub(crate) fn actions(joined: &[JoinedAction], reference: &HumanPose) -> Vec<Action> {
    joined.iter().map(|joined| action(joined, reference)).collect()
}

fn action(joined: &JoinedAction, reference: &HumanPose) -> Action {
    let [entry, exit] = joined.ends.map(|(example, phase)| ActionEnd { example: example as u32, phase: phase as f32 });
    Action {
        name: joined.name.clone(),
        kind: joined.kind,
        source: joined.source,
        window_s: joined.window_s.map(|second| second as f32),
        mirrored: joined.mirrored,
        entry,
        exit,
        frames: joined.frames.iter().map(|frame| action_frame(frame, reference)).collect(),
    }
}

fn action_frame(frame: &JoinedFrame, reference: &HumanPose) -> ActionFrame {
    let mut rotations = frame.pose.rotations;
    align_hemispheres(&mut rotations, &reference.rotations);
    let (position_m, facing_rad) = frame.root;
    ActionFrame {
        pose: Pose { pelvis_m: frame.pose.pelvis_m.as_vec3(), rotations: rotations.map(|rotation| rotation.as_quat()) },
        contacts: frame.contacts.map(|contact| contact.clamp(0.0, 1.0) as f32),
        root: Root { position_m: position_m.as_vec2(), facing_rad: facing_rad as f32 },
    }
}

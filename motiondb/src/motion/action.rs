//! Actions: recorded motions that are no cycles. They are stored frame by frame, at their own length.
//!
//! An *idle* is a loop of a body that stands. A *transition* is played once, from one example to another: a start, a
//! stop, a turn, a step, a pivot. Both have one form: uniform frames at [`ACTION_RATE_HZ`], each with a pose in its root
//! frame (x forward, y left, z up), the contacts of both feet, and the root relative to that of the first frame. The
//! root is free of the oscillation of the steps. It begins and ends at the velocity of the example at that end, so that
//! no velocity jumps where an action meets a cycle. Metres, seconds, radians.

use glam::Vec2;
use serde::{Deserialize, Serialize};

use crate::body::pose::{Pose, Root};

/// Frame rate of every action, Hz: about that of the 64 rows of a stride.
pub const ACTION_RATE_HZ: f32 = 60.0;
/// Greatest number of frames of an action: a minute.
pub const ACTION_FRAMES_MAX: usize = 3601;

/// What a body does in an action.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ActionKind {
    /// It stands; the last frame is the first one again.
    Idle,
    /// It stands, then walks or runs.
    Start,
    /// It walks or runs, then stands.
    Stop,
    /// It turns on the spot, and stands before and after.
    Turn,
    /// It makes one or two steps forward, backward or aside, and stands before and after.
    Step,
    /// It walks or runs, turns sharply within a few steps, and walks or runs on.
    Pivot,
}

impl ActionKind {
    /// The name in manifests and reports.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Idle => "idle",
            Self::Start => "start",
            Self::Stop => "stop",
            Self::Turn => "turn",
            Self::Step => "step",
            Self::Pivot => "pivot",
        }
    }

    /// Whether the body stands at the first frame and at the last.
    pub const fn stands(self) -> [bool; 2] {
        match self {
            Self::Idle | Self::Turn | Self::Step => [true, true],
            Self::Start => [true, false],
            Self::Stop => [false, true],
            Self::Pivot => [false, false],
        }
    }
}

/// Where an action meets the cycle of an example.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ActionEnd {
    /// Index of the example; the root moves at its parameters.
    pub example: u32,
    /// Phase of the example whose pose is most like that of the action, in [0, 1).
    pub phase: f32,
}

/// One frame of an action.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ActionFrame {
    /// The pose in the root frame; rotations lie in the hemispheres of the database's rows.
    pub pose: Pose,
    /// Contact of each foot with the ground, `[left, right]`, 0 to 1.
    pub contacts: [f32; 2],
    /// Root relative to that of the first frame; the facing has no jumps of 2π.
    pub root: Root,
}

/// A recorded motion that is stored frame by frame.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Action {
    /// Unique name: the clip's, the kind, and the second at which it begins where the clip has several.
    pub name: String,
    /// What the body does.
    pub kind: ActionKind,
    /// Index of the source in [`MotionDb::sources`](crate::motion::MotionDb::sources).
    pub source: u32,
    /// First and last second of the source's part that it was made from, from the file's first frame.
    pub window_s: [f32; 2],
    /// Whether left and right were exchanged.
    pub mirrored: bool,
    /// The example that it leaves at its first frame.
    pub entry: ActionEnd,
    /// The example that it joins at its last frame.
    pub exit: ActionEnd,
    /// Frames at [`ACTION_RATE_HZ`], at least two.
    pub frames: Vec<ActionFrame>,
}

impl Action {
    /// Time from the first frame to the last, s.
    pub fn duration_s(&self) -> f32 {
        self.frames.len().saturating_sub(1) as f32 / ACTION_RATE_HZ
    }

    /// Position of the last root in the first root frame: forward and left, m.
    pub fn displacement_m(&self) -> Vec2 {
        self.frames.last().map_or(Vec2::ZERO, |frame| frame.root.position_m)
    }

    /// Change of the facing, positive to the left, rad.
    pub fn turn_rad(&self) -> f32 {
        self.frames.last().map_or(0.0, |frame| frame.root.facing_rad)
    }

    /// The motion at a time from the first frame, s, between the two frames next to it. A time beyond an end gives that
    /// end. The action must be valid.
    pub fn at(&self, time_s: f32) -> ActionFrame {
        let ([index, next], share) = self.frames_at(time_s);
        self.frames[index].lerp(&self.frames[next], share)
    }

    /// Indices of the two frames next to a time from the first frame, s, and the share of the second one.
    pub(crate) fn frames_at(&self, time_s: f32) -> ([usize; 2], f32) {
        let last = self.frames.len() - 1;
        let position = (time_s * ACTION_RATE_HZ).clamp(0.0, last as f32);
        let index = (position as usize).min(last.saturating_sub(1));
        ([index, (index + 1).min(last)], position - index as f32)
    }
}

impl ActionFrame {
    /// The motion between two frames of one action; `share` is 0 at this frame and 1 at the other.
    fn lerp(&self, other: &Self, share: f32) -> Self {
        let between = |from: f32, to: f32| from + share * (to - from);
        Self {
            pose: self.pose.lerp(&other.pose, share),
            contacts: [0, 1].map(|side| between(self.contacts[side], other.contacts[side])),
            root: Root {
                position_m: self.root.position_m.lerp(other.root.position_m, share),
                facing_rad: between(self.root.facing_rad, other.root.facing_rad),
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::{Quat, Vec3};

    use super::*;
    use crate::body::skeleton::JOINT_COUNT;

    fn frame(at: f32) -> ActionFrame {
        ActionFrame {
            pose: Pose { pelvis_m: Vec3::new(0.0, 0.0, at), rotations: [Quat::from_rotation_y(at); JOINT_COUNT] },
            contacts: [at, 1.0 - at],
            root: Root { position_m: Vec2::new(at, 0.0), facing_rad: -at },
        }
    }

    #[test]
    fn times_between_frames_are_interpolated() {
        let end = ActionEnd { example: 0, phase: 0.0 };
        let step = Action {
            name: "step".into(),
            kind: ActionKind::Step,
            source: 0,
            window_s: [0.0, 0.1],
            mirrored: false,
            entry: end,
            exit: end,
            frames: [0.0, 0.1, 0.3].map(frame).to_vec(),
        };
        assert!((step.duration_s() - 2.0 / 60.0).abs() < 1e-7);
        assert_eq!((step.displacement_m(), step.turn_rad()), (Vec2::new(0.3, 0.0), -0.3));
        for (time_s, wanted) in [(-1.0, 0.0), (0.5 / 60.0, 0.05), (1.5 / 60.0, 0.2), (2.0 / 60.0, 0.3), (9.0, 0.3)] {
            let (found, wanted) = (step.at(time_s), frame(wanted));
            assert!((found.contacts[0] - wanted.contacts[0]).abs() < 1e-5, "{time_s} s: {found:?}");
            assert!((found.root.facing_rad - wanted.root.facing_rad).abs() < 1e-5);
            assert!(found.pose.rotations[5].angle_between(wanted.pose.rotations[5]) < 1e-3);
        }
    }
}

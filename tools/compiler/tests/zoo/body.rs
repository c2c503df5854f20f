//! The motion that every rig of the zoo performs: a bundled clip as positions and rotations of the performer's parts.
//! Its parameters are those of `assets/clips/README.md`. Metres; x to the left, y up, z forward.

use std::path::Path;

use glam::{DQuat, DVec3};
use motiondb_compiler::read::bvh;

pub(crate) const CLIPS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets/clips");

/// The performer's parts, by their names in the bundled clips; a parent before its children.
pub(crate) const PARTS: [&str; 22] = [
    "Hips",
    "Spine",
    "Spine1",
    "Spine2",
    "Neck",
    "Head",
    "LeftShoulder",
    "LeftArm",
    "LeftForeArm",
    "LeftHand",
    "RightShoulder",
    "RightArm",
    "RightForeArm",
    "RightHand",
    "LeftUpLeg",
    "LeftLeg",
    "LeftFoot",
    "LeftToeBase",
    "RightUpLeg",
    "RightLeg",
    "RightFoot",
    "RightToeBase",
];
const PARENTS: [usize; 22] = [0, 0, 1, 2, 3, 4, 3, 6, 7, 8, 3, 10, 11, 12, 0, 14, 15, 16, 0, 18, 19, 20];

/// The number of a part.
pub(crate) fn part(name: &str) -> usize {
    PARTS.iter().position(|part| *part == name).expect("a name of PARTS")
}

/// A clip, its frames at any rate.
#[derive(Clone)]
pub(crate) struct Performance {
    pub frame_rate_hz: f64,
    /// Offset of each part from its parent, in the parent's frame, m.
    pub offsets_m: [DVec3; 22],
    pub poses: Vec<Pose>,
    /// Forward speed, m/s; turn rate of the motion, degrees a second; speed to the left, m/s.
    pub parameters: [f64; 3],
    /// Seconds in which the body stands before and after the motion.
    pub standing_s: [f64; 2],
}

#[derive(Clone)]
pub(crate) struct Pose {
    pub hips_m: DVec3,
    /// Against the T-pose that faces z.
    pub turns: [DQuat; 22],
}

impl Performance {
    /// `walk_110` …, at 30 frames a second.
    pub(crate) fn read(clip: &str) -> Self {
        let path = Path::new(CLIPS).join(format!("{clip}.bvh"));
        let source = bvh::read(&path, &std::fs::read(&path).unwrap()[..]).unwrap();
        let joints = PARTS.map(|name| source.joints.iter().position(|joint| joint.name == name).unwrap());
        let pose = |frame: usize| Pose {
            hips_m: 0.01 * source.position(frame, joints[0]),
            turns: joints.map(|joint| source.orientation(frame, joint)),
        };
        let offset = |part: usize| {
            let parent = joints[PARENTS[part]];
            let bone = source.position(0, joints[part]) - source.position(0, parent);
            0.01 * (source.orientation(0, parent).inverse() * bone)
        };
        Self {
            frame_rate_hz: source.frame_rate_hz,
            offsets_m: std::array::from_fn(offset),
            poses: (0..source.frame_count()).map(pose).collect(),
            parameters: readme_parameters(clip),
            standing_s: [0.0; 2],
        }
    }

    /// Positions of all parts.
    pub(crate) fn positions_m(&self, pose: &Pose) -> [DVec3; 22] {
        let mut positions = [pose.hips_m; 22];
        for part in 1..22 {
            let parent = PARENTS[part];
            positions[part] = positions[parent] + pose.turns[parent] * self.offsets_m[part];
        }
        positions
    }

    /// The same seconds at another rate.
    pub(crate) fn resampled(&self, frame_rate_hz: f64) -> Self {
        let count = ((self.poses.len() - 1) as f64 * frame_rate_hz / self.frame_rate_hz) as usize + 1;
        let pose = |frame: usize| {
            let at = frame as f64 * self.frame_rate_hz / frame_rate_hz;
            let first = (at as usize).min(self.poses.len() - 2);
            self.poses[first].lerp(&self.poses[first + 1], at - first as f64)
        };
        Self { frame_rate_hz, poses: (0..count).map(pose).collect(), ..self.clone() }
    }

    /// The mirror image, left and right exchanged: another correct clip.
    pub(crate) fn mirrored(&self) -> Self {
        let opposite = |part: usize| {
            let name = PARTS[part];
            if name.starts_with("Left") {
                part + 4
            } else if name.starts_with("Right") {
                part - 4
            } else {
                part
            }
        };
        let turn = |turn: DQuat| DQuat::from_xyzw(turn.x, -turn.y, -turn.z, turn.w);
        let flip = DVec3::new(-1.0, 1.0, 1.0);
        let pose = |pose: &Pose| Pose {
            hips_m: flip * pose.hips_m,
            turns: std::array::from_fn(|part| turn(pose.turns[opposite(part)])),
        };
        let [forward, turn_rate, left] = self.parameters;
        Self {
            offsets_m: std::array::from_fn(|part| flip * self.offsets_m[opposite(part)]),
            poses: self.poses.iter().map(pose).collect(),
            parameters: [forward, -turn_rate, -left],
            ..*self
        }
    }

    /// Puts a T-pose and a transition before the motion.
    pub(crate) fn stand_before(&mut self, stand_s: f64, blend_s: f64) {
        let (stand, first) = (self.t_pose(), self.poses[0].clone());
        let mut poses = self.transition(&stand, &first, stand_s, blend_s);
        self.dilute(0, poses.len());
        poses.append(&mut self.poses);
        self.poses = poses;
    }

    /// Puts a transition and a T-pose after the motion.
    pub(crate) fn stand_after(&mut self, stand_s: f64, blend_s: f64) {
        let last = self.poses[self.poses.len() - 1].clone();
        let facing = last.turns[0] * DVec3::Z;
        let turn = DQuat::from_rotation_y(libm::atan2(facing.x, facing.z));
        let stand = Pose { hips_m: last.hips_m.with_y(0.93), turns: [turn; 22] };
        let mut poses = self.transition(&stand, &last, stand_s, blend_s);
        poses.reverse();
        self.dilute(1, poses.len());
        self.poses.append(&mut poses);
    }

    fn transition(&self, stand: &Pose, to: &Pose, stand_s: f64, blend_s: f64) -> Vec<Pose> {
        let [stood, blended] = [stand_s, blend_s].map(|time_s| (time_s * self.frame_rate_hz).round() as usize);
        let blend = (0..blended).map(|frame| stand.lerp(to, (frame + 1) as f64 / (blended + 1) as f64));
        std::iter::repeat_n(stand.clone(), stood).chain(blend).collect()
    }

    /// Scales the velocities: whole-clip means count standing frames, except a single one, which import removes.
    fn dilute(&mut self, end: usize, standing: usize) {
        if standing > 1 {
            let share = (self.poses.len() - 1) as f64 / (self.poses.len() + standing - 1) as f64;
            let [forward, turn_rate, left] = self.parameters;
            self.parameters = [share * forward, turn_rate, share * left];
            self.standing_s[end] += standing as f64 / self.frame_rate_hz;
        }
    }

    /// Whole-clip turn rate, degrees a second: the change of facing between its means over the first and the last
    /// quarter of a second, divided by the time between them.
    pub(crate) fn turn_rate(&self) -> f64 {
        const END_S: f64 = 0.25;
        let duration_s = (self.poses.len() - 1) as f64 / self.frame_rate_hz;
        let moving_s = duration_s - self.standing_s.iter().sum::<f64>();
        let lost_s = self.standing_s.map(|standing_s| {
            let moving_s = (END_S - standing_s).max(0.0);
            0.5 * moving_s * moving_s / END_S
        });
        self.parameters[1] * (moving_s - lost_s.iter().sum::<f64>()) / (duration_s - END_S)
    }

    /// Blends from a T-pose into the motion while the body moves.
    pub(crate) fn blend_out(&mut self, blend_s: f64) {
        let frames = (blend_s * self.frame_rate_hz).ceil();
        for (frame, pose) in self.poses.iter_mut().enumerate().take(frames as usize) {
            let facing = pose.turns[0] * DVec3::Z;
            let turn = DQuat::from_rotation_y(libm::atan2(facing.x, facing.z));
            let stand = Pose { hips_m: pose.hips_m, turns: [turn; 22] };
            *pose = stand.lerp(pose, frame as f64 / frames);
        }
    }

    /// Removes the straight displacement of the hips from the first to the last frame. Turning clips stay as they are.
    pub(crate) fn stay_in_place(&mut self) {
        if self.parameters[1] != 0.0 {
            return;
        }
        let last = self.poses.len() - 1;
        let displacement_m = (self.poses[last].hips_m - self.poses[0].hips_m).with_y(0.0);
        for (frame, pose) in self.poses.iter_mut().enumerate() {
            pose.hips_m -= displacement_m * frame as f64 / last as f64;
        }
    }

    /// Raises the ground along the path, by `slope` metres a metre.
    pub(crate) fn slope(&mut self, slope: f64) {
        let start_m = self.poses[0].hips_m;
        for pose in &mut self.poses {
            pose.hips_m.y += slope * (pose.hips_m - start_m).with_y(0.0).length();
        }
    }

    /// The pose of all offsets, standing where the first frame does.
    pub(crate) fn t_pose(&self) -> Pose {
        let hips_m = self.poses[0].hips_m;
        let facing = self.poses[0].turns[0] * DVec3::Z;
        let turn = DQuat::from_rotation_y(libm::atan2(facing.x, facing.z));
        Pose { hips_m: hips_m.with_y(0.93), turns: [turn; 22] }
    }
}

impl Pose {
    pub(crate) fn lerp(&self, other: &Self, share: f64) -> Self {
        Self {
            hips_m: self.hips_m.lerp(other.hips_m, share),
            turns: std::array::from_fn(|part| self.turns[part].slerp(other.turns[part], share)),
        }
    }
}

/// The parameters of a clip in the table of `assets/clips/README.md`.
fn readme_parameters(clip: &str) -> [f64; 3] {
    let table = std::fs::read_to_string(Path::new(CLIPS).join("README.md")).unwrap();
    let row = table.lines().find(|line| line.starts_with(&format!("| {clip}."))).unwrap();
    let number = |column: usize| row.split('|').nth(column).unwrap().trim().parse::<f64>().unwrap();
    [number(2), number(3), number(4)]
}

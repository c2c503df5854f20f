//! The pose in which a character is shown in mid-stride: that of a recording or of a database's base walk in which the
//! feet are farthest apart. Root frame, metres.

use fbcrowd_sim::recording::{AgentFrame, RecordedDatabase, Recording, RecordingError};
use glam::Vec2;
use motiondb::body::{Joint, Pose, Skeleton};
use motiondb::motion::{MotionDb, PHASE_COUNT};

/// Greatest number of frames of a recording that are looked at, evenly spread.
const FRAMES_MAX: usize = 64;

/// A pose of a crowd's body.
#[derive(Clone, Debug, PartialEq)]
pub struct Stride {
    /// The database of the body.
    pub database: RecordedDatabase,
    /// The pose.
    pub pose: Pose,
}

impl Stride {
    /// The longest stride of a database's base walk.
    pub fn of_database(db: &MotionDb) -> Self {
        let example = db.correspondence.as_ref().map_or(0, |between| between.semi_procedural as usize);
        let poses = (0..PHASE_COUNT).map(|phase| db.rows.pose(example, phase));
        let (skeleton, velocity_hull) = (db.skeleton.clone(), db.velocity_hull.clone());
        let pose = longest(&skeleton, poses);
        Self { database: RecordedDatabase { checksum: 0, skeleton, velocity_hull, style: String::new() }, pose }
    }

    /// The longest stride of a recording, over frames that are spread evenly; agents that run are looked at as well.
    ///
    /// # Errors
    /// Where a frame is missing or damaged.
    pub fn of_recording(recording: &Recording) -> Result<Self, RecordingError> {
        let database = recording.header().databases[0].clone();
        let (count, mut poses) = (recording.frame_count(), Vec::new());
        let mut agents: Vec<AgentFrame> = Vec::new();
        for index in 0..count.min(FRAMES_MAX) {
            recording.read_frame(index * count / count.min(FRAMES_MAX), &mut agents)?;
            poses.push(longest(&database.skeleton, agents.iter().map(|agent| agent.pose)));
        }
        let pose = longest(&database.skeleton, poses);
        Ok(Self { database, pose })
    }
}

/// The pose with the greatest distance of the ankles on the ground, the first of equals; at rest without any.
fn longest(skeleton: &Skeleton, poses: impl IntoIterator<Item = Pose>) -> Pose {
    let step_m = |pose: &Pose| {
        let joints = pose.forward_kinematics(skeleton);
        let [left_m, right_m]: [Vec2; 2] = Joint::FEET.map(|foot| joints.positions_m[foot.index()].truncate());
        left_m.distance(right_m)
    };
    let mut best: Option<(f32, Pose)> = None;
    for pose in poses {
        let length_m = step_m(&pose);
        if best.as_ref().is_none_or(|(most_m, _)| length_m > *most_m) {
            best = Some((length_m, pose));
        }
    }
    best.map_or(AgentFrame::default().pose, |(_, pose)| pose)
}

//! Standing, for a database of clips of which none stands: the mid-stances of its slowest steps, both at once.
//!
//! At its mid-stance (phase 0 for the right foot, ½ for the left) a foot is flat on the ground under the body. The pose
//! made here stands on both feet where they are then, with the mean of the cycle above them; it becomes an example of
//! the database in memory, never of a file. It belongs to no simplex: [`crate::synthesis::blending::blend_space`] mixes it in.

use std::sync::Arc;

use motiondb::body::Pose;
use motiondb::motion::{MotionDb, MotionExample, PHASE_COUNT, Parameters, PhaseMap};

use crate::synthesis::pose::leg::Leg;
use crate::synthesis::pose::posture::Posture;

/// Rows of the mid-stance of the left foot and of the right one.
const MID_STANCES: [usize; 2] = [PHASE_COUNT / 2, 0];

/// The database itself, or one in which a body can stand.
pub(crate) fn provided(db: Arc<MotionDb>) -> Arc<MotionDb> {
    match slowest(&db) {
        Some(example) if db.examples.iter().all(|example| example.key_times_s.is_some()) => {
            Arc::new(with_standing(&db, example))
        }
        _ => db,
    }
}

/// The example nearest to standing.
fn slowest(db: &MotionDb) -> Option<usize> {
    let far = |example: usize| db.blend_space.scaled(db.examples[example].parameters).length();
    (0..db.examples.len()).min_by(|&a, &b| far(a).total_cmp(&far(b)))
}

fn with_standing(db: &MotionDb, example: usize) -> MotionDb {
    let mut db = db.clone();
    let pose = standing_pose(&db, example);
    for _ in 0..PHASE_COUNT {
        db.rows.push_like((example, 0), &pose, [1.0; 2]);
    }
    let steps = &db.examples[example];
    db.examples.push(MotionExample {
        name: format!("standing as in {}", steps.name),
        parameters: Parameters::default(),
        phase_map: PhaseMap { period_s: steps.phase_map.period_s, left_share: 0.5 },
        key_times_s: None,
        planted_slide_cm_s: 0.0,
        planted_share: 1.0,
        ..steps.clone()
    });
    db
}

/// Each leg as at its mid-stance, the mean of the cycle above them, and the feet where they stood.
fn standing_pose(db: &MotionDb, example: usize) -> Pose {
    let mut pose = db.rows.mean_pose(example);
    let poses = MID_STANCES.map(|row| db.rows.pose(example, row));
    let feet = [0, 1].map(|side| {
        Leg::joints(side).into_iter().for_each(|joint| pose.rotations[joint] = poses[side].rotations[joint]);
        Leg::new(&poses[side], &db.skeleton, side).foot()
    });
    let mut posture = Posture::new(pose, [1.0; 2], &db.skeleton);
    posture.move_feet(feet, &db.skeleton);
    posture.bend_legs(&db.skeleton);
    posture.pose
}

//! A standing example for a database without one, made of the mid-stances of its slowest steps.
//!
//! At its mid-stance (phase 0 for the right foot, ½ for the left) a foot is flat on the ground under the body. The pose
//! stands on both feet where they are then, under the mean upper body of the cycle. It becomes an example in memory,
//! never in a file, and belongs to no simplex: [`crate::synthesis::blending::blend_domain`] mixes it in.

use std::sync::Arc;

use motiondb::body::Pose;
use motiondb::motion::{MotionDb, MotionExample, PHASE_COUNT, Parameters, PhaseMap};

use crate::synthesis::pose::{PosedLeg, Posture};

/// Rows of the mid-stance of each foot, `[left, right]`.
const MID_STANCES: [usize; 2] = [PHASE_COUNT / 2, 0];

/// The database itself if an example stands, otherwise one with a standing example.
pub(crate) fn with_standing(db: Arc<MotionDb>) -> Arc<MotionDb> {
    match slowest(&db) {
        Some(example) if db.examples.iter().all(|example| example.key_times_s.is_some()) => {
            Arc::new(with_standing_as_in(&db, example))
        }
        _ => db,
    }
}

/// The example nearest to (0, 0, 0).
fn slowest(db: &MotionDb) -> Option<usize> {
    let distance = |example: usize| db.blend_space.scaled(db.examples[example].parameters).length();
    (0..db.examples.len()).min_by(|&a, &b| distance(a).total_cmp(&distance(b)))
}

fn with_standing_as_in(db: &MotionDb, example: usize) -> MotionDb {
    let mut db = db.clone();
    let pose = standing_pose(&db, example);
    let mut mean = Vec::new();
    let rows = (0..PHASE_COUNT).map(|phase| (db.extra.row(example, phase), 1.0 / PHASE_COUNT as f32));
    db.extra.blend(rows, &mut mean);
    for _ in 0..PHASE_COUNT {
        db.rows.push_like((example, 0), &pose, [1.0; 2]);
        db.extra.rotations.extend(&mean);
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

/// The mean pose of the cycle with each leg as at its mid-stance.
fn standing_pose(db: &MotionDb, example: usize) -> Pose {
    let mut pose = db.rows.mean_pose(example);
    let poses = MID_STANCES.map(|row| db.rows.pose(example, row));
    let feet = [0, 1].map(|side| {
        PosedLeg::joints(side).into_iter().for_each(|joint| pose.rotations[joint] = poses[side].rotations[joint]);
        PosedLeg::new(&poses[side], &db.skeleton, side).foot()
    });
    let mut posture = Posture::new(pose, [1.0; 2], &db.skeleton);
    posture.move_feet(feet, &db.skeleton);
    posture.bend_legs(&db.skeleton);
    posture.pose
}

//! The databases of all styles → one database over one skeleton.
//!
//! All were made on one body. Only the joint limits follow from the poses of each: those of the skeleton hold all
//! poses.

use glam::Vec3;
use motiondb::body::JOINT_COUNT;
use motiondb::motion::MotionDb;

/// The first database, with the others as its further styles; they are sorted by style. `None` without databases.
pub(crate) fn joined(databases: Vec<MotionDb>) -> Option<MotionDb> {
    let limits_rad = databases.iter().map(|db| db.skeleton.limits_rad).reduce(union)?;
    let mut databases = databases.into_iter().map(|mut db| {
        db.skeleton.limits_rad = limits_rad;
        db
    });
    let mut first = databases.next()?;
    first.further_styles = databases.collect();
    Some(first)
}

/// The limits that hold what either holds.
fn union(one: [[Vec3; 2]; JOINT_COUNT], other: [[Vec3; 2]; JOINT_COUNT]) -> [[Vec3; 2]; JOINT_COUNT] {
    std::array::from_fn(|joint| {
        let ([least, greatest], [other_least, other_greatest]) = (one[joint], other[joint]);
        [least.min(other_least), greatest.max(other_greatest)]
    })
}

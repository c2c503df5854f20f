//! Can the database do without an example? Its motion blended from the others, against the nearest other played alone.
//!
//! For every recorded example whose (v_f, ω_t, ω_s) lies inside the hull of the others: the database is rebuilt without
//! it *and its mirror* (simplices and axes' ranges anew; the other rows stay), and blended at its parameters by the
//! runtime's own synthesis (`fbcrowd_sim::synthesis::blending`: w_i ∝ u_i·r_i(φ)). With x_j(φ) the place of joint j in the
//! root frame,
//!
//! ```text
//! RMSE_j = √( mean over 64 uniform phases of |x_j(φ) − x'_j(φ)|² )     of one joint,
//! RMSE   = √( mean over 22 joints of RMSE_j² )                         of the body,
//! ```
//!
//! x' once the blend's, once those of the nearest other example (each axis divided by its range over the others) at
//! the same phase. Whether a blend is the better one is decided by the body's, in which the joints that are furthest
//! off, the hands, count most; the median of all RMSE_j says how far off a joint usually is. Mirrored examples are not
//! asked for themselves: mirrors count once.

use fbcrowd_sim::synthesis::blending::ExampleMix;
use motiondb::blend_space::triangulation;
use motiondb::body::{JOINT_COUNT, Joint, Pose, Skeleton};
use motiondb::motion::{MotionDb, MotionExample, PHASE_COUNT, Rows};
use serde::Serialize;

use crate::statistics::{median, share};

/// One example, left out.
#[derive(Debug, PartialEq, Serialize)]
pub(crate) struct LeftOut {
    pub(crate) name: String,
    /// The body against the blend of the others, metres.
    pub(crate) blended_rmse_m: f32,
    /// The body against the nearest of the others, metres.
    pub(crate) nearest_rmse_m: f32,
    /// RMSE_j, in the order of `per_joint`, metres.
    pub(crate) joint_blended_rmse_m: [f32; JOINT_COUNT],
    pub(crate) joint_nearest_rmse_m: [f32; JOINT_COUNT],
    pub(crate) nearest: String,
    /// The blend's examples, with their shares of time, greatest first.
    pub(crate) mix: Vec<Part>,
}

impl LeftOut {
    /// Whether the blend of the others meets the body better than the nearest of them.
    pub(crate) fn blend_is_better(&self) -> bool {
        self.blended_rmse_m < self.nearest_rmse_m
    }
}

#[derive(Debug, PartialEq, Serialize)]
pub(crate) struct Part {
    pub(crate) name: String,
    pub(crate) share: f32,
}

/// One joint over all examples that were left out.
#[derive(Debug, PartialEq, Serialize)]
pub(crate) struct JointError {
    pub(crate) joint: &'static str,
    /// Medians of RMSE_j over the examples, metres.
    pub(crate) median_blended_rmse_m: f32,
    pub(crate) median_nearest_rmse_m: f32,
}

/// Every recorded example inside the hull of the others, and what stands for it where it is missing.
#[derive(Debug, PartialEq, Serialize)]
pub(crate) struct LeaveOneOut {
    pub(crate) examples: Vec<LeftOut>,
    /// Recorded examples on the hull's corners: nothing but themselves reaches them.
    pub(crate) outside: Vec<String>,
    /// Share of the examples that the blend meets better than the nearest example; null without any.
    pub(crate) blended_better_share: Option<f32>,
    /// Median of the bodies' RMSE over the examples, metres; null without any.
    pub(crate) median_blended_rmse_m: Option<f32>,
    pub(crate) median_nearest_rmse_m: Option<f32>,
    /// Median of RMSE_j over joints and examples, metres; null without any.
    pub(crate) median_joint_blended_rmse_m: Option<f32>,
    pub(crate) median_joint_nearest_rmse_m: Option<f32>,
    /// Every joint, in storage order; empty without any example.
    pub(crate) per_joint: Vec<JointError>,
}

/// Leaves out one recorded example after the other.
pub(crate) fn leave_one_out(db: &MotionDb) -> LeaveOneOut {
    let (mut examples, mut outside) = (Vec::new(), Vec::new());
    for (index, example) in db.examples.iter().enumerate().filter(|(_, example)| !example.mirrored) {
        match left_out(db, index) {
            Some(found) => examples.push(found),
            None => outside.push(example.name.clone()),
        }
    }
    LeaveOneOut {
        blended_better_share: share(examples.iter(), |found| found.blend_is_better()).map(|share| share as f32),
        median_blended_rmse_m: median(examples.iter().map(|found| found.blended_rmse_m)),
        median_nearest_rmse_m: median(examples.iter().map(|found| found.nearest_rmse_m)),
        median_joint_blended_rmse_m: median(examples.iter().flat_map(|found| found.joint_blended_rmse_m)),
        median_joint_nearest_rmse_m: median(examples.iter().flat_map(|found| found.joint_nearest_rmse_m)),
        per_joint: Joint::ALL.into_iter().filter_map(|joint| joint_error(&examples, joint)).collect(),
        examples,
        outside,
    }
}

/// None without examples.
fn joint_error(examples: &[LeftOut], joint: Joint) -> Option<JointError> {
    Some(JointError {
        joint: joint.name(),
        median_blended_rmse_m: median(examples.iter().map(|found| found.joint_blended_rmse_m[joint.index()]))?,
        median_nearest_rmse_m: median(examples.iter().map(|found| found.joint_nearest_rmse_m[joint.index()]))?,
    })
}

/// None where the others' hull does not hold the example.
fn left_out(db: &MotionDb, index: usize) -> Option<LeftOut> {
    let example = &db.examples[index];
    let others = without(db, example);
    if others.examples.is_empty() {
        return None;
    }
    let locator = others.locator();
    let mix = ExampleMix::new(&locator.locate_inside(example.parameters)?);
    let nearest = nearest(&others, example);
    let name = |index: usize| others.examples[index].name.clone();
    let mut parts: Vec<Part> =
        mix.entries().iter().map(|&(other, share)| Part { name: name(other as usize), share }).collect();
    parts.sort_by(|a, b| b.share.total_cmp(&a.share));
    let blended = |row: usize| {
        let phase = row as f32 / PHASE_COUNT as f32;
        mix.weights(&others, phase).pose(&others, phase)
    };
    let recorded = |row: usize| stored(db, index, row);
    let joint_blended_rmse_m = joint_rmse_m(&db.skeleton, recorded, blended);
    let joint_nearest_rmse_m = joint_rmse_m(&db.skeleton, recorded, |row| stored(&others, nearest, row));
    Some(LeftOut {
        name: example.name.clone(),
        blended_rmse_m: body_rmse_m(&joint_blended_rmse_m),
        nearest_rmse_m: body_rmse_m(&joint_nearest_rmse_m),
        joint_blended_rmse_m,
        joint_nearest_rmse_m,
        nearest: name(nearest),
        mix: parts,
    })
}

/// The database rebuilt without an example and its mirror, as far as blending goes.
fn without(db: &MotionDb, example: &MotionExample) -> MotionDb {
    let is_kept = |other: &MotionExample| !other.is_of_one_window_with(example);
    let kept: Vec<usize> = (0..db.examples.len()).filter(|&index| is_kept(&db.examples[index])).collect();
    let examples: Vec<MotionExample> = kept.iter().map(|&index| db.examples[index].clone()).collect();
    let rows = |index: &usize| index * PHASE_COUNT..(index + 1) * PHASE_COUNT;
    let rotations = |index: &usize| index * PHASE_COUNT * JOINT_COUNT..(index + 1) * PHASE_COUNT * JOINT_COUNT;
    MotionDb {
        skeleton: db.skeleton.clone(),
        sources: Vec::new(),
        rows: Rows {
            rotations: kept.iter().flat_map(|index| db.rows.rotations[rotations(index)].iter().copied()).collect(),
            pelvis_m: kept.iter().flat_map(|index| db.rows.pelvis_m[rows(index)].iter().copied()).collect(),
            contacts: kept.iter().flat_map(|index| db.rows.contacts[rows(index)].iter().copied()).collect(),
        },
        velocity_hull: db.velocity_hull.clone(),
        blend_space: triangulation::build(&examples.iter().map(|example| example.parameters).collect::<Vec<_>>()),
        correspondence: None,
        examples,
    }
}

/// The nearest example in the metric of the others.
fn nearest(others: &MotionDb, example: &MotionExample) -> usize {
    let scaled = |example: &MotionExample| others.blend_space.scaled(example.parameters);
    let distance = |index: &usize| scaled(&others.examples[*index]).distance_squared(scaled(example));
    let nearest = (0..others.examples.len()).min_by(|a, b| distance(a).total_cmp(&distance(b)));
    nearest.expect("checked: there are others")
}

fn stored(db: &MotionDb, example: usize, row: usize) -> Pose {
    Pose { pelvis_m: db.rows.pelvis_m[example * PHASE_COUNT + row], rotations: *db.rows.rotations(example, row) }
}

/// RMSE_j of every joint, metres.
fn joint_rmse_m(
    skeleton: &Skeleton,
    recorded: impl Fn(usize) -> Pose,
    other: impl Fn(usize) -> Pose,
) -> [f32; JOINT_COUNT] {
    let mut squares = [0.0; JOINT_COUNT];
    for row in 0..PHASE_COUNT {
        let [a, b] = [recorded(row), other(row)].map(|pose| pose.forward_kinematics(skeleton).positions_m);
        for (joint, square) in squares.iter_mut().enumerate() {
            *square += f64::from(a[joint].distance_squared(b[joint]));
        }
    }
    squares.map(|square| (square / PHASE_COUNT as f64).sqrt() as f32)
}

/// RMSE of the body from those of its joints, metres.
fn body_rmse_m(joint_rmse_m: &[f32; JOINT_COUNT]) -> f32 {
    (joint_rmse_m.iter().map(|joint| joint * joint).sum::<f32>() / JOINT_COUNT as f32).sqrt()
}

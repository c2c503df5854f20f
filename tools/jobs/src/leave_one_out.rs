//! Leave-one-out: how near the blend of the other examples comes to each example of a database.
//!
//! For every recorded example whose (v_f, ω_t, ω_s) lies inside the hull of the others: the database is rebuilt without
//! the example *and its mirror* (simplices and ranges of the axes are computed again; the other rows stay), and blended
//! at the example's parameters by the runtime's own synthesis (`fbcrowd_sim::synthesis::blending::mix`: w_i ∝
//! u_i·r_i(φ)). With x_j(φ) the position of joint j in the root frame,
//!
//! ```text
//! RMSE_j = √( mean over 64 uniform phases of |x_j(φ) − x'_j(φ)|² )     of one joint,
//! RMSE   = √( mean over 22 joints of RMSE_j² )                         of the body.
//! ```
//!
//! x' is once that of the blend, and once that of the nearest other example (each axis divided by its range over the
//! others) at the same phase. The body's RMSE decides which of the two is better; the joints that are furthest off, the
//! hands, count most in it. The median of all RMSE_j is the error of a typical joint. Mirrored examples are not left
//! out themselves: they would count twice.

use fbcrowd_sim::synthesis::blending::ExampleMix;
use motiondb::blend_space::triangulation;
use motiondb::body::{JOINT_COUNT, Joint, Pose, Skeleton};
use motiondb::motion::{ExtraMotion, MotionDb, MotionExample, PHASE_COUNT, Rows};
use motiondb::statistics;
use schemars::JsonSchema;
use serde::Serialize;

/// One example that was left out.
#[derive(Debug, PartialEq, JsonSchema, Serialize)]
pub struct LeftOut {
    /// Name of the example.
    pub name: String,
    /// RMSE of the body between the example and the blend of the others, m.
    pub blended_rmse_m: f32,
    /// RMSE of the body between the example and the nearest other one, m.
    pub nearest_rmse_m: f32,
    /// RMSE of each joint between the example and the blend, in the order of `per_joint`, m.
    pub joint_blended_rmse_m: [f32; JOINT_COUNT],
    /// RMSE of each joint between the example and the nearest other one, in the order of `per_joint`, m.
    pub joint_nearest_rmse_m: [f32; JOINT_COUNT],
    /// Name of the nearest other example.
    pub nearest: String,
    /// Examples of the blend, the greatest share first.
    pub mix: Vec<MixPart>,
}

impl LeftOut {
    /// Whether the blend of the others is nearer to the body than the nearest of them.
    pub fn blend_is_better(&self) -> bool {
        self.blended_rmse_m < self.nearest_rmse_m
    }
}

/// One example of a blend.
#[derive(Debug, PartialEq, JsonSchema, Serialize)]
pub struct MixPart {
    /// Name of the example.
    pub name: String,
    /// Share of time of the example in the blend, 0 to 1.
    pub share: f32,
}

/// One joint over all examples that were left out.
#[derive(Debug, PartialEq, JsonSchema, Serialize)]
pub struct JointError {
    /// Name of the joint.
    pub joint: &'static str,
    /// Median over the examples of the joint's RMSE to the blend, m.
    pub median_blended_rmse_m: f32,
    /// Median over the examples of the joint's RMSE to the nearest other example, m.
    pub median_nearest_rmse_m: f32,
}

/// Every recorded example of a database inside the hull of the others, and how near the others come to it.
#[derive(Debug, PartialEq, JsonSchema, Serialize)]
pub struct LeaveOneOut {
    /// Examples that were left out one by one.
    pub examples: Vec<LeftOut>,
    /// Names of recorded examples on corners of the hull, which no blend of the others reaches.
    pub outside: Vec<String>,
    /// Share of the examples to which the blend is nearer than the nearest other example, 0 to 1; null without
    /// examples.
    pub blended_better_share: Option<f32>,
    /// Median over the examples of the body's RMSE to the blend, m; null without examples.
    pub median_blended_rmse_m: Option<f32>,
    /// Median over the examples of the body's RMSE to the nearest other example, m; null without examples.
    pub median_nearest_rmse_m: Option<f32>,
    /// Median over joints and examples of a joint's RMSE to the blend, m; null without examples.
    pub median_joint_blended_rmse_m: Option<f32>,
    /// Median over joints and examples of a joint's RMSE to the nearest other example, m; null without examples.
    pub median_joint_nearest_rmse_m: Option<f32>,
    /// Every joint in the order of storage; empty without examples.
    pub per_joint: Vec<JointError>,
}

/// Leaves out one recorded example after the other.
pub fn leave_one_out(db: &MotionDb) -> LeaveOneOut {
    let (mut examples, mut outside) = (Vec::new(), Vec::new());
    for (index, example) in db.examples.iter().enumerate().filter(|(_, example)| !example.mirrored) {
        match left_out(db, index) {
            Some(found) => examples.push(found),
            None => outside.push(example.name.clone()),
        }
    }
    let better = examples.iter().filter(|found| found.blend_is_better()).count();
    let better_share = (better as f64 / examples.len() as f64) as f32;
    LeaveOneOut {
        blended_better_share: (!examples.is_empty()).then_some(better_share),
        median_blended_rmse_m: median(examples.iter().map(|found| found.blended_rmse_m)),
        median_nearest_rmse_m: median(examples.iter().map(|found| found.nearest_rmse_m)),
        median_joint_blended_rmse_m: median(examples.iter().flat_map(|found| found.joint_blended_rmse_m)),
        median_joint_nearest_rmse_m: median(examples.iter().flat_map(|found| found.joint_nearest_rmse_m)),
        per_joint: Joint::ALL.into_iter().filter_map(|joint| joint_error(&examples, joint)).collect(),
        examples,
        outside,
    }
}

/// The middle value; none without values.
fn median(values: impl Iterator<Item = f32>) -> Option<f32> {
    statistics::median(values.map(f64::from)).map(|middle| middle as f32)
}

/// None without examples.
fn joint_error(examples: &[LeftOut], joint: Joint) -> Option<JointError> {
    Some(JointError {
        joint: joint.name(),
        median_blended_rmse_m: median(examples.iter().map(|found| found.joint_blended_rmse_m[joint.index()]))?,
        median_nearest_rmse_m: median(examples.iter().map(|found| found.joint_nearest_rmse_m[joint.index()]))?,
    })
}

/// None where the example lies outside the hull of the others.
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
    let mut parts: Vec<MixPart> =
        mix.entries().iter().map(|&(other, share)| MixPart { name: name(other as usize), share }).collect();
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

/// The parts of the database that blending needs, rebuilt without an example and its mirror.
fn without(db: &MotionDb, example: &MotionExample) -> MotionDb {
    let is_kept = |other: &MotionExample| !other.is_of_one_window_with(example);
    let kept: Vec<usize> = (0..db.examples.len()).filter(|&index| is_kept(&db.examples[index])).collect();
    let examples: Vec<MotionExample> = kept.iter().map(|&index| db.examples[index].clone()).collect();
    let rows = |index: &usize| index * PHASE_COUNT..(index + 1) * PHASE_COUNT;
    let rotations = |index: &usize| index * PHASE_COUNT * JOINT_COUNT..(index + 1) * PHASE_COUNT * JOINT_COUNT;
    MotionDb {
        extra: ExtraMotion::default(),
        style: String::new(),
        further_styles: Vec::new(),
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
        actions: Vec::new(),
        examples,
    }
}

/// The nearest of the other examples, each axis divided by its range over them.
fn nearest(others: &MotionDb, example: &MotionExample) -> usize {
    let scaled = |example: &MotionExample| others.blend_space.scaled(example.parameters);
    let distance = |index: &usize| scaled(&others.examples[*index]).distance_squared(scaled(example));
    let nearest = (0..others.examples.len()).min_by(|a, b| distance(a).total_cmp(&distance(b)));
    nearest.expect("checked: there are others")
}

/// A stored pose.
fn stored(db: &MotionDb, example: usize, row: usize) -> Pose {
    Pose { pelvis_m: db.rows.pelvis_m[example * PHASE_COUNT + row], rotations: *db.rows.rotations(example, row) }
}

/// RMSE_j of every joint, m.
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

/// RMSE of the body from those of its joints, m.
fn body_rmse_m(joint_rmse_m: &[f32; JOINT_COUNT]) -> f32 {
    (joint_rmse_m.iter().map(|joint| joint * joint).sum::<f32>() / JOINT_COUNT as f32).sqrt()
}

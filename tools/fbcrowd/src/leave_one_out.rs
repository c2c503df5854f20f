//! Can the database do without an example? Its motion blended from the others, against the nearest other played alone.
//!
//! For every recorded example whose (v_f, ω_t, ω_s) lies inside the hull of the others: the database is rebuilt without
//! it *and its mirror* (simplices and axes' ranges anew; the other rows stay), and blended at its parameters by the
//! runtime's own synthesis (`definitions.md`, "Blend": w_i ∝ u_i·r_i(φ)). With x_j(φ) the place of joint j in the root
//! frame,
//!
//! ```text
//! RMSE = √( mean over 64 uniform phases and 22 joints of |x_j(φ) − x'_j(φ)|² ),
//! ```
//!
//! x' once the blend's, once those of the nearest other example (each axis divided by its range over the others) at
//! the same phase. Mirrored examples are not asked for themselves: mirrors count once.

use fbcrowd_sim::hms::blending::Mix;
use motiondb::blend_space::Locator;
use motiondb::coverage::{locate_inside, locator};
use motiondb::motion_db::{MotionDb, MotionExample, PHASE_COUNT, Rows};
use motiondb::pose::Pose;
use motiondb::skeleton::{JOINT_COUNT, Skeleton};
use motiondb_compiler::blend_space;
use serde::Serialize;

/// One example, left out.
#[derive(Debug, PartialEq, Serialize)]
pub(crate) struct LeftOut {
    pub(crate) name: String,
    /// Against the blend of the others, metres.
    pub(crate) blended_rmse_m: f32,
    /// Against the nearest of the others, metres.
    pub(crate) nearest_rmse_m: f32,
    pub(crate) nearest: String,
    /// The blend's examples, with their shares of time, greatest first.
    pub(crate) mix: Vec<Part>,
}

#[derive(Debug, PartialEq, Serialize)]
pub(crate) struct Part {
    pub(crate) name: String,
    pub(crate) share: f32,
}

/// Every recorded example inside the hull of the others, and what stands for it where it is missing.
#[derive(Debug, PartialEq, Serialize)]
pub(crate) struct LeaveOneOut {
    pub(crate) examples: Vec<LeftOut>,
    /// Recorded examples on the hull's corners: nothing but themselves reaches them.
    pub(crate) outside: Vec<String>,
    /// Share of the examples that the blend meets better than the nearest example; null without any.
    pub(crate) blended_better_share: Option<f32>,
    /// Median over the examples, metres; null without any.
    pub(crate) median_blended_rmse_m: Option<f32>,
    pub(crate) median_nearest_rmse_m: Option<f32>,
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
    let better = examples.iter().filter(|found| found.blended_rmse_m < found.nearest_rmse_m).count();
    LeaveOneOut {
        blended_better_share: (!examples.is_empty()).then(|| better as f32 / examples.len() as f32),
        median_blended_rmse_m: median(examples.iter().map(|found| found.blended_rmse_m).collect()),
        median_nearest_rmse_m: median(examples.iter().map(|found| found.nearest_rmse_m).collect()),
        examples,
        outside,
    }
}

/// None where the others' hull does not hold the example.
fn left_out(db: &MotionDb, index: usize) -> Option<LeftOut> {
    let example = &db.examples[index];
    let others = without(db, example);
    if others.examples.is_empty() {
        return None;
    }
    let locator: Locator = locator(&others);
    let mix = Mix::new(&locate_inside(&others, &locator, example.parameters)?);
    let nearest = nearest(&others, example);
    let name = |index: usize| others.examples[index].name.clone();
    let mut parts: Vec<Part> =
        mix.entries().iter().map(|&(other, share)| Part { name: name(other as usize), share }).collect();
    parts.sort_by(|a, b| b.share.total_cmp(&a.share));
    let blended = |row: usize| {
        let phase = row as f32 / PHASE_COUNT as f32;
        mix.weights(&others, phase).pose(&others, phase)
    };
    Some(LeftOut {
        name: example.name.clone(),
        blended_rmse_m: rmse_m(&db.skeleton, |row| stored(db, index, row), blended),
        nearest_rmse_m: rmse_m(&db.skeleton, |row| stored(db, index, row), |row| stored(&others, nearest, row)),
        nearest: name(nearest),
        mix: parts,
    })
}

/// The database rebuilt without an example and its mirror, as far as blending goes.
fn without(db: &MotionDb, example: &MotionExample) -> MotionDb {
    let mirror = format!("{}_mirrored", example.name);
    let is_kept = |other: &MotionExample| other.name != example.name && !(other.mirrored && other.name == mirror);
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
        blend_space: if examples.is_empty() { db.blend_space.clone() } else { blend_space::build(&examples) },
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

/// Root mean square distance of joints over the stored phases, metres.
fn rmse_m(skeleton: &Skeleton, recorded: impl Fn(usize) -> Pose, other: impl Fn(usize) -> Pose) -> f32 {
    let squared = |row: usize| {
        let [a, b] = [recorded(row), other(row)].map(|pose| pose.forward_kinematics(skeleton).positions_m);
        a.iter().zip(&b).map(|(a, b)| f64::from(a.distance_squared(*b))).sum::<f64>()
    };
    ((0..PHASE_COUNT).map(squared).sum::<f64>() / (PHASE_COUNT * JOINT_COUNT) as f64).sqrt() as f32
}

fn median(mut values: Vec<f32>) -> Option<f32> {
    values.sort_by(f32::total_cmp);
    let middle = values.len() / 2;
    match values.len() {
        0 => None,
        odd if odd % 2 == 1 => Some(values[middle]),
        _ => Some(0.5 * (values[middle - 1] + values[middle])),
    }
}

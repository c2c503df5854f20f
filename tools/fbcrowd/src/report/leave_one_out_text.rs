//! The text of `fbcrowd inspect --leave-one-out`: how near the blend comes to each example, then to each joint.
//!
//! Root mean squares in cm: of the body over all joints, and of single joints ([`fbcrowd_jobs::leave_one_out`]).

use fbcrowd_jobs::leave_one_out::{JointError, LeaveOneOut, LeftOut};

/// Joints in one line.
const JOINTS_PER_LINE: usize = 4;

/// A table of examples, medians, joints, and the examples that no blend reaches.
pub(crate) fn text(found: &LeaveOneOut) -> String {
    if found.examples.is_empty() {
        let corners = found.outside.join(", ");
        return format!(
            "\nno example can be left out: each is a corner of the hull, which no blend reaches: {corners}\n"
        );
    }
    let width = found.examples.iter().map(|left_out| left_out.name.chars().count()).max().unwrap_or(0).max(12);
    let mut text =
        format!("\n{:<width$}  blend cm  nearest cm  nearest example, then the blend's shares\n", "left out");
    for left_out in &found.examples {
        let others = format!("{}; {}", left_out.nearest, shares(left_out));
        text += &line(&left_out.name, width, left_out.blended_rmse_m, left_out.nearest_rmse_m, &others);
    }
    text += &medians(found, width).unwrap_or_default();
    text += &joints(&found.per_joint);
    if !found.outside.is_empty() {
        text += &format!("corners of the hull, which no blend reaches: {}\n", found.outside.join(", "));
    }
    text
}

/// One line of the table.
fn line(name: &str, width: usize, blended_m: f32, nearest_m: f32, rest: &str) -> String {
    format!("{name:<width$}  {:8.1}  {:10.1}  {rest}\n", 100.0 * blended_m, 100.0 * nearest_m)
}

/// Shares of the blend from half a percent on.
fn shares(left_out: &LeftOut) -> String {
    let counting = left_out.mix.iter().filter(|part| part.share >= 0.005);
    let parts = counting.map(|part| format!("{:.0} % {}", 100.0 * part.share, part.name));
    parts.collect::<Vec<_>>().join(", ")
}

/// Medians of the bodies over the examples, and of all their joints.
fn medians(found: &LeaveOneOut, width: usize) -> Option<String> {
    let better = 100.0 * found.blended_better_share?;
    let better = format!("the blend is nearer for {better:.0} % of {}", found.examples.len());
    let bodies = line("median", width, found.median_blended_rmse_m?, found.median_nearest_rmse_m?, &better);
    let (blended_m, nearest_m) = (found.median_joint_blended_rmse_m?, found.median_joint_nearest_rmse_m?);
    Some(bodies + &line("median joint", width, blended_m, nearest_m, "each joint by itself"))
}

/// Medians of each joint over the examples; empty without examples.
fn joints(per_joint: &[JointError]) -> String {
    if per_joint.is_empty() {
        return String::new();
    }
    let one = |joint: &JointError| {
        let (blended_cm, nearest_cm) = (100.0 * joint.median_blended_rmse_m, 100.0 * joint.median_nearest_rmse_m);
        format!("{:<16} {blended_cm:4.1} {nearest_cm:4.1}", joint.joint)
    };
    let lines = per_joint.chunks(JOINTS_PER_LINE).map(|joints| joints.iter().map(one).collect::<Vec<_>>().join("   "));
    let lines: String = lines.map(|line| format!("  {line}\n")).collect();
    format!("median of each joint: blend, nearest example, cm\n{lines}")
}

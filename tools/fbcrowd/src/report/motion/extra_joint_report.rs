//! Joints of a database beside the 22 roles, in JSON, and as a table.

use glam::Quat;
use motiondb::body::ExtraParent;
use motiondb::motion::MotionDb;
use schemars::JsonSchema;
use serde::Serialize;

/// A joint beside the 22 roles: of a finger, a toe, or a twist bone.
#[derive(JsonSchema, Serialize)]
pub(crate) struct ExtraJointReport {
    /// Name of the joint, such as `left_index_1`: the left index finger's joint next to the palm.
    pub(crate) joint: String,
    /// Name of the joint that it hangs from.
    pub(crate) parent: String,
    /// Distance from that joint, m.
    pub(crate) bone_m: f32,
    /// Angle of its mean rotation over the examples from its rest, rad.
    pub(crate) mean_rad: f32,
    /// Greatest angle between its rotation, in an example or an action, and that mean, rad.
    pub(crate) greatest_rad: f32,
}

/// The joints of a database beside the 22 roles, in its order.
pub(crate) fn extra_joint_reports(db: &MotionDb) -> Vec<ExtraJointReport> {
    let extra = &db.extra;
    let count = extra.bones.len();
    let report = |index: usize| {
        let bone = &extra.bones[index];
        let of_rows = extra.rotations.iter().skip(index).step_by(count);
        let of_actions = extra.actions.iter().flat_map(|action| action.iter().skip(index).step_by(count));
        // All lie in one hemisphere.
        let mean = of_rows.clone().fold(Quat::from_xyzw(0.0, 0.0, 0.0, 0.0), |sum, turn| sum + *turn).normalize();
        ExtraJointReport {
            joint: bone.joint.name(),
            parent: match bone.joint.parent() {
                ExtraParent::Role(role) => role.name().to_owned(),
                ExtraParent::Extra(parent) => parent.name(),
            },
            bone_m: bone.offset_m.length(),
            mean_rad: mean.angle_between(Quat::IDENTITY),
            greatest_rad: of_rows.chain(of_actions).map(|turn| mean.angle_between(*turn)).fold(0.0, f32::max),
        }
    };
    (0..count).map(report).collect()
}

/// The table of the joints; empty without joints.
pub(crate) fn text(joints: &[ExtraJointReport]) -> String {
    if joints.is_empty() {
        return String::new();
    }
    let mut text = format!(
        "\njoints beside the 22 roles (mean turn from the rest; greatest turn from the mean)\n  {:<22}  {:<22}  {:>7}  {:>6}  {:>10}\n",
        "joint", "of", "bone cm", "mean °", "greatest °"
    );
    for joint in joints {
        let (mean_deg, greatest_deg) = (joint.mean_rad.to_degrees(), joint.greatest_rad.to_degrees());
        text += &format!(
            "  {:<22}  {:<22}  {:7.1}  {mean_deg:6.1}  {greatest_deg:10.1}\n",
            joint.joint,
            joint.parent,
            100.0 * joint.bone_m
        );
    }
    text
}

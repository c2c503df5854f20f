//! Which meshes are worn: all but those that the caller hides, and of several that a hand could hold the first.

use motiondb::body::Joint;

use crate::character::bind_pose::BindPose;
use crate::character::joint_roles::{self, SlotMap};
use crate::character::mesh_instances::Instance;
use crate::character::reason::{CharacterNote, CharacterReason};

/// The meshes that are worn.
///
/// # Errors
/// [`CharacterReason::NoSuchMesh`] where a hidden name names none.
pub(crate) fn worn<'a>(
    mut instances: Vec<Instance<'a>>,
    hide: &[String],
    pose: &BindPose,
    slots: &SlotMap,
    notes: &mut Vec<CharacterNote>,
) -> Result<Vec<Instance<'a>>, CharacterReason> {
    if let Some(name) = hide.iter().find(|name| !instances.iter().any(|instance| instance.is_called(name))) {
        return Err(CharacterReason::NoSuchMesh { name: name.clone(), meshes: names(&instances).join(", ") });
    }
    instances.retain(|instance| !hide.iter().any(|name| instance.is_called(name)));
    leave_one_a_socket(&mut instances, pose, slots, notes);
    if instances.is_empty() { Err(CharacterReason::NoMesh) } else { Ok(instances) }
}

/// Names of the nodes that draw meshes, each once.
fn names(instances: &[Instance]) -> Vec<String> {
    let mut names: Vec<String> = instances.iter().map(|instance| instance.node.clone()).collect();
    names.dedup();
    names
}

/// Things for a hand hang from a joint without role below it. Of several on one such joint, the first is worn.
fn leave_one_a_socket(instances: &mut Vec<Instance>, pose: &BindPose, slots: &SlotMap, notes: &mut Vec<CharacterNote>) {
    let leaders = joint_roles::leaders(pose, slots);
    let is_hand = |slot: usize| matches!(leaders[slot], Some(Joint::LeftHand | Joint::RightHand));
    let socket = |instance: &Instance| {
        let parent = pose.parents[instance.slot].filter(|_| instance.skin.is_none())?;
        (is_hand(parent) && !slots.contains(&Some(parent))).then_some(parent)
    };
    let mut held: Vec<(usize, usize)> = Vec::new();
    let (mut worn, mut left_out) = (Vec::new(), Vec::new());
    for instance in std::mem::take(instances) {
        let Some(socket) = socket(&instance) else {
            worn.push(instance);
            continue;
        };
        match held.iter().find(|(other, _)| *other == socket) {
            Some((_, slot)) if *slot != instance.slot => left_out.push(instance),
            _ => {
                held.push((socket, instance.slot));
                worn.push(instance);
            }
        }
    }
    *instances = worn;
    if !left_out.is_empty() {
        notes.push(CharacterNote::SpareMeshes(names(&left_out)));
    }
}

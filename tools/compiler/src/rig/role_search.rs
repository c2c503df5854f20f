//! One search for the roles of a clip's joints, by hierarchy, geometry and names.
//!
//! Legs and arms are the two pairs of limbs that go together best (`body_plan`). Left and right come from names, unless
//! toes and knees contradict them; without names, from the direction of the toes. A body is human when its trunk stands
//! over its legs, unlike a quadruped's.

use motiondb::body::Joint;

use crate::error::{ManifestKey, RejectionReason};
use crate::read::source_clip::SourceClip;
use crate::rig::body_plan;
use crate::rig::limb::LimbPair;
use crate::rig::role_assignment::assigned_roles;
use crate::rig::roles::{ARMS, JointMap, LEGS, Roles};
use crate::rig::source_rig::SourceRig;

/// Least mean cosine between the legs' mean direction (toes → hips) and the trunk (hips → shoulders). People walk at
/// 0.9 to 1 and bow at 0.64; a fox gallops at 0.28.
const UPRIGHT_COSINE: f64 = 0.45;
/// Weights of names where there is no motion: the part that is sought, another part, a helper.
const NAME_WEIGHTS_WITHOUT_MOTION: [f64; 3] = [2.0, 0.4, 0.2];
/// Greatest standard deviation of a leg bone's length, divided by its mean. Knees of one hand-keyed walk translate by
/// 0.05.
const LOOSE_BONE: f64 = 0.15;

/// The roles that one search finds.
///
/// # Errors
/// As [`crate::rig::find_roles`].
pub(crate) fn search(clip: &SourceClip, known: &JointMap) -> Result<Roles, RejectionReason> {
    search_rig(&SourceRig::new(clip), known)
}

/// The roles of a clip without motion, which cannot show which limbs walk: a named leg beats an ear of twice its
/// length.
///
/// # Errors
/// As [`crate::rig::find_roles`].
pub(crate) fn search_by_name(clip: &SourceClip, known: &JointMap) -> Result<Roles, RejectionReason> {
    let mut rig = SourceRig::new(clip);
    rig.name_weights = NAME_WEIGHTS_WITHOUT_MOTION;
    search_rig(&rig, known)
}

fn search_rig(rig: &SourceRig, known: &JointMap) -> Result<Roles, RejectionReason> {
    let (known_legs, known_arms) = (known_pair(rig, known, LEGS)?, known_pair(rig, known, ARMS)?);
    let [mut legs, mut arms] = body_plan::legs_and_arms(rig, known_legs.clone(), known_arms.clone())?;
    if known_legs.is_none() {
        check_leg_bones(rig, &legs)?;
    }
    check_upright(rig, &legs, &arms)?;
    let sides = body_plan::leg_sides(rig, &legs, &arms);
    if known_legs.is_none() && sides.are_swapped {
        legs.limbs.swap(0, 1);
    }
    if known_arms.is_none() && body_plan::are_arms_swapped(rig, &legs, &arms) {
        arms.limbs.swap(0, 1);
    }
    let mut roles = assigned_roles(rig, &legs, &arms);
    roles.are_names_mirrored = known_legs.is_none() && sides.contradict_names;
    for (role, known) in roles.joints.iter_mut().zip(known) {
        *role = known.or(*role);
    }
    Ok(roles)
}

/// Checks that the stated limbs hang together and that the trunk stands over the legs. Returns whether left and right
/// are swapped: the feet point backward.
///
/// # Errors
/// [`RejectionReason::ManifestContradicted`], [`RejectionReason::NotUpright`].
pub(crate) fn check_known(clip: &SourceClip, known: &JointMap) -> Result<bool, RejectionReason> {
    let rig = SourceRig::new(clip);
    let (Some(legs), Some(arms)) = (known_pair(&rig, known, LEGS)?, known_pair(&rig, known, ARMS)?) else {
        return Ok(false);
    };
    check_upright(&rig, &legs, &arms)?;
    Ok(body_plan::are_feet_backward(&rig, &legs, &arms))
}

/// The pair of limbs whose six joints are known.
fn known_pair(rig: &SourceRig, known: &JointMap, roles: [[Joint; 3]; 2]) -> Result<Option<LimbPair>, RejectionReason> {
    let mut joints = [[0; 3]; 2];
    for (joint, role) in joints.as_flattened_mut().iter_mut().zip(roles.as_flattened()) {
        let Some(known) = known[role.index()] else { return Ok(None) };
        *joint = known;
    }
    for (limb, roles) in joints.iter().zip(roles) {
        for bone in 0..2 {
            let [above, below] = [limb[bone], limb[bone + 1]];
            if above == below || !rig.ancestors(below).contains(&above) {
                let [above, below] = [above, below].map(|joint| &rig.clip.joints[joint].name);
                return Err(RejectionReason::ManifestContradicted {
                    key: ManifestKey::Joint(roles[bone + 1]),
                    problem: format!("`{below}` does not hang from `{above}` in {}", rig.clip.file),
                    remedy: "follow each limb from the trunk outwards",
                });
            }
        }
    }
    Ok(Some(LimbPair::known(rig, joints)))
}

fn check_leg_bones(rig: &SourceRig, legs: &LimbPair) -> Result<(), RejectionReason> {
    for limb in &legs.limbs {
        let [hip, knee, ankle] = limb.joints;
        if rig.looseness(hip, knee).max(rig.looseness(knee, ankle)) > LOOSE_BONE {
            return Err(RejectionReason::LooseLeg { knee: rig.clip.joints[knee].name.clone() });
        }
    }
    Ok(())
}

fn check_upright(rig: &SourceRig, legs: &LimbPair, arms: &LimbPair) -> Result<(), RejectionReason> {
    let cosine = body_plan::upright_cosine(rig, legs, arms);
    if cosine < UPRIGHT_COSINE {
        return Err(RejectionReason::NotUpright { trunk_deg: libm::acos(cosine.clamp(-1.0, 1.0)).to_degrees() });
    }
    Ok(())
}

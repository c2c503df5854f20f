//! A character on a skeleton: what both give once, before any pose.
//!
//! A scale makes the hips of both equally high above the soles. A constant rotation of each role turns the character's
//! bind bone to the skeleton's rest bone, so an A-pose, relaxed elbows and a bent spine vanish:
//! - thighs, shanks, upper arms and forearms: the shortest arc from bone to bone;
//! - hands: from the character's palm to the skeleton's, which faces down; without known fingers they turn with their
//!   forearms;
//! - the spine as a whole: the shortest arc from the line between pelvis and neck to that of the skeleton, so the
//!   curve of the character's back stays its own;
//! - feet and toes: about the vertical, from the character's ankle → ball to the skeleton's;
//! - pelvis, neck, head and clavicles: none.

use glam::{Quat, Vec3};

use crate::body::two_bone_reach::shortest_arc;
use crate::body::{ExtraParent, JOINT_COUNT, Joint, Skeleton};
use crate::character::model::Character;
use crate::character::sole_outline::sole_outline_m;
use crate::character::trunk_room::TrunkRoom;

/// Greatest deviation of the scale from 1 for which a character's legs count as those of the skeleton.
pub const SCALE_TOLERANCE: f32 = 0.1;
/// Greatest deviation of a worn character's height from the skeleton's for which it is as tall as the crowd, as a share:
/// people of one age differ by about as much.
pub const HEIGHT_TOLERANCE: f32 = 0.15;
/// Least length of a bone that has a direction, divided by the height of the hips.
const BONE_MIN: f32 = 1e-3;

/// A character that is ready to take the poses of a skeleton.
#[derive(Clone, Debug)]
pub struct CharacterFit<'a> {
    /// The character.
    pub character: &'a Character,
    /// Factor of all lengths of the character.
    pub scale: f32,
    /// Rotation of each role from bind to the skeleton's rest, body axes.
    pub(crate) turns: [Quat; JOINT_COUNT],
    /// The role that each joint moves with: its own, or that of the nearest joint above; the pelvis where there is none.
    pub(crate) leaders: Vec<Joint>,
    /// The joint of the extra joint that each joint moves with: its own, or the nearest above it below any role; else the
    /// joint itself.
    pub(crate) extra_leaders: Vec<u32>,
    /// Distance by which each foot stands farther to the left than the skeleton's, `[left, right]`, m.
    pub(crate) wider_m: [f32; 2],
    /// Outline of each sole, `[left, right]`: points that move with the foot, and with the toes; bind space, m.
    pub(crate) soles_m: [[Vec<Vec3>; 2]; 2],
    /// What keeps arms outside the trunk.
    pub(crate) trunk_room: TrunkRoom,
    /// Height of the skeleton's hips above the soles at rest, m.
    pub hips_over_soles_m: f32,
    /// Height of the skeleton at rest, m.
    pub skeleton_height_m: f32,
}

impl<'a> CharacterFit<'a> {
    /// Fits a character to a skeleton.
    pub fn new(character: &'a Character, skeleton: &Skeleton) -> Self {
        let rest_m = rest_positions_m(skeleton);
        let hips_m = Joint::THIGHS.map(|thigh| rest_m[thigh.index()].z);
        let hips_over_soles_m = 0.5 * (hips_m[0] + hips_m[1]);
        let scale = hips_over_soles_m / character.hips_over_soles_m;
        let hips_m = Joint::THIGHS.map(|thigh| character.role_position_m(thigh).unwrap_or_default().y);
        let rest_hips_m = Joint::THIGHS.map(|thigh| rest_m[thigh.index()].y);
        let wider_m = 0.5 * (scale * (hips_m[0] - hips_m[1]) - (rest_hips_m[0] - rest_hips_m[1]));
        let leaders = leaders(character);
        Self {
            character,
            scale,
            soles_m: [0, 1].map(|side| sole_outline_m(character, &leaders, side)),
            trunk_room: TrunkRoom::of(character, &leaders),
            wider_m: [wider_m, -wider_m],
            turns: turns(character, skeleton, &rest_m),
            leaders,
            extra_leaders: extra_leaders(character),
            hips_over_soles_m,
            skeleton_height_m: skeleton.height_m(),
        }
    }

    /// Whether the character's legs differ from the skeleton's by more than [`SCALE_TOLERANCE`].
    pub fn is_scaled(&self) -> bool {
        (self.scale - 1.0).abs() > SCALE_TOLERANCE
    }

    /// Height of the character as worn, m.
    pub fn height_m(&self) -> f32 {
        self.scale * self.character.height_m
    }

    /// Whether the worn character is as tall as the crowd, within [`HEIGHT_TOLERANCE`]. Short legs below a large head make
    /// a giant.
    pub fn is_as_tall(&self) -> bool {
        (self.height_m() / self.skeleton_height_m - 1.0).abs() <= HEIGHT_TOLERANCE
    }
}

/// Positions of the joints at rest, m.
fn rest_positions_m(skeleton: &Skeleton) -> [Vec3; JOINT_COUNT] {
    let mut positions_m = skeleton.offsets_m;
    for joint in &Joint::ALL[1..] {
        let Some(parent) = joint.parent() else { continue };
        positions_m[joint.index()] += positions_m[parent.index()];
    }
    positions_m
}

fn turns(character: &Character, skeleton: &Skeleton, rest_m: &[Vec3; JOINT_COUNT]) -> [Quat; JOINT_COUNT] {
    let mut turns = [Quat::IDENTITY; JOINT_COUNT];
    let least_m = BONE_MIN * character.hips_over_soles_m;
    // The rotation from the character's line between two joints to the skeleton's.
    let turn = |from: Joint, to: Joint| {
        let own_m = character.role_position_m(to)? - character.role_position_m(from)?;
        let rest_m = rest_m[to.index()] - rest_m[from.index()];
        (own_m.length() > least_m && rest_m.length() > 0.0)
            .then(|| shortest_arc(own_m, rest_m, own_m.length() * rest_m.length()).normalize())
    };
    let trunk =
        turn(Joint::Pelvis, Joint::Neck).or_else(|| turn(Joint::Pelvis, Joint::SpineUpper)).unwrap_or(Quat::IDENTITY);
    for spine in [Joint::SpineLower, Joint::SpineMiddle, Joint::SpineUpper] {
        turns[spine.index()] = trunk;
    }
    for first in [Joint::LeftUpperArm, Joint::RightUpperArm, Joint::LeftThigh, Joint::RightThigh] {
        let [upper, lower, end] = [0, 1, 2].map(|bone| Joint::ALL[first.index() + bone]);
        turns[upper.index()] = turn(upper, lower).unwrap_or(Quat::IDENTITY);
        turns[lower.index()] = turn(lower, end).unwrap_or(turns[upper.index()]);
        let palm = character.extra.iter().find(|known| known.extra.parent() == ExtraParent::Role(end));
        turns[end.index()] = palm.map_or(turns[lower.index()], |known| known.parent_axes.conjugate());
    }
    for side in 0..2 {
        let (foot, toe) = (Joint::FEET[side], Joint::TOES[side]);
        let ankle_m = character.role_position_m(foot).unwrap_or_default();
        let turn = level_turn(character.feet[side].ball_m - ankle_m, skeleton.feet[side].ball_m);
        (turns[foot.index()], turns[toe.index()]) = (turn, turn);
    }
    turns
}

/// The rotation about the vertical from one direction to another.
fn level_turn(from: Vec3, to: Vec3) -> Quat {
    let [from, to] = [from, to].map(|vector| vector.with_z(0.0));
    match (from.try_normalize(), to.try_normalize()) {
        (Some(from), Some(to)) => {
            let angle = libm::atan2f(from.cross(to).z, from.dot(to));
            Quat::from_rotation_z(angle)
        }
        _ => Quat::IDENTITY,
    }
}

fn leaders(character: &Character) -> Vec<Joint> {
    let mut own: Vec<Option<Joint>> = vec![None; character.joints.len()];
    for role in Joint::ALL {
        if let Some(joint) = character.joint(role) {
            own[joint] = Some(role);
        }
    }
    // A parent comes before its children.
    for joint in 0..own.len() {
        own[joint] = own[joint].or_else(|| own[character.joints[joint].parent? as usize]);
    }
    own.into_iter().map(|role| role.unwrap_or(Joint::Pelvis)).collect()
}

fn extra_leaders(character: &Character) -> Vec<u32> {
    let mut leaders: Vec<u32> = (0..character.joints.len() as u32).collect();
    let is_extra = |joint: u32| character.extra.iter().any(|known| known.joint == joint);
    // A parent comes before its children.
    for joint in 0..leaders.len() as u32 {
        let above = character.joints[joint as usize].parent.map(|above| leaders[above as usize]);
        let is_led = !character.roles.contains(&Some(joint)) && !is_extra(joint);
        leaders[joint as usize] = above.filter(|above| is_led && is_extra(*above)).unwrap_or(joint);
    }
    leaders
}

//! A tool's skeleton around the performer: which joints there are, where they sit and how they are turned at rest.

use glam::{DQuat, DVec3};

use super::body::{Performance, part};
use super::names::Names;

/// One joint of a rig.
#[derive(Clone, Debug)]
pub(crate) struct Bone {
    pub name: String,
    pub parent: Option<usize>,
    /// The part it moves with; none stays at the origin.
    pub part: Option<usize>,
    /// In the part's frame, metres.
    pub position_m: DVec3,
    /// Its own frame in the part's: what the file calls no rotation.
    pub rest: DQuat,
    /// It has position channels that really vary.
    pub is_loose: bool,
}

/// Joints beyond the body's own.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Extra {
    TwistLeaves,
    TwistInline,
    Segments,
    ZeroHelpers,
    Fingers,
    Metacarpals,
    FiveToes,
    Heels,
    Face,
    TwinTails,
    Skirt,
    Tail,
    Wings,
    Cape,
    Sword,
    Guns,
    Breasts,
    IkTargets,
    Backpack,
}

pub(crate) const EXTRAS: [Extra; 19] = [
    Extra::TwistLeaves,
    Extra::TwistInline,
    Extra::Segments,
    Extra::ZeroHelpers,
    Extra::Fingers,
    Extra::Metacarpals,
    Extra::FiveToes,
    Extra::Heels,
    Extra::Face,
    Extra::TwinTails,
    Extra::Skirt,
    Extra::Tail,
    Extra::Wings,
    Extra::Cape,
    Extra::Sword,
    Extra::Guns,
    Extra::Breasts,
    Extra::IkTargets,
    Extra::Backpack,
];

/// What the file's zero pose is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Rest {
    TPose,
    APose,
    ArmsDown,
    /// Every bone along one axis of its joint: 0..6 is ±X, ±Y, ±Z.
    Along(usize),
    /// Each joint's frame rotated without a pattern.
    Any,
}

/// The rig and its limbs' joints, `[left, right]` from the trunk outwards.
pub(crate) struct Rig {
    pub bones: Vec<Bone>,
    pub legs: [[usize; 3]; 2],
    pub arms: [[usize; 3]; 2],
}

/// Builds a rig; `any_turn` gives rotations without a pattern.
pub(crate) fn build(
    body: &Performance,
    names: &Names,
    extras: &[Extra],
    rest: Rest,
    mut any_turn: impl FnMut() -> DQuat,
) -> Rig {
    let mut rig = Rig { bones: Vec::new(), legs: [[0; 3]; 2], arms: [[0; 3]; 2] };
    let mut parent = None;
    for name in &names.above {
        parent = Some(rig.add(name, parent, None, DVec3::ZERO));
    }
    if parent.is_some() && extras.contains(&Extra::IkTargets) {
        for (side, foot) in names.sides.iter().zip(["LeftFoot", "RightFoot"]) {
            let target = rig.add(&names.of("ik_foot_%", side), parent, Some(part(foot)), DVec3::ZERO);
            rig.bones[target].is_loose = true;
        }
    }
    let pelvis = rig.add(&names.pelvis, parent, Some(part("Hips")), DVec3::ZERO);
    rig.bones[pelvis].is_loose = true;
    let spine = rig.spine(names, pelvis);
    let chest = *spine.last().unwrap_or(&pelvis);
    let mut neck = chest;
    for (index, name) in names.neck.iter().enumerate() {
        neck = rig.add(name, Some(neck), Some(part("Neck")), index as f64 * 0.04 * DVec3::Y);
    }
    let head = rig.add(&names.head, Some(neck), Some(part("Head")), DVec3::ZERO);
    rig.add(&format!("{}_nub", names.head), Some(head), Some(part("Head")), 0.185 * DVec3::Y);
    let (shoulders, hips) = if names.is_biped { (neck, spine[0]) } else { (chest, pelvis) };
    for side in 0..2 {
        rig.arm(names, extras, side, shoulders);
        rig.leg(names, extras, side, hips);
    }
    rig.ornaments(extras, [pelvis, chest, head]);
    rig.turn(body, rest, &mut any_turn);
    rig
}

impl Names {
    fn of(&self, pattern: &str, side: &str) -> String {
        pattern.replace('%', side)
    }
}

const WORDS: [&str; 2] = ["Left", "Right"];

impl Rig {
    fn add(&mut self, name: &str, parent: Option<usize>, part: Option<usize>, position_m: DVec3) -> usize {
        let rest = DQuat::IDENTITY;
        self.bones.push(Bone { name: name.to_owned(), parent, part, position_m, rest, is_loose: false });
        self.bones.len() - 1
    }

    /// A chain on one part, each joint a step on from the last.
    fn chain(&mut self, name: &str, parent: usize, part: usize, from_m: DVec3, step_m: DVec3, count: usize) -> usize {
        let mut tail = parent;
        for link in 0..count {
            let name = if name.is_empty() { String::new() } else { format!("{name}{link}") };
            tail = self.add(&name, Some(tail), Some(part), from_m + link as f64 * step_m);
        }
        tail
    }

    fn spine(&mut self, names: &Names, pelvis: usize) -> Vec<usize> {
        let count = names.spine.len();
        let mut spine = Vec::new();
        for (index, name) in names.spine.iter().enumerate() {
            let on = 3 - (3 * (count - index)).div_ceil(count).min(3);
            let same = names.spine[..index]
                .iter()
                .enumerate()
                .filter(|(earlier, _)| 3 - (3 * (count - earlier)).div_ceil(count).min(3) == on);
            let position_m = 0.05 * same.count() as f64 * DVec3::Y;
            let on = if index + 1 == count { "Spine2" } else { ["Spine", "Spine1", "Spine2"][on] };
            let parent = *spine.last().unwrap_or(&pelvis);
            spine.push(self.add(name, Some(parent), Some(part(on)), position_m));
        }
        spine
    }

    /// A bone's own helpers between its two ends.
    fn along(&mut self, extras: &[Extra], name: &str, from: usize, bone_m: DVec3) -> usize {
        let on = self.bones[from].part;
        let named = |suffix: &str| if name.is_empty() { String::new() } else { format!("{name}{suffix}") };
        let mut end = from;
        if extras.contains(&Extra::ZeroHelpers) {
            end = self.add(&named("Offset"), Some(end), on, DVec3::ZERO);
        }
        if extras.contains(&Extra::TwistLeaves) {
            self.add(&named("Twist01"), Some(end), on, 0.3 * bone_m);
            self.add(&named("Twist02"), Some(end), on, 0.6 * bone_m);
        }
        if extras.contains(&Extra::TwistInline) {
            end = self.add(&named("Twist"), Some(end), on, 0.5 * bone_m);
        }
        if extras.contains(&Extra::Segments) {
            end = self.add(&named(".001"), Some(end), on, 0.7 * bone_m);
        }
        end
    }

    fn arm(&mut self, names: &Names, extras: &[Extra], side: usize, parent: usize) {
        let word = WORDS[side];
        let sign = if side == 0 { 1.0 } else { -1.0 };
        let at = |name: &str| Some(part(&format!("{word}{name}")));
        let mut parent = parent;
        for collar in &names.collar {
            parent = self.add(&names.of(collar, names.sides[side]), Some(parent), at("Shoulder"), DVec3::ZERO);
        }
        let name = names.arm.each_ref().map(|pattern| names.of(pattern, names.sides[side]));
        let arm = self.add(&name[0], Some(parent), at("Arm"), DVec3::ZERO);
        let end = self.along(extras, &name[0], arm, sign * 0.3255 * DVec3::X);
        let forearm = self.add(&name[1], Some(end), at("ForeArm"), DVec3::ZERO);
        let end = self.along(extras, &name[1], forearm, sign * 0.2555 * DVec3::X);
        let hand = self.add(&name[2], Some(end), at("Hand"), DVec3::ZERO);
        self.arms[side] = [arm, forearm, hand];
        self.hand(extras, side, hand);
    }

    fn hand(&mut self, extras: &[Extra], side: usize, hand: usize) {
        let (word, sign) = (WORDS[side], if side == 0 { 1.0 } else { -1.0 });
        let on = self.bones[hand].part.expect("hands are parts");
        let along = sign * DVec3::X;
        let start = if extras.contains(&Extra::Metacarpals) { 0.02 } else { 0.09 };
        if extras.contains(&Extra::Fingers) || extras.contains(&Extra::Metacarpals) {
            for (index, finger) in ["Thumb", "Index", "Middle", "Ring", "Pinky"].iter().enumerate() {
                let from_m = start * along + (0.03 - 0.02 * index as f64) * DVec3::Z;
                self.chain(&format!("{word}Hand{finger}"), hand, on, from_m, 0.03 * along, 4);
            }
        }
        if extras.contains(&Extra::Guns) || (extras.contains(&Extra::Sword) && side == 1) {
            self.chain("Prop", hand, on, 0.08 * along, 0.55 * DVec3::Z, 3);
        }
    }

    fn leg(&mut self, names: &Names, extras: &[Extra], side: usize, parent: usize) {
        let (word, sign) = (WORDS[side], if side == 0 { 1.0 } else { -1.0 });
        let at = |name: &str| Some(part(&format!("{word}{name}")));
        let mut parent = parent;
        for helper in &names.hip_helper {
            let helper_m = sign * 0.04 * DVec3::X;
            let name = names.of(helper, names.sides[side]);
            parent = self.add(&name, Some(parent), Some(part("Hips")), helper_m);
        }
        let name = names.leg.each_ref().map(|pattern| names.of(pattern, names.sides[side]));
        let thigh = self.add(&name[0], Some(parent), at("UpLeg"), DVec3::ZERO);
        let end = self.along(extras, &name[0], thigh, -0.42875 * DVec3::Y);
        let shank = self.add(&name[1], Some(end), at("Leg"), DVec3::ZERO);
        let end = self.along(extras, &name[1], shank, -0.4305 * DVec3::Y);
        let foot = self.add(&name[2], Some(end), at("Foot"), DVec3::ZERO);
        self.legs[side] = [thigh, shank, foot];
        if extras.contains(&Extra::Heels) {
            self.add(&format!("{word}Heel"), Some(foot), at("Foot"), DVec3::new(0.0, -0.06, -0.05));
        }
        let mut toe = foot;
        for (index, pattern) in names.toes.iter().enumerate() {
            let position_m = DVec3::new(0.0, -0.02, 0.065) * index as f64;
            toe = self.add(&names.of(pattern, names.sides[side]), Some(toe), at("ToeBase"), position_m);
        }
        if names.toes.is_empty() {
            self.add(&format!("{word}FootNub"), Some(foot), at("Foot"), DVec3::new(0.0, -0.06, 0.19));
        } else if extras.contains(&Extra::FiveToes) {
            for index in 0..5 {
                let from_m = DVec3::new(0.02 * index as f64 - 0.04, -0.015, 0.03);
                self.chain(
                    &format!("{word}SmallToe{index}"),
                    toe,
                    part(&format!("{word}ToeBase")),
                    from_m,
                    0.02 * DVec3::Z,
                    2,
                );
            }
        }
    }

    fn ornaments(&mut self, extras: &[Extra], [pelvis, chest, head]: [usize; 3]) {
        let [on_hips, on_chest, on_head] = ["Hips", "Spine2", "Head"].map(part);
        for extra in extras {
            match extra {
                Extra::Face => {
                    for feature in 0..24 {
                        let position_m = DVec3::new(0.01 * feature as f64 - 0.12, 0.05, 0.09);
                        self.chain(&format!("face{feature}_"), head, on_head, position_m, 0.01 * DVec3::Z, 2);
                    }
                }
                Extra::TwinTails => {
                    for (word, sign) in WORDS.iter().zip([1.0, -1.0]) {
                        let from_m = DVec3::new(0.1 * sign, 0.1, -0.05);
                        self.chain(
                            &format!("{word}Hair"),
                            head,
                            on_head,
                            from_m,
                            DVec3::new(0.02 * sign, -0.12, 0.0),
                            10,
                        );
                    }
                }
                Extra::Skirt => {
                    for pleat in 0..8 {
                        let turn = DQuat::from_rotation_y(std::f64::consts::TAU * pleat as f64 / 8.0);
                        let (from_m, step_m) = (turn * (0.15 * DVec3::Z), turn * DVec3::new(0.0, -0.14, 0.03));
                        self.chain(&format!("skirt{pleat}_"), pelvis, on_hips, from_m, step_m, 4);
                    }
                }
                Extra::Tail => {
                    self.chain("tail", pelvis, on_hips, -0.1 * DVec3::Z, DVec3::new(0.0, -0.05, -0.15), 8);
                }
                Extra::Wings => {
                    for (word, sign) in WORDS.iter().zip([1.0, -1.0]) {
                        let step_m = DVec3::new(0.55 * sign, 0.3, -0.2);
                        self.chain(
                            &format!("{word}Wing"),
                            chest,
                            on_chest,
                            DVec3::new(0.1 * sign, 0.1, -0.1),
                            step_m,
                            4,
                        );
                    }
                }
                Extra::Cape => {
                    for fold in 0..3 {
                        let from_m = DVec3::new(0.15 * fold as f64 - 0.15, 0.15, -0.12);
                        self.chain(&format!("cape{fold}_"), chest, on_chest, from_m, DVec3::new(0.0, -0.2, -0.02), 6);
                    }
                }
                Extra::Breasts => {
                    for (word, sign) in WORDS.iter().zip([1.0, -1.0]) {
                        let from_m = DVec3::new(0.08 * sign, 0.08, 0.1);
                        self.chain(&format!("{word}Breast"), chest, on_chest, from_m, 0.04 * DVec3::Z, 2);
                    }
                }
                Extra::Backpack => {
                    self.chain("Backpack", chest, on_chest, DVec3::new(0.0, 0.0, -0.2), 0.3 * DVec3::NEG_Y, 2);
                }
                _ => {}
            }
        }
    }

    fn turn(&mut self, body: &Performance, rest: Rest, any_turn: &mut impl FnMut() -> DQuat) {
        let positions_m = body.positions_m(&body.t_pose());
        let position = |bone: &Bone| bone.part.map_or(DVec3::ZERO, |part| positions_m[part] + bone.position_m);
        for index in 0..self.bones.len() {
            let bone = &self.bones[index];
            let Some(on) = bone.part else { continue };
            let name = super::body::PARTS[on];
            let side = if name.starts_with("Left") { 1.0 } else { -1.0 };
            let is_arm = ["Arm", "ForeArm", "Hand"].iter().any(|end| name.ends_with(end));
            let child = self.bones.iter().find(|child| child.parent == Some(index));
            let lowered = |degrees: f64| DQuat::from_rotation_z(side * degrees.to_radians());
            self.bones[index].rest = match rest {
                Rest::APose if is_arm => lowered(45.0),
                Rest::ArmsDown if is_arm => lowered(90.0),
                Rest::TPose | Rest::APose | Rest::ArmsDown => DQuat::IDENTITY,
                Rest::Any => any_turn(),
                Rest::Along(axis) => {
                    let axis = DVec3::AXES[axis / 2] * if axis % 2 == 0 { 1.0 } else { -1.0 };
                    let along = child.map_or(DVec3::Y, |child| position(child) - position(bone)).try_normalize();
                    DQuat::from_rotation_arc(axis, along.unwrap_or(DVec3::Y))
                }
            };
        }
    }
}

//! Hints of a joint's name: a side and parts of the body. Hierarchy and geometry decide; hints weigh in.
//!
//! A name is cut into words at punctuation, digits and capitals (`CC_Base_L_Thigh`, `JtHipLf`, `mixamorig:LeftUpLeg`,
//! `upperleg.l`, `lThigh`).

use motiondb::body::Side;

/// A part of the body that names of joints state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum BodyPart {
    Thigh,
    Shank,
    Foot,
    /// Heel, ball or toe.
    Toe,
    Clavicle,
    UpperArm,
    Forearm,
    Hand,
    Finger,
    Neck,
    Head,
    /// A joint without a role: twist, share, roll and IK bones, parts of the face, ears, tails, clothes, held things.
    Helper,
}

/// Hints of one name.
#[derive(Clone, Debug, Default)]
pub(crate) struct NameHints {
    pub side: Option<Side>,
    /// All parts that the name may mean: a "shoulder" is a clavicle or an upper arm.
    pub parts: Vec<BodyPart>,
}

/// Words for the left side, in lower case.
const LEFT_WORDS: [&str; 4] = ["l", "left", "lf", "lft"];
/// Words for the right side, in lower case.
const RIGHT_WORDS: [&str; 5] = ["r", "right", "rt", "rgt", "rght"];

/// Parts by words. The first row with a word that occurs in a name's joined words counts, so compounds come first.
/// Japanese words are those of MikuMikuDance's models.
const PARTS: [(&[&str], &[BodyPart]); 31] = [
    (&["twist", "share", "roll", "pole", "target", "helper", "slot"], &[BodyPart::Helper]),
    (&["upleg", "upperleg", "thigh", "buttock", "femur"], &[BodyPart::Thigh]),
    (&["lowerleg", "lowleg", "loleg", "knee", "shin", "calf", "tibia", "shank"], &[BodyPart::Shank]),
    (&["toe", "ball", "heel"], &[BodyPart::Toe]),
    (&["foot", "ankle"], &[BodyPart::Foot]),
    (&["thumb", "index", "middle", "mid", "ring", "pinky", "finger"], &[BodyPart::Finger]),
    (&["forearm", "lowerarm", "lowarm", "loarm", "elbow", "ulna", "radius"], &[BodyPart::Forearm]),
    (&["upperarm", "uparm", "shldr", "humerus"], &[BodyPart::UpperArm]),
    (&["clavicle", "collar", "scapula"], &[BodyPart::Clavicle]),
    (&["hand", "wrist", "palm"], &[BodyPart::Hand]),
    (&["shoulder"], &[BodyPart::Clavicle, BodyPart::UpperArm]),
    (&["arm"], &[BodyPart::UpperArm, BodyPart::Forearm]),
    (&["leg"], &[BodyPart::Thigh, BodyPart::Shank, BodyPart::Foot]),
    (&["hip"], &[BodyPart::Thigh]),
    (&["neck"], &[BodyPart::Neck]),
    (&["eye", "jaw", "tongue", "teeth", "hair", "brow", "lip", "cheek"], &[BodyPart::Helper]),
    (&["head", "skull"], &[BodyPart::Head]),
    (&["ik", "ｉｋ", "捩", "キャンセル"], &[BodyPart::Helper]),
    (&["つま先"], &[BodyPart::Toe]),
    (&["足首"], &[BodyPart::Foot]),
    (&["手首"], &[BodyPart::Hand]),
    (&["指"], &[BodyPart::Finger]),
    (&["ひざ"], &[BodyPart::Shank]),
    (&["ひじ"], &[BodyPart::Forearm]),
    (&["足"], &[BodyPart::Thigh]),
    (&["腕"], &[BodyPart::UpperArm]),
    (&["肩"], &[BodyPart::Clavicle]),
    (&["首"], &[BodyPart::Neck]),
    (&["頭"], &[BodyPart::Head]),
    (&["ear", "tail", "wing"], &[BodyPart::Helper]),
    (&["cape", "cloak", "coat", "skirt", "cloth", "dress", "prop", "weapon", "sword"], &[BodyPart::Helper]),
];

/// The hints of a name; a namespace before a colon does not count.
pub(crate) fn hints(name: &str) -> NameHints {
    let words = words(name.rsplit(':').next().unwrap_or(name));
    let joined: String = words.iter().filter(|word| !is_side(word)).map(String::as_str).collect();
    let parts =
        PARTS.iter().find(|(keys, _)| keys.iter().any(|key| joined.contains(key))).map_or(&[][..], |(_, parts)| parts);
    NameHints { side: words.iter().find_map(|word| side(word)), parts: parts.to_vec() }
}

/// First letters of left and right: in English and German, Japanese and Chinese, French, Italian, Spanish, Portuguese,
/// and Slavic languages.
const SIDE_INITIALS: [(char, char); 7] =
    [('l', 'r'), ('左', '右'), ('g', 'd'), ('s', 'd'), ('i', 'd'), ('e', 'd'), ('l', 'p')];

/// Sides of two mirrored joints, by the first letters in which their names differ.
pub(crate) fn sides_by_difference(first: &str, second: &str) -> Option<[Side; 2]> {
    let [first, second] = [first, second].map(|name| name.to_lowercase().chars().collect::<Vec<char>>());
    let difference = first.iter().zip(&second).position(|(a, b)| a != b)?;
    let initials = (first[difference], second[difference]);
    if SIDE_INITIALS.contains(&initials) {
        Some([Side::Left, Side::Right])
    } else {
        SIDE_INITIALS.contains(&(initials.1, initials.0)).then_some([Side::Right, Side::Left])
    }
}

fn is_side(word: &str) -> bool {
    LEFT_WORDS.contains(&word) || RIGHT_WORDS.contains(&word)
}

fn side(word: &str) -> Option<Side> {
    if LEFT_WORDS.contains(&word) || word.starts_with("left") {
        Some(Side::Left)
    } else if RIGHT_WORDS.contains(&word) || word.starts_with("right") {
        Some(Side::Right)
    } else {
        glued_side(word)
    }
}

/// Side of a word that joins a side's letter to a part: `lthigh`, `rhand`.
fn glued_side(word: &str) -> Option<Side> {
    let side = match word.chars().next()? {
        'l' => Side::Left,
        'r' => Side::Right,
        _ => return None,
    };
    let rest = &word[1..];
    let is_part =
        PARTS.iter().any(|(keys, parts)| parts[0] != BodyPart::Helper && keys.iter().any(|key| rest.starts_with(key)));
    is_part.then_some(side)
}

/// Words of letters, in lower case. A capital begins a word; a run of capitals is one word up to its last capital.
pub(crate) fn words(name: &str) -> Vec<String> {
    let letters: Vec<char> = name.chars().collect();
    let mut words = vec![String::new()];
    for (index, &letter) in letters.iter().enumerate() {
        let after_lower = index > 0 && letters[index - 1].is_lowercase();
        let before_lower = letters.get(index + 1).is_some_and(|next| next.is_lowercase());
        if !letter.is_alphabetic() || (letter.is_uppercase() && (after_lower || before_lower)) {
            words.push(String::new());
        }
        if let Some(word) = words.last_mut().filter(|_| letter.is_alphabetic()) {
            word.extend(letter.to_lowercase());
        }
    }
    words.retain(|word| !word.is_empty());
    words
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn check(name: &str, side: Option<Side>, part: BodyPart) {
        let found = hints(name);
        assert_eq!(found.side, side, "{name}: {:?}", words(name));
        assert!(found.parts.contains(&part), "{name}: {found:?}");
    }

    #[test]
    fn names_of_common_tools_are_understood() {
        check("mixamorig:LeftUpLeg", Some(Side::Left), BodyPart::Thigh);
        check("CC_Base_R_Calf", Some(Side::Right), BodyPart::Shank);
        check("JtHipLf", Some(Side::Left), BodyPart::Thigh);
        check("JtBallRt", Some(Side::Right), BodyPart::Toe);
        check("Skeleton_leg_joint_L_1", Some(Side::Left), BodyPart::Thigh);
        check("lButtock", Some(Side::Left), BodyPart::Thigh);
        check("rShldr", Some(Side::Right), BodyPart::UpperArm);
        check("upperarm.l", Some(Side::Left), BodyPart::UpperArm);
        check("Bip01 L Forearm", Some(Side::Left), BodyPart::Forearm);
        check("lthigh", Some(Side::Left), BodyPart::Thigh);
        check("LHipJoint", Some(Side::Left), BodyPart::Thigh);
        check("CC_Base_L_CalfTwist01", Some(Side::Left), BodyPart::Helper);
        check("torso_head", None, BodyPart::Head);
        check("rTorso_Clavicle", Some(Side::Right), BodyPart::Clavicle);
        check("UpArm_L", Some(Side::Left), BodyPart::UpperArm);
        check("右足首", None, BodyPart::Foot);
        check("左ひざ", None, BodyPart::Shank);
        check("足ＩＫ.L", Some(Side::Left), BodyPart::Helper);
        check("首", None, BodyPart::Neck);
        check("LongCape_L_02", Some(Side::Left), BodyPart::Helper);
        check("hand_prop_r", Some(Side::Right), BodyPart::Hand);
    }
}

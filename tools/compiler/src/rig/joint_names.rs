//! What a joint's name hints at: a side and a set of anatomical parts. Hints only: hierarchy and geometry decide, names
//! break ties.
//!
//! Words are cut at punctuation, digits and capitals (`CC_Base_L_Thigh`, `JtHipLf`, `mixamorig:LeftUpLeg`,
//! `upperleg.l`, `lThigh`).

use motiondb::body::Side;

/// Anatomical parts that rigs' names tell apart; one word may fit several (a "shoulder" is a clavicle or an upper arm).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Part {
    Thigh,
    Shank,
    Foot,
    /// All of the foot that is not the ankle.
    Toe,
    Clavicle,
    UpperArm,
    Forearm,
    Hand,
    Finger,
    Neck,
    Head,
    /// Twist, share, roll and IK bones: never a role of their own.
    Helper,
}

/// The hints of one name.
#[derive(Clone, Debug, Default)]
pub(crate) struct NameHints {
    pub side: Option<Side>,
    pub parts: Vec<Part>,
}

const LEFT_WORDS: [&str; 4] = ["l", "left", "lf", "lft"];
const RIGHT_WORDS: [&str; 5] = ["r", "right", "rt", "rgt", "rght"];

/// Compound before simple: the first line that matches a name's words (joined without gaps) gives its parts.
/// The Japanese ones are those of MikuMikuDance's models.
const PARTS: [(&[&str], &[Part]); 29] = [
    (&["twist", "share", "roll", "pole", "target", "helper", "slot"], &[Part::Helper]),
    (&["upleg", "upperleg", "thigh", "buttock", "femur"], &[Part::Thigh]),
    (&["lowerleg", "lowleg", "loleg", "knee", "shin", "calf", "tibia", "shank"], &[Part::Shank]),
    (&["toe", "ball", "heel"], &[Part::Toe]),
    (&["foot", "ankle"], &[Part::Foot]),
    (&["thumb", "index", "middle", "mid", "ring", "pinky", "finger"], &[Part::Finger]),
    (&["forearm", "lowerarm", "lowarm", "loarm", "elbow", "ulna", "radius"], &[Part::Forearm]),
    (&["upperarm", "uparm", "shldr", "humerus"], &[Part::UpperArm]),
    (&["clavicle", "collar", "scapula"], &[Part::Clavicle]),
    (&["hand", "wrist", "palm"], &[Part::Hand]),
    (&["shoulder"], &[Part::Clavicle, Part::UpperArm]),
    (&["arm"], &[Part::UpperArm, Part::Forearm]),
    (&["leg"], &[Part::Thigh, Part::Shank, Part::Foot]),
    (&["hip"], &[Part::Thigh]),
    (&["neck"], &[Part::Neck]),
    (&["eye", "jaw", "tongue", "teeth", "hair", "brow", "lip", "cheek"], &[Part::Helper]),
    (&["head", "skull"], &[Part::Head]),
    (&["ik", "ｉｋ", "捩", "キャンセル"], &[Part::Helper]),
    (&["つま先"], &[Part::Toe]),
    (&["足首"], &[Part::Foot]),
    (&["手首"], &[Part::Hand]),
    (&["指"], &[Part::Finger]),
    (&["ひざ"], &[Part::Shank]),
    (&["ひじ"], &[Part::Forearm]),
    (&["足"], &[Part::Thigh]),
    (&["腕"], &[Part::UpperArm]),
    (&["肩"], &[Part::Clavicle]),
    (&["首"], &[Part::Neck]),
    (&["頭"], &[Part::Head]),
];

/// Reads the hints of a name.
pub(crate) fn hints(name: &str) -> NameHints {
    let words = words(name.rsplit(':').next().unwrap_or(name));
    let joined: String = words.iter().filter(|word| !is_side(word)).map(String::as_str).collect();
    let parts =
        PARTS.iter().find(|(keys, _)| keys.iter().any(|key| joined.contains(key))).map_or(&[][..], |(_, parts)| parts);
    NameHints { side: words.iter().find_map(|word| side(word)), parts: parts.to_vec() }
}

/// What two mirrored joints' names differ in, by its first letters: left and right in English and German, in Japanese
/// and Chinese, French, Italian, Spanish, Portuguese and Slavic languages.
const SIDE_INITIALS: [(char, char); 7] =
    [('l', 'r'), ('左', '右'), ('g', 'd'), ('s', 'd'), ('i', 'd'), ('e', 'd'), ('l', 'p')];

/// The sides of two mirrored joints, told by what is left of their names without what they share at either end.
pub(crate) fn sides(first: &str, second: &str) -> Option<[Side; 2]> {
    let [first, second] = [first, second].map(|name| name.to_lowercase().chars().collect::<Vec<char>>());
    let unlike = first.iter().zip(&second).position(|(a, b)| a != b)?;
    let initials = (first[unlike], second[unlike]);
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

/// `lthigh`, `rhand`: a side's letter glued to a part.
fn glued_side(word: &str) -> Option<Side> {
    let side = match word.chars().next()? {
        'l' => Side::Left,
        'r' => Side::Right,
        _ => return None,
    };
    let rest = &word[1..];
    let is_part =
        PARTS.iter().any(|(keys, parts)| parts[0] != Part::Helper && keys.iter().any(|key| rest.starts_with(key)));
    is_part.then_some(side)
}

/// Lower-case words of letters; a capital begins one, a run of capitals is one up to its last.
fn words(name: &str) -> Vec<String> {
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
    fn check(name: &str, side: Option<Side>, part: Part) {
        let found = hints(name);
        assert_eq!(found.side, side, "{name}: {:?}", words(name));
        assert!(found.parts.contains(&part), "{name}: {found:?}");
    }

    #[test]
    fn the_name_families_in_use_are_understood() {
        check("mixamorig:LeftUpLeg", Some(Side::Left), Part::Thigh);
        check("CC_Base_R_Calf", Some(Side::Right), Part::Shank);
        check("JtHipLf", Some(Side::Left), Part::Thigh);
        check("JtBallRt", Some(Side::Right), Part::Toe);
        check("Skeleton_leg_joint_L_1", Some(Side::Left), Part::Thigh);
        check("lButtock", Some(Side::Left), Part::Thigh);
        check("rShldr", Some(Side::Right), Part::UpperArm);
        check("upperarm.l", Some(Side::Left), Part::UpperArm);
        check("Bip01 L Forearm", Some(Side::Left), Part::Forearm);
        check("lthigh", Some(Side::Left), Part::Thigh);
        check("LHipJoint", Some(Side::Left), Part::Thigh);
        check("CC_Base_L_CalfTwist01", Some(Side::Left), Part::Helper);
        check("torso_head", None, Part::Head);
        check("rTorso_Clavicle", Some(Side::Right), Part::Clavicle);
        check("UpArm_L", Some(Side::Left), Part::UpperArm);
        check("右足首", None, Part::Foot);
        check("左ひざ", None, Part::Shank);
        check("足ＩＫ.L", Some(Side::Left), Part::Helper);
        check("首", None, Part::Neck);
    }
}

//! What a joint's name says about an extra joint: which finger or toe it belongs to, and whether it is a twist bone.
//!
//! Names of common tools: `LeftHandIndex1` (Mixamo), `index_01_l` (Unreal), `leftIndexProximal` (VRM), `f_index.01.L`
//! (Rigify), `CC_Base_L_Mid1` (iClone), `finger2-1.L` (MakeHuman), `Bip01 L Finger1` (Biped), `左人指１` (MikuMikuDance).

use crate::rig::joint_names::words;

/// Words of each finger from the thumb to the little finger, in lower case.
const FINGERS: [&[&str]; 5] = [
    &["thumb", "親指"],
    &["index", "pointer", "人指", "人差指"],
    &["middle", "mid", "中指"],
    &["ring", "薬指"],
    &["pinky", "pinkie", "little", "小指"],
];
/// Words of each toe from the great toe to the little one, in lower case.
const TOES: [&[&str]; 5] = [&["big", "great", "thumb"], &["index"], &["mid"], &["ring"], &["pinky", "little"]];
/// Words of joints that are no finger: bones of the palm, tips, controls.
const NO_FINGER: [&str; 13] = [
    "metacarpal",
    "carpal",
    "palm",
    "end",
    "tip",
    "nub",
    "effector",
    "ik",
    "target",
    "ctrl",
    "twist",
    "share",
    "helper",
];
/// Words of joints that bear `roll` or `twist` and do not twist with a limb.
const NO_TWIST: [&str; 12] =
    ["ik", "pole", "ctrl", "target", "foot", "toe", "heel", "ball", "ankle", "hand", "finger", "neck"];

/// The finger or toe that a name states.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Digit {
    /// By its word: 0 for the thumb or the great toe, 4 for the little one.
    Named(usize),
    /// By a number, which tools count from 0 or from 1.
    Numbered(usize),
}

/// The finger that a name states; `None` for other joints. A metacarpal of the thumb is its first joint.
pub(crate) fn finger(name: &str) -> Option<Digit> {
    let (joined, words) = joined_words(name);
    let named = FINGERS.iter().position(|keys| keys.iter().any(|key| joined.contains(key)));
    let is_palm = words.windows(2).any(|pair| pair == ["in", "hand"]);
    let is_other = |word: &String| NO_FINGER.contains(&word.as_str()) && !(named == Some(0) && word.contains("carpal"));
    if is_palm || words.iter().any(is_other) {
        return None;
    }
    named.map(Digit::Named).or_else(|| number_after(name, "finger").map(Digit::Numbered))
}

/// The toe that a name states; `None` for other joints.
pub(crate) fn toe(name: &str) -> Option<Digit> {
    let (joined, words) = joined_words(name);
    if !joined.contains("toe") || words.iter().any(|word| NO_FINGER.contains(&word.as_str())) {
        return None;
    }
    let named = TOES.iter().position(|keys| keys.iter().any(|key| joined.contains(key)));
    named.map(Digit::Named).or_else(|| number_after(name, "toe").map(Digit::Numbered))
}

/// Whether a name is that of a bone that shares the twist of a limb.
pub(crate) fn is_twist(name: &str) -> bool {
    let (joined, words) = joined_words(name);
    let is_word = |word: &String| word.starts_with("twist") || word.starts_with("roll");
    (words.iter().any(is_word) || joined.contains('捩')) && !words.iter().any(|word| NO_TWIST.contains(&word.as_str()))
}

/// The last number of a name.
pub(crate) fn last_number(name: &str) -> Option<usize> {
    let name = without_namespace(name);
    let end = name.rfind(|letter: char| letter.is_ascii_digit())? + 1;
    let start = name[..end].rfind(|letter: char| !letter.is_ascii_digit());
    let start = start.map_or(0, |start| start + name[start..].chars().next().map_or(1, char::len_utf8));
    name[start..end].parse().ok()
}

/// The first digit after a word.
fn number_after(name: &str, word: &str) -> Option<usize> {
    let name = without_namespace(name).to_lowercase();
    let rest = &name[name.find(word)? + word.len()..];
    let digit = rest.chars().find(|letter| letter.is_alphanumeric())?;
    digit.to_digit(10).map(|digit| digit as usize)
}

fn joined_words(name: &str) -> (String, Vec<String>) {
    let words = words(without_namespace(name));
    (words.concat(), words)
}

fn without_namespace(name: &str) -> &str {
    name.rsplit(':').next().unwrap_or(name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fingers_of_common_tools_are_understood() {
        for (name, wanted) in [
            ("mixamorig:LeftHandIndex1", Some(Digit::Named(1))),
            ("index_01_l", Some(Digit::Named(1))),
            ("leftThumbMetacarpal", Some(Digit::Named(0))),
            ("index_metacarpal_l", None),
            ("leftLittleDistal", Some(Digit::Named(4))),
            ("DEF-f_middle.02.L", Some(Digit::Named(2))),
            ("CC_Base_L_Mid1", Some(Digit::Named(2))),
            ("LThumb", Some(Digit::Named(0))),
            ("LeftInHandRing", None),
            ("LeftFingerBase", None),
            ("finger2-1.L", Some(Digit::Numbered(2))),
            ("Bip01 L Finger01", Some(Digit::Numbered(0))),
            ("左小指１", Some(Digit::Named(4))),
            ("Ring2.L_end", None),
            ("LeftHand", None),
        ] {
            assert_eq!(finger(name), wanted, "{name}");
        }
    }

    #[test]
    fn toes_twists_and_numbers_are_understood() {
        assert_eq!(toe("CC_Base_L_BigToe1"), Some(Digit::Named(0)));
        assert_eq!(toe("toe3-1.L"), Some(Digit::Numbered(3)));
        assert_eq!([toe("LeftToeBase"), toe("LeftToe_End")], [None; 2]);
        assert!(is_twist("CC_Base_L_ForearmTwist01") && is_twist("JtUpperArmTwistBRt") && is_twist("LeftArmRoll"));
        assert!(!is_twist("foot_roll_L") && !is_twist("LeftArm"));
        assert_eq!(["Index12_L", "__Index1_L", "LThumb", "左人指"].map(last_number), [Some(12), Some(1), None, None]);
    }
}

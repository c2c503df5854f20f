//! The words of names: known manners of moving, and words that make no style.

use std::collections::BTreeSet;

use crate::rig::joint_names::words;

/// Words for manners of moving that folders are named by: those of the published sets, and near ones.
const MANNERS: [&str; 75] = [
    "active",
    "aeroplane",
    "aged",
    "akimbo",
    "angry",
    "balance",
    "brisk",
    "casual",
    "cat",
    "cheerful",
    "chicken",
    "childish",
    "childlike",
    "chimpira",
    "cool",
    "crouched",
    "depressed",
    "dinosaur",
    "drunk",
    "elated",
    "elderly",
    "excited",
    "exhausted",
    "feminine",
    "flapping",
    "giant",
    "graceful",
    "happy",
    "heavy",
    "heavyset",
    "hurried",
    "injured",
    "joyful",
    "kangaroo",
    "lame",
    "limp",
    "limping",
    "lively",
    "march",
    "marching",
    "masculine",
    "morris",
    "musical",
    "neutral",
    "normal",
    "not-confident",
    "old",
    "penguin",
    "proud",
    "quail",
    "relaxed",
    "roadrunner",
    "robot",
    "rocket",
    "rushed",
    "sad",
    "scared",
    "sexy",
    "shy",
    "sleepy",
    "sneaky",
    "star",
    "stiff",
    "strutting",
    "stumbling",
    "superman",
    "swagger",
    "tiptoe",
    "tired",
    "wary",
    "weak",
    "wild",
    "young",
    "youthful",
    "zombie",
];
/// Words for people: without a manner beside them they name no style.
const PEOPLE: [&str; 23] = [
    "actor",
    "actors",
    "actress",
    "boy",
    "boys",
    "child",
    "children",
    "female",
    "females",
    "girl",
    "girls",
    "ladies",
    "lady",
    "male",
    "males",
    "man",
    "men",
    "people",
    "performer",
    "person",
    "subject",
    "woman",
    "women",
];
/// Manners that are things, too: beside other words they name no manner, as in `RobotArm`.
const THINGS: [&str; 16] = [
    "aeroplane",
    "balance",
    "cat",
    "chicken",
    "dinosaur",
    "giant",
    "kangaroo",
    "morris",
    "musical",
    "penguin",
    "quail",
    "roadrunner",
    "robot",
    "rocket",
    "star",
    "superman",
];
/// Words of which one makes a folder an archive of clips.
const ARCHIVES: [&str; 9] =
    ["archive", "archived", "backup", "copy", "deprecated", "project", "projects", "takes", "unused"];
/// Words for movements, directions, speeds and parts of a collection: folders of these names alone hold no style.
const MOVEMENTS: [&str; 52] = [
    "animation",
    "animations",
    "anims",
    "back",
    "backward",
    "bvh",
    "circle",
    "clips",
    "copy",
    "data",
    "dataset",
    "fast",
    "fbx",
    "forward",
    "gait",
    "gaits",
    "glb",
    "gltf",
    "idle",
    "idles",
    "jog",
    "jogs",
    "jump",
    "left",
    "locomotion",
    "misc",
    "mocap",
    "motion",
    "motions",
    "other",
    "raw",
    "right",
    "run",
    "runs",
    "side",
    "slow",
    "sprint",
    "stand",
    "start",
    "step",
    "stop",
    "strafe",
    "take",
    "takes",
    "test",
    "train",
    "turn",
    "turns",
    "val",
    "walk",
    "walking",
    "walks",
];

/// Whether a word is a known manner.
pub(crate) fn is_manner(word: &str) -> bool {
    MANNERS.contains(&word)
}

/// The known manner in a name; none where there are several, where the name is that of an archive, or where a manner that is
/// a thing, too, stands beside other words than those for movements.
pub(crate) fn manner_in(name: &str) -> Option<&'static str> {
    let words = words(name);
    if words.iter().any(|word| ARCHIVES.contains(&word.as_str())) {
        return None;
    }
    let said: Vec<&str> = words.iter().map(String::as_str).filter(|word| !MOVEMENTS.contains(word)).collect();
    if let Some(whole) = manner_of(&said.join("-")) {
        return Some(whole);
    }
    let manners: BTreeSet<&'static str> = said.iter().filter_map(|word| manner_of(word)).collect();
    manners.first().copied().filter(|manner| manners.len() == 1 && !THINGS.contains(manner))
}

/// The known manner that a word names, also in the plural: `drunks`.
fn manner_of(word: &str) -> Option<&'static str> {
    let named = |word: &str| MANNERS.into_iter().find(|manner| *manner == word);
    named(word).or_else(|| named(word.strip_suffix('s')?))
}

/// Whether a letter joins two words.
pub(crate) fn is_joint(letter: char) -> bool {
    matches!(letter, '_' | '-' | ' ' | '.')
}

/// Letters, and what joins words.
pub(crate) fn is_word(name: &str) -> bool {
    name.chars().any(char::is_alphabetic) && name.chars().all(|letter| letter.is_alphabetic() || is_joint(letter))
}

/// Whether a style may have this name: no number, no movement.
pub(crate) fn is_style_word(name: &str) -> bool {
    let is_other = |word: &str| MOVEMENTS.contains(&word) || PEOPLE.contains(&word);
    is_word(name) && name.chars().count() > 2 && !name.split(is_joint).any(is_other)
}

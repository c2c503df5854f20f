//! Paths of clips → the styles that they name, where a set is arranged by styles. A manifest overrides them.
//!
//! 1. File names of published sets: `Angry_FW.bvh` beside other movements of the same style (100STYLE),
//!    `dataset-1_walk_elderly_001.bvh` (Bandai Namco), `strutting_01_000.bvh` (Xia et al. 2015).
//! 2. Folders side by side of at least two known manners of moving. Other words may stand beside the manner:
//!    `01_elderly`, `Happy Walk`, `SadAnna`, `drunks`.
//! 3. Beside these, folders that hold a walk, by its name, and are named by words without digits.
//!
//! So folders of subjects, sexes, takes and movements are no styles. Nor are those with words for archives (`old_takes`), with
//! two manners, or with a manner that is a thing, too (`RobotArm`).
//!
//! A style is a manner in which anybody can move: old, drunk, happy. Who moves is none, a woman, a child or an actor:
//! other bodies of another sex are no reason for an agent to move otherwise.
//!
//! Names of styles are in lower case.

use std::collections::{BTreeMap, BTreeSet};
use std::ffi::OsStr;
use std::path::Path;

use motiondb::validate::is_style_name;

use crate::input::style_words::{is_joint, is_manner, is_style_word, is_word, manner_in};

/// Movements of 100STYLE (Mason et al. 2022): forward, backward and sideways walks and runs, idle, transitions.
const MOVEMENT_CODES: [&str; 10] = ["bw", "br", "fw", "fr", "id", "sw", "sr", "tr1", "tr2", "tr3"];
/// The styles of Xia et al. 2015.
const XIA_STYLES: [&str; 8] = ["angry", "childlike", "depressed", "neutral", "old", "proud", "sexy", "strutting"];
/// Styles that serve agents without a style where no clip is without one, the first that the set has.
pub(crate) const NEUTRAL_STYLES: [&str; 2] = ["neutral", "normal"];

/// The style of each clip by its path; empty where it names none.
pub(crate) fn found_styles(paths: &[&Path]) -> Vec<String> {
    let of_folders = StyleFolders::of(paths);
    let of_codes = styles_of_movement_codes(paths);
    let of_path = |path: &&Path| {
        let found = style_of_name(path, &of_codes).or_else(|| of_folders.style(path));
        found.filter(|name| is_style_name(name)).unwrap_or_default()
    };
    paths.iter().map(of_path).collect()
}

/// The style in a file name of a published set.
fn style_of_name(path: &Path, of_codes: &BTreeSet<String>) -> Option<String> {
    let stem = stem(path);
    let is_number = |word: &str, digits: usize| word.len() == digits && word.bytes().all(|b| b.is_ascii_digit());
    match stem.split('_').collect::<Vec<&str>>()[..] {
        [set, _, style, number] if set.starts_with("dataset-") && is_number(number, 3) && is_word(style) => {
            Some(style.to_owned())
        }
        [style, movement, take] if XIA_STYLES.contains(&style) && is_number(movement, 2) && is_number(take, 3) => {
            Some(style.to_owned())
        }
        _ => {
            let (style, code) = stem.rsplit_once('_')?;
            (of_codes.contains(style) && MOVEMENT_CODES.contains(&code)).then(|| style.to_owned())
        }
    }
}

/// Styles that have a walk by the codes of 100STYLE, and known manners with any movement; where one of the styles has a walk and
/// another movement, or two known manners have codes.
fn styles_of_movement_codes(paths: &[&Path]) -> BTreeSet<String> {
    let mut codes: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for path in paths {
        let stem = stem(path);
        let Some((style, code)) = stem.rsplit_once('_') else { continue };
        if MOVEMENT_CODES.contains(&code) && is_style_word(style) {
            codes.entry(style.to_owned()).or_default().insert(code.to_owned());
        }
    }
    let is_whole = |codes: &BTreeSet<String>| codes.contains("fw") && codes.len() > 1;
    let manners = codes.keys().filter(|style| is_manner(style)).count();
    let is_set = codes.values().any(is_whole) || manners > 1;
    codes.retain(|style, codes| is_set && (codes.contains("fw") || is_manner(style)));
    codes.into_keys().collect()
}

/// Known manners in the names of clips and of their folders, below the folder that holds them all; in alphabetical order. None
/// if there is but one, in the names of files: it may be a speed.
pub(crate) fn manners_in_names(paths: &[&Path]) -> BTreeSet<&'static str> {
    let folder = |path: &&Path| path.parent().map(Path::to_path_buf).unwrap_or_default();
    let shared = paths.iter().map(folder).reduce(|shared, other| {
        shared.ancestors().find(|ancestor| other.starts_with(ancestor)).map(Path::to_path_buf).unwrap_or_default()
    });
    let shared = shared.unwrap_or_default();
    let manner = |part: &OsStr| manner_in(&part.to_string_lossy());
    let folders = |path: &&'_ Path| -> Vec<&'static str> {
        let below = path.strip_prefix(&shared).unwrap_or(path).parent();
        below.into_iter().flatten().filter_map(manner).collect()
    };
    let of_folders: BTreeSet<&str> = paths.iter().flat_map(folders).collect();
    let of_files: BTreeSet<&str> = paths.iter().filter_map(|path| path.file_stem().and_then(manner)).collect();
    if of_folders.is_empty() && of_files.len() < 2 {
        return BTreeSet::new();
    }
    of_folders.union(&of_files).copied().collect()
}

/// Folders that hold the clips of one style, and the style of each.
struct StyleFolders<'a> {
    styles: BTreeMap<&'a Path, String>,
}

/// A folder that may hold the clips of one style.
struct StyleFolder {
    /// Its name, in lower case.
    name: String,
    /// The known manner in its name.
    manner: Option<&'static str>,
    /// It holds a clip that is a walk by its name.
    has_walk: bool,
}

impl<'a> StyleFolders<'a> {
    fn of(paths: &[&'a Path]) -> Self {
        let mut siblings: BTreeMap<&Path, BTreeMap<&Path, StyleFolder>> = BTreeMap::new();
        for path in paths {
            for folder in path.ancestors().skip(1) {
                let (Some(parent), Some(name)) = (folder.parent(), folder.file_name()) else { continue };
                let Some(name) = name.to_str() else { continue };
                let found =
                    siblings.entry(parent).or_default().entry(folder).or_insert_with(|| StyleFolder::named(name));
                found.has_walk |= is_walk(&without(&stem(path), &found.name));
            }
        }
        let (mut styles, mut others) = (BTreeMap::new(), Vec::new());
        for folders in siblings.into_values() {
            let manners: BTreeSet<&str> = folders.values().filter_map(|found| found.manner).collect();
            for (folder, found) in &folders {
                if let Some(style) = found.style().filter(|_| manners.len() > 1) {
                    styles.insert(*folder, style);
                } else if let Some(manner) = found.manner {
                    others.push((*folder, manner.to_owned()));
                }
            }
        }
        // A manner that is a style elsewhere in the set: `bob/angry` beside `anna/angry` and `anna/happy`.
        let found: BTreeSet<String> = styles.values().cloned().collect();
        styles.extend(others.into_iter().filter(|(_, manner)| found.contains(manner)));
        Self { styles }
    }

    /// The style of the innermost such folder around a clip.
    fn style(&self, path: &Path) -> Option<String> {
        path.ancestors().skip(1).find_map(|folder| self.styles.get(folder)).cloned()
    }
}

impl StyleFolder {
    fn named(name: &str) -> Self {
        Self { name: name.to_lowercase(), manner: manner_in(name), has_walk: false }
    }

    /// The style, among folders that are styles: the manner, or of a folder with a walk its name.
    fn style(&self) -> Option<String> {
        let of_walk = || (self.has_walk && is_style_word(&self.name)).then(|| self.name.clone());
        self.manner.map(str::to_owned).or_else(of_walk)
    }
}

/// The name of a file without its extension, in lower case.
fn stem(path: &Path) -> String {
    path.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().to_lowercase())
}

/// The name of a clip without that of its folder and what joins both.
fn without(stem: &str, folder: &str) -> String {
    stem.replacen(folder, "", 1).trim_matches(is_joint).to_owned()
}

/// Whether a clip is a walk by its name without the folder's.
fn is_walk(name: &str) -> bool {
    name.contains("walk") || name == "fw"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn check(paths: &[(&str, &str)]) {
        let found = found_styles(&paths.iter().map(|(path, _)| Path::new(path)).collect::<Vec<_>>());
        let wanted: Vec<&str> = paths.iter().map(|(_, style)| *style).collect();
        assert_eq!(found, wanted, "{paths:?}");
    }

    #[test]
    fn folders_that_each_hold_a_walk_are_styles() {
        check(&[
            ("set/Elderly/walk.bvh", "elderly"),
            ("set/Elderly/turns/turn_left.bvh", "elderly"),
            ("set/brisk/walk.bvh", "brisk"),
            ("set/idles/idle.bvh", ""),
            ("set/walk_110.bvh", ""),
        ]);
        check(&[("neutral/walk_slow.bvh", "neutral"), ("cheerful/cheerful_walk.glb", "cheerful"), ("run.bvh", "")]);
    }

    #[test]
    fn folders_of_movements_subjects_and_sources_are_no_styles() {
        check(&[("walks/walk.bvh", ""), ("runs/walk_run.bvh", "")]);
        check(&[("left/walk.bvh", ""), ("right/walk.bvh", "")]);
        check(&[("subject_07/walk.bvh", ""), ("subject_12/walk.bvh", "")]);
        check(&[("07/walk.bvh", ""), ("12/walk.bvh", "")]);
        check(&[("vendor/walk1.bvh", ""), ("studio/ezgi_walk.bvh", "")]);
        check(&[("elderly/walk.bvh", ""), ("elderly/walk_fast.bvh", "")]);
        check(&[("elderly/walk.bvh", ""), ("studio/run.bvh", "")]);
    }

    #[test]
    fn folders_of_two_manners_are_styles() {
        check(&[("elderly/take001.bvh", "elderly"), ("happy/take001.bvh", "happy"), ("studio/take001.bvh", "")]);
        check(&[("01_elderly/a.bvh", "elderly"), ("02_happy/a.bvh", "happy"), ("03/a.bvh", "")]);
        check(&[("Elderly Walk/a.bvh", "elderly"), ("Not Confident/a.bvh", "not-confident")]);
        check(&[
            ("01_not_confident/a.bvh", "not-confident"),
            ("02_robots/a.bvh", "robot"),
            ("Old_OldMan/a.bvh", "old"),
        ]);
        check(&[("01_elderly/walk.bvh", ""), ("02_elderly/walk.bvh", "")]);
        check(&[("Elderly_v2/a.bvh", "elderly"), ("Drunk_final/a.bvh", "drunk"), ("Normal/a.bvh", "normal")]);
        check(&[("OldManWalk/a.bvh", "old"), ("DrunkWalk/a.bvh", "drunk"), ("Walk/a.bvh", "")]);
        check(&[("Zombies/a.bvh", "zombie"), ("drunks/a.bvh", "drunk"), ("Civilians/a.bvh", "")]);
        check(&[("Old Man/a.bvh", "old"), ("Elderly Woman/a.bvh", "elderly"), ("Woman/a.bvh", "")]);
        check(&[("anna/angry/a.bvh", "angry"), ("anna/happy/a.bvh", "happy"), ("bob/angry/a.bvh", "angry")]);
        check(&[("men/elderly/a.bvh", "elderly"), ("women/elderly/a.bvh", "elderly"), ("men/happy/a.bvh", "happy")]);
        check(&[("sad_anna/a.bvh", "sad"), ("happy anna/a.bvh", "happy"), ("sad_bob/a.bvh", "sad")]);
    }

    #[test]
    fn archives_and_mixed_manners_are_no_styles() {
        check(&[("old_project/a.bvh", ""), ("active_archive/a.bvh", "")]);
        check(&[("old_takes/a.bvh", ""), ("active_takes/a.bvh", "")]);
        check(&[("sad_happy_anna/a.bvh", ""), ("happy_anna/a.bvh", "")]);
        check(&[("RobotExpressive/walk.bvh", ""), ("StarCaptain/walk.bvh", "")]);
        check(&[("Mixamo/walk.bvh", ""), ("CMU/walk.bvh", ""), ("old/walk.bvh", "")]);
    }

    #[test]
    fn manners_in_names_are_found() {
        let found = |paths: &[&str]| {
            let paths: Vec<&Path> = paths.iter().map(Path::new).collect();
            manners_in_names(&paths).into_iter().collect::<Vec<_>>()
        };
        let files = ["a/elderly_walk.bvh", "a/Walk-Happy.glb", "a/happy.bvh", "a/walk_110.bvh", "a/RobotArm.glb"];
        assert_eq!(found(&files), ["elderly", "happy"]);
        assert_eq!(found(&["/old/my/happy/sad_anna/a.bvh", "/old/my/happy/bob/OldWalk.bvh"]), ["old", "sad"]);
        assert_eq!(found(&["a/walk.bvh", "a/elderly/walk.bvh"]), ["elderly"]);
        assert!(found(&["a/walk.bvh", "a/brisk_walk.bvh"]).is_empty());
        assert!(found(&["a/old_project/walk.bvh", "a/walk.bvh"]).is_empty());
    }

    #[test]
    fn who_moves_is_no_style() {
        check(&[("men/walk.bvh", ""), ("women/walk.bvh", "")]);
        check(&[("Male/walk_fast.bvh", ""), ("Female/walk_fast.bvh", "")]);
        check(&[("anna/walk.bvh", ""), ("peter/walk.bvh", "")]);
        check(&[("adults/walk.bvh", ""), ("children/walk.bvh", "")]);
        check(&[
            ("women/old/walk.bvh", "old"),
            ("women/happy/walk.bvh", "happy"),
            ("men/old/walk.bvh", "old"),
            ("men/happy/walk.bvh", "happy"),
        ]);
        check(&[("masculine/walk.bvh", "masculine"), ("feminine/walk.bvh", "feminine"), ("women/walk.bvh", "")]);
    }

    #[test]
    fn names_of_published_sets_state_styles() {
        check(&[("100STYLE/Angry/Angry_FW.bvh", "angry"), ("100STYLE/Angry/Angry_ID.bvh", "angry")]);
        check(&[("Angry_FW.bvh", "angry"), ("Angry_BW.bvh", "angry"), ("Happy_FW.bvh", "happy"), ("Take_FW.bvh", "")]);
        check(&[
            ("Neutral_FW.bvh", "neutral"),
            ("Neutral_ID.bvh", "neutral"),
            ("LimpRight_FW.bvh", "limpright"),
            ("HandsInPockets_FW.bvh", "handsinpockets"),
        ]);
        check(&[("Angry_FW.bvh", "angry"), ("Old_FW.bvh", "old"), ("BeatChest_FW.bvh", "beatchest")]);
        check(&[("BeatChest_FW.bvh", "beatchest"), ("BeatChest_TR1.bvh", "beatchest"), ("Walk_FW.bvh", "")]);
        check(&[
            ("dataset-1_walk_elderly_001.bvh", "elderly"),
            ("dataset-2_walk-turn-left_not-confident_003.bvh", "not-confident"),
        ]);
        check(&[("neutral_01_000.bvh", "neutral"), ("capture_01_000.bvh", ""), ("walk_fast_001.bvh", "")]);
    }
}

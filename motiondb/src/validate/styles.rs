//! Invariants between the styles of a set. Each style is a database of its own, with all other invariants.

use crate::motion::motion_db::MotionDb;
use crate::validate::{CheckResult, ensure};

/// Greatest length of a style's name, bytes.
const NAME_MAX_BYTES: usize = 64;

/// Whether a style may have this name: letters, digits, and between them spaces, `-` and `_`. Pictures of a style lie
/// in a folder of its name.
///
/// ```
/// use motiondb::validate::is_style_name;
///
/// assert!(is_style_name("not-confident") && is_style_name("älter 2"));
/// assert!(!is_style_name("") && !is_style_name("../angry") && !is_style_name(" angry"));
/// ```
pub fn is_style_name(name: &str) -> bool {
    let is_letter = |letter: char| letter.is_alphanumeric() || matches!(letter, ' ' | '-' | '_');
    !name.is_empty() && name.trim() == name && name.len() <= NAME_MAX_BYTES && name.chars().all(is_letter)
}

/// Further styles are sorted by name, no name occurs twice, and none has further styles itself.
pub(crate) fn styles_are_unique(db: &MotionDb) -> CheckResult {
    let further = &db.further_styles;
    if let Some(bad) = db.styles().find(|db| !db.style.is_empty() && !is_style_name(&db.style)) {
        return Err(format!("`{}` cannot name a style", bad.style.escape_debug()));
    }
    if let Some(pair) = further.windows(2).find(|pair| pair[0].style >= pair[1].style) {
        let [first, second] = [&pair[0].style, &pair[1].style];
        return Err(format!("styles are not sorted or not unique: `{first}` is followed by `{second}`"));
    }
    ensure(further.iter().all(|other| other.style != db.style), || format!("there are two styles `{}`", db.style))?;
    let nested = further.iter().find(|other| !other.further_styles.is_empty());
    ensure(nested.is_none(), || format!("style `{}` has styles itself", nested.map_or("", |nested| &nested.style)))
}

/// All styles have the same skeleton, with the same extra joints.
pub(crate) fn styles_share_the_skeleton(db: &MotionDb) -> CheckResult {
    let is_other = |other: &&MotionDb| other.skeleton != db.skeleton || other.extra.bones != db.extra.bones;
    let other = db.further_styles.iter().find(is_other);
    ensure(other.is_none(), || format!("style `{}` has another skeleton", other.map_or("", |other| &other.style)))
}

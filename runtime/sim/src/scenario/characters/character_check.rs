//! The rules of characters: names, weights, hues.

use motiondb::body::JOINT_COUNT;

use crate::scenario::characters::character_spec::{CHARACTERS_MAX, CharacterSize, CharacterSpec, SEGMENT_RADIUS_MAX_M};
use crate::scenario::fault::{ScenarioFault, ScenarioPart};
use crate::scenario::ranges::{RADIUS_M, check_name, within};

/// Greatest weight of a character.
const WEIGHT_MAX: f32 = 1e6;

/// Checks all characters.
pub(crate) fn check_characters(characters: &[CharacterSpec]) -> Result<(), ScenarioFault> {
    let (part, count) = (&ScenarioPart::Character(0), characters.len());
    within(part, "the number of characters", count, &(0..=CHARACTERS_MAX), "give fewer")?;
    (0..count).try_for_each(|index| check_character(&ScenarioPart::Character(index), &characters[..=index]))
}

/// Checks the last of some characters.
fn check_character(part: &ScenarioPart, characters: &[CharacterSpec]) -> Result<(), ScenarioFault> {
    let Some((spec, before)) = characters.split_last() else { return Ok(()) };
    check_name(&spec.name).or_else(|fault| part.fault(format!("name {}", fault.message), fault.help))?;
    if before.iter().any(|other| other.name == spec.name) {
        return part.fault(format!("name `{}` is that of two characters", spec.name), "choose another `name`");
    }
    within(part, "weight", spec.weight, &(0.0..=WEIGHT_MAX), "give a share relative to the other characters")?;
    if !spec.size.as_ref().is_none_or(is_sound) {
        return part.fault(format!("the size of the character `{}` is out of range", spec.name), "compile it again");
    }
    within(part, "hue_variation_deg", spec.hue_variation_deg, &(0.0..=180.0), "give degrees to either side")
}

/// Whether a size can be that of a character.
fn is_sound(size: &CharacterSize) -> bool {
    RADIUS_M.contains(&size.radius_m)
        && size.segment_radii_m.len() == JOINT_COUNT
        && size.segment_radii_m.iter().all(|radius_m| (0.0..=SEGMENT_RADIUS_MAX_M).contains(radius_m))
}

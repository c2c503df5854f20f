//! Diagnostics: sentence, code, number and bytes of each.

mod notes;
mod unfit;
mod warnings;

use std::collections::BTreeSet;

use motiondb::diagnostic::{Diagnostic, Note, Severity, Unfit, Warning};

use crate::notes::notes;
use crate::unfit::unfit;
use crate::warnings::warnings;

/// At least one of every variant, with its sentence.
fn sentences() -> Vec<(Diagnostic, &'static str)> {
    let notes = notes().into_iter().map(|(note, text)| (Diagnostic::Note(note), text));
    let warnings = warnings().into_iter().map(|(warning, text)| (Diagnostic::Warning(warning), text));
    let unfit = unfit().into_iter().map(|(unfit, text)| (Diagnostic::NoExample(unfit), text));
    notes.chain(warnings).chain(unfit).collect()
}

#[test]
fn each_diagnostic_has_its_sentence() {
    for (diagnostic, sentence) in sentences() {
        assert_eq!(diagnostic.to_string(), sentence);
    }
}

#[test]
fn codes_are_the_names_in_serde() {
    for (diagnostic, _) in sentences() {
        let severity = serde_json::to_value(diagnostic.severity()).unwrap();
        let json = serde_json::to_value(&diagnostic).unwrap();
        let finding = &json[severity.as_str().unwrap()];
        let is_named = finding == diagnostic.code() || finding.get(diagnostic.code()).is_some();
        assert!(is_named, "{json} is not named {}", diagnostic.code());
    }
}

/// Codes in the order of the numbers by which databases store them: new ones come last.
const NUMBERED: [&[&str]; 3] = [
    &[
        "first_pose_cut",
        "t_pose_cut",
        "text_after_motion",
        "last_row_incomplete",
        "pointers_not_read",
        "turn_rate_snapped",
        "strafe_snapped",
        "windows_left_out",
        "example_left_out",
        "only_rest_used",
        "same_take",
        "coincident_example",
        "low_parts_left_out",
        "coincident_manners",
        "idle_of_other_style",
        "added_to_style",
        "corners_unused",
        "joints_left_out",
        "held_pose_cut",
        "only_transitions_used",
        "rests_left_out",
        "carriage_left_out",
        "in_place",
        "movements_without_idle",
        "brief_rest_used",
    ],
    &[
        "inhuman_size",
        "unit_rejected",
        "sides_exchanged",
        "leap",
        "slope",
        "skating",
        "turn_without_step",
        "jump",
        "feet_slide",
        "feet_hardly_planted",
        "frame_count_wrong",
        "t_pose_kept",
        "frame_times_differ",
        "not_compared",
        "unit_doubtful",
        "frame_time_doubtful",
        "style_without_example",
        "style_without_stride",
        "pose_jumps",
        "radians_likely",
        "pose_frozen",
        "quick_motion",
        "leans_aside",
        "trunk_bent",
        "rare_frame_rate",
        "trunk_twisted",
        "frames_dropped",
        "frames_repeated",
        "forward_against_feet",
        "carriage_unlike",
    ],
    &[
        "up_contradicted",
        "inhuman_gait",
        "no_step",
        "no_whole_stride",
        "no_steady_stride",
        "pelvis_out_of_reach",
        "feet_hardly_planted",
        "feet_slide",
        "no_mid_stance",
        "mid_stance_off",
        "root_contradicted",
        "same_take",
        "not_upright",
        "t_pose",
        "moves_lengthwise",
        "strides_uneven",
        "arms_out",
        "arm_raised",
        "cycle_open",
        "cleaner_clips",
        "stated_transition",
        "lies_down",
    ],
];

/// Numbers of the severity and of the code, by which databases store them.
fn numbers(diagnostic: &Diagnostic) -> [usize; 2] {
    let bytes = bincode::serde::encode_to_vec(diagnostic, bincode::config::standard()).unwrap();
    [bytes[0], bytes[1]].map(usize::from)
}

#[test]
fn codes_keep_their_numbers_in_databases() {
    for (diagnostic, _) in sentences() {
        let [severity, number] = numbers(&diagnostic);
        assert_eq!(NUMBERED[severity].get(number), Some(&diagnostic.code()), "number {number}");
    }
}

#[test]
fn each_code_has_a_sentence() {
    let found: BTreeSet<[usize; 2]> = sentences().iter().map(|(diagnostic, _)| numbers(diagnostic)).collect();
    assert_eq!(found.len(), NUMBERED.concat().len());
}

#[test]
fn databases_store_no_sentences() {
    let config = bincode::config::standard();
    for (diagnostic, sentence) in sentences() {
        let bytes = bincode::serde::encode_to_vec(&diagnostic, config).unwrap();
        let read = bincode::serde::decode_from_slice::<Diagnostic, _>(&bytes, config).unwrap();
        assert_eq!(read, (diagnostic, bytes.len()));
        assert!(bytes.len() < sentence.len(), "{sentence}: {} bytes", bytes.len());
    }
}

#[test]
fn each_variant_has_its_severity() {
    let of = |diagnostic: Diagnostic| diagnostic.severity();
    assert_eq!(of(Diagnostic::Note(Note::FirstPoseCut)), Severity::Note);
    assert_eq!(of(Diagnostic::Warning(Warning::SidesExchanged)), Severity::Warning);
    assert_eq!(of(Diagnostic::NoExample(Unfit::NoStep)), Severity::NoExample);
}

#[test]
fn only_diagnostics_of_examples_name_a_start() {
    let slide = |from_s| Diagnostic::Warning(Warning::FeetSlide { slide_cm_s: 26.0, from_s });
    assert_eq!(slide(None).with_example_start_s(4.0), slide(Some(4.0)));
    let pose = Diagnostic::Note(Note::FirstPoseCut);
    assert_eq!(pose.clone().with_example_start_s(4.0), pose);
}

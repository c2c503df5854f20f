//! Diagnostics: sentence, code, number and bytes of each.

use std::f32::consts::FRAC_PI_2;

use motiondb::body::Side;
use motiondb::diagnostic::{ClipEnd, Diagnostic, Note, Posture, Severity, Unfit, Warning};
use motiondb::motion::Parameters;

/// At least one of every variant, with its sentence.
fn sentences() -> Vec<(Diagnostic, &'static str)> {
    let notes = notes().into_iter().map(|(note, text)| (Diagnostic::Note(note), text));
    let warnings = warnings().into_iter().map(|(warning, text)| (Diagnostic::Warning(warning), text));
    let unfit = unfit().into_iter().map(|(unfit, text)| (Diagnostic::NoExample(unfit), text));
    notes.chain(warnings).chain(unfit).collect()
}

fn notes() -> Vec<(Note, &'static str)> {
    let (first, last) = (ClipEnd::First, ClipEnd::Last);
    let other = || "walk.bvh".to_owned();
    vec![
        (Note::FirstPoseCut, "the first frame is a separate pose and is not used"),
        (Note::TPoseCut { frames: 40, end: first }, "the clip begins with 40 frames of T-pose, which are not used"),
        (Note::TPoseCut { frames: 12, end: last }, "the clip ends with 12 frames of T-pose, which are not used"),
        (
            Note::HeldPoseCut { frames: 90, end: first },
            "the clip begins with 90 frames of a frozen pose, which are not used",
        ),
        (
            Note::HeldPoseCut { frames: 30, end: last },
            "the clip ends with 30 frames of a frozen pose, which are not used",
        ),
        (Note::TextAfterMotion { line: 90 }, "line 90: the text after the motion is not used"),
        (Note::LastRowIncomplete { line: 90 }, "line 90: the last row is cut short and is not used"),
        (
            Note::PointersNotRead,
            "channels that animate something other than nodes (KHR_animation_pointer) are not used",
        ),
        (Note::TurnRateSnapped { turn_rate_rad_s: -0.02, from_s: None }, "the turn rate of -1.1 °/s is set to 0"),
        (
            Note::TurnRateSnapped { turn_rate_rad_s: 0.02, from_s: Some(7.25) },
            "the turn rate of 1.1 °/s in the example from 7.2 s on is set to 0",
        ),
        (Note::StrafeSnapped { strafe_mps: 0.05, from_s: None }, "the side speed of 0.050 m/s is set to 0"),
        (Note::WindowsLeftOut { near_equal: 1, doubtful: 0 }, "left out: 1 steady window, near-equal to examples"),
        (
            Note::WindowsLeftOut { near_equal: 0, doubtful: 2 },
            "left out: 2 steady windows, whose feet slide or are hardly planted",
        ),
        (
            Note::WindowsLeftOut { near_equal: 1, doubtful: 2 },
            "left out: 3 steady windows, 1 near-equal to examples and 2 whose feet slide or are hardly planted",
        ),
        (Note::ExampleLeftOut { example: "walk".into(), max_examples: 40 }, "`walk` is left out: max_examples = 40"),
        (
            Note::OnlyRestUsed { reason: Unfit::NoWholeStride },
            "only the part that stands is used; of the part that steps: no whole stride, a step of each foot, was \
             found; use at least a stride and a half (1.5 to 2 s of a walk), or a loop whose last pose leads into its \
             first",
        ),
        (Note::SameTake { other: other(), mirrored: false, windows_left_out: 0 }, "the same take as walk.bvh"),
        (
            Note::SameTake { other: other(), mirrored: true, windows_left_out: 1 },
            "the same take as walk.bvh, mirrored (1 steady window is left out)",
        ),
        (
            Note::SameTake { other: other(), mirrored: false, windows_left_out: 2 },
            "the same take as walk.bvh (2 steady windows are left out)",
        ),
        (
            Note::CoincidentExample { example: "walk".into(), blended: "stroll".into() },
            "`walk` has the parameters of `stroll`, which is blended in its place",
        ),
        (
            Note::LowPartsLeftOut { posture: Posture::Kneeling, longest_s: [4.0, 11.54], total_s: 7.54, more: 0 },
            "from 4.0 s to 11.5 s the body kneels; this gives no example (state `posture = \"any\"` in a manifest.toml \
             to use it)",
        ),
        (
            Note::LowPartsLeftOut { posture: Posture::OnHands, longest_s: [4.0, 11.54], total_s: 12.0, more: 2 },
            "from 4.0 s to 11.5 s the body goes on its hands, and in 2 more parts it is not upright (12.0 s in all); \
             this gives no example (state `posture = \"any\"` in a manifest.toml to use it)",
        ),
        (
            Note::CoincidentManners { example: "bent".into(), blended: "walk".into(), distance_cm: 11.6 },
            "`bent` has the parameters of `walk`, which is blended in its place, but moves otherwise (12 cm a joint); to \
             keep both, state a `style` in a manifest.toml",
        ),
        (
            Note::IdleOfOtherStyle { style: "elderly".into(), lender: "neutral".into() },
            "style `elderly` has no idle and stands as `neutral` does; add a clip of it that stands",
        ),
        (
            Note::IdleOfOtherStyle { style: "elderly".into(), lender: String::new() },
            "style `elderly` has no idle and stands as a clip without style does; add a clip of it that stands",
        ),
        (
            Note::AddedToStyle { style: "neutral".into() },
            "no clip without a style steps, so this one is used for style `neutral`",
        ),
        (
            Note::JointsLeftOut { moving: 485, kept: 30 },
            "485 moving joints of hands, feet and limbs are not used: they are no fingers, toes or twist bones by their \
             names, or more than fit; 30 are kept",
        ),
        (
            Note::JointsLeftOut { moving: 1, kept: 0 },
            "1 moving joint of hands, feet and limbs is not used: it is no finger, toe or twist bone by its name, or \
             does not fit",
        ),
    ]
}

fn warnings() -> Vec<(Warning, &'static str)> {
    vec![
        (
            Warning::InhumanSize { leg_m: 3.2 },
            "thigh and shank are 3.20 m long, unlike any human's; if the unit is wrong, state `metres_per_unit` in a \
             manifest.toml",
        ),
        (
            Warning::UnitRejected { leg_m: 84.0 },
            "thigh and shank would be 84.00 m long in the format's unit, so another unit is used; if that is wrong, \
             state `metres_per_unit` in a manifest.toml",
        ),
        (
            Warning::UnitDoubtful { leg_m: 0.4, other_leg_m: 1.016, other_unit_m: 0.0254 },
            "the unit is doubtful: thigh and shank are taken to be 0.40 m long; if they are 1.02 m long, state \
             `metres_per_unit = 0.0254` in a manifest.toml",
        ),
        (
            Warning::FrameTimeDoubtful { step_cm: 68.0, steps_per_min: 52.0, frame_rate_hz: 60.0 },
            "steps of 68 cm, only 52 a minute, look like slow motion; if the clip was recorded at another rate than 60 \
             Hz, state `frame_rate_hz` in a manifest.toml",
        ),
        (
            Warning::StyleWithoutExample { style: "elderly".into() },
            "style `elderly` gives no example, so the database lacks it; add a steady walk of this style, or state \
             `style = \"\"` for its clips in a manifest.toml",
        ),
        (
            Warning::StyleWithoutStride { style: "elderly".into() },
            "style `elderly` has no stride, so its agents reach no goal; add a steady walk of this style, or state \
             `style = \"\"` for its clips in a manifest.toml",
        ),
        (
            Warning::SidesExchanged,
            "toes and knees contradict the joints' names, so left and right are exchanged, as in a left-handed file; \
             if the names are right, state `joints` in a manifest.toml",
        ),
        (
            Warning::Leap { distance_m: 3.0, frame: 20, more: 0 },
            "the body leaps by 3.0 m from frame 20 to frame 21, so its mean speeds are wrong; cut the file there, or \
             select `frames` in a manifest.toml",
        ),
        (
            Warning::Leap { distance_m: 3.0, frame: 20, more: 1 },
            "the body leaps by 3.0 m from frame 20 to frame 21 (1 further leap in the clip), so its mean speeds are \
             wrong; cut the file there, or select `frames` in a manifest.toml",
        ),
        (
            Warning::Leap { distance_m: 3.0, frame: 20, more: 2 },
            "the body leaps by 3.0 m from frame 20 to frame 21 (2 further leaps in the clip), so its mean speeds are \
             wrong; cut the file there, or select `frames` in a manifest.toml",
        ),
        (Warning::Slope { rise_cm: 12.0 }, "the body climbs 12 cm a step; use a clip on level ground"),
        (Warning::Slope { rise_cm: -12.0 }, "the body descends 12 cm a step; use a clip on level ground"),
        (
            Warning::Skating { body_mps: 1.2, slide_mps: 1.2, steps: false },
            "the body moves at 1.2 m/s, but its feet take no step and slide over the ground at 1.2 m/s; correct the \
             root's motion",
        ),
        (
            Warning::Skating { body_mps: 1.2, slide_mps: 0.6, steps: true },
            "the body moves at 1.2 m/s, but its stance feet slide over the ground at 0.6 m/s; correct the root's motion",
        ),
        (
            Warning::TurnWithoutStep { turn_rate_rad_s: -FRAC_PI_2 },
            "the body turns at -90 °/s without a step, as on a turntable; correct the root's motion",
        ),
        (
            Warning::Jump { lift_cm: 41.0 },
            "the body jumps: both feet leave the ground by 41 cm; select other `frames` in a manifest.toml",
        ),
        (
            Warning::FeetSlide { slide_cm_s: 26.0, from_s: None },
            "planted feet slide by 26 cm/s; repair the clip, or use another one",
        ),
        (
            Warning::FeetSlide { slide_cm_s: 26.0, from_s: Some(4.0) },
            "planted feet slide by 26 cm/s in the example from 4.0 s on; repair the clip, or use another one",
        ),
        (
            Warning::FeetHardlyPlanted { planted_share: 0.18, from_s: None },
            "feet are planted for only 18 % of the cycle; repair the clip, or use another one",
        ),
        (
            Warning::FrameCountWrong { stated: 99.0, rows: 40 },
            "`Frames:` states 99, but the file has 40 rows, which are used; correct the header",
        ),
        (
            Warning::TPoseKept { frames: 60, end: ClipEnd::First },
            "the clip begins with 60 frames of T-pose; they are kept, because too little motion remains without them; \
             use a longer clip",
        ),
        (
            Warning::TPoseKept { frames: 60, end: ClipEnd::Last },
            "the clip ends with 60 frames of T-pose; they are kept, because too little motion remains without them; \
             use a longer clip",
        ),
        (
            Warning::FrameTimesDiffer { others: vec!["a.bvh".into()], more: 0, mirrored: true, windows_left_out: 2 },
            "the same take as a.bvh, mirrored, but at another frame time (2 steady windows are left out); state the \
             right `frame_rate_hz` in a manifest.toml",
        ),
        (
            Warning::FrameTimesDiffer {
                others: vec!["a.bvh".into(), "b.bvh".into()],
                more: 3,
                mirrored: false,
                windows_left_out: 0,
            },
            "the same take as a.bvh, b.bvh and 3 more, but at another frame time; state the right `frame_rate_hz` in a \
             manifest.toml",
        ),
        (
            Warning::NotCompared { compared: 4000 },
            "duplicates of this clip are not searched for: only the 4000 longest clips are compared; compile fewer \
             clips at once",
        ),
        (
            Warning::PoseJumps { at_s: 1.0, distance_cm: 32.0, more: 1 },
            "the pose jumps by 32 cm at 1.00 s, and at one other time by less; no example and no transition is made \
             across; repair the motion there",
        ),
        (
            Warning::RadiansLikely { turned_rad: 0.02 },
            "the body moves without a step, and no joint turns by more than 1.1°: the file seems to hold radians; export \
             it with angles in degrees",
        ),
        (
            Warning::PoseFrozen,
            "all frames hold the same pose, so a body that stands in it does not move at all; use a clip of a body that \
             stands at ease",
        ),
    ]
}

fn unfit() -> Vec<(Unfit, &'static str)> {
    let at = |speed_mps: f32| Parameters { speed_mps, turn_rate_rad_s: 0.5, strafe_mps: -0.25 };
    vec![
        (
            Unfit::UpContradicted { stated: "+Z".into(), found: "+Y".into() },
            "the manifest states that up is +Z, but the body stands along +Y; correct `up`, or remove it",
        ),
        (
            Unfit::InhumanGait { step_cm: 60.0, steps_per_min: 480.0 },
            "steps of 60 cm, 480 a minute, are not a human gait; state the right `frame_rate_hz` in a manifest.toml",
        ),
        (Unfit::NoStep, "no foot both lands and leaves, and the body does not stand; use a clip of a steady gait"),
        (
            Unfit::NoWholeStride,
            "no whole stride, a step of each foot, was found; use at least a stride and a half (1.5 to 2 s of a walk), or a loop whose last pose leads into its first",
        ),
        (
            Unfit::NoSteadyStride,
            "no steady stride was found: each differs from its neighbours; use a clip of a steady gait",
        ),
        (Unfit::PelvisOutOfReach, "the pelvis leaves the reach of the legs; correct the root's motion"),
        (
            Unfit::FeetHardlyPlanted { planted_share: 0.1 },
            "feet are planted for only 10 % of the cycle; repair the clip, or use another one",
        ),
        (Unfit::FeetSlide { slide_cm_s: 60.0 }, "planted feet slide by 60 cm/s; repair the clip, or use another one"),
        (
            Unfit::NoMidStance { foot: Side::Left },
            "the left foot has no contact about its mid-stance; use another clip",
        ),
        (
            Unfit::MidStanceOff { foot: Side::Right, share: 0.14 },
            "the right foot's contact is 14 % of the cycle off its mid-stance; use another clip",
        ),
        (
            Unfit::RootContradicted { root: at(1.2), feet: at(0.9), misfit_mps: 0.3, limit_mps: 0.12 },
            "the root moves at 1.20 m/s, 29 °/s and -0.25 m/s to the left, but the planted feet show 0.90 m/s, 29 °/s \
             and -0.25 m/s to the left: 0.300 m/s apart, above 0.120; correct the root's motion",
        ),
        (
            Unfit::SameTake { other: "walk.bvh".into(), mirrored: false, frame_times_differ: false },
            "the same take as walk.bvh, which gives the example",
        ),
        (
            Unfit::SameTake { other: "walk.bvh".into(), mirrored: true, frame_times_differ: true },
            "the same take as walk.bvh, mirrored, which gives the example, but at another frame time; state the right \
             `frame_rate_hz` in a manifest.toml",
        ),
        (Unfit::TPose, "the body stands in a T-pose; use a clip of a body that stands at ease"),
        (
            Unfit::ArmsOut,
            "the body stands with its arms spread, as in a bind pose; use a clip of a body that stands at ease",
        ),
        (
            Unfit::ArmRaised,
            "the body stands with a raised arm, as one that aims; use a clip of a body that stands at ease",
        ),
        (
            Unfit::StridesUneven { speeds_mps: [0.4, 0.9], turn_rates_rad_s: [0.0, FRAC_PI_2] },
            "no steady stride was found: in the steadiest one the speed varies from 0.40 to 0.90 m/s (at most 0.20 apart), \
             and its steps turn by 0 and 90 °/s (at most 60 apart); use a clip of a steady gait",
        ),
        (
            Unfit::StridesUneven { speeds_mps: [2.0, 4.0], turn_rates_rad_s: [0.0, 0.0] },
            "no steady stride was found: in the steadiest one the speed varies from 2.00 to 4.00 m/s (at most 0.75 apart), \
             and its steps turn by 0 and 0 °/s (at most 60 apart); use a clip of a steady gait",
        ),
        (
            Unfit::CycleOpen { seam_rad: 0.5, largest_rad: 0.1 },
            "the closed stride jumps: its end turns a joint by 29° to its beginning, other poses by 6° at most; use a \
             steadier part",
        ),
        (
            Unfit::CleanerClips,
            "clips with cleaner feet reach its speed and give the examples in its place; repair its feet, or leave it out",
        ),
        (
            Unfit::MovesLengthwise,
            "the body moves along its own length, as one that jumps, kneels down and rises, climbs or swims; use a clip \
             of walking or standing",
        ),
        (
            Unfit::NotUpright { posture: Posture::Crouching },
            "the body crouches; use a clip of an upright body, or state `posture = \"any\"` in a manifest.toml",
        ),
    ]
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
    ],
];

#[test]
fn codes_keep_their_numbers_in_databases() {
    for (diagnostic, _) in sentences() {
        let bytes = bincode::serde::encode_to_vec(&diagnostic, bincode::config::standard()).unwrap();
        let [severity, number] = [bytes[0], bytes[1]].map(usize::from);
        assert_eq!(NUMBERED[severity].get(number), Some(&diagnostic.code()), "number {number}");
    }
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

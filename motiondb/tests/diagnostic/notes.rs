//! Notes and their sentences.

use std::f32::consts::FRAC_PI_2;

use motiondb::diagnostic::{ClipEnd, Note, Posture, Unfit};

pub(crate) fn notes() -> Vec<(Note, &'static str)> {
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
        (
            Note::InPlace { speed_mps: 1.104 },
            "the root does not travel, as on a treadmill; the speed, 1.10 m/s, is estimated from the feet, and less accurate \
             than that of a root that travels",
        ),
        (
            Note::MovementsWithoutIdle { movements: 1, first_s: [2.0, 3.25] },
            "a start, stop, turn or step from 2.0 s to 3.2 s gives no transition, since no clip of this style gives an \
             idle: a body that stands for 2 s",
        ),
        (
            Note::MovementsWithoutIdle { movements: 3, first_s: [2.0, 3.25] },
            "3 starts, stops, turns or steps, the first from 2.0 s to 3.2 s, give no transition, since no clip of this \
             style gives an idle: a body that stands for 2 s",
        ),
        (
            Note::BriefRestUsed { rest_s: [12.0, 12.8] },
            "bodies stand as from 12.00 to 12.80 s, since no clip stands for long; add an idle of some seconds",
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
        (
            Note::RestsLeftOut { longest_s: [4.0, 6.04], reason: Unfit::TPose, more: 0 },
            "no idle is made from 4.0 s to 6.0 s: the body stands in a T-pose; use a clip of a body that stands at ease",
        ),
        (
            Note::RestsLeftOut { longest_s: [4.0, 6.04], reason: Unfit::TPose, more: 1 },
            "no idle is made from 4.0 s to 6.0 s (1 further part is left out, too): the body stands in a T-pose; use a clip \
             of a body that stands at ease",
        ),
        (
            Note::OnlyTransitionsUsed { reason: Unfit::NoWholeStride },
            "the clip gives transitions, but no example of a gait: no whole stride, a step of each foot, was found; use at \
             least a stride and a half (1.5 to 2 s of a walk), or a loop whose last pose leads into its first",
        ),
        (
            Note::CornersUnused { window_s: [2.0, 3.5], turn_rad: -FRAC_PI_2, more: 2 },
            "from 2.0 s to 3.5 s the body walks and turns by 90° to the right (60 °/s); no example and no transition shows \
             this, nor 2 further turns",
        ),
        (
            Note::CarriageLeftOut { windows: 2, longest_s: [8.2, 12.13], kept_s: [0.4, 6.0] },
            "left out: 2 steady windows, the longest from 8.2 s to 12.1 s: trunk, arms or legs are held otherwise than from 0.4 s \
             to 6.0 s, which gives the example of nearly the same velocity. To use both, cut them out by `frames` in a \
             manifest.toml and give them a `style` each",
        ),
    ]
}

//! Warnings and their sentences.

use std::f32::consts::FRAC_PI_2;

use motiondb::diagnostic::{ClipEnd, HeldPart, Warning};

pub(crate) fn warnings() -> Vec<(Warning, &'static str)> {
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
             Hz, state the right `frame_rate_hz` in a manifest.toml",
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
            "`Frames:` states 99, but the file has 40 rows, which are used; export the whole file again, or correct the header",
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
            Warning::QuickMotion { step_cm: 41.2, steps_per_min: 219.6, frame_rate_hz: 120.0 },
            "steps of only 41 cm, 220 a minute, look like motion played too fast; if the clip was recorded at another rate \
             than 120 Hz, state the right `frame_rate_hz` in a manifest.toml",
        ),
        (
            Warning::RadiansLikely { turned_rad: 0.02 },
            "no foot steps, and no joint turns by more than 1.1°: the file seems to hold radians; export it with angles in \
             degrees",
        ),
        (
            Warning::PoseFrozen,
            "all frames hold the same pose, so a body that stands in it does not move at all; use a clip of a body that \
             stands at ease",
        ),
        (
            Warning::LeansAside { lean_deg: -15.2, from_s: None },
            "the whole body leans by 15° to the right, although it goes straight on: the ground seems to be tilted, or the body \
             carries something; bodies of the crowd lean, too. Turn the clip upright in another program, or leave it out",
        ),
        (
            Warning::TrunkBent { lean_deg: 47.0, from_s: Some(3.2) },
            "the trunk is bent by 47° in the example from 3.2 s on; to keep this manner apart, give the clip a `style` in a \
             manifest.toml",
        ),
        (
            Warning::RareFrameRate { frame_rate_hz: 120.0, usual_hz: 60.0, steps_per_min: [184.0, 92.0] },
            "184 steps a minute at the stated 120 Hz are unusual; at 60 Hz, the rate of the rig's other clips, they are 92; \
             state the right `frame_rate_hz` in a manifest.toml",
        ),
        (
            Warning::TrunkTwisted { twist_deg: -30.4, from_s: None },
            "the shoulders are turned by 30° to the right of the hips; the body faces between both, so that a walk straight \
             ahead counts as one to the side. If it carries something or looks aside, give the clip a `style` in a \
             manifest.toml",
        ),
        (
            Warning::FramesDropped { share: 0.148 },
            "about 15 % of the frames are missing, so the motion is too fast by as much; record or export the clip again \
             without gaps",
        ),
        (
            Warning::FramesRepeated { share: 0.5 },
            "50 % of the frames repeat the one before; if the motion is too slow by as much, state the right `frame_rate_hz` \
             in a manifest.toml, else export the clip without repeated frames",
        ),
        (
            Warning::ForwardAgainstFeet { forward: "-Z".into() },
            "both feet point away from -Z, so the body walks backward; correct `forward` in the manifest.toml",
        ),
        (
            Warning::CarriageUnlike { part: HeldPart::LeftArm, angle_deg: 61.6, from_s: Some(12.0) },
            "the left arm is held 62° off how the other walks hold it in the example from 12.0 s on; to keep this manner \
             apart, give the clip a `style` in a manifest.toml",
        ),
    ]
}

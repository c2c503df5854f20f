//! Reasons why a clip gives no example, and their sentences.

use std::f32::consts::FRAC_PI_2;

use motiondb::body::Side;
use motiondb::diagnostic::{Posture, Unfit};
use motiondb::motion::Parameters;

pub(crate) fn unfit() -> Vec<(Unfit, &'static str)> {
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
        (
            Unfit::NoStep,
            "no foot was found that both lands and leaves the ground, and the body does not stand; use a clip of a steady \
             gait, at least a stride and a half (1.5 to 2 s of a walk)",
        ),
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
            Unfit::StatedTransition,
            "the manifest states that it shows a transition, which joins examples of other clips, of walking and of \
             standing",
        ),
        (
            Unfit::LiesDown { found: "-Z".to_owned(), walks: vec!["+Y".to_owned()] },
            "the body lies: it stretches along -Z, but the same rig walks with +Y up; leave it out, or state `up` in a \
             manifest.toml if it stands",
        ),
        (
            Unfit::MovesLengthwise,
            "the body moves along its own length, as in a jump, a climb or a crawl, or in kneeling down and rising; use a clip \
             of walking or standing",
        ),
        (
            Unfit::NotUpright { posture: Posture::Crouching },
            "the body crouches; use a clip of an upright body, or state `posture = \"any\"` in a manifest.toml",
        ),
    ]
}

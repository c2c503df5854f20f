//! One `[[clips]]` table of a manifest: its keys, the values that they accept, and how they override the settings of a
//! clip.

use std::collections::BTreeMap;
use std::ops::{Range, RangeInclusive};
use std::path::PathBuf;

use motiondb::body::Joint;
use motiondb::files::{Invalid, SourceText};
use motiondb::motion::ActionKind;
use serde::Deserialize;
use toml::Spanned;

use crate::error::ManifestKey;
use crate::input::clip_settings::ClipSettings;
use crate::read::axis::Axis;
use crate::rig::roles::{ARMS, LEGS};

/// Accepted units of a source, from micrometres to ten kilometres, m.
const UNIT_M: RangeInclusive<f64> = 1e-6..=1e4;
/// Accepted frame rates, Hz.
const FRAME_RATE_HZ: RangeInclusive<f64> = 1.0..=10_000.0;

/// A `[[clips]]` table as it is written.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct ClipsTable {
    pub path: Spanned<PathBuf>,
    #[serde(default)]
    pub skip: bool,
    animation: Option<Spanned<String>>,
    name: Option<Spanned<String>>,
    frames: Option<Spanned<FramePair>>,
    metres_per_unit: Option<Spanned<f64>>,
    up: Option<Axis>,
    forward: Option<Spanned<Axis>>,
    frame_rate_hz: Option<Spanned<f64>>,
    #[serde(default)]
    joints: BTreeMap<Spanned<String>, Spanned<String>>,
    mirror: Option<bool>,
    posture: Option<AcceptedPosture>,
    transition: Option<Spanned<StatedTransition>>,
    style: Option<Spanned<String>>,
}

/// The transition that a clip shows.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(rename_all = "snake_case")]
enum StatedTransition {
    Start,
    Stop,
    Turn,
    Step,
    Pivot,
}

impl From<StatedTransition> for ActionKind {
    fn from(stated: StatedTransition) -> Self {
        match stated {
            StatedTransition::Start => Self::Start,
            StatedTransition::Stop => Self::Stop,
            StatedTransition::Turn => Self::Turn,
            StatedTransition::Step => Self::Step,
            StatedTransition::Pivot => Self::Pivot,
        }
    }
}

/// The postures of which examples are made.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(rename_all = "snake_case")]
enum AcceptedPosture {
    /// The body walks, runs or stands upright.
    Upright,
    /// Any posture.
    Any,
}

/// First and last frame, counted from 1. Deserializes from a list of exactly two numbers.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(try_from = "Vec<usize>")]
struct FramePair([usize; 2]);

impl TryFrom<Vec<usize>> for FramePair {
    type Error = &'static str;

    fn try_from(frames: Vec<usize>) -> Result<Self, Self::Error> {
        frames.try_into().map(Self).map_err(|_| "frames are two numbers: the first and the last, counted from 1")
    }
}

impl ClipsTable {
    /// Checks every value that can be checked without the clip.
    pub(crate) fn check(&self, source: &SourceText) -> Result<(), Invalid> {
        check_range(source, "metres_per_unit", self.metres_per_unit.as_ref(), UNIT_M)?;
        check_range(source, "frame_rate_hz", self.frame_rate_hz.as_ref(), FRAME_RATE_HZ)?;
        self.check_frames(source)?;
        self.check_name(source)?;
        self.check_style(source)?;
        self.check_joints(source)?;
        self.check_limbs(source)
    }

    fn check_frames(&self, source: &SourceText) -> Result<(), Invalid> {
        let Some(frames) = &self.frames else { return Ok(()) };
        let FramePair([first, last]) = *frames.get_ref();
        if first == 0 || first >= last {
            let message = format!("no motion goes from frame {first} to {last}");
            return Err(source.invalid(frames.span(), message, "write the first and the last frame, counted from 1"));
        }
        Ok(())
    }

    fn check_name(&self, source: &SourceText) -> Result<(), Invalid> {
        let Some(name) = &self.name else { return Ok(()) };
        if name.get_ref().trim().is_empty() {
            return Err(source.invalid(name.span(), "the name is empty", "write a name, or remove the key"));
        }
        if name.get_ref().contains(char::is_control) {
            let message = "the name holds a line break or another control character";
            return Err(source.invalid(name.span(), message, "write letters, digits, spaces and punctuation"));
        }
        Ok(())
    }

    /// Checks that a style has a name that can be written in one line, or none.
    fn check_style(&self, source: &SourceText) -> Result<(), Invalid> {
        let Some(style) = self.style.as_ref().filter(|style| !style.get_ref().is_empty()) else { return Ok(()) };
        let name = style.get_ref();
        if motiondb::validate::is_style_name(name) {
            return Ok(());
        }
        let message = "a style is a word of letters, digits, spaces, `-` and `_`";
        Err(source.invalid(style.span(), message, "write a word, such as \"elderly\", or \"\" for no style"))
    }

    /// Checks that every key of `joints` is a role, and that no joint has two roles.
    fn check_joints(&self, source: &SourceText) -> Result<(), Invalid> {
        let mut role_of: BTreeMap<&str, &str> = BTreeMap::new();
        for (role, name) in &self.joints {
            if role_named(role.get_ref()).is_none() {
                let roles = Joint::ALL.map(Joint::name).join(", ");
                let message = format!("`{}` is not a role; the roles are {roles}", role.get_ref());
                return Err(source.invalid(role.span(), message, "name one of these"));
            }
            if let Some(other) = role_of.insert(name.get_ref(), role.get_ref()) {
                let message = format!("`{}` has two roles, {other} and {}", name.get_ref(), role.get_ref());
                return Err(source.invalid(name.span(), message, "state a joint of its own for each role"));
            }
        }
        Ok(())
    }

    /// Checks that `joints` names all six joints of the legs or none, and the same of the arms.
    fn check_limbs(&self, source: &SourceText) -> Result<(), Invalid> {
        for (limbs, what) in [(LEGS, "legs"), (ARMS, "arms")] {
            let named = |joint: Joint| self.joints.iter().find(|(role, _)| role.get_ref() == joint.name());
            let roles = limbs.as_flattened();
            let (Some((role, _)), Some(missing)) =
                (roles.iter().find_map(|&joint| named(joint)), roles.iter().find(|&&joint| named(joint).is_none()))
            else {
                continue;
            };
            let message = format!("of the {what}, `{}` is named but `{}` is not", role.get_ref(), missing.name());
            return Err(source.invalid(role.span(), message, "name all six joints or none"));
        }
        Ok(())
    }

    /// Checks that the table of a folder has no key that holds for one clip only.
    pub(crate) fn check_folder(&self, source: &SourceText) -> Result<(), Invalid> {
        let of_one_clip = [
            self.animation.as_ref().map(Spanned::span),
            self.name.as_ref().map(Spanned::span),
            self.frames.as_ref().map(Spanned::span),
        ];
        match of_one_clip.into_iter().flatten().next() {
            Some(span) => Err(source.invalid(span, "this cannot hold for a whole folder", "name one file in `path`")),
            None => Ok(()),
        }
    }

    /// Overrides settings with the values of this table, which stands at `span` of the manifest's text.
    pub(crate) fn override_settings(&self, span: Range<usize>, settings: &mut ClipSettings) {
        settings.spans.table = span;
        let spans = &mut settings.spans.values;
        if let Some(animation) = &self.animation {
            settings.animation = Some(animation.get_ref().clone());
            spans.insert(ManifestKey::Animation, animation.span());
        }
        if let Some(frames) = &self.frames {
            settings.frames = Some(frames.get_ref().0);
            spans.insert(ManifestKey::Frames, frames.span());
        }
        if let Some(forward) = &self.forward {
            settings.forward = Some(*forward.get_ref());
            spans.insert(ManifestKey::Forward, forward.span());
        }
        if let Some(transition) = &self.transition {
            settings.transition = Some((*transition.get_ref()).into());
            spans.insert(ManifestKey::Transition, transition.span());
        }
        for (role, name) in &self.joints {
            let Some(role) = role_named(role.get_ref()) else { continue };
            settings.joints.insert(role, name.get_ref().clone());
            spans.insert(ManifestKey::Joint(role), name.span());
        }
        settings.name = value(&self.name).or(settings.name.take());
        if let Some(metres_per_unit) = &self.metres_per_unit {
            settings.metres_per_unit = Some(*metres_per_unit.get_ref());
            spans.insert(ManifestKey::MetresPerUnit, metres_per_unit.span());
        }
        settings.frame_rate_hz = value(&self.frame_rate_hz).or(settings.frame_rate_hz);
        settings.up = self.up.or(settings.up);
        if let Some(posture) = self.posture {
            settings.takes_any_posture = posture == AcceptedPosture::Any;
        }
        settings.mirror = self.mirror.or(settings.mirror);
        settings.style = value(&self.style).or(settings.style.take());
    }
}

fn check_range(
    source: &SourceText,
    key: &str,
    value: Option<&Spanned<f64>>,
    range: RangeInclusive<f64>,
) -> Result<(), Invalid> {
    match value {
        Some(value) if !range.contains(value.get_ref()) => {
            let message = format!("{key} is {}, not within {} and {}", value.get_ref(), range.start(), range.end());
            Err(source.invalid(value.span(), message, "correct the value, or remove the key and let it be found"))
        }
        _ => Ok(()),
    }
}

fn value<T: Clone>(spanned: &Option<Spanned<T>>) -> Option<T> {
    spanned.as_ref().map(|value| value.get_ref().clone())
}

fn role_named(name: &str) -> Option<Joint> {
    Joint::ALL.into_iter().find(|joint| joint.name() == name)
}

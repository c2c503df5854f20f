//! One `[[clips]]` table of a [`crate::input::manifest`]: its keys, what they may say, and how they fill a [`Take`].

use std::collections::BTreeMap;
use std::ops::{Range, RangeInclusive};
use std::path::PathBuf;

use motiondb::body::Joint;
use motiondb::files::{Invalid, SourceText};
use serde::Deserialize;
use toml::Spanned;

use crate::error::Setting;
use crate::input::clip_settings::Take;
use crate::retarget::axis::Axis;
use crate::rig::roles::{ARMS, LEGS};

/// Units of anybody's motion, micrometres to tens of kilometres, m.
const UNIT_M: RangeInclusive<f64> = 1e-6..=1e4;
/// Rates of anybody's motion, Hz.
const FRAME_RATE_HZ: RangeInclusive<f64> = 1.0..=10_000.0;

/// A table as written.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Table {
    pub path: Spanned<PathBuf>,
    #[serde(default)]
    pub skip: bool,
    animation: Option<Spanned<String>>,
    name: Option<Spanned<String>>,
    frames: Option<Spanned<FrameRange>>,
    metres_per_unit: Option<Spanned<f64>>,
    up: Option<Axis>,
    forward: Option<Spanned<Axis>>,
    frame_rate_hz: Option<Spanned<f64>>,
    #[serde(default)]
    joints: BTreeMap<Spanned<String>, Spanned<String>>,
    mirror: Option<bool>,
}

/// First and last frame, and nothing more.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(try_from = "Vec<usize>")]
struct FrameRange([usize; 2]);

impl TryFrom<Vec<usize>> for FrameRange {
    type Error = &'static str;

    fn try_from(frames: Vec<usize>) -> Result<Self, Self::Error> {
        frames.try_into().map(Self).map_err(|_| "frames are two numbers: the first and the last, counted from 1")
    }
}

impl Table {
    /// That every value can be true of some clip.
    pub(crate) fn check(&self, source: &SourceText) -> Result<(), Invalid> {
        let within = |value: &Option<Spanned<f64>>, range: RangeInclusive<f64>, key: &str| match value {
            Some(value) if !range.contains(value.get_ref()) => {
                let message = format!("{key} is {}, not within {} and {}", value.get_ref(), range.start(), range.end());
                Err(source.invalid(value.span(), message, "correct the value, or remove it and let it be found"))
            }
            _ => Ok(()),
        };
        within(&self.metres_per_unit, UNIT_M, "metres_per_unit")?;
        within(&self.frame_rate_hz, FRAME_RATE_HZ, "frame_rate_hz")?;
        if let Some(frames) = &self.frames {
            let FrameRange([first, last]) = *frames.get_ref();
            if first == 0 || first >= last {
                let help = "write the first and the last frame, counted from 1";
                return Err(source.invalid(
                    frames.span(),
                    format!("no motion goes from frame {first} to {last}"),
                    help,
                ));
            }
        }
        self.check_name(source)?;
        self.check_joints(source)
    }

    fn check_name(&self, source: &SourceText) -> Result<(), Invalid> {
        let Some(name) = &self.name else { return Ok(()) };
        if name.get_ref().trim().is_empty() {
            return Err(source.invalid(name.span(), "the name is empty", "give it a name, or remove the key"));
        }
        if name.get_ref().contains(char::is_control) {
            let message = "the name holds a line break or another control character";
            return Err(source.invalid(name.span(), message, "write letters, digits, spaces and punctuation"));
        }
        Ok(())
    }

    fn check_joints(&self, source: &SourceText) -> Result<(), Invalid> {
        let mut players: BTreeMap<&str, &str> = BTreeMap::new();
        for (role, name) in &self.joints {
            if role_named(role.get_ref()).is_none() {
                let roles = Joint::ALL.map(Joint::name).join(", ");
                let message = format!("`{}` is no role; the roles are {roles}", role.get_ref());
                return Err(source.invalid(role.span(), message, "name one of these"));
            }
            if let Some(other) = players.insert(name.get_ref(), role.get_ref()) {
                let message = format!("`{}` plays {other} and {}", name.get_ref(), role.get_ref());
                return Err(source.invalid(name.span(), message, "give each role a joint of its own"));
            }
        }
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

    /// That nothing is said of all clips of a folder that holds of one only.
    pub(crate) fn check_folder(&self, source: &SourceText) -> Result<(), Invalid> {
        let of_one = [
            self.animation.as_ref().map(Spanned::span),
            self.name.as_ref().map(Spanned::span),
            self.frames.as_ref().map(Spanned::span),
        ];
        match of_one.into_iter().flatten().next() {
            Some(span) => Err(source.invalid(span, "this cannot hold for a whole folder", "name one file in `path`")),
            None => Ok(()),
        }
    }

    /// Lets a take say what the table, whose place in the text is `span`, says.
    pub(crate) fn tell(&self, span: Range<usize>, take: &mut Take) {
        take.places.table = span;
        let values = &mut take.places.values;
        let settings = &mut take.settings;
        put(&mut take.animation, self.animation.as_ref(), Setting::Animation, values);
        if let Some(frames) = &self.frames {
            settings.frames = Some(frames.get_ref().0);
            values.insert(Setting::Frames, frames.span());
        }
        put(&mut settings.forward, self.forward.as_ref(), Setting::Forward, values);
        for (role, name) in &self.joints {
            let Some(role) = role_named(role.get_ref()) else { continue };
            settings.joints.insert(role, name.get_ref().clone());
            values.insert(Setting::Joint(role), name.span());
        }
        settings.name = self.name.as_ref().map(|name| name.get_ref().clone()).or(settings.name.take());
        settings.metres_per_unit =
            self.metres_per_unit.as_ref().map(|unit| *unit.get_ref()).or(settings.metres_per_unit);
        settings.frame_rate_hz = self.frame_rate_hz.as_ref().map(|rate| *rate.get_ref()).or(settings.frame_rate_hz);
        settings.up = self.up.or(settings.up);
        settings.mirror = self.mirror.or(settings.mirror);
    }
}

/// Puts a value, where there is one, over an earlier one and notes its place.
fn put<T: Clone>(
    old: &mut Option<T>,
    new: Option<&Spanned<T>>,
    setting: Setting,
    places: &mut BTreeMap<Setting, Range<usize>>,
) {
    if let Some(new) = new {
        *old = Some(new.get_ref().clone());
        places.insert(setting, new.span());
    }
}

fn role_named(name: &str) -> Option<Joint> {
    Joint::ALL.into_iter().find(|joint| joint.name() == name)
}

//! `[profiles.NAME]`: numbers of agents that are drawn, and `profile` of agents and sources.
//!
//! ```toml
//! [profiles.adult]
//! preferred_speed_mps = { normal = [1.34, 0.26], min = 0.8, max = 1.9 }
//! radius_m = { uniform = [0.22, 0.28] }
//! [profiles.child]
//! stature = { uniform = [0.6, 0.75] }  # of the database's skeleton; radius and speed follow it
//! [profiles.elderly]
//! inherits = "adult"                  # all numbers that it does not state itself
//! preferred_speed_mps = { uniform = [0.6, 0.9] }
//! pre_movement_s = { uniform = [5, 20] }
//! ```

use std::collections::BTreeMap;

use motiondb::files::SourceText;
use serde::Deserialize;
use toml::Spanned;

use crate::behaviour::Distribution;
use crate::scenario::characters::character_spec::CharacterSpec;
use crate::scenario::characters::character_tables::set_of;
use crate::scenario::error::ScenarioError;
use crate::scenario::fault::TableFault;
use crate::scenario::file::behaviour::{DistributionValue, Names, priority};
use crate::scenario::profile::{DrawnStature, Profile};
use crate::scenario::ranges::{PRE_MOVEMENT_S, RADIUS_M, SPEED_MPS, STATURE};

/// Greatest number of profiles.
const PROFILES_MAX: usize = 1_000;

/// `[profiles.NAME]`
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(crate) struct ProfileTable {
    inherits: Option<String>,
    preferred_speed_mps: Option<DistributionValue>,
    radius_m: Option<DistributionValue>,
    pre_movement_s: Option<DistributionValue>,
    stature: Option<DistributionValue>,
    priority: Option<f32>,
    characters: Option<Vec<String>>,
    pub(crate) style: Option<Spanned<String>>,
}

/// `profile` of agents and sources.
#[derive(Clone, Debug, Deserialize)]
#[serde(untagged, expecting = "the name of a profile, or profiles with shares as in `{ adult = 3, elderly = 1 }`")]
pub(crate) enum ProfileValue {
    One(String),
    Shares(BTreeMap<String, f32>),
}

/// All profiles, by the order of their names.
pub(crate) struct Profiles<'a> {
    names: Names<'a>,
    resolved: Vec<Profile>,
    characters: &'a [CharacterSpec],
    styles: &'a [String],
}

impl<'a> Profiles<'a> {
    /// Resolves all tables: what a profile inherits, and its ranges.
    pub(crate) fn new(
        tables: &'a BTreeMap<String, Spanned<ProfileTable>>,
        characters: &'a [CharacterSpec],
        styles: &'a [String],
        source: &SourceText,
    ) -> Result<Self, ScenarioError> {
        let names = Names::new("profile", tables);
        let tables: Vec<&Spanned<ProfileTable>> = tables.values().collect();
        if let Some(table) = tables.get(PROFILES_MAX) {
            let message = format!("the scenario has more than {PROFILES_MAX} profiles");
            return Err(source.invalid(table.span(), message, "give fewer").into());
        }
        let resolve = |(index, table): (usize, &&Spanned<ProfileTable>)| {
            profile(index, &names, &tables, characters, styles)
                .map_err(|(message, help)| source.invalid(table.span(), message, help).into())
        };
        let resolved = tables.iter().enumerate().map(resolve).collect::<Result<_, ScenarioError>>()?;
        Ok(Self { names, resolved, characters, styles })
    }

    /// Closes a zone to the agents of a profile, by the zone's bit.
    pub(crate) fn close_zone(&mut self, name: &str, bit: u32) -> Result<(), TableFault> {
        let index = self.names.index(name)?;
        self.resolved[index].closed_zones |= 1 << bit;
        Ok(())
    }

    /// The profiles of a table of agents; numbers that the table states itself are taken out of them.
    pub(crate) fn of_table(
        &self,
        value: Option<&Spanned<ProfileValue>>,
        pre_movement_s: Option<DistributionValue>,
        states_speed: bool,
        states_radius: bool,
    ) -> Result<Vec<Profile>, TableFault> {
        let mut profiles = match value.map(Spanned::get_ref) {
            None => vec![Profile { weight: 1.0, ..Profile::default() }],
            Some(ProfileValue::One(name)) => vec![self.with_weight(name, 1.0)?],
            Some(ProfileValue::Shares(shares)) => {
                let profiles = shares.iter().map(|(name, &weight)| self.with_weight(name, weight));
                profiles.collect::<Result<_, _>>()?
            }
        };
        let sum: f32 = profiles.iter().map(|profile| profile.weight).sum();
        let are_shares = profiles.iter().all(|profile| profile.weight >= 0.0) && sum > 0.0 && sum.is_finite();
        if !are_shares {
            return Err((format!("the shares add up to {sum}, or one is negative"), "give shares of 0 or more"));
        }
        let pre_movement_s = pre_movement_s.map(pre_movement).transpose()?;
        for profile in &mut profiles {
            profile.pre_movement_s = pre_movement_s.or(profile.pre_movement_s);
            profile.preferred_speed_mps = profile.preferred_speed_mps.filter(|_| !states_speed);
            profile.radius_m = profile.radius_m.filter(|_| !states_radius);
            profile.stature = profile.stature.map(|stature| DrawnStature {
                scales_radius: !states_radius && profile.radius_m.is_none(),
                scales_speed: !states_speed && profile.preferred_speed_mps.is_none(),
                ..stature
            });
        }
        let states_nothing = |profile: &Profile| *profile == Profile { weight: profile.weight, ..Profile::default() };
        if profiles.iter().all(states_nothing) {
            profiles.clear();
        }
        Ok(profiles)
    }

    /// The profiles of a table that states characters itself: these go before those of the profiles. Beside them the
    /// characters of agents without profile.
    pub(crate) fn with_characters(
        &self,
        mut profiles: Vec<Profile>,
        names: Option<&Vec<String>>,
    ) -> Result<(Vec<Profile>, u64), TableFault> {
        let Some(names) = names else { return Ok((profiles, 0)) };
        let characters = set_of(names, self.characters)?;
        profiles.iter_mut().for_each(|profile| profile.characters = characters);
        Ok((profiles, characters))
    }

    /// The profiles of a table that states a style itself: it goes before those of the profiles. Beside them the style
    /// of agents without profile.
    pub(crate) fn with_style(
        &self,
        mut profiles: Vec<Profile>,
        style: Option<&Spanned<String>>,
    ) -> (Vec<Profile>, u32) {
        let stated = style_index(self.styles, style);
        if style.is_some() {
            profiles.iter_mut().for_each(|profile| profile.style = stated);
        }
        (profiles, stated)
    }

    /// Whether agents wear characters.
    pub(crate) fn has_characters(&self) -> bool {
        !self.characters.is_empty()
    }

    fn with_weight(&self, name: &str, weight: f32) -> Result<Profile, TableFault> {
        Ok(Profile { weight, ..self.resolved[self.names.index(name)?].clone() })
    }
}

/// One profile with all that it inherits.
fn profile(
    index: usize,
    names: &Names<'_>,
    tables: &[&Spanned<ProfileTable>],
    characters: &[CharacterSpec],
    styles: &[String],
) -> Result<Profile, TableFault> {
    let mut merged = tables[index].get_ref().clone();
    let mut ancestors = vec![index];
    while let Some(name) = merged.inherits.take() {
        let index = names.index(&name)?;
        if ancestors.contains(&index) {
            return Err((format!("profile `{name}` inherits from itself"), "remove one `inherits`"));
        }
        ancestors.push(index);
        let parent = tables[index].get_ref();
        merged = ProfileTable {
            inherits: parent.inherits.clone(),
            preferred_speed_mps: merged.preferred_speed_mps.or(parent.preferred_speed_mps),
            radius_m: merged.radius_m.or(parent.radius_m),
            pre_movement_s: merged.pre_movement_s.or(parent.pre_movement_s),
            stature: merged.stature.or(parent.stature),
            priority: merged.priority.or(parent.priority),
            characters: merged.characters.or_else(|| parent.characters.clone()),
            style: merged.style.or_else(|| parent.style.clone()),
        };
    }
    let speeds = [*SPEED_MPS.start(), *SPEED_MPS.end()];
    let radii = [*RADIUS_M.start(), *RADIUS_M.end()];
    let sizes = [*STATURE.start(), *STATURE.end()];
    let number =
        |name, value: Option<DistributionValue>, bounds| value.map(|value| value.resolve(name, bounds)).transpose();
    Ok(Profile {
        weight: 1.0,
        preferred_speed_mps: number("`preferred_speed_mps`", merged.preferred_speed_mps, speeds)?,
        radius_m: number("`radius_m`", merged.radius_m, radii)?,
        pre_movement_s: merged.pre_movement_s.map(pre_movement).transpose()?,
        stature: number("`stature`", merged.stature, sizes)?.map(|size| DrawnStature {
            size,
            scales_radius: false,
            scales_speed: false,
        }),
        closed_zones: 0,
        priority: merged.priority.map_or(Ok(0.0), priority)?,
        characters: merged.characters.map_or(Ok(0), |names| set_of(&names, characters))?,
        style: style_index(styles, merged.style.as_ref()),
    })
}

/// Index of a stated style, counted from 1; 0 where none is stated.
fn style_index(styles: &[String], style: Option<&Spanned<String>>) -> u32 {
    let position = style.and_then(|style| styles.iter().position(|name| name == style.get_ref()));
    position.map_or(0, |position| position as u32 + 1)
}

fn pre_movement(value: DistributionValue) -> Result<Distribution, TableFault> {
    value.resolve("`pre_movement_s`", [*PRE_MOVEMENT_S.start(), *PRE_MOVEMENT_S.end()])
}

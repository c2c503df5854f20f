//! Profiles: numbers of agents by name, each with those of the profile that it inherits from.

use std::collections::{BTreeMap, BTreeSet};

use crate::error::SceneError;
use crate::menge::xml::Element;
use crate::scene::{DrawnNumber, Scene, SceneProfile, SceneState};

/// Preferred speed of a profile that states none, m/s; Menge's.
const PREFERRED_SPEED_MPS: f64 = 1.34;
/// Radius of a profile that states none, m; Menge's.
const RADIUS_M: f64 = 0.2;
/// Mask of the obstacle sets that agents see, where a profile states none; Menge's.
const OBSTACLE_MASK: u64 = 0xffff_ffff;
/// Preferred speeds that a scenario takes, m/s.
const SPEEDS_MPS: [f64; 2] = [0.1, 10.0];
/// Radii that a scenario takes, m.
const RADII_M: [f64; 2] = [0.1, 1.0];

/// One profile with all that it inherits.
#[derive(Clone, Debug)]
pub(crate) struct MengeProfile {
    /// Name under which the scenario writes it: its own, or that of an ancestor with the same numbers.
    pub(crate) shown: String,
    pub(crate) speed_mps: DrawnNumber,
    pub(crate) radius_m: DrawnNumber,
    /// Mask of the obstacle sets that its agents see.
    pub(crate) obstacle_mask: u64,
    written: SceneProfile,
    is_used: bool,
}

/// A set of polygons among the obstacles of the scene.
#[derive(Clone, Debug)]
pub(crate) struct ExplicitSet {
    pub(crate) class: u64,
    /// Indices of its obstacles.
    pub(crate) obstacles: std::ops::Range<usize>,
    /// Its file and line.
    pub(crate) origin: (String, usize),
}

/// All profiles of a scene.
#[derive(Default)]
pub(crate) struct Profiles {
    profiles: BTreeMap<String, MengeProfile>,
    /// Names in the order of the file.
    order: Vec<String>,
    /// Names of the profiles of agents that begin in a state.
    starts: BTreeMap<String, BTreeSet<String>>,
    /// Sets of polygons in the scene; what agents see of them, states decide.
    pub(crate) sets: Vec<ExplicitSet>,
}

impl Profiles {
    /// Reads one profile; it inherits from earlier ones only.
    pub(crate) fn read(&mut self, element: &Element<'_>, scene: &mut Scene) -> Result<(), SceneError> {
        let name = element.required("name")?;
        if self.profiles.contains_key(name) {
            return Err(element.attribute_fault("name", format!("a second profile `{name}`"), "rename one"));
        }
        let parent = match element.text("inherits") {
            None => None,
            Some(parent) => Some(self.profiles.get(parent).ok_or_else(|| {
                let message = format!("profile `{name}` inherits from `{parent}`, which does not come before it");
                element.attribute_fault("inherits", message, "move that profile up; none inherits from itself")
            })?),
        };
        let (own_speed, own_radius, mask) = own_numbers(element, scene)?;
        let or = |own: Option<DrawnNumber>, inherited: Option<DrawnNumber>, default| {
            own.or(inherited).unwrap_or(DrawnNumber::Constant(default))
        };
        let profile = MengeProfile {
            shown: match (parent, own_speed.or(own_radius)) {
                (Some(parent), None) => parent.shown.clone(),
                _ => name.to_owned(),
            },
            speed_mps: or(own_speed, parent.map(|parent| parent.speed_mps), PREFERRED_SPEED_MPS),
            radius_m: or(own_radius, parent.map(|parent| parent.radius_m), RADIUS_M),
            obstacle_mask: mask.or(parent.map(|parent| parent.obstacle_mask)).unwrap_or(OBSTACLE_MASK),
            written: SceneProfile {
                name: name.to_owned(),
                inherits: parent.map(|parent| parent.shown.clone()),
                preferred_speed_mps: own_speed
                    .or(parent.is_none().then_some(DrawnNumber::Constant(PREFERRED_SPEED_MPS))),
                radius_m: own_radius.or(parent.is_none().then_some(DrawnNumber::Constant(RADIUS_M))),
                origin: element.origin(),
            },
            is_used: false,
        };
        self.order.push(name.to_owned());
        self.profiles.insert(name.to_owned(), profile);
        Ok(())
    }

    /// A profile that a group names.
    pub(crate) fn use_named(&mut self, name: &str, selector: &Element<'_>) -> Result<&MengeProfile, SceneError> {
        let fault = || selector.attribute_fault("name", format!("there is no profile `{name}`"), "correct the name");
        let shown = self.profiles.get(name).ok_or_else(fault)?.shown.clone();
        let mut next = Some(shown);
        while let Some(profile) = next.take().and_then(|name| self.profiles.get_mut(&name)) {
            profile.is_used = true;
            next.clone_from(&profile.written.inherits);
        }
        self.profiles.get(name).ok_or_else(fault)
    }

    /// Remembers that agents of some profiles begin in a state.
    pub(crate) fn begin_in(&mut self, state: &str, selected: &[(String, f64, Element<'_>)]) {
        let names = selected.iter().map(|(name, ..)| name.clone());
        self.starts.entry(state.to_owned()).or_default().extend(names);
    }

    /// The profiles that agents have, with their ancestors, in the order of the file.
    pub(crate) fn used(&self) -> Vec<SceneProfile> {
        let in_order = self.order.iter().filter_map(|name| self.profiles.get(name));
        in_order.filter(|profile| profile.is_used).map(|profile| profile.written.clone()).collect()
    }

    /// Whether some, and whether all agents see an obstacle set of a class.
    pub(crate) fn see(&self, class: u64) -> [bool; 2] {
        let names: BTreeSet<&String> = self.starts.values().flatten().collect();
        let sees = |name: &&String| self.profiles.get(*name).is_some_and(|profile| profile.obstacle_mask & class != 0);
        [names.iter().any(&sees), names.iter().all(sees)]
    }

    /// For each state, the profiles of agents that may get there.
    pub(crate) fn by_state<'a>(&'a self, states: &[SceneState]) -> BTreeMap<String, Vec<&'a MengeProfile>> {
        let mut found: BTreeMap<String, BTreeSet<&str>> = BTreeMap::new();
        for (start, names) in &self.starts {
            let mut open = vec![start.as_str()];
            let mut reached = BTreeSet::new();
            while let Some(name) = open.pop() {
                if !reached.insert(name) {
                    continue;
                }
                found.entry(name.to_owned()).or_default().extend(names.iter().map(String::as_str));
                let here = states.iter().filter(|state| state.name == name);
                open.extend(here.flat_map(|state| &state.transitions).flat_map(|transition| transition.to.states()));
            }
        }
        let profiles = |names: BTreeSet<&str>| names.iter().filter_map(|name| self.profiles.get(*name)).collect();
        found.into_iter().map(|(state, names)| (state, profiles(names))).collect()
    }
}

/// Speed, radius and obstacle mask that a profile states itself.
type OwnNumbers = (Option<DrawnNumber>, Option<DrawnNumber>, Option<u64>);

/// Numbers of a profile that agents with bodies do not have: how fast they walk and speed up, and whom they see.
const UNUSED: [&str; 4] = ["max_speed", "max_accel", "neighbor_dist", "max_neighbors"];
/// Note on priorities, of profiles and of states.
pub(crate) const PRIORITIES_UNUSED: &str = "priorities are not used; they act in Menge's model \"pedvo\" alone";

fn own_numbers(element: &Element<'_>, scene: &mut Scene) -> Result<OwnNumbers, SceneError> {
    let (mut speed_mps, mut radius_m, mut mask) = (None, None, None);
    for common in element.named("Common") {
        speed_mps = common.number("pref_speed")?.map(DrawnNumber::Constant).or(speed_mps);
        radius_m = common.number("r")?.map(DrawnNumber::Constant).or(radius_m);
        mask = common.count("obstacleSet")?.or(mask);
        if UNUSED.iter().any(|name| common.text(name).is_some()) {
            let what = format!("{} are not used: the bodies decide", UNUSED.join(", "));
            scene.notes.add(&common.file.shown, common.line(), what, false);
        }
        let mut priority = common.number("priority")?.map(DrawnNumber::Constant);
        for property in common.named("Property") {
            match property.required("name")? {
                "pref_speed" => speed_mps = property.drawn("")?.or(speed_mps),
                "r" => radius_m = property.drawn("")?.or(radius_m),
                "priority" => priority = property.drawn("")?.or(priority),
                _ => {}
            }
        }
        if priority.is_some_and(|priority| priority.constant() != Some(0.0)) {
            scene.notes.add(&common.file.shown, common.line(), PRIORITIES_UNUSED, false);
        }
    }
    for modifier in element.named("VelModifier") {
        let what = format!("the velocity modifier \"{}\" of a profile is not used", modifier.kind());
        scene.notes.add(&modifier.file.shown, modifier.line(), what, true);
    }
    let mut in_range = |what: &str, drawn: Option<DrawnNumber>, [least, greatest]: [f64; 2]| {
        let drawn = drawn?;
        let Some(cut) = drawn.cut(least, greatest) else { return Some(drawn) };
        let [low, high] = drawn.bounds();
        let words = format!("{what} from {low} to {high} is cut to the range from {least} to {greatest}");
        scene.notes.add(&element.file.shown, element.line(), words, drawn.constant().is_some());
        Some(cut)
    };
    Ok((in_range("a speed", speed_mps, SPEEDS_MPS), in_range("a radius", radius_m, RADII_M), mask))
}

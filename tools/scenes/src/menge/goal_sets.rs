//! Goal sets and goals. A scenario states with the goals how an agent chooses, so each choice that a state makes of a
//! set becomes goals of their own.

use std::collections::{BTreeMap, BTreeSet};

use crate::error::SceneError;
use crate::menge::xml::Element;
use crate::scene::{Choose, GoalPlace, Notes, Scene, SceneGoals, Shape};

/// What a selector picks of a set.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Pick {
    /// One goal, by its id.
    One(u64),
    /// Any goal.
    Any(Choose),
}

/// One set.
struct GoalSetEntry {
    goals: BTreeMap<u64, GoalPlace>,
    origin: String,
}

/// All sets, and what the states pick of them.
pub(crate) struct GoalSets {
    sets: BTreeMap<u64, GoalSetEntry>,
    picks: BTreeSet<(u64, Pick)>,
}

impl GoalSets {
    /// Reads the sets of a behaviour, and what its states pick.
    pub(crate) fn read(root: &Element<'_>, scene: &mut Scene) -> Result<Self, SceneError> {
        let mut sets: BTreeMap<u64, GoalSetEntry> = BTreeMap::new();
        for set in root.named("GoalSet") {
            let id = set.count("id")?.ok_or_else(|| set.fault("the goal set has no `id`", "add it"))?;
            let entry = sets.entry(id).or_insert_with(|| GoalSetEntry { goals: BTreeMap::new(), origin: set.origin() });
            for goal in set.named("Goal") {
                let goal_id = goal.count("id")?.ok_or_else(|| goal.fault("the goal has no `id`", "add it"))?;
                if entry.goals.insert(goal_id, place(&goal, scene)?).is_some() {
                    return Err(goal.attribute_fault("id", format!("a second goal {goal_id}"), "give it another id"));
                }
            }
        }
        let mut read = Self { sets, picks: BTreeSet::new() };
        for state in root.named("State") {
            if let Some(selector) = state.child("GoalSelector")
                && let Some(picked) = pick(&selector)?
            {
                read.check(&selector, picked)?;
                read.picks.insert(picked);
            }
        }
        Ok(read)
    }

    fn check(&self, selector: &Element<'_>, (set, pick): (u64, Pick)) -> Result<(), SceneError> {
        let Some(entry) = self.sets.get(&set) else {
            return Err(selector.attribute_fault("goal_set", format!("there is no goal set {set}"), "correct the id"));
        };
        match pick {
            Pick::One(goal) if !entry.goals.contains_key(&goal) => {
                let message = format!("goal set {set} has no goal {goal}");
                Err(selector.attribute_fault("goal", message, "correct the id"))
            }
            Pick::Any(_) if entry.goals.is_empty() => {
                let message = format!("goal set {set} has no goals");
                Err(selector.attribute_fault("goal_set", message, "add a goal"))
            }
            _ => Ok(()),
        }
    }

    /// Name of the goals that a state picks: by the ids of the source.
    pub(crate) fn name(&self, (set, pick): (u64, Pick)) -> String {
        let choices = |(other, pick): &&(u64, Pick)| *other == set && matches!(pick, Pick::Any(_));
        match pick {
            Pick::One(goal) => format!("set_{set}_goal_{goal}"),
            Pick::Any(_) if self.picks.iter().filter(choices).count() == 1 => format!("set_{set}"),
            Pick::Any(Choose::Nearest) => format!("set_{set}_nearest"),
            Pick::Any(Choose::Farthest) => format!("set_{set}_farthest"),
            Pick::Any(Choose::Random) => format!("set_{set}_random"),
            Pick::Any(Choose::Weighted) => format!("set_{set}_weighted"),
        }
    }

    /// The goals that states pick. A capacity that holds all agents is left out.
    pub(crate) fn into_used(self, agents: usize, notes: &mut Notes) -> Vec<SceneGoals> {
        let goals = |&(set, pick): &(u64, Pick)| {
            let entry = self.sets.get(&set)?;
            let (choose, picked): (_, Vec<&GoalPlace>) = match pick {
                Pick::One(goal) => (Choose::Nearest, entry.goals.get(&goal).into_iter().collect()),
                Pick::Any(choose) => (choose, entry.goals.values().collect()),
            };
            let limited = |place: &GoalPlace| GoalPlace {
                capacity: place.capacity.filter(|capacity| *capacity < agents as u64),
                ..place.clone()
            };
            let places = picked.into_iter().map(limited).collect();
            Some(SceneGoals { name: self.name((set, pick)), choose, places, origin: entry.origin.clone() })
        };
        let used: Vec<SceneGoals> = self.picks.iter().filter_map(goals).collect();
        for (set, entry) in &self.sets {
            let counted = self.picks.iter().filter(|(other, _)| other == set).count();
            let is_limited = entry.goals.values().any(|place| place.capacity.is_some_and(|most| most < agents as u64));
            if counted > 1 && is_limited {
                let (file, line) = entry.origin.rsplit_once(':').unwrap_or((&entry.origin, "0"));
                let what = format!("goal set {set} is picked in several ways; each counts its capacity apart");
                notes.add(file, line.parse().unwrap_or(0), what, true);
            }
        }
        used
    }
}

/// What a selector picks of which set; none where it needs no set.
pub(crate) fn pick(selector: &Element<'_>) -> Result<Option<(u64, Pick)>, SceneError> {
    let pick = match selector.kind() {
        "explicit" => {
            let goal = selector.count("goal")?;
            Pick::One(goal.ok_or_else(|| selector.fault("the selector has no `goal`", "add it"))?)
        }
        "nearest" | "nearest_nav_mesh" => Pick::Any(Choose::Nearest),
        "farthest" | "farthest_nav_mesh" => Pick::Any(Choose::Farthest),
        "random" => Pick::Any(Choose::Random),
        "weighted" => Pick::Any(Choose::Weighted),
        _ => return Ok(None),
    };
    let set = selector.count("goal_set")?;
    let set = set.ok_or_else(|| selector.fault("the selector has no `goal_set`", "add it"))?;
    Ok(Some((set, pick)))
}

fn place(goal: &Element<'_>, scene: &mut Scene) -> Result<GoalPlace, SceneError> {
    let shape = match goal.kind() {
        "point" => Shape::Point(goal.point("x", "y")?),
        "circle" => Shape::Circle(goal.point("x", "y")?, goal.metres("radius")?.abs()),
        "AABB" => Shape::rect(goal.point("min_x", "min_y")?, goal.point("max_x", "max_y")?),
        "OBB" => {
            let (pivot_m, size_m) = (goal.point("x", "y")?, goal.point("width", "height")?);
            Shape::turned_rect(pivot_m, size_m, goal.number("angle")?.unwrap_or_default())
        }
        "path" => {
            let what = "a goal that moves along a path stays at the path's first point";
            scene.notes.add(&goal.file.shown, goal.line(), what, true);
            let first = goal.children().find(|child| child.text("x").is_some());
            Shape::Point(first.unwrap_or(*goal).point("x", "y")?)
        }
        kind => {
            return Err(goal.fault(format!("a goal of type \"{kind}\" is unknown"), "use point, circle, AABB or OBB"));
        }
    };
    let weight = goal.number("weight")?.unwrap_or(1.0).clamp(0.0, 1e6);
    let capacity = goal.count("capacity")?;
    if capacity == Some(0) {
        return Err(goal.attribute_fault("capacity", "the goal takes no agent", "give 1 or more"));
    }
    Ok(GoalPlace { shape, capacity: capacity.filter(|most| *most <= u64::from(u32::MAX)), weight })
}

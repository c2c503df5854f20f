//! Scenes for planners to meet in: lines `x y goal_x goal_y`, metres, a file a scene and seed (`NAME_s1.txt`).
//!
//! Those of Table 1 and of the user study are compiled in (`assets/scenarios/table1`, `study`), so that no bench
//! depends on the folder it is run in.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use fbcrowd_sim::params::Params;
use fbcrowd_sim::planning::Planner;
use fbcrowd_sim::scenario::{self, AgentSpec, Coupling, Scenario, agents_of_lines, fault_of_lines};
use motiondb::files::SourceText;

use crate::failure::Failure;

/// Step and time of the comparison: the paper's step (§7); it names no time.
pub(super) const STEP_S: f32 = 0.1;
const DURATION_S: f32 = 60.0;

/// The bundled files: stem and text.
macro_rules! bundled {
    ($folder:literal: $($stem:literal),* $(,)?) => {
        [$(($stem, include_str!(concat!("../../../../../assets/scenarios/", $folder, "/", $stem, ".txt")))),*]
    };
}

const BUNDLED: [(&str, &str); 20] = bundled!["table1":
    "cross2_30_s1",
    "cross2_30_s2",
    "cross2_30_s3",
    "cross2_30_s4",
    "cross2_30_s5",
    "bidir_53_s1",
    "bidir_53_s2",
    "bidir_53_s3",
    "bidir_53_s4",
    "bidir_53_s5",
    "cross4_100_s1",
    "cross4_100_s2",
    "cross4_100_s3",
    "cross4_100_s4",
    "cross4_100_s5",
    "circle_17_s1",
    "circle_17_s2",
    "circle_17_s3",
    "circle_17_s4",
    "circle_17_s5",
];

/// The second scene of the paper's user study; the first is the circle above.
const STUDY: [(&str, &str); 5] =
    bundled!["study": "bidir_18_s1", "bidir_18_s2", "bidir_18_s3", "bidir_18_s4", "bidir_18_s5"];

/// Agents at their starts, for one seed.
#[derive(Clone, Debug)]
pub(super) struct Scene {
    /// The file's stem without `_s<seed>`: scenes of one name are averaged.
    pub(super) name: String,
    /// 1 where the file's name says none.
    pub(super) seed: u64,
    pub(super) agents: Vec<AgentSpec>,
}

impl Scene {
    /// The scene under one planner; MCN's and the rivals' tunables are the same for all scenes.
    pub(super) fn scenario(&self, planner: Planner, coupling: Coupling, params: Params) -> Scenario {
        let (name, seed) = (self.name.clone(), self.seed);
        let settled = Scenario::of(self.agents.clone());
        Scenario { name, duration_s: DURATION_S, dt_s: STEP_S, seed, planner, coupling, params, ..settled }
    }
}

/// The scenes of Table 1 and the antipodal circle, in the paper's order, of some seeds or of all.
pub(super) fn bundled(seeds: &[u64]) -> Result<Vec<Scene>, Failure> {
    scenes(BUNDLED.iter().map(text), seeds)
}

/// The scenes of the paper's user study (§7): the antipodal circle of 17, and two groups of nine head-on.
pub(super) fn study(seeds: &[u64]) -> Result<Vec<Scene>, Failure> {
    let circle = BUNDLED.iter().filter(|(stem, _)| stem.starts_with("circle_17"));
    scenes(circle.chain(&STUDY).map(text), seeds)
}

fn text((stem, text): &(&str, &str)) -> SourceText {
    SourceText { path: PathBuf::from(stem), text: (*text).to_owned() }
}

/// Every scene file of a folder, by name, of some seeds or of all.
pub(super) fn of_folder(folder: &Path, seeds: &[u64]) -> Result<Vec<Scene>, Failure> {
    let bad = |path: &Path, error: std::io::Error| Failure::bad(format!("cannot read {}: {error}", path.display()));
    let mut paths = Vec::new();
    for entry in fs::read_dir(folder).map_err(|error| bad(folder, error))? {
        let path = entry.map_err(|error| bad(folder, error))?.path();
        if path.extension().is_some_and(|extension| extension == "txt") {
            paths.push(path);
        }
    }
    paths.sort();
    let texts = paths.iter().map(|path| SourceText::read(path).map_err(|error| bad(path, error)));
    let texts = texts.collect::<Result<Vec<SourceText>, Failure>>()?;
    if texts.is_empty() {
        let message = format!("{}: no scene there; give a folder of `NAME_s1.txt`", folder.display());
        return Err(Failure::bad(message));
    }
    scenes(texts.into_iter(), seeds)
}

fn scenes(texts: impl Iterator<Item = SourceText>, seeds: &[u64]) -> Result<Vec<Scene>, Failure> {
    let mut found = texts.map(|text| scene(&text)).collect::<Result<Vec<Scene>, Failure>>()?;
    let there: BTreeSet<u64> = found.iter().map(|scene| scene.seed).collect();
    if let Some(missing) = seeds.iter().find(|seed| !there.contains(seed)) {
        let there: Vec<String> = there.iter().map(u64::to_string).collect();
        return Err(Failure::bad(format!("no scene has seed {missing}; there are {}", there.join(", "))));
    }
    found.retain(|scene| seeds.is_empty() || seeds.contains(&scene.seed));
    Ok(found)
}

fn scene(text: &SourceText) -> Result<Scene, Failure> {
    let stem = text.path.file_stem().unwrap_or_default().to_string_lossy();
    let (name, seed) = name_and_seed(&stem);
    let scene = Scene { name: name.to_owned(), seed, agents: agents_of_lines(text)? };
    let scenario = scene.scenario(Planner::default(), Coupling::default(), Params::default());
    scenario::check(&scenario).map_err(|fault| fault_of_lines(text, fault))?;
    Ok(scene)
}

fn name_and_seed(stem: &str) -> (&str, u64) {
    let seeded = stem.rsplit_once("_s").and_then(|(name, seed)| Some((name, seed.parse().ok()?)));
    seeded.unwrap_or((stem, 1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bundled_scenes_are_whole() {
        let scenes = bundled(&[]).unwrap();
        for (name, agents) in [("cross2_30", 30), ("bidir_53", 53), ("cross4_100", 100), ("circle_17", 17)] {
            let found: Vec<&Scene> = scenes.iter().filter(|scene| scene.name == name).collect();
            assert_eq!(found.iter().map(|scene| scene.seed).collect::<Vec<_>>(), [1, 2, 3, 4, 5]);
            assert!(found.iter().all(|scene| scene.agents.len() == agents));
        }
        assert_eq!(bundled(&[2, 4]).unwrap().len(), 8);
        assert_eq!(study(&[3]).unwrap().iter().map(|scene| scene.agents.len()).collect::<Vec<_>>(), [17, 18]);
    }

    #[test]
    fn names_end_before_their_seed() {
        assert_eq!(name_and_seed("cross2_30_s4"), ("cross2_30", 4));
        assert_eq!(name_and_seed("circle_1000"), ("circle_1000", 1));
        assert_eq!(name_and_seed("two_sides"), ("two_sides", 1));
    }
}

//! Scenes for the comparison of planners: lines `x y goal_x goal_y`, metres, a file for each scene and seed
//! (`NAME_s1.txt`).
//!
//! Those of Table 1 and of the user study are compiled in (`assets/scenarios/table1`, `study`), so that no bench
//! depends on its working folder.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use fbcrowd_sim::params::Params;
use fbcrowd_sim::planning::Planner;
use fbcrowd_sim::scenario::{self, AgentSpec, Coupling, Scenario, agents_of_lines, fault_of_lines};
use motiondb::files::SourceText;

use crate::error::BenchError;

/// Time step of the comparison, s: the paper's (§7).
pub(crate) const STEP_S: f32 = 0.1;
/// Duration of a run, s; the paper names none.
const DURATION_S: f32 = 60.0;

/// Stems and texts of bundled files.
macro_rules! bundled {
    ($folder:literal: $($stem:literal),* $(,)?) => {
        [$(($stem, include_str!(concat!("../../../../assets/scenarios/", $folder, "/", $stem, ".txt")))),*]
    };
}

/// The scenes of Table 1 and the antipodal circle.
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

/// The second scene of the paper's user study; the first is the antipodal circle.
const STUDY: [(&str, &str); 5] =
    bundled!["study": "bidir_18_s1", "bidir_18_s2", "bidir_18_s3", "bidir_18_s4", "bidir_18_s5"];

/// Agents at their starts, with their goals.
#[derive(Clone, Debug)]
pub(crate) struct Scene {
    /// The file's stem without `_s<seed>`. Measures are means over the scenes of one name.
    pub(crate) name: String,
    /// Seed of the scene; 1 where the file's name has none.
    pub(crate) seed: u64,
    /// The agents.
    pub(crate) agents: Vec<AgentSpec>,
}

impl Scene {
    /// The scene with one planner. All scenes use the same parameters of the planners.
    pub(crate) fn scenario(&self, planner: Planner, coupling: Coupling, params: Params) -> Scenario {
        let (name, seed) = (self.name.clone(), self.seed);
        let settled = Scenario::of(self.agents.clone());
        Scenario { name, duration_s: DURATION_S, dt_s: STEP_S, seed, planner, coupling, params, ..settled }
    }
}

/// The scenes of Table 1 and the antipodal circle, in the paper's order; of all seeds where none is given.
pub(crate) fn bundled(seeds: &[u64]) -> Result<Vec<Scene>, BenchError> {
    scenes(BUNDLED.iter().map(text), seeds)
}

/// The scenes of the paper's user study (§7): the antipodal circle of 17, and two groups of nine head-on.
pub(crate) fn study(seeds: &[u64]) -> Result<Vec<Scene>, BenchError> {
    let circle = BUNDLED.iter().filter(|(stem, _)| stem.starts_with("circle_17"));
    scenes(circle.chain(&STUDY).map(text), seeds)
}

fn text((stem, text): &(&str, &str)) -> SourceText {
    SourceText { path: PathBuf::from(stem), text: (*text).to_owned() }
}

/// Every scene file of a folder, by name; of all seeds where none is given.
pub(crate) fn of_folder(folder: &Path, seeds: &[u64]) -> Result<Vec<Scene>, BenchError> {
    let unreadable = |error| BenchError::unreadable(folder, error);
    let mut paths = Vec::new();
    for entry in fs::read_dir(folder).map_err(unreadable)? {
        let path = entry.map_err(unreadable)?.path();
        if path.extension().is_some_and(|extension| extension == "txt") {
            paths.push(path);
        }
    }
    paths.sort();
    let texts = paths.iter().map(|path| SourceText::read(path).map_err(|error| BenchError::unreadable(path, error)));
    let texts = texts.collect::<Result<Vec<SourceText>, BenchError>>()?;
    if texts.is_empty() {
        return Err(BenchError::NoScenes { folder: folder.to_owned() });
    }
    scenes(texts.into_iter(), seeds)
}

fn scenes(texts: impl Iterator<Item = SourceText>, seeds: &[u64]) -> Result<Vec<Scene>, BenchError> {
    let mut found = texts.map(|text| scene(&text)).collect::<Result<Vec<Scene>, BenchError>>()?;
    let of_scenes: BTreeSet<u64> = found.iter().map(|scene| scene.seed).collect();
    if let Some(&seed) = seeds.iter().find(|seed| !of_scenes.contains(seed)) {
        return Err(BenchError::NoSuchSeed { seed, seeds: of_scenes.into_iter().collect() });
    }
    found.retain(|scene| seeds.is_empty() || seeds.contains(&scene.seed));
    Ok(found)
}

fn scene(text: &SourceText) -> Result<Scene, BenchError> {
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
    fn bundled_scenes_are_complete() {
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
    fn scene_names_end_before_their_seed() {
        assert_eq!(name_and_seed("cross2_30_s4"), ("cross2_30", 4));
        assert_eq!(name_and_seed("circle_1000"), ("circle_1000", 1));
        assert_eq!(name_and_seed("two_sides"), ("two_sides", 1));
    }
}

//! A made-up Menge project, and what all tests of conversion need.
#![allow(dead_code, reason = "each test uses a part")]

use std::fs;
use std::path::{Path, PathBuf};

use fbcrowd_scenes::write::{WriteOptions, WrittenScene, write};
use fbcrowd_scenes::{ReadOptions, ReadScene, SceneError, read};
use tempfile::TempDir;

pub(crate) const PROJECT: &str = r#"<?xml version="1.0"?>
<Project scene="fair/scene.xml" behavior="fair/behaviour.xml" view="fair/view.xml" model="orca" duration="90" random="7"/>
"#;

pub(crate) const SCENE: &str = r#"<?xml version="1.0"?>
<Experiment version="2.0">
  Stray words between tags.
  <Common time_step="0.1"/>
  <AgentProfile name="adult">
    <Common r="0.25" pref_speed="1.20" obstacleSet="1"/>
  </AgentProfile>
  <AgentProfile name="alike" inherits="adult">
    <Common class="3"/>
  </AgentProfile>
  <AgentProfile name="child" inherits="adult">
    <Common r="0.15"><Property name="pref_speed" dist="u" min="0.8" max="1.1"/></Common>
  </AgentProfile>
  <AgentGroup>
    <ProfileSelector type="const" name="alike"/>
    <StateSelector type="const" name="Visit"/>
    <Generator type="rect_grid" anchor_x="0" anchor_y="0" offset_x="-2" offset_y="2" count_x="3" count_y="2"
      displace_dist="u" displace_min="0" displace_max="0.2"/>
  </AgentGroup>
  <AgentGroup>
    <ProfileSelector type="weighted"><Profile name="adult" weight="3"/><Profile name="child" weight="1"/></ProfileSelector>
    <StateSelector type="const" name="Visit"/>
    <Generator type="explicit"><Agent p_x="5" p_y="5"/><Agent p_x="8.5" p_y="8.5"/></Generator>
  </AgentGroup>
  <ObstacleSet type="explicit" class="1">
    <Obstacle closed="1"><Vertex p_x="8" p_y="8"/><Vertex p_x="9" p_y="8"/><Vertex p_x="9" p_y="9"/><Vertex p_x="8" p_y="9"/></Obstacle>
    <Obstacle closed="1"><Vertex p_x="-20" p_y="-20"/><Vertex p_x="-20" p_y="20"/><Vertex p_x="20" p_y="20"/><Vertex p_x="20" p_y="-20"/></Obstacle>
  </ObstacleSet>
  <ObstacleSet type="explicit" class="2">
    <Obstacle closed="1"><Vertex p_x="1" p_y="-9"/><Vertex p_x="2" p_y="-9"/><Vertex p_x="2" p_y="-8"/></Obstacle>
  </ObstacleSet>
</Experiment>
"#;

pub(crate) const BEHAVIOUR: &str = r#"<?xml version="1.0"?>
<BFSM>
  <GoalSet id="4">
    <Goal id="0" type="AABB" min_x="10" min_y="0" max_x="12" max_y="1" capacity="2" weight="3"/>
    <Goal id="1" type="circle" x="-10" y="0" radius="0.5"/>
    <Goal id="2" type="OBB" x="0" y="12" width="2" height="1" angle="90"/>
  </GoalSet>
  <State name="Visit" final="0">
    <GoalSelector type="weighted" goal_set="4"/>
    <VelComponent type="goal"/>
    <Action type="scale_property" property="pref_speed" dist="c" value="0.5" exit_reset="0"/>
  </State>
  <State name="Look" final="0"><VelComponent type="zero"/></State>
  <State name="Home" final="0">
    <GoalSelector type="explicit" goal_set="4" goal="1"/>
    <VelComponent type="road_map" file_name="roads.txt"/>
  </State>
  <State name="End" final="1"/>
  <Transition from="Visit" to="Look"><Condition type="goal_reached" distance="0.4"/></Transition>
  <Transition from="Look, Visit">
    <Condition type="timer" dist="n" mean="5" stddev="2" min="1" max="9" per_agent="1"/>
    <Target type="prob"><State name="Visit" weight="2"/><State name="Home" weight="1"/></Target>
  </Transition>
  <Transition from="Home" to="End">
    <Condition type="and">
      <Condition type="circle" center_x="-10" center_y="0" radius="2" inside="1"/>
      <Condition type="not"><Condition type="AABB" min_x="0" min_y="0" max_x="1" max_y="1" inside="0"/></Condition>
    </Condition>
  </Transition>
</BFSM>
"#;

/// A folder with a project.
pub(crate) struct Project(pub(crate) TempDir);

impl Project {
    /// The made-up project, with files replaced.
    pub(crate) fn new(replaced: &[(&str, &str)]) -> Self {
        let folder = tempfile::tempdir().unwrap();
        fs::create_dir(folder.path().join("fair")).unwrap();
        let files = [
            ("fair.xml", PROJECT),
            ("fair/scene.xml", SCENE),
            ("fair/behaviour.xml", BEHAVIOUR),
            ("fair/view.xml", "<View width=\"320\" height=\"200\"><Camera/></View>"),
            ("fair/roads.txt", "0\n0\n"),
        ];
        for (name, text) in files.iter().chain(replaced) {
            fs::write(folder.path().join(name), text).unwrap();
        }
        Self(folder)
    }

    /// The made-up project, with a part of a file replaced.
    pub(crate) fn with(file: &str, from: &str, to: &str) -> Self {
        let text = match file {
            "fair.xml" => PROJECT,
            "fair/scene.xml" => SCENE,
            _ => BEHAVIOUR,
        };
        assert!(text.contains(from), "{from}");
        Self::new(&[(file, &text.replacen(from, to, 1))])
    }

    pub(crate) fn path(&self) -> PathBuf {
        self.0.path().join("fair.xml")
    }

    pub(crate) fn read(&self) -> Result<ReadScene, SceneError> {
        read(&self.path(), &ReadOptions::default())
    }

    /// The scenario, checked as TOML, and its notes "line: what" with `!` where they change what happens.
    pub(crate) fn converted(&self) -> (WrittenScene, Vec<String>) {
        written(&self.read().unwrap())
    }
}

/// The scenario of a scene, checked as TOML, and its notes.
pub(crate) fn written(read: &ReadScene) -> (WrittenScene, Vec<String>) {
    let written = write(&read.scene, &WriteOptions { stem: "fair".to_owned(), ..WriteOptions::default() });
    toml::from_str::<toml::Table>(&written.scenario).unwrap_or_else(|error| panic!("{error}\n{}", written.scenario));
    let note = |note: fbcrowd_scenes::scene::Note| {
        format!("{}{}: {}", if note.changes { "!" } else { "" }, note.line, note.what)
    };
    (written, read.scene.notes.list().into_iter().map(note).collect())
}

/// Writes a file and reads it as a scene.
pub(crate) fn read_text(name: &str, text: &str) -> Result<ReadScene, SceneError> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    fs::write(&path, text).unwrap();
    read(&path, &ReadOptions::default())
}

/// Names of all project files below a folder.
pub(crate) fn projects(folder: &Path) -> Vec<PathBuf> {
    let mut open = vec![folder.to_owned()];
    let mut found = Vec::new();
    while let Some(folder) = open.pop() {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                open.push(path);
            } else if path.extension().is_some_and(|extension| extension == "xml")
                && fs::read_to_string(&path).is_ok_and(|text| text.contains("<Project"))
            {
                found.push(path);
            }
        }
    }
    found.sort();
    found
}

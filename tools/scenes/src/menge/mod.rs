//! Projects of Menge (menge.cs.unc.edu): a project file, and the scene, behaviour and view files that it names.
//!
//! Enters: the path of a project file. Leaves: a [`Scene`], and the files that were read. `docs/convert.md` lists every
//! feature and what becomes of it.
//!
//! Read `project` (the order of reading), `xml` and `files`; then the scene: `scene_file`, `profiles`, `generators`,
//! `obstacle_sets`, `nav_mesh`; then the behaviour: `behaviour_file`, `goal_sets`, `states`, `actions`, `transitions`,
//! `events`.

mod actions;
mod behaviour_file;
mod events;
mod files;
mod generators;
mod goal_sets;
mod nav_mesh;
mod obstacle_sets;
mod profiles;
mod project;
mod scene_file;
mod states;
mod transitions;
mod xml;

pub(crate) use project::read;

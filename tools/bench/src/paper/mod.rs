//! Benches of the paper's tables and figures (§7, App. 11).
//!
//! Enters: the paper's scenes and its obstacle course. Leaves: Table 1 ([`table1`]; its measures in [`table1_figures`],
//! its texts and pictures in [`table1_text`] and [`table1_plots`], its baselines without bodies in [`table1_discs`]),
//! Fig. 7 ([`figure7`]), Fig. 6 ([`figure6`], with [`figure6_scene`] and [`figure6_times`]), the coupling on the scenes
//! of the user study ([`coupled`]), the obstacle course ([`course`]), and the scenes of §7 ([`scenes`], of which
//! [`scene_run`] simulates one).

pub mod coupled;
pub mod course;
pub mod figure6;
pub(crate) mod figure6_scene;
pub mod figure6_times;
pub mod figure7;
pub mod scene_run;
pub mod scenes;
pub mod table1;
pub(crate) mod table1_discs;
pub mod table1_figures;
pub(crate) mod table1_plots;
pub(crate) mod table1_text;

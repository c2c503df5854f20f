//! All plots of a database, as `inspect --plots` writes them.
//!
//! Plots of single examples are split into sheets if the examples are many: `contact_sheet.png`, `contact_sheet_2.png`
//! …

use std::fs;
use std::ops::Range;
use std::path::{Path, PathBuf};

use motiondb::motion::MotionDb;
use tiny_skia::Pixmap;

use crate::error::RenderError;
use crate::plots::database::contact_sheet::{self, contact_sheet};
use crate::plots::database::coverage::coverage_slices;
use crate::plots::database::gait_events::{self, gait_events};
use crate::plots::database::parameter_space::parameter_space;
use crate::plots::database::pose_distances::pose_distances;
use crate::plots::database::transition_sheet::{self, recorded_transitions, transition_sheet};
use crate::plots::database::velocity_space::velocity_space;
use crate::raster::png_frame;

/// Writes every plot of a database into a folder, which is made if missing; returns the paths of the files.
///
/// ```no_run
/// use std::path::Path;
///
/// use fbcrowd_render::plots::database::write_database_plots;
/// use motiondb::files::database_file;
///
/// let (db, _checksum) = database_file::load(Path::new("motion.fbdb"))?;
/// for file in write_database_plots(&db, Path::new("plots"))? {
///     println!("{}", file.display());
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// If the folder cannot be made or a file cannot be written.
pub fn write_database_plots(db: &MotionDb, folder: &Path) -> Result<Vec<PathBuf>, RenderError> {
    fs::create_dir_all(folder).map_err(|source| RenderError::Folder { folder: folder.to_owned(), source })?;
    let always = [
        ("velocity_space.png", velocity_space(db)),
        ("parameter_space.png", parameter_space(db)),
        ("coverage.png", coverage_slices(db)),
    ];
    let write = |(name, plot): (String, Pixmap)| {
        let path = folder.join(name);
        png_frame::write(&path, &plot).map(|()| path)
    };
    let correspondences = pose_distances(db).map(|plot| ("pose_distance.png", plot));
    let single = always.into_iter().chain(correspondences).map(|(name, plot)| (name.to_owned(), plot));
    let gaits = sheets(db.examples.len(), gait_events::SHEET_EXAMPLES)
        .map(|(suffix, examples)| (format!("gait_events{suffix}.png"), gait_events(db, examples)));
    let bodies = sheets(db.examples.len(), contact_sheet::SHEET_EXAMPLES)
        .map(|(suffix, examples)| (format!("contact_sheet{suffix}.png"), contact_sheet(db, examples)));
    let recorded = recorded_transitions(db);
    let transitions = sheets(recorded.len(), transition_sheet::SHEET_TRANSITIONS)
        .map(|(suffix, part)| (format!("transitions{suffix}.png"), transition_sheet(db, &recorded[part])));
    single.chain(gaits).chain(bodies).chain(transitions).map(write).collect()
}

/// Paths of all files that [`write_database_plots`] may write into a folder.
pub fn database_plot_paths(db: &MotionDb, folder: &Path) -> Vec<PathBuf> {
    let single = ["velocity_space", "parameter_space", "coverage", "pose_distance"].map(str::to_owned);
    let gaits =
        sheets(db.examples.len(), gait_events::SHEET_EXAMPLES).map(|(suffix, _)| format!("gait_events{suffix}"));
    let bodies =
        sheets(db.examples.len(), contact_sheet::SHEET_EXAMPLES).map(|(suffix, _)| format!("contact_sheet{suffix}"));
    let transitions = sheets(recorded_transitions(db).len(), transition_sheet::SHEET_TRANSITIONS)
        .map(|(suffix, _)| format!("transitions{suffix}"));
    single
        .into_iter()
        .chain(gaits)
        .chain(bodies)
        .chain(transitions)
        .map(|name| folder.join(format!("{name}.png")))
        .collect()
}

/// Suffix of each sheet's name, and the indices of its examples.
fn sheets(examples: usize, each: usize) -> impl Iterator<Item = (String, Range<usize>)> {
    (0..examples.div_ceil(each)).map(move |sheet| {
        let suffix = if sheet == 0 { String::new() } else { format!("_{}", sheet + 1) };
        (suffix, sheet * each..examples.min((sheet + 1) * each))
    })
}

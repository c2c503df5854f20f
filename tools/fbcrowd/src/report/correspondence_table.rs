//! Times at which synthesis could change between any two examples (`FbCrowd` §5, Eq. 10): JSON, text and picture.

use std::path::{Path, PathBuf};

use fbcrowd_render::error::RenderError;
use fbcrowd_render::plots::database::pose_distances_between;
use fbcrowd_render::raster::png_frame;
use motiondb::motion::{MotionDb, pose_pairs};
use motiondb_compiler::input::nearest_first;
use schemars::JsonSchema;
use serde::Serialize;

/// Most similar names that the message shows where a name is unknown.
const NEAR_NAMES: usize = 5;

/// Times at which the poses of two examples are alike.
#[derive(JsonSchema, Serialize)]
pub(crate) struct CorrespondenceTable {
    /// Name of the first example.
    from: String,
    /// Name of the second example.
    to: String,
    /// Pairs of a time of the first and a time of the second example, s.
    pairs_s: Vec<[f32; 2]>,
    /// Distance of the two poses of each pair, m.
    distances_m: Vec<f32>,
    /// Both examples, as indices.
    #[serde(skip)]
    examples: [usize; 2],
    /// Names of those that stand.
    #[serde(skip)]
    standing: Vec<String>,
}

impl CorrespondenceTable {
    /// The table of two examples; an error message where a name is unknown.
    pub(crate) fn new(db: &MotionDb, [from, to]: [&String; 2]) -> Result<Self, String> {
        let examples = [find(db, from)?, find(db, to)?];
        let table = pose_pairs(db, examples[0], examples[1]);
        let standing =
            examples.map(|index| &db.examples[index]).into_iter().filter(|example| example.key_times_s.is_none());
        Ok(Self {
            from: from.clone(),
            to: to.clone(),
            pairs_s: table.iter().map(|pair| pair.times_s).collect(),
            distances_m: table.iter().map(|pair| pair.distance_m).collect(),
            examples,
            standing: standing.map(|example| example.name.clone()).collect(),
        })
    }

    /// Draws the distances of all poses into an existing folder; returns the path of the picture.
    pub(crate) fn draw(&self, db: &MotionDb, folder: &Path) -> Result<PathBuf, RenderError> {
        let path = Self::plot_path(folder);
        png_frame::write(&path, &pose_distances_between(db, self.examples)).map(|()| path)
    }

    /// Path of the picture in a folder.
    pub(crate) fn plot_path(folder: &Path) -> PathBuf {
        folder.join("pose_distance_between.png")
    }

    /// The table as text.
    pub(crate) fn text(&self) -> String {
        let mut text = format!("\nalike in {} and {}\n  from s    to s  distance cm\n", self.from, self.to);
        for ([from_s, to_s], distance_m) in self.pairs_s.iter().zip(&self.distances_m) {
            text += &format!("{from_s:8.3}{to_s:8.3}{:13.1}\n", 100.0 * distance_m);
        }
        for name in &self.standing {
            text += &format!("{name} stands and has no steps: its times are those at which the poses are most alike\n");
        }
        text
    }
}

/// The index of the example with this name.
fn find(db: &MotionDb, name: &str) -> Result<usize, String> {
    let found = db.examples.iter().position(|example| example.name == name);
    found.ok_or_else(|| {
        let mut near = nearest_first(name, db.examples.iter().map(|example| example.name.as_str()));
        near.truncate(NEAR_NAMES);
        format!("no example is called `{name}`; near it are {}", near.join(", "))
    })
}

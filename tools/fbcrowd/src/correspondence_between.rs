//! Where synthesis could switch between any two examples (`FbCrowd` §5, Eq. 10): the table, its JSON and its picture.

use std::path::{Path, PathBuf};

use fbcrowd_render::plots::database::pose_distances_between;
use fbcrowd_render::raster::png_frame;
use motiondb::motion::{MotionDb, pose_pairs};
use motiondb_compiler::input::nearest_first;
use serde::Serialize;

use crate::failure::Failure;

/// Names that are shown where there is none as given.
const NEAR_NAMES: usize = 5;

/// The table of two examples.
#[derive(Serialize)]
pub(crate) struct Between {
    from: String,
    to: String,
    pairs_s: Vec<[f32; 2]>,
    distances_m: Vec<f32>,
    #[serde(skip)]
    examples: [usize; 2],
    #[serde(skip)]
    stands: Vec<String>,
}

impl Between {
    /// The table of the two examples that are named.
    pub(crate) fn new(db: &MotionDb, names: &[String]) -> Result<Self, Failure> {
        let [from, to] = names else { return Err(Failure::bad("--correspondence takes the names of two examples")) };
        let examples = [find(db, from)?, find(db, to)?];
        let table = pose_pairs(db, examples[0], examples[1]);
        let stands =
            examples.map(|index| &db.examples[index]).into_iter().filter(|example| example.key_times_s.is_none());
        Ok(Self {
            from: from.clone(),
            to: to.clone(),
            pairs_s: table.iter().map(|alike| alike.times_s).collect(),
            distances_m: table.iter().map(|alike| alike.distance_m).collect(),
            examples,
            stands: stands.map(|example| example.name.clone()).collect(),
        })
    }

    /// Draws the distances of all poses into a folder that exists; returns the picture.
    pub(crate) fn draw(&self, db: &MotionDb, folder: &Path) -> Result<PathBuf, Failure> {
        let path = folder.join("pose_distance_between.png");
        png_frame::write(&path, &pose_distances_between(db, self.examples))?;
        Ok(path)
    }

    /// The table for people.
    pub(crate) fn text(&self) -> String {
        let mut text = format!("\nalike in {} and {}\n  from s    to s  distance cm\n", self.from, self.to);
        for ([from_s, to_s], distance_m) in self.pairs_s.iter().zip(&self.distances_m) {
            text += &format!("{from_s:8.3}{to_s:8.3}{:13.1}\n", 100.0 * distance_m);
        }
        for name in &self.stands {
            text += &format!("{name} stands and has no steps: its times are those of standing that are most alike\n");
        }
        text
    }
}

/// The example of a name.
fn find(db: &MotionDb, name: &str) -> Result<usize, Failure> {
    let found = db.examples.iter().position(|example| example.name == name);
    found.ok_or_else(|| {
        let mut near = nearest_first(name, db.examples.iter().map(|example| example.name.as_str()));
        near.truncate(NEAR_NAMES);
        Failure::bad(format!("no example is called `{name}`; near it are {}", near.join(", ")))
    })
}

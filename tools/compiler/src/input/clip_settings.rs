//! What is to be imported: a file, one animation of it or a part, and whatever a manifest says instead of letting it be
//! found.

use std::collections::BTreeMap;
use std::ops::Range;
use std::path::PathBuf;

use motiondb::body::{JOINT_COUNT, Joint};

use crate::error::{Refusal, Setting};
use crate::input::name_suggestions::nearest_first;
use crate::read::source_clip::SourceClip;
use crate::retarget::axis::Axis;

/// Source joint by canonical role, where a manifest names it.
pub type JointMap = [Option<usize>; JOINT_COUNT];

/// One file, as it is to be imported.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Take {
    /// The file.
    pub path: PathBuf,
    /// The only animation to be used of a glTF file.
    pub animation: Option<String>,
    /// What need not be found.
    pub settings: Settings,
    /// Where the manifest says it.
    pub places: Places,
}

/// What a manifest says of a clip; all else is found.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Settings {
    /// The example's name, else the file's stem.
    pub name: Option<String>,
    /// First and last frame that are used, counted from 1.
    pub frames: Option<[usize; 2]>,
    /// Metres of one source unit.
    pub metres_per_unit: Option<f64>,
    /// Up in the source's axes.
    pub up: Option<Axis>,
    /// Where the body faces in the first frame, to within 90°, in the source's axes.
    pub forward: Option<Axis>,
    /// Frames a second.
    pub frame_rate_hz: Option<f64>,
    /// Names of source joints by role.
    pub joints: BTreeMap<Joint, String>,
    /// Whether its example is mirrored.
    pub mirror: Option<bool>,
}

/// Bytes of the manifest's text.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Places {
    /// Of the whole table.
    pub table: Range<usize>,
    /// Of single values.
    pub values: BTreeMap<Setting, Range<usize>>,
}

impl From<PathBuf> for Take {
    fn from(path: PathBuf) -> Self {
        Self { path, ..Self::default() }
    }
}

impl Settings {
    /// Changes a clip as its file tells it into the clip that its file should have told.
    ///
    /// # Errors
    /// Where the frames are not there.
    pub(crate) fn correct(&self, clip: &mut SourceClip) -> Result<(), Refusal> {
        clip.frame_rate_hz = self.frame_rate_hz.unwrap_or(clip.frame_rate_hz);
        clip.metres_per_unit = self.metres_per_unit.or(clip.metres_per_unit);
        clip.up_axis = self.up.or(clip.up_axis);
        let Some([first, last]) = self.frames else { return Ok(()) };
        let count = clip.frame_count();
        if last > count {
            let reason = format!("{} has no frame {last}: its frames are 1 to {count}", title(clip));
            return Err(Refusal::Setting { setting: Setting::Frames, reason, remedy: "end the range earlier" });
        }
        clip.keep_frames(first - 1..last);
        Ok(())
    }

    /// The joints that the map names.
    ///
    /// # Errors
    /// Where the clip has no joint of a name.
    pub(crate) fn joint_map(&self, clip: &SourceClip) -> Result<JointMap, Refusal> {
        let mut map = [None; JOINT_COUNT];
        for (&role, name) in &self.joints {
            let found = clip.joints.iter().position(|joint| joint.name == *name);
            map[role.index()] = Some(found.ok_or_else(|| {
                let names = nearest_first(name, clip.joints.iter().map(|joint| joint.name.as_str()));
                let reason = format!("{} has no joint `{name}`; it has {}", title(clip), names.join(", "));
                Refusal::Setting { setting: Setting::Joint(role), reason, remedy: "name one of these" }
            })?);
        }
        Ok(map)
    }
}

fn title(clip: &SourceClip) -> String {
    if clip.clip.is_empty() { clip.file.clone() } else { format!("{}, {}", clip.file, clip.clip) }
}

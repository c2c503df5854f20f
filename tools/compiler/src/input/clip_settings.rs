//! Settings of one clip: the file, the part of it to import, and values that the user states instead of letting the
//! compiler find them.

use std::collections::BTreeMap;
use std::ops::Range;
use std::path::PathBuf;

use motiondb::body::{JOINT_COUNT, Joint};
use motiondb::motion::ActionKind;

use crate::error::{ManifestKey, RejectionReason};
use crate::input::name_suggestions::nearest_first;
use crate::read::axis::Axis;
use crate::read::gltf::Outside;
use crate::read::source_clip::SourceClip;
use crate::read::source_motion::SourceMotion;
use crate::rig::roles::JointMap;

/// One clip to import. The default of every field but `path` lets the compiler find the value.
///
/// ```
/// use std::path::PathBuf;
///
/// use motiondb_compiler::{ClipSettings, import_with_settings};
///
/// let walk = PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets/clips/walk_110.bvh"));
/// let settings = ClipSettings { frames: Some([1, 61]), ..ClipSettings::from(walk) };
/// let clip = import_with_settings(&settings)?.remove(0).outcome?;
/// assert_eq!(clip.frames.len(), 61);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ClipSettings {
    /// Path of the file.
    pub path: PathBuf,
    /// The only animation to use of a glTF file; all of them where `None`.
    pub animation: Option<String>,
    /// Name of the example; the file's stem where `None`.
    pub name: Option<String>,
    /// First and last frame to use, counted from 1.
    pub frames: Option<[usize; 2]>,
    /// Metres of one source unit.
    pub metres_per_unit: Option<f64>,
    /// The source's axis that points up.
    pub up: Option<Axis>,
    /// The source's axis that the body faces in the first frame, to within 60°.
    pub forward: Option<Axis>,
    /// Frame rate, Hz.
    pub frame_rate_hz: Option<f64>,
    /// Names of source joints, by role.
    pub joints: BTreeMap<Joint, String>,
    /// Whether the example is mirrored; where `None`, when its mirror image adds to the set.
    pub mirror: Option<bool>,
    /// Whether parts in which the body kneels, crawls or crouches give examples, too.
    pub takes_any_posture: bool,
    /// The kind of transition that the clip shows; it then gives no example.
    pub transition: Option<ActionKind>,
    /// The style, such as `elderly`; empty for none; where `None`, the one that the path names.
    pub style: Option<String>,
    /// Whether a glTF file's buffers may lie outside its folder; no manifest can allow it.
    pub outside: Outside,
    /// Positions of these values in the manifest's text, for messages.
    pub spans: ManifestSpans,
}

/// Byte ranges of a manifest's text that state the settings of one clip.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ManifestSpans {
    /// The innermost `[[clips]]` table.
    pub table: Range<usize>,
    /// Single values, by key.
    pub values: BTreeMap<ManifestKey, Range<usize>>,
}

impl From<PathBuf> for ClipSettings {
    fn from(path: PathBuf) -> Self {
        Self { path, ..Self::default() }
    }
}

impl ClipSettings {
    /// Overrides what the file states of its frame rate, unit, up axis and frames.
    ///
    /// # Errors
    /// [`RejectionReason::ManifestContradicted`] if the clip has fewer frames than are stated.
    pub(crate) fn apply_to(&self, motion: &mut SourceMotion) -> Result<(), RejectionReason> {
        let clip = &mut motion.head;
        clip.frame_rate_hz = self.frame_rate_hz.unwrap_or(clip.frame_rate_hz);
        clip.metres_per_unit = self.metres_per_unit.or(clip.metres_per_unit);
        clip.up_axis = self.up.or(clip.up_axis);
        let Some([first, last]) = self.frames else { return Ok(()) };
        let count = motion.frame_count();
        if last > count {
            return Err(RejectionReason::ManifestContradicted {
                key: ManifestKey::Frames,
                problem: format!("{} has no frame {last}: its frames are 1 to {count}", title(&motion.head)),
                remedy: "end the range earlier",
            });
        }
        motion.keep_frames(first - 1..last);
        Ok(())
    }

    /// The reason that a stated unit makes no human body, where a body is impossible by its size alone.
    pub(crate) fn contradicted_unit(&self, reason: &RejectionReason) -> Option<RejectionReason> {
        let (Some(metres_per_unit), RejectionReason::LegLength { leg_m }) = (self.metres_per_unit, reason) else {
            return None;
        };
        Some(RejectionReason::ManifestContradicted {
            key: ManifestKey::MetresPerUnit,
            problem: format!("with {metres_per_unit} m a unit, thigh and shank are {leg_m:.3} m long"),
            remedy: "correct `metres_per_unit`, or leave it out: units are found by the size of the body",
        })
    }

    /// The source joints of the roles that `joints` names.
    ///
    /// # Errors
    /// [`RejectionReason::ManifestContradicted`] if the clip has no joint of a stated name.
    pub(crate) fn joint_map(&self, clip: &SourceClip) -> Result<JointMap, RejectionReason> {
        let mut map = [None; JOINT_COUNT];
        for (&role, name) in &self.joints {
            let found = clip.joints.iter().position(|joint| joint.name == *name);
            map[role.index()] = Some(found.ok_or_else(|| {
                let names = nearest_first(name, clip.joints.iter().map(|joint| joint.name.as_str()));
                RejectionReason::ManifestContradicted {
                    key: ManifestKey::Joint(role),
                    problem: format!("{} has no joint `{name}`; it has {}", title(clip), names.join(", ")),
                    remedy: "name one of these",
                }
            })?);
        }
        Ok(map)
    }
}

/// File and clip, for messages.
fn title(clip: &SourceClip) -> String {
    if clip.clip.is_empty() { clip.file.clone() } else { format!("{}, {}", clip.file, clip.clip) }
}

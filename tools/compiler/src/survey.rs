//! Survey: what can be reported of clips without a database. The record of each source, and its gait in the source's
//! time.
//!
//! The gait is that of the performer's own body and independent of the other clips: all contacts of the clip, not only
//! those of the steady part that an example is made of. Times in seconds from the file's first frame, so that they
//! compare with labels that others set on the same file.

use motiondb::diagnostic::Unfit;
use motiondb::motion::SourceRecord;
use rayon::prelude::*;
use serde::{Serialize, Serializer};

use crate::compile::TargetedClips;
use crate::cycle::analyzed_clip::AnalyzedClip;
use crate::dedup::comparison_log::ComparisonLog;
use crate::gait::foot_stance::FootStance;
use crate::gait::performer_gait::PerformerGait;
use crate::gait::windows::{GaitWindow, WindowGait};
use crate::retarget::human_clip::HumanClip;
use crate::styles::style_part::{StylePart, by_style};

/// The record of a clip, and what its feet do.
#[derive(Clone, Debug, PartialEq)]
pub struct SurveyedSource {
    /// The record that a database would hold.
    pub source: SourceRecord,
    /// The style of the clip; empty for none.
    pub style: String,
    /// Gait of the whole clip.
    pub gait: SourceGait,
}

/// What the feet do in a whole clip.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SourceGait {
    /// The clip steps, stands or does neither.
    #[serde(flatten)]
    pub kind: GaitKind,
    /// Share of the clip for which a foot is planted, mean of both feet.
    pub planted_share: f32,
    /// Contacts of the right foot, in order of time.
    pub right: Vec<ContactTimes>,
    /// Contacts of the left foot, in order of time.
    pub left: Vec<ContactTimes>,
}

/// What a clip shows.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
pub enum GaitKind {
    /// Steady strides.
    Steps,
    /// A body that stands.
    Stands,
    /// Nothing that an example could be made of.
    Unsteady {
        /// Why the clip gives no example; in JSON as a sentence.
        #[serde(serialize_with = "sentence")]
        reason: Unfit,
    },
}

/// Times of one contact of a foot.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ContactTimes {
    /// Heel strike, or first touch of any part of the foot, s; `None` where the clip begins later.
    pub strike_s: Option<f32>,
    /// Toe-off, or last touch of any part of the foot, s; `None` where the clip ends before.
    pub toe_off_s: Option<f32>,
}

impl SourceGait {
    /// Number of contacts whose strike the clip shows.
    pub fn step_count(&self) -> usize {
        self.right.iter().chain(&self.left).filter(|contact| contact.strike_s.is_some()).count()
    }
}

/// The record and the gait of each clip, with the diagnostics of a compilation, in the order of a database.
///
/// # Examples
/// ```
/// use std::path::Path;
///
/// use motiondb_compiler::import_file;
/// use motiondb_compiler::survey::{GaitKind, survey};
///
/// let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/clips/walk_110.bvh");
/// let clips = import_file(&file)?.into_iter().filter_map(|import| import.outcome.ok()).collect();
/// let gait = &survey(clips)[0].gait;
/// assert_eq!(gait.kind, GaitKind::Steps);
/// assert!(gait.step_count() >= 8);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn survey(clips: Vec<HumanClip>) -> Vec<SurveyedSource> {
    let Some(mut set) = TargetedClips::of(clips) else { return Vec::new() };
    let gaits: Vec<SourceGait> = set.clips.par_iter().map(source_gait).collect();
    let compared = set.compared();
    let analyzed = set.analyzed();
    let TargetedClips { clips, body } = set;
    let log = ComparisonLog::default();
    let parts = by_style(clips, compared, analyzed).into_iter().map(|part| part.without_duplicates(&body, &log));
    let records = |part: StylePart| {
        let StylePart { indices, clips, analyzed, .. } = part;
        let record = |((index, clip), found): ((usize, HumanClip), AnalyzedClip)| {
            (index, clip.style.clone(), found.record(&clip))
        };
        indices.into_iter().zip(clips).zip(analyzed).map(record).collect::<Vec<_>>()
    };
    let mut records: Vec<(usize, String, SourceRecord)> = parts.flat_map(records).collect();
    records.sort_by_key(|(index, ..)| *index);
    let surveyed = |((_, style, source), gait)| SurveyedSource { source, style, gait };
    records.into_iter().zip(gaits).map(surveyed).collect()
}

fn sentence<S: Serializer>(reason: &Unfit, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_str(reason)
}

fn source_gait(clip: &HumanClip) -> SourceGait {
    let performer = PerformerGait::of(clip);
    let gait = &performer.gait;
    let steps = |window: &GaitWindow| matches!(window.gait, WindowGait::Steps(_));
    let kind = match &gait.windows {
        Ok(windows) if windows.iter().any(steps) => GaitKind::Steps,
        Ok(_) => GaitKind::Stands,
        Err(reason) => GaitKind::Unsteady { reason: reason.clone() },
    };
    let frames = FileFrames::of(&performer, clip);
    let stances = gait.clearest_stances();
    let [left_share, right_share] = stances.each_ref().map(|stances| frames.planted_share(stances));
    let [left, right] = stances.each_ref().map(|stances| frames.contact_times(stances));
    SourceGait { kind, planted_share: (0.5 * (left_share + right_share)) as f32, right, left }
}

/// The frames of an analysed clip that the file itself has: all frames, or the middle copy of an unrolled loop.
struct FileFrames {
    /// First frame of the analysed clip that the file has.
    start: f64,
    /// Last frame of the analysed clip that the file has.
    end: f64,
    /// Frames of the file before `start`.
    first_frame: usize,
    frame_rate_hz: f64,
}

impl FileFrames {
    fn of(performer: &PerformerGait, clip: &HumanClip) -> Self {
        let frames = performer.loop_frames.map_or([0, performer.frame_count - 1], |round| [round, 2 * round]);
        let [start, end] = frames.map(|frame| frame as f64);
        Self { start, end, first_frame: clip.first_frame, frame_rate_hz: clip.frame_rate_hz }
    }

    fn contact_times(&self, stances: &[FootStance]) -> Vec<ContactTimes> {
        let in_file_s = |frame: f64| ((frame - self.start + self.first_frame as f64) / self.frame_rate_hz) as f32;
        let times = |stance: &FootStance| ContactTimes {
            strike_s: (stance.strike_frame >= self.start).then(|| in_file_s(stance.strike_frame)),
            toe_off_s: (stance.off_frame <= self.end).then(|| in_file_s(stance.off_frame)),
        };
        stances.iter().filter(|stance| self.overlap(stance) > 0.0).map(times).collect()
    }

    fn planted_share(&self, stances: &[FootStance]) -> f64 {
        stances.iter().fold(0.0, |sum, stance| sum + self.overlap(stance).max(0.0)) / (self.end - self.start)
    }

    /// Frames of a stance that the file has; negative where the stance lies elsewhere.
    fn overlap(&self, stance: &FootStance) -> f64 {
        stance.off_frame.min(self.end) - stance.strike_frame.max(self.start)
    }
}

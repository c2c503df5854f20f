//! Clips → what can be reported of them without a database: each source's record, and its gait in the source's own time.
//!
//! The gait is that of the performer's own body, whatever clips lie beside this one: all contacts of the clip, not only
//! those of the steady part that an example is made of. Seconds from the file's first frame, so that they compare with
//! labels that others made on the same file.

use motiondb::diagnostic::Unfit;
use motiondb::motion::SourceRecord;
use rayon::prelude::*;
use serde::{Serialize, Serializer};

use crate::cycle::analysis::{Analyzed, analyze};
use crate::dedup::duplicates;
use crate::gait::gait_events::Stance;
use crate::gait::own_body::{self, Performer};
use crate::gait::windows::Gait;
use crate::ground::root_motion::GroundedClip;
use crate::ground::target_skeleton;
use crate::input::clip_set;
use crate::retarget::human_clip::HumanClip;

/// A clip, and what its feet do.
#[derive(Clone, Debug, PartialEq)]
pub struct SurveyedSource {
    /// As a database would hold it.
    pub source: SourceRecord,
    /// Its gait.
    pub gait: SourceGait,
}

/// What the feet do in a whole clip.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SourceGait {
    /// Steps, standing or neither.
    #[serde(flatten)]
    pub kind: GaitKind,
    /// Share of the clip that a foot is planted, mean of both.
    pub planted_share: f32,
    /// Contacts of the right foot, in order of time.
    pub right: Vec<ContactTimes>,
    /// Of the left foot.
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
        /// Why; in JSON its sentence.
        #[serde(serialize_with = "sentence")]
        reason: Unfit,
    },
}

/// When a foot touched the ground and when it left it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ContactTimes {
    /// Heel strike, or whatever touched first; none where the clip begins later.
    pub strike_s: Option<f32>,
    /// Toe-off, or whatever left last; none where the clip ends before.
    pub toe_off_s: Option<f32>,
}

impl SourceGait {
    /// Times that a foot was put down.
    pub fn step_count(&self) -> usize {
        self.right.iter().chain(&self.left).filter(|contact| contact.strike_s.is_some()).count()
    }
}

/// What is found in clips, with what a compilation would say of each, in the order of a database.
pub fn survey(mut clips: Vec<HumanClip>) -> Vec<SurveyedSource> {
    clip_set::sort(&mut clips);
    if clips.is_empty() {
        return Vec::new();
    }
    let body = target_skeleton::choose(&clips);
    let mut analyzed: Vec<Analyzed> = clips.par_iter().map(|clip| analyze(clip, &body)).collect();
    duplicates::set_aside(&clips, &mut analyzed, &body);
    let surveyed =
        |(clip, found): (&HumanClip, &Analyzed)| SurveyedSource { source: found.record(clip), gait: source_gait(clip) };
    clips.par_iter().zip(&analyzed).map(surveyed).collect()
}

fn sentence<S: Serializer>(reason: &Unfit, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_str(reason)
}

fn source_gait(clip: &HumanClip) -> SourceGait {
    let Performer { clip: grounded, gait: analysis, .. } = own_body::analyze(clip);
    let kind = match &analysis.windows {
        Ok(windows) if windows.iter().any(|window| matches!(window.gait, Gait::Steps(_))) => GaitKind::Steps,
        Ok(_) => GaitKind::Stands,
        Err(reason) => GaitKind::Unsteady { reason: reason.clone() },
    };
    let shown = Shown::of(&grounded, clip.first_frame);
    let stances = analysis.clearest_stances();
    let [left_share, right_share] = stances.each_ref().map(|stances| shown.planted_share(stances));
    let [left, right] = stances.each_ref().map(|stances| shown.contacts(stances));
    SourceGait { kind, planted_share: (0.5 * (left_share + right_share)) as f32, right, left }
}

/// The frames of an analysed clip that the file itself has: all, or the middle copy of an unrolled loop.
struct Shown {
    start: f64,
    end: f64,
    /// Frames of the file before `start`.
    first_frame: usize,
    frame_rate_hz: f64,
}

impl Shown {
    fn of(clip: &GroundedClip, first_frame: usize) -> Self {
        let frames = clip.loop_frames.map_or([0, clip.poses.len() - 1], |round| [round, 2 * round]);
        let [start, end] = frames.map(|frame| frame as f64);
        Self { start, end, first_frame, frame_rate_hz: clip.frame_rate_hz }
    }

    fn contacts(&self, stances: &[Stance]) -> Vec<ContactTimes> {
        let in_file_s = |frame: f64| ((frame - self.start + self.first_frame as f64) / self.frame_rate_hz) as f32;
        let contact = |stance: &Stance| ContactTimes {
            strike_s: (stance.strike_frame >= self.start).then(|| in_file_s(stance.strike_frame)),
            toe_off_s: (stance.off_frame <= self.end).then(|| in_file_s(stance.off_frame)),
        };
        stances.iter().filter(|stance| self.overlap(stance) > 0.0).map(contact).collect()
    }

    fn planted_share(&self, stances: &[Stance]) -> f64 {
        stances.iter().fold(0.0, |sum, stance| sum + self.overlap(stance).max(0.0)) / (self.end - self.start)
    }

    /// Frames of a stance that are shown; negative where it lies elsewhere.
    fn overlap(&self, stance: &Stance) -> f64 {
        stance.off_frame.min(self.end) - stance.strike_frame.max(self.start)
    }
}

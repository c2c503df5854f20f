//! The report of `fbcrowd inspect`: of a database, of a database that breaks an invariant, or of clips.

use fbcrowd_jobs::json_schema::motion::{CoverageGapMirror, VelocityHullMirror};
use fbcrowd_jobs::json_schema::survey::SourceGaitMirror;
use fbcrowd_jobs::leave_one_out::LeaveOneOut;
use motiondb::diagnostic::Diagnostic;
use motiondb::motion::{MotionDb, MotionExample, SourceRecord};
use motiondb::quality::coverage::{self, CoverageGap};
use motiondb::velocity_sets::velocity_hull::VelocityHull;
use motiondb_compiler::Rejection;
use motiondb_compiler::survey::{SourceGait, SurveyedSource};
use schemars::JsonSchema;
use serde::Serialize;

use crate::report::character_report::CharacterReport;
use crate::report::compile_report::UnusedClip;
use crate::report::correspondence_table::CorrespondenceTable;
use crate::report::json_diagnostic::JsonDiagnostic;
use crate::report::motion::action_report::{ActionReport, action_reports};
use crate::report::motion::extra_joint_report::{ExtraJointReport, extra_joint_reports};
use crate::report::motion::style_report::StyleReport;

/// Clips without a database.
#[derive(JsonSchema, Serialize)]
pub(crate) struct ClipsReport {
    /// Clips of human motion.
    sources: Vec<InspectedClip>,
    /// Files and clips that were rejected.
    refused: Vec<UnusedClip>,
    /// The character of the file, where one file is inspected and it has meshes on a human skeleton.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) character: Option<CharacterReport>,
}

impl ClipsReport {
    pub(crate) fn new(surveyed: &[SurveyedSource], rejected: Vec<Rejection>) -> Self {
        let clip = |found: &SurveyedSource| InspectedClip {
            style: Some(found.style.clone()),
            ..InspectedClip::new(&found.source, Some(found.gait.clone()))
        };
        Self {
            sources: surveyed.iter().map(clip).collect(),
            refused: rejected.into_iter().map(UnusedClip::from).collect(),
            character: None,
        }
    }
}

/// A clip of human motion, and its mean parameters over its whole length.
#[derive(JsonSchema, Serialize)]
struct InspectedClip {
    /// File of the clip, without folders.
    file: String,
    /// Name of the clip within the file; empty where the file holds one.
    clip: String,
    /// Mean speed along the facing, m/s; negative backward.
    speed_mps: f32,
    /// Mean turn rate, rad/s; counter-clockwise from above is positive.
    turn_rate_rad_s: f32,
    /// Mean speed to the left of the facing, m/s.
    strafe_mps: f32,
    /// Up axis of the file, `+X` to `-Z`.
    up_axis: String,
    /// Metres per unit of the file.
    metres_per_unit: f32,
    /// Frames per second.
    frame_rate_hz: f32,
    /// Sentences of the diagnostics.
    warnings: Vec<String>,
    /// Diagnostics of the clip.
    diagnostics: Vec<JsonDiagnostic>,
    /// Gait of the whole clip; only without a database.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<SourceGaitMirror>")]
    gait: Option<SourceGait>,
    /// Style of the clip; empty for none; only without a database.
    #[serde(skip_serializing_if = "Option::is_none")]
    style: Option<String>,
}

/// A database that breaks an invariant.
#[derive(JsonSchema, Serialize)]
pub(crate) struct BrokenReport {
    /// The first invariant that is broken.
    pub(crate) broken: BrokenInvariant,
}

/// An invariant of databases that does not hold.
#[derive(JsonSchema, Serialize)]
pub(crate) struct BrokenInvariant {
    /// Where and how it is broken.
    pub(crate) detail: String,
    /// Its name, as `fbcrowd validate` lists it.
    pub(crate) invariant: String,
}

/// A whole database.
#[derive(JsonSchema, Serialize)]
pub(crate) struct DatabaseReport {
    /// The styles of the database, the one of agents without a style first; empty where no clip has one.
    pub(crate) styles: Vec<StyleReport>,
    /// The style that the other fields describe; empty for clips without one.
    pub(crate) style: String,
    /// Examples of motion.
    pub(crate) examples: Vec<InspectedExample>,
    /// Idles, the best first, and transitions.
    pub(crate) actions: Vec<ActionReport>,
    /// Joints beside the 22 roles: of fingers and toes, and twist bones; empty where no clip has them.
    pub(crate) extra_joints: Vec<ExtraJointReport>,
    /// Clips that the examples come from.
    sources: Vec<InspectedClip>,
    /// Velocities that the examples allow.
    #[schemars(with = "VelocityHullMirror")]
    pub(crate) velocity_hull: VelocityHull,
    /// Simplices in which examples are blended.
    pub(crate) blend_space: BlendSpaceReport,
    /// Times at which synthesis changes between blending and semi-procedural locomotion; null where it cannot.
    pub(crate) correspondence: Option<Correspondence>,
    /// Coverage gaps: regions of gaits without examples nearby.
    #[schemars(with = "Vec<CoverageGapMirror>")]
    pub(crate) coverage: Vec<CoverageGap>,
    /// How near the others come to each example; only with `--leave-one-out`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) leave_one_out: Option<LeaveOneOut>,
    /// Times at which two examples are alike; only with `--correspondence`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) correspondence_between: Option<CorrespondenceTable>,
}

/// One example of motion.
#[derive(JsonSchema, Serialize)]
pub(crate) struct InspectedExample {
    /// Name of the example.
    pub(crate) name: String,
    /// File of the clip that it comes from.
    pub(crate) source: String,
    /// Name of the clip within the file; empty where the file holds one.
    pub(crate) clip: String,
    /// Start and end of the window in the clip, s.
    pub(crate) window_s: [f32; 2],
    /// Whether the motion is mirrored.
    pub(crate) mirrored: bool,
    /// Mean speed along the facing, m/s; negative backward.
    pub(crate) speed_mps: f32,
    /// Mean turn rate, rad/s; counter-clockwise from above is positive.
    pub(crate) turn_rate_rad_s: f32,
    /// Mean speed to the left of the facing, m/s.
    pub(crate) strafe_mps: f32,
    /// Duration of one cycle, s.
    pub(crate) duration_s: f32,
    /// Right toe-off, right heel strike, left toe-off, left heel strike, s from right mid-stance; null where it stands.
    pub(crate) key_times_s: Option<[f32; 4]>,
    /// Mean speed of planted feet, cm/s.
    pub(crate) planted_slide_cm_s: f32,
    /// Share of the cycle in which a foot is planted, mean of both feet, 0 to 1.
    pub(crate) planted_share: f32,
}

/// Times at which synthesis changes between blending and semi-procedural locomotion.
#[derive(JsonSchema, Serialize)]
pub(crate) struct Correspondence {
    /// Name of the example of semi-procedural locomotion, m_sp.
    pub(crate) semi_procedural: String,
    /// Name of the example of blending that is most like it, m_mb.
    pub(crate) blending: String,
    /// Pairs of a time of m_sp and a time of m_mb at which the poses are alike, s.
    pub(crate) pairs_s: Vec<[f32; 2]>,
}

/// The simplices in which examples are blended.
#[derive(JsonSchema, Serialize)]
pub(crate) struct BlendSpaceReport {
    /// Dimension of the space that the examples span, 0 to 3.
    pub(crate) dimension: u32,
    /// Simplices as indices into `examples`.
    pub(crate) simplices: Vec<Vec<u32>>,
    /// Share of the hull's volume that the simplices cover, 0 to 1.
    pub(crate) covered_share: f32,
}

impl DatabaseReport {
    /// The report of the database of a style; `styles` are those of the whole.
    pub(crate) fn new(db: &MotionDb, styles: Vec<StyleReport>) -> Self {
        let name = |example: u32| db.examples[example as usize].name.clone();
        Self {
            styles,
            style: db.style.clone(),
            examples: db.examples.iter().map(|example| InspectedExample::new(example, &db.sources)).collect(),
            actions: action_reports(db),
            extra_joints: extra_joint_reports(db),
            sources: db.sources.iter().map(|source| InspectedClip::new(source, None)).collect(),
            velocity_hull: db.velocity_hull.clone(),
            blend_space: BlendSpaceReport {
                dimension: db.blend_space.dimension,
                // The runtime holds a lone example as a simplex of one corner.
                simplices: db
                    .blend_space
                    .simplices()
                    .filter(|corners| corners.len() > 1)
                    .map(<[u32]>::to_vec)
                    .collect(),
                covered_share: db.blend_space.covered_share,
            },
            correspondence: db.correspondence.as_ref().map(|found| Correspondence {
                semi_procedural: name(found.semi_procedural),
                blending: name(found.blending),
                pairs_s: found.pairs_s.clone(),
            }),
            coverage: coverage::coverage(db),
            leave_one_out: None,
            correspondence_between: None,
        }
    }
}

impl InspectedClip {
    fn new(source: &SourceRecord, gait: Option<SourceGait>) -> Self {
        let sentence = |found: &Diagnostic| match found {
            Diagnostic::NoExample(unfit) => format!("no example: {unfit}"),
            other => other.to_string(),
        };
        Self {
            file: source.file.clone(),
            clip: source.clip.clone(),
            speed_mps: source.speed_mps,
            turn_rate_rad_s: source.turn_rate_rad_s,
            strafe_mps: source.strafe_mps,
            up_axis: source.up_axis.clone(),
            metres_per_unit: source.metres_per_unit,
            frame_rate_hz: source.frame_rate_hz,
            warnings: source.diagnostics.iter().map(sentence).collect(),
            diagnostics: source.diagnostics.iter().map(JsonDiagnostic::from).collect(),
            gait,
            style: None,
        }
    }
}

impl InspectedExample {
    fn new(example: &MotionExample, sources: &[SourceRecord]) -> Self {
        let source = &sources[example.source as usize];
        Self {
            name: example.name.clone(),
            source: source.file.clone(),
            clip: source.clip.clone(),
            window_s: example.window_s,
            mirrored: example.mirrored,
            speed_mps: example.parameters.speed_mps,
            turn_rate_rad_s: example.parameters.turn_rate_rad_s,
            strafe_mps: example.parameters.strafe_mps,
            duration_s: example.phase_map.period_s,
            key_times_s: example.key_times_s,
            planted_slide_cm_s: example.planted_slide_cm_s,
            planted_share: example.planted_share,
        }
    }
}

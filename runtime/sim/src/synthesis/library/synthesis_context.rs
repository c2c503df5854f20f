//! The synthesis context: all that every step of every body reads, derived once from a database.

use std::sync::Arc;

use motiondb::motion::MotionDb;

use crate::synthesis::HmsParams;
use crate::synthesis::blending::BlendDomain;
use crate::synthesis::library::augmented_database::{augmented, walk};
use crate::synthesis::library::hybrid_data::HybridData;
use crate::synthesis::library::starts::Starts;
use crate::synthesis::pose::LackingMotion;
use crate::synthesis::pose::upper_body::squeeze::shoulder_breadth_m;
use crate::synthesis::traits::{ArmRotations, arm_rotations};

/// A database and what the synthesis derives from it, shared by all bodies.
///
/// ```no_run
/// use std::path::Path;
/// use std::sync::Arc;
///
/// use fbcrowd_sim::synthesis::{HmsParams, SynthesisContext};
/// use motiondb::files::database_file;
///
/// let (db, _checksum) = database_file::read(Path::new("motion.fbdb"))?;
/// let context = SynthesisContext::new(Arc::new(db), HmsParams::default());
/// println!("fastest example: {} m/s", context.domain.speed_max_mps);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct SynthesisContext {
    /// Poses, parameters and phase maps of the examples; augmented where the given database lacks what crowds need.
    pub db: Arc<MotionDb>,
    /// Blend domain of the database.
    pub domain: BlendDomain,
    /// Data of hybrid synthesis; `None` where bodies only blend.
    pub hybrid: Option<HybridData>,
    /// Recorded starts.
    pub(crate) starts: Starts,
    /// Mean rotations of the joints of the arms in each example.
    pub(crate) arm_means: Vec<ArmRotations>,
    /// Index of the base walk, or of the first example where none walks.
    pub(crate) base: usize,
    /// Strides per second of the base walk.
    pub base_hz: f32,
    /// Speed of the base walk, m/s.
    pub base_mps: f32,
    /// Breadth of the shoulders, m.
    pub shoulder_breadth_m: f32,
    /// What the base walk lacks of secondary motion.
    pub lacking: LackingMotion,
    /// Tunables.
    pub params: HmsParams,
}

impl SynthesisContext {
    /// Prepares a database for the syntheses that the tunables name, and adds the examples that a crowd needs.
    pub fn new(db: Arc<MotionDb>, params: HmsParams) -> Self {
        Self::of_complete(augmented(db), params)
    }

    /// Prepares a database as it is: of a set without side-steps, bodies do not side-step.
    pub fn of_complete(db: Arc<MotionDb>, params: HmsParams) -> Self {
        let base = walk(&db).unwrap_or(0);
        let base_hz = 1.0 / db.examples[base].phase_map.period_s;
        let arm_means = (0..db.examples.len()).map(|example| arm_rotations(&db.rows.mean_pose(example))).collect();
        let (domain, hybrid) = (BlendDomain::new(&db), HybridData::new(&db, params.modes));
        let base_mps = db.examples[base].parameters.speed_mps.abs().max(f32::MIN_POSITIVE);
        let (lacking, shoulder_breadth_m) = (LackingMotion::of(&db, base), shoulder_breadth_m(&db.skeleton));
        let starts = Starts::of(&db);
        Self { starts, lacking, shoulder_breadth_m, domain, hybrid, arm_means, base, base_hz, base_mps, db, params }
    }
}

/// The context of a style, by index; of an unknown one that of agents without a style.
pub(crate) fn context_of(contexts: &[SynthesisContext], style: u32) -> &SynthesisContext {
    contexts.get(style as usize).unwrap_or(&contexts[0])
}

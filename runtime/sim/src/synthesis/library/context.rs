//! A database made ready for one synthesis, with whatever a crowd needs of it ([`augmented_database`]): where every simulation
//! begins, and where benches and tests let a body walk alone on open ground. World, metres, seconds.

use std::sync::Arc;

use motiondb::body::Root;
use motiondb::motion::MotionDb;

use crate::planning::plan::Plan;
use crate::synthesis::blending::blend_space::Space;
use crate::synthesis::hybrid::switch_points::Hybrid;
use crate::synthesis::library::augmented_database;
use crate::synthesis::params::HmsParams;
use crate::synthesis::time_step::TimeStep;
use crate::synthesis::{Body, Motion, Synthesis};

/// All that [`Motion`] borrows.
#[derive(Clone, Debug)]
pub struct Studio {
    /// Poses, parameters and phase maps.
    pub db: Arc<MotionDb>,
    /// Its blend space.
    pub space: Space,
    /// What hybrid synthesis needs of it; none where bodies only blend.
    pub hybrid: Option<Hybrid>,
    /// Tunables.
    pub params: HmsParams,
}

impl Studio {
    /// Makes a database ready for the syntheses that the tunables name.
    pub fn new(db: Arc<MotionDb>, params: HmsParams) -> Self {
        let db = augmented_database::complete(db);
        Self { space: Space::new(&db), hybrid: Hybrid::new(&db, params.modes), db, params }
    }

    /// As bodies use it.
    pub fn motion(&self) -> Motion<'_> {
        Motion { db: &self.db, space: &self.space, hybrid: self.hybrid.as_ref(), params: &self.params }
    }

    /// A body that stands, its cycle at `phase`, follows a plan of time and root in steps of `dt_s`; what `see` makes
    /// of it at first and after each step.
    pub fn walk<T>(
        &self,
        phase: f32,
        seconds: f32,
        dt_s: f32,
        plan: impl Fn(f32, &Root) -> Plan,
        see: impl Fn(&Body, &Synthesis) -> T,
    ) -> Vec<T> {
        let (motion, time_step) = (self.motion(), TimeStep::new(dt_s));
        let (mut body, first) = Body::standing(&motion, Root::default(), phase);
        let mut seen = vec![see(&body, &first)];
        for step in 0..(seconds / dt_s).round() as usize {
            body.advance(&motion, &plan(step as f32 * dt_s, &body.root), &time_step);
            let synthesis = body.synthesize(&motion, &time_step);
            seen.push(see(&body, &synthesis));
        }
        seen
    }
}

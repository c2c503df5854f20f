//! Correspondence times T between the semi-procedural clip and the blending clip (`FbCrowd` §5, Eq. 10).

use serde::{Deserialize, Serialize};

/// Weight of a joint's velocity beside its place where poses are compared: as far as it gets in this time, a
/// transition's first instants, seconds.
pub const VELOCITY_WEIGHT_S: f64 = 0.1;

/// Where m_sp and m_mb are most alike, so that synthesis may switch from one to the other.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Correspondence {
    /// m_sp: index of the example that semi-procedural locomotion deforms.
    pub semi_procedural: u32,
    /// m_mb: index of the other example nearest to it in (v_f, ω_t, ω_s).
    pub blending: u32,
    /// [t_sp, t_mb], seconds from phase 0 of each cycle, in order of t_sp; cyclic and monotone in both.
    pub pairs_s: Vec<[f32; 2]>,
}

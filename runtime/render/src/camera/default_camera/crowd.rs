//! A crowd at a few moments of its recording. World, metres, seconds.

use fbcrowd_sim::recording::{AgentFrame, Recording, duration_s, sample};
use glam::Vec2;

use crate::error::RenderError;

/// Number of moments of a recording at which a moving camera has a key.
const KEYS: usize = 36;
/// Number of moments from key to key of a small crowd. A wall may hide a lone body between two keys.
const MOMENTS_OF_KEY: usize = 4;
/// Greatest number of bodies of a crowd that has twice as many moments as keys.
const FEW_BODIES: usize = 60;
/// Greatest number of bodies of a moment, at even steps.
const BODIES_MAX: usize = 1_000;
/// Least height of bodies, m.
const HEIGHT_MIN_M: f32 = 0.1;
/// Share of the bodies of a moment that its middle leaves out on each side.
const OUTERMOST: f32 = 0.1;

/// Where a body stands, and the direction that it faces.
#[derive(Clone, Copy, Debug)]
pub(super) struct CrowdBody {
    pub(super) position_m: Vec2,
    pub(super) ahead: Vec2,
    pub(super) height_m: f32,
}

/// A crowd over its recording.
#[derive(Clone, Debug)]
pub(super) struct CrowdMoments {
    pub(super) moments: Vec<CrowdMoment>,
    /// Number of moments from key to key of a moving camera.
    pub(super) of_key: usize,
}

impl CrowdMoments {
    /// Indices of the moments at which a moving camera has a key.
    pub(super) fn keys(&self) -> Vec<usize> {
        let last = self.moments.len().saturating_sub(1);
        let inner = (0..last).step_by(self.of_key);
        inner.chain((!self.moments.is_empty()).then_some(last)).collect()
    }

    /// Median height of the bodies, m.
    pub(super) fn height_m(&self) -> f32 {
        let mut heights_m: Vec<f32> =
            self.moments.iter().flat_map(|moment| &moment.bodies).map(|body| body.height_m).collect();
        heights_m.sort_by(f32::total_cmp);
        quantile(&heights_m, 0.5).max(HEIGHT_MIN_M)
    }
}

/// The crowd at a moment.
#[derive(Clone, Debug)]
pub(super) struct CrowdMoment {
    pub(super) time_s: f64,
    /// Point on the ground that the camera keeps its distance from, m.
    pub(super) centre_m: Vec2,
    /// Number of bodies that are present.
    pub(super) present: usize,
    /// Some of them, at even steps.
    pub(super) bodies: Vec<CrowdBody>,
}

impl CrowdMoment {
    fn positions_m(&self) -> impl Iterator<Item = Vec2> + Clone + '_ {
        self.bodies.iter().map(|body| body.position_m)
    }
}

/// Moments from a time to the end of a recording at which bodies are present.
pub(super) fn read_moments(recording: &Recording, start_s: f64) -> Result<CrowdMoments, RenderError> {
    let moments = moments_at(recording, start_s, KEYS)?;
    let present = moments.iter().map(|moment| moment.present).max().unwrap_or(0);
    let of_key = (2 * FEW_BODIES / present.max(1)).clamp(1, MOMENTS_OF_KEY);
    let moments = if of_key == 1 { moments } else { moments_at(recording, start_s, of_key * (KEYS - 1) + 1)? };
    Ok(CrowdMoments { moments, of_key })
}

/// So many moments from a time to the end of a recording, less those without a body.
fn moments_at(recording: &Recording, start_s: f64, count: usize) -> Result<Vec<CrowdMoment>, RenderError> {
    let length_s = (duration_s(recording) - start_s).max(0.0);
    let crowd_m = recording.header().skeleton().height_m();
    let lives = &recording.population().agents;
    let body = |agent: &AgentFrame| CrowdBody {
        position_m: agent.root.position_m,
        ahead: agent.root.forward(),
        height_m: crowd_m * lives.get(agent.id.index()).map_or(1.0, |life| life.stature),
    };
    let mut moments = Vec::new();
    for index in 0..count {
        let time_s = start_s + length_s * index as f64 / (count - 1) as f64;
        let agents = sample(recording, time_s)?;
        let step = agents.len().div_ceil(BODIES_MAX).max(1);
        if !agents.is_empty() {
            let bodies = agents.iter().step_by(step).map(body).collect();
            moments.push(CrowdMoment { time_s, centre_m: Vec2::ZERO, present: agents.len(), bodies });
        }
    }
    Ok(moments)
}

/// About so many moments, and bodies of each, at even steps.
pub(super) fn thinned(moments: &[CrowdMoment], [moment_count, body_count]: [usize; 2]) -> Vec<CrowdMoment> {
    let step = moments.len().div_ceil(moment_count).max(1);
    let thin = |moment: &CrowdMoment| {
        let step = moment.bodies.len().div_ceil(body_count).max(1);
        CrowdMoment { bodies: moment.bodies.iter().copied().step_by(step).collect(), ..*moment }
    };
    moments.iter().step_by(step).map(thin).collect()
}

/// The same moments for a camera that stands still.
pub(super) fn filmed_still(crowd: &CrowdMoments) -> CrowdMoments {
    let centre_m = middle_m(crowd.moments.iter().flat_map(CrowdMoment::positions_m));
    let moments = crowd.moments.iter().map(|moment| CrowdMoment { centre_m, ..moment.clone() }).collect();
    CrowdMoments { moments, ..*crowd }
}

/// The same moments for a camera that moves with the middle of the crowd: smoothed over the keys before and after, and
/// straight from key to key.
pub(super) fn filmed_moving(crowd: &CrowdMoments) -> CrowdMoments {
    let keys = crowd.keys();
    let middles_m: Vec<Vec2> = keys.iter().map(|key| middle_m(crowd.moments[*key].positions_m())).collect();
    let last = middles_m.len().saturating_sub(1);
    let key_m = |at: usize| match at {
        _ if at == 0 || at == last => middles_m[at],
        _ => 0.25 * middles_m[at - 1] + 0.5 * middles_m[at] + 0.25 * middles_m[at + 1],
    };
    let mut moments = crowd.moments.clone();
    for (at, keys) in keys.windows(2).enumerate() {
        for (index, moment) in moments.iter_mut().enumerate().take(keys[1] + 1).skip(keys[0]) {
            let share = (index - keys[0]) as f32 / (keys[1] - keys[0]) as f32;
            moment.centre_m = key_m(at).lerp(key_m(at + 1), share);
        }
    }
    if let ([_], [only]) = (&keys[..], &mut moments[..]) {
        only.centre_m = key_m(0);
    }
    CrowdMoments { moments, ..*crowd }
}

/// Middle of the box that holds all but the outermost positions on each side, m.
pub(super) fn middle_m(positions_m: impl Iterator<Item = Vec2> + Clone) -> Vec2 {
    let middle = |axis: usize| {
        let mut along: Vec<f32> = positions_m.clone().map(|position_m| position_m[axis]).collect();
        along.sort_by(f32::total_cmp);
        quantile(&along, OUTERMOST).midpoint(quantile(&along, 1.0 - OUTERMOST))
    };
    Vec2::new(middle(0), middle(1))
}

/// Positions on both sides of their median, along the longer side of their box.
pub(super) fn halves(mut positions_m: Vec<Vec2>) -> [Vec<Vec2>; 2] {
    let low_m = positions_m.iter().copied().fold(Vec2::INFINITY, Vec2::min);
    let high_m = positions_m.iter().copied().fold(Vec2::NEG_INFINITY, Vec2::max);
    let size_m = high_m - low_m;
    let axis = usize::from(size_m.y > size_m.x);
    positions_m.sort_by(|a, b| a[axis].total_cmp(&b[axis]));
    let upper = positions_m.split_off(positions_m.len() / 2);
    [positions_m, upper]
}

/// The value of sorted ones below which a share lies; 0 where there is none.
pub(super) fn quantile(sorted: &[f32], share: f32) -> f32 {
    let last = sorted.len().saturating_sub(1);
    sorted.get((share * last as f32).round() as usize).copied().unwrap_or(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_crowd_is_halved_along_its_longer_side() {
        let positions_m = [[0.0, 9.0], [1.0, 0.0], [2.0, 3.0], [0.0, 6.0]].map(Vec2::from).to_vec();
        assert_eq!(
            halves(positions_m),
            [vec![[1.0, 0.0], [2.0, 3.0]], vec![[0.0, 6.0], [0.0, 9.0]]]
                .map(|part| { part.into_iter().map(Vec2::from).collect::<Vec<Vec2>>() })
        );
        assert_eq!(halves(Vec::new()), [Vec::new(), Vec::new()]);
    }

    #[test]
    fn a_moving_camera_is_straight_between_its_keys() {
        let moment = |index: u8| CrowdMoment {
            time_s: f64::from(index),
            centre_m: Vec2::ZERO,
            present: 1,
            bodies: vec![CrowdBody { position_m: Vec2::new(f32::from(index), 0.0), ahead: Vec2::X, height_m: 1.6 }],
        };
        let crowd = CrowdMoments { moments: (0..11).map(moment).collect(), of_key: 4 };
        assert_eq!(crowd.keys(), [0, 4, 8, 10]);
        assert!((crowd.height_m() - 1.6).abs() < 1e-6);
        let centres_m: Vec<f32> = filmed_moving(&crowd).moments.iter().map(|moment| moment.centre_m.x).collect();
        // The last span is shorter, so its first key is drawn back.
        assert_eq!(centres_m, [0.0, 1.0, 2.0, 3.0, 4.0, 4.875, 5.75, 6.625, 7.5, 8.75, 10.0]);
        for count in [0, 1] {
            let crowd = CrowdMoments { moments: (3..3 + count).map(moment).collect(), of_key: 4 };
            let centres_m: Vec<f32> = filmed_moving(&crowd).moments.iter().map(|moment| moment.centre_m.x).collect();
            assert_eq!(centres_m, vec![3.0; usize::from(count)]);
        }
    }
}

//! A crowd at a few moments of its recording. World, metres, seconds.

use fbcrowd_sim::recording::{AgentFrame, Recording, duration_s, sample};
use glam::Vec2;

use crate::error::RenderError;

/// Number of moments of a recording.
const MOMENTS: u32 = 36;
/// Greatest number of bodies of a moment, at even steps.
const BODIES_MAX: usize = 1_000;
/// Share of the bodies of a moment that its middle leaves out on each side.
const OUTERMOST: f32 = 0.1;

/// Where a body stands, and the direction that it faces.
#[derive(Clone, Copy, Debug)]
pub(super) struct CrowdBody {
    pub(super) position_m: Vec2,
    pub(super) ahead: Vec2,
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
pub(super) fn read_moments(recording: &Recording, start_s: f64) -> Result<Vec<CrowdMoment>, RenderError> {
    let length_s = (duration_s(recording) - start_s).max(0.0);
    let mut moments = Vec::new();
    for index in 0..MOMENTS {
        let time_s = start_s + length_s * f64::from(index) / f64::from(MOMENTS - 1);
        let agents = sample(recording, time_s)?;
        let step = agents.len().div_ceil(BODIES_MAX).max(1);
        let body = |agent: &AgentFrame| CrowdBody { position_m: agent.root.position_m, ahead: agent.root.forward() };
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
pub(super) fn filmed_still(moments: Vec<CrowdMoment>) -> Vec<CrowdMoment> {
    let centre_m = middle_m(moments.iter().flat_map(CrowdMoment::positions_m));
    moments.into_iter().map(|moment| CrowdMoment { centre_m, ..moment }).collect()
}

/// The same moments for a camera that moves with the middle of the crowd, smoothed over those before and after.
pub(super) fn filmed_moving(moments: Vec<CrowdMoment>) -> Vec<CrowdMoment> {
    let middles_m: Vec<Vec2> = moments.iter().map(|moment| middle_m(moment.positions_m())).collect();
    let last = middles_m.len().saturating_sub(1);
    let centre_m = |at: usize| match at {
        _ if at == 0 || at == last => middles_m[at],
        _ => 0.25 * middles_m[at - 1] + 0.5 * middles_m[at] + 0.25 * middles_m[at + 1],
    };
    moments.into_iter().enumerate().map(|(at, moment)| CrowdMoment { centre_m: centre_m(at), ..moment }).collect()
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
}

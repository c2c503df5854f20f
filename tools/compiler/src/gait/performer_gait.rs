//! HumanClip → gait on the performer's own body, independent of the other clips of the set; then on another body.
//!
//! When feet touch and leave the ground is what the performer did, with its own proportions and its own soles. On the
//! feet of a database's skeleton the toe-off would come up to 0.1 s later. So contacts, landmarks and steady windows
//! are found on the performer's own body, scaled to a common leg length: limits of lengths and speeds then mean the
//! same for children, toys and giants. Poses and root motion are those of the target body; its frames correspond one to
//! one. World frame: frames of the clip, metres, seconds.

use motiondb::diagnostic::Unfit;

use crate::gait::body_track::BodyTrack;
use crate::gait::foot_stance;
use crate::gait::stride::Stride;
use crate::gait::windows::{GaitAnalysis, GaitWindow, WindowGait, analyze_gait};
use crate::ground::grounded_clip::GroundedClip;
use crate::ground::grounded_poses::GroundedPoses;
use crate::ground::root_motion::{grounded_clip, grounded_in_place};
use crate::ground::{foot_grounding, loop_unrolling};
use crate::retarget::human_clip::{HumanBody, HumanClip};

/// Thigh plus shank of every body whose gait is analysed, m: that of the captures whose events are labelled by hand.
const LEG_M: f64 = 0.8;

/// The gait of a clip on its performer's own body.
#[derive(Clone, Debug)]
pub struct PerformerGait {
    /// The performer's proportions, scaled to a leg of 0.8 m.
    pub body: HumanBody,
    /// Frames of the clip on that body; a loop is unrolled.
    pub frame_count: usize,
    /// Frames of one round of a clip that is a loop.
    pub loop_frames: Option<usize>,
    /// The gait of the clip.
    pub gait: GaitAnalysis,
}

impl PerformerGait {
    /// Analyses the gait of a clip.
    pub fn of(clip: &HumanClip) -> Self {
        let (body, grounded) = own_clip(clip);
        let gait = analyze_gait(&grounded, &body, &clip.left_out_frames());
        Self { frame_count: grounded.frame_count(), loop_frames: grounded.loop_frames(), gait, body }
    }

    /// The same clip on another body: soles do not sink, a loop is unrolled. The clip has no frames afterwards: its
    /// poses are changed in place.
    pub fn clip_on(&self, clip: &mut HumanClip, body: &HumanBody) -> GroundedClip<'static> {
        let mut grounded = grounded_in_place(clip, body);
        let first_frame = self.loop_frames.unwrap_or(0);
        let stances = self.gait.clearest_stances();
        if let GroundedPoses::Own(poses) = &mut grounded.poses {
            foot_grounding::shift_to_ground(poses, body, |side, frame| {
                foot_stance::stands_at(&stances[side], (first_frame + frame) as f64)
            });
            let is_loop = self.loop_frames.is_some();
            foot_grounding::keep_soles_above_ground(poses, body, grounded.frame_rate_hz, is_loop);
        }
        match self.loop_frames {
            Some(round) => loop_unrolling::repeated(grounded, body, round),
            None => grounded,
        }
    }

    /// The steady windows on another body: landmarks and contacts are the performer's, the root's arcs are that body's.
    pub fn windows_on(&self, grounded: &GroundedClip, body: &HumanBody) -> Result<Vec<GaitWindow>, Unfit> {
        let windows = self.gait.windows.as_ref().map_err(Clone::clone)?;
        let track = BodyTrack::of(grounded, body, |_| ());
        let carried = |stride: &Stride| Stride::over(&stride.landmarks(), &track);
        let on_body = |window: &GaitWindow| match &window.gait {
            WindowGait::Steps(strides) => {
                GaitWindow { gait: WindowGait::Steps(strides.iter().map(carried).collect()), ..*window }
            }
            WindowGait::Stands(_) => window.clone(),
        };
        Ok(windows.iter().map(on_body).collect())
    }
}

/// A clip on its performer's own body, scaled to a leg of 0.8 m; a loop is unrolled.
pub fn own_clip(clip: &HumanClip) -> (HumanBody, GroundedClip<'_>) {
    let body = clip.body.scaled(LEG_M / clip.body.leg_length_m());
    let grounded = loop_unrolling::unrolled(grounded_clip(clip, &body), &body);
    (body, grounded)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ground::root_arc::Rates;
    use crate::synthetic::{self, SyntheticWalk};

    #[test]
    fn size_does_not_change_the_gait() {
        let stances = |size: f64| {
            let rates = Rates { speed_mps: 1.2 * size, ..Rates::default() };
            let clip = synthetic::walk("walk", SyntheticWalk { size, rates, ..SyntheticWalk::default() });
            PerformerGait::of(&clip).gait.stances
        };
        let human = stances(1.0);
        for size in [0.3, 0.7, 2.0, 10.0] {
            for (found, human) in stances(size).iter().flatten().flatten().zip(human.iter().flatten().flatten()) {
                let errors = [found.off_frame - human.off_frame, found.strike_frame - human.strike_frame];
                let error = errors.iter().map(|error| error.abs()).fold(0.0, f64::max);
                assert!(error < 1e-3 || found == human, "size {size}: {found:?}, not {human:?}");
            }
        }
    }

    #[test]
    fn landmarks_are_the_performers_and_root_motion_the_bodys() {
        let clip = synthetic::walk("walk", SyntheticWalk::default());
        let performer = PerformerGait::of(&clip);
        let body = synthetic::body(0.5);
        let grounded = performer.clip_on(&mut clip.clone(), &body);
        let own = performer.gait.windows.as_ref().unwrap();
        for (window, own) in performer.windows_on(&grounded, &body).unwrap().iter().zip(own) {
            let (WindowGait::Steps(strides), WindowGait::Steps(own)) = (&window.gait, &own.gait) else {
                panic!("{window:?}")
            };
            for (stride, own) in strides.iter().zip(own) {
                assert!((stride.zero_frame - own.zero_frame).abs() < 1e-9, "{stride:?}, not {own:?}");
                assert!((stride.period_frames - own.period_frames).abs() < 1e-9, "{stride:?}, not {own:?}");
                assert!((stride.arc.rates.speed_mps - 0.6).abs() < 0.01, "{stride:?}");
            }
        }
    }
}

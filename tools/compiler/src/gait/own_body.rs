//! HumanClip → GaitAnalysis of the performer himself: the same whatever clips lie beside his, and carried over to
//! another body.
//!
//! When feet touch and leave the ground is what the performer did, with his own proportions and his own soles; on the
//! feet of a database's skeleton his toe-off would come up to 0.1 s later. So contacts, landmarks and steady windows
//! are found on his own body. It is scaled to a common leg length, so that limits of lengths and speeds mean the same
//! of children, toys and giants. Poses and root motion are those of the body that a database has: frames correspond one
//! to one. Frames of the clip, metres, seconds.

use motiondb::diagnostic::Unfit;

use crate::gait::gait_events;
use crate::gait::stride::{BodyTrack, Stride};
use crate::gait::windows::{self, Gait, GaitAnalysis, Window};
use crate::ground::root_motion::{self, GroundedClip, leg_length_m};
use crate::ground::{foot_grounding, loop_unrolling};
use crate::retarget::human_clip::{HumanBody, HumanClip};

/// Thigh plus shank at which gaits are looked at, metres: that of the captures whose events were labelled by hand.
const LEG_M: f64 = 0.8;

/// A clip on its performer's own body, and its gait there.
#[derive(Clone, Debug)]
pub struct Performer {
    /// His proportions, scaled.
    pub body: HumanBody,
    /// The clip on that body.
    pub clip: GroundedClip,
    /// Its gait.
    pub gait: GaitAnalysis,
}

/// Finds the gait of a clip.
pub fn analyze(clip: &HumanClip) -> Performer {
    let body = clip.body.scaled(LEG_M / leg_length_m(&clip.body));
    let grounded = loop_unrolling::unroll(root_motion::ground(clip, &body), &body);
    let gait = windows::analyze(&grounded, &body);
    Performer { body, clip: grounded, gait }
}

impl Performer {
    /// The same clip on another body, whose soles do not sink, unrolled where his is.
    pub fn clip_on(&self, clip: &HumanClip, body: &HumanBody) -> GroundedClip {
        let mut grounded = root_motion::ground(clip, body);
        let first_frame = self.clip.loop_frames.unwrap_or(0);
        let stances = self.gait.clearest_stances();
        foot_grounding::stand(&mut grounded.poses, body, |side, frame| {
            gait_events::stands_at(&stances[side], (first_frame + frame) as f64)
        });
        match self.clip.loop_frames {
            Some(round) => loop_unrolling::repeat(grounded, body, round),
            None => grounded,
        }
    }

    /// His steady windows on another body: landmarks and contacts are his, the root's arcs are that body's.
    pub fn windows_on(&self, grounded: &GroundedClip, body: &HumanBody) -> Result<Vec<Window>, Unfit> {
        let windows = self.gait.windows.as_ref().map_err(Clone::clone)?;
        let joints = grounded.poses.iter().map(|pose| pose.forward_kinematics(body)).collect();
        let track = BodyTrack::of(joints, grounded.frame_rate_hz);
        let carried = |stride: &Stride| Stride::over(&stride.landmarks(), &track);
        let on_body = |window: &Window| match &window.gait {
            Gait::Steps(strides) => Window { gait: Gait::Steps(strides.iter().map(carried).collect()), ..*window },
            Gait::Stands(_) => window.clone(),
        };
        Ok(windows.iter().map(on_body).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synthetic::{self, Walk};

    #[test]
    fn the_gait_of_a_toy_is_that_of_a_human_of_its_proportions() {
        let with_legs = |size: f64| {
            let rates = crate::ground::arc::Rates { speed_mps: 1.2 * size, ..Default::default() };
            analyze(&synthetic::walk("walk", Walk { size, rates, ..Walk::default() })).gait.stances
        };
        let wanted = with_legs(1.0);
        for size in [0.3, 0.7, 2.0, 10.0] {
            for (found, wanted) in with_legs(size).iter().flatten().flatten().zip(wanted.iter().flatten().flatten()) {
                let off =
                    (found.off_frame - wanted.off_frame).abs().max((found.strike_frame - wanted.strike_frame).abs());
                assert!(off < 1e-3 || found == wanted, "size {size}: {found:?}, not {wanted:?}");
            }
        }
    }

    #[test]
    fn landmarks_are_the_performers_and_root_motion_is_the_bodys() {
        let clip = synthetic::walk("walk", Walk::default());
        let performer = analyze(&clip);
        let body = synthetic::body(0.5);
        let grounded = performer.clip_on(&clip, &body);
        let own = performer.gait.windows.as_ref().unwrap();
        for (window, own) in performer.windows_on(&grounded, &body).unwrap().iter().zip(own) {
            let (Gait::Steps(strides), Gait::Steps(own)) = (&window.gait, &own.gait) else { panic!("{window:?}") };
            for (stride, own) in strides.iter().zip(own) {
                assert!((stride.zero_frame - own.zero_frame).abs() < 1e-9, "{stride:?}, not {own:?}");
                assert!((stride.period_frames - own.period_frames).abs() < 1e-9, "{stride:?}, not {own:?}");
                assert!((stride.arc.rates.speed_mps - 0.6).abs() < 0.01, "{stride:?}");
            }
        }
    }
}

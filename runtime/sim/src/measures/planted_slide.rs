//! Slide of planted feet: the mean horizontal speed of each foot's contact point over the middle 80 % of each contact,
//! measured on the recorded pose, so after the leg IK.
//!
//! As the compiler measures clips: central differences, contacts of less than 0.08 s left out. Only the rule for
//! planted differs: here the blended contact of the database's rows (≥ ½), never a foot lock's own flag. Roots' frames
//! and world axes, metres, seconds; slides in cm/s.

use glam::{DVec2, Vec3};
use motiondb::body::{Joints, Root, Skeleton};

use crate::planning::plan::PLANTED_CONTACT;
use crate::recording::frame::AgentFrame;

/// Share left out at each end of a contact, where the foot rolls on and off.
const TRIMMED_SHARE: f64 = 0.1;
/// Shortest contact that counts, s.
const CONTACT_MIN_S: f64 = 0.08;

/// Measures every foot, frame by frame.
#[derive(Debug)]
pub struct PlantedSlide {
    dt_s: f64,
    /// `[left, right]` of each agent, by id.
    feet: Vec<[FootTrack; 2]>,
    samples: usize,
    slide_cm_s: f64,
    examples_slide_cm_s: f64,
    foot_frames: usize,
    planted_foot_frames: usize,
}

/// Slide of planted feet over a whole recording.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FootSlide {
    /// Slide of the recorded bodies, cm/s; none where no foot was ever planted.
    pub slide_cm_s: Option<f64>,
    /// Slide of the examples of the active motion over the same samples, cm/s.
    pub examples_slide_cm_s: Option<f64>,
    /// Share of all feet and frames that are planted.
    pub planted_share: f64,
}

/// One foot's last two frames and its present contact.
#[derive(Clone, Debug, Default)]
struct FootTrack {
    earlier: Option<FootFrame>,
    latest: Option<FootFrame>,
    /// Samples of the contact so far, frame by frame.
    contact: Vec<SlideSample>,
}

/// A foot in one frame.
#[derive(Clone, Copy, Debug)]
struct FootFrame {
    /// Heel, ball and toe on the ground, world, m.
    points_m: [DVec2; 3],
    /// Index of the lowest of them.
    lowest: usize,
    planted: bool,
    examples_slide_cm_s: f32,
}

/// Slide in one frame of a contact. In f32, because a body that stands adds to its contact as long as the recording
/// lasts.
#[derive(Clone, Copy, Debug)]
struct SlideSample {
    slide_cm_s: f32,
    examples_slide_cm_s: f32,
}

impl PlantedSlide {
    /// No frames yet; more agents may come.
    pub fn new(agent_count: usize, dt_s: f32) -> Self {
        Self {
            dt_s: f64::from(dt_s),
            feet: vec![Default::default(); agent_count],
            samples: 0,
            slide_cm_s: 0.0,
            examples_slide_cm_s: 0.0,
            foot_frames: 0,
            planted_foot_frames: 0,
        }
    }

    /// Adds one frame: every agent, and its joints in its root's frame, in index order.
    pub fn push(&mut self, skeleton: &Skeleton, agents: &[AgentFrame], joints: &[Joints]) {
        for (index, (agent, joints)) in agents.iter().zip(joints).enumerate() {
            self.push_one(index, agent, skeleton, joints);
        }
    }

    /// Adds one frame of one agent, given its skeleton and its joints in its root's frame. An agent that is no longer
    /// added counts up to its last frame.
    pub fn push_one(&mut self, index: usize, agent: &AgentFrame, skeleton: &Skeleton, joints: &Joints) {
        if index >= self.feet.len() {
            self.feet.resize(index + 1, Default::default());
        }
        for (side, foot) in foot_frames(skeleton, agent, joints).into_iter().enumerate() {
            self.foot_frames += 1;
            self.planted_foot_frames += usize::from(foot.planted);
            let ended = self.feet[index][side].push(foot, self.dt_s);
            self.count(&ended);
        }
    }

    /// Adds one frame of one agent whose feet are not the skeleton's: heel, ball and toe tip of each foot in the root's
    /// frame, m; planted, they are on the ground.
    pub fn push_feet(&mut self, index: usize, agent: &AgentFrame, feet_m: [[Vec3; 3]; 2]) {
        if index >= self.feet.len() {
            self.feet.resize(index + 1, Default::default());
        }
        for (side, points_m) in feet_m.into_iter().enumerate() {
            let foot = foot_frame(agent, side, points_m, [0.0; 3]);
            self.foot_frames += 1;
            self.planted_foot_frames += usize::from(foot.planted);
            let ended = self.feet[index][side].push(foot, self.dt_s);
            self.count(&ended);
        }
    }

    /// Ends the contacts of an agent that is moved at once before its next frame.
    pub fn lift(&mut self, index: usize) {
        for track in self.feet.get_mut(index).map(std::mem::take).into_iter().flatten() {
            self.count(&track.finish(self.dt_s));
        }
    }

    /// The measures after the last frame.
    pub fn finish(mut self) -> FootSlide {
        for track in std::mem::take(&mut self.feet).into_iter().flatten() {
            self.count(&track.finish(self.dt_s));
        }
        let mean = |sum: f64| (self.samples > 0).then(|| sum / self.samples as f64);
        FootSlide {
            slide_cm_s: mean(self.slide_cm_s),
            examples_slide_cm_s: mean(self.examples_slide_cm_s),
            planted_share: self.planted_foot_frames as f64 / self.foot_frames.max(1) as f64,
        }
    }

    /// Counts the middle of a contact that ended.
    fn count(&mut self, contact: &[SlideSample]) {
        if (contact.len() as f64) * self.dt_s < CONTACT_MIN_S {
            return;
        }
        let trimmed = (contact.len() as f64 * TRIMMED_SHARE).round_ties_even() as usize;
        for sample in &contact[trimmed..contact.len() - trimmed] {
            self.samples += 1;
            self.slide_cm_s += f64::from(sample.slide_cm_s);
            self.examples_slide_cm_s += f64::from(sample.examples_slide_cm_s);
        }
    }
}

impl FootTrack {
    /// Takes the next frame, which makes the one before it measurable; returns the contact that it ends, if any.
    fn push(&mut self, next: FootFrame, dt_s: f64) -> Vec<SlideSample> {
        let mut ended = Vec::new();
        match self.latest {
            Some(latest) if latest.planted => self.contact.push(sample(self.earlier, latest, Some(next), dt_s)),
            _ => ended = std::mem::take(&mut self.contact),
        }
        self.earlier = self.latest.replace(next);
        ended
    }

    /// The last contact; the last frame is measured against the one before it alone.
    fn finish(mut self, dt_s: f64) -> Vec<SlideSample> {
        if let Some(latest) = self.latest.filter(|latest| latest.planted) {
            self.contact.push(sample(self.earlier, latest, None, dt_s));
        }
        self.contact
    }
}

/// The contact point's speed by central differences, one-sided at either end of the contact. In steps of 0.1 s a
/// contact has so few frames that nothing is trimmed, and a foot that swings in the adjacent frame does not slide.
fn sample(earlier: Option<FootFrame>, at: FootFrame, next: Option<FootFrame>, dt_s: f64) -> SlideSample {
    let [earlier, next] = [earlier, next].map(|frame| frame.filter(|frame| frame.planted));
    let steps = usize::from(earlier.is_some()) + usize::from(next.is_some());
    let point_m = |frame: Option<FootFrame>| frame.unwrap_or(at).points_m[at.lowest];
    let metres = point_m(earlier).distance(point_m(next));
    let slide_cm_s = (metres / (steps.max(1) as f64 * dt_s) * 100.0) as f32;
    SlideSample { slide_cm_s, examples_slide_cm_s: at.examples_slide_cm_s }
}

/// Both feet of an agent in one frame, `[left, right]`.
fn foot_frames(skeleton: &Skeleton, agent: &AgentFrame, joints: &Joints) -> [FootFrame; 2] {
    [0, 1].map(|side| {
        let (points_m, planted_heights_m) = contact_points_m(skeleton, joints, side);
        foot_frame(agent, side, points_m, planted_heights_m)
    })
}

/// A foot whose heel, ball and toe are at these points of the root's frame, m.
fn foot_frame(agent: &AgentFrame, side: usize, points_m: [Vec3; 3], planted_heights_m: [f32; 3]) -> FootFrame {
    let height_m = |point: usize| points_m[point].z - planted_heights_m[point];
    let lowest = (1..3).fold(0, |best, point| if height_m(point) < height_m(best) { point } else { best });
    FootFrame {
        points_m: points_m.map(|point_m| to_ground_m(&agent.root, point_m)),
        lowest,
        planted: agent.contacts[side] >= PLANTED_CONTACT,
        examples_slide_cm_s: agent.examples_slide_cm_s,
    }
}

/// Heel, ball and toe in the root's frame, and their heights above the sole, at which they are when planted, m.
fn contact_points_m(skeleton: &Skeleton, joints: &Joints, side: usize) -> ([Vec3; 3], [f32; 3]) {
    let foot = &skeleton.feet[side];
    let soles_m = [foot.heel_m, foot.ball_m, foot.toe_tip_m];
    let heights_m = std::array::from_fn(|point| foot.measured_m[point].z - soles_m[point].z);
    (joints.measured_points_m(skeleton, side), heights_m)
}

/// A point of the root's frame on the ground, world, m. In f64, so that the distance from the origin costs no
/// precision.
fn to_ground_m(root: &Root, point_m: Vec3) -> DVec2 {
    let (sin, cos) = libm::sincos(f64::from(root.facing_rad));
    DVec2::from(root.position_m) + DVec2::new(cos, sin).rotate(DVec2::from(point_m.truncate()))
}

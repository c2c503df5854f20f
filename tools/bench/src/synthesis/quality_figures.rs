//! Measures of the bodies that follow a command sequence. Every measure is the worst of all bodies and measured
//! intervals, at one time step.

use std::f64::consts::TAU;
use std::ops::Range;

use fbcrowd_sim::measures::PlantedSlide;
use fbcrowd_sim::planning::PLANTED_CONTACT;
use fbcrowd_sim::synthesis::blending::{BlendDomain, ExampleMix};
use glam::Vec3;
use motiondb::body::{Joint, Joints, Skeleton};
use motiondb::motion::MotionDb;
use schemars::JsonSchema;
use serde::Serialize;

use crate::synthesis::command_sequences::CommandSequence;
use crate::synthesis::sequence_walk::{BodyStep, SequenceWalk};

/// Share of a contact that is left out at each of its ends.
const TRIMMED_SHARE: f64 = 0.1;
/// Greatest height of a sole on the ground, mm.
const GROUNDED_MM: f64 = 5.0;
/// Least speed of a swinging foot, m/s.
const SWING_MPS: f32 = 1.0;
/// Least speed in the ratio of correction and speed, m/s.
const STILL_MPS: f64 = 0.01;
/// Durations before and after a change of synthesis in which its effect shows, s.
const SWITCH_S: [f32; 2] = [0.08, 0.35];
/// Greatest frequency in the smoothness of a speed, Hz.
const SPARC_MAX_HZ: f64 = 10.0;
/// Step between the frequencies, Hz.
const SPARC_STEP_HZ: f64 = 0.05;
/// The spectrum ends at the last frequency with at least this share of its mean.
const SPARC_LEAST: f64 = 0.05;

/// Measures of one walk.
#[derive(Clone, Copy, Debug, Default, JsonSchema, Serialize)]
pub struct QualityFigures {
    /// Slide of planted feet in the interval in which they slide most, cm/s.
    pub slide_cm_s: f64,
    /// Slide of planted feet in the examples in use in that interval, cm/s.
    pub examples_slide_cm_s: f64,
    /// Share of feet and frames that are planted, 0 to 1.
    pub planted_share: f64,
    /// Planted share of the examples in use, 0 to 1.
    pub examples_planted_share: f64,
    /// Share of planted soles that stand on the ground, 0 to 1.
    pub grounded_share: f64,
    /// Greatest depth of a sole under the ground, mm.
    pub penetration_mm: f64,
    /// Least height of a swinging sole, mm.
    pub clearance_mm: f64,
    /// Least flexion of a knee, degrees; negative where it is hyperextended.
    pub knee_min_deg: f64,
    /// Greatest rate of change of a knee's flexion, rad/s.
    pub knee_speed_max_rad_s: f64,
    /// Greatest speed of a foot, m/s.
    pub foot_speed_max_mps: f64,
    /// Least distance of the left ankle to the left of the right one, m.
    pub ankles_apart_m: f64,
    /// Greatest acceleration of a joint in the root's frame, divided by that of the examples in use shortly before and
    /// after.
    pub acceleration_ratio: f64,
    /// Greatest acceleration of a joint about a change of synthesis, divided by that of the examples in use; null
    /// without changes.
    pub switch_acceleration_ratio: Option<f64>,
    /// Mean size of the root's speed that is not in the rows, since the phase catches up with the feet, m/s.
    pub correction_mps: f64,
    /// Mean size of the root's speed that is not in the rows, divided by the mean speed.
    pub correction_share: f64,
    /// Mean of the root's speed that is not in the rows, with its sign, divided by the mean speed: how much faster the
    /// root goes in the long run.
    pub signed_correction_share: f64,
    /// Number of planted soles on the ground, and of all planted soles.
    #[serde(skip)]
    soles: [usize; 2],
    /// Spectral arc length of the root's speed: 0 for a single bump, the lower the less smooth.
    pub sparc: f64,
}

/// Greatest acceleration of a joint in the root's frame within each example, played with this time step, m/s².
pub(crate) fn example_peaks_mps2(db: &MotionDb, space: &BlendDomain, dt_s: f32) -> Vec<f32> {
    let peak = |example: usize| {
        let mix = ExampleMix::new(&space.locate(db.examples[example].parameters));
        let steps = (2.0 * db.examples[example].phase_map.period_s / dt_s) as usize + 3;
        let mut phase = 0.0;
        let joints: Vec<Joints> = (0..steps)
            .map(|_| {
                phase = mix.advanced_phase(db, phase, dt_s);
                mix.weights(db, phase).pose(db, phase).forward_kinematics(&db.skeleton)
            })
            .collect();
        joints.windows(3).map(|three| acceleration_mps2([&three[0], &three[1], &three[2]], dt_s)).fold(0.0, f32::max)
    };
    (0..db.examples.len()).map(peak).collect()
}

/// All measures of a walk; `peaks_mps2` are those of the examples.
pub(crate) fn figures(
    walk: &SequenceWalk,
    sequence: &CommandSequence,
    skeleton: &Skeleton,
    peaks_mps2: &[f32],
) -> QualityFigures {
    let mut figures =
        QualityFigures { knee_min_deg: 180.0, clearance_mm: 1e3, ankles_apart_m: 1.0, ..QualityFigures::default() };
    let intervals: Vec<Range<usize>> = sequence.measured_s().iter().map(|&from_to_s| walk.steps(from_to_s)).collect();
    for interval in &intervals {
        let bodies: Vec<&[BodyStep]> = walk.bodies.iter().map(|steps| &steps[interval.clone()]).collect();
        figures.feet(&bodies, skeleton, walk.dt_s);
        bodies.iter().for_each(|steps| figures.body(steps, skeleton, walk.dt_s));
    }
    walk.bodies.iter().for_each(|steps| figures.accelerations(steps, &intervals, walk.dt_s, peaks_mps2));
    let measured = |steps| intervals.iter().flat_map(move |interval| &Vec::as_slice(steps)[interval.clone()]);
    let all: Vec<&BodyStep> = walk.bodies.iter().flat_map(measured).collect();
    let mean = |of: fn(&BodyStep) -> f32| all.iter().map(|step| f64::from(of(step))).sum::<f64>() / all.len() as f64;
    let speed_mps = mean(|step| step.speed_mps).max(STILL_MPS);
    figures.correction_mps = mean(|step| step.correction_mps.abs());
    figures.correction_share = figures.correction_mps / speed_mps;
    figures.signed_correction_share = -mean(|step| step.correction_mps) / speed_mps;
    figures.examples_planted_share = mean(|step| step.examples_planted_share);
    let planted =
        |step: &BodyStep| 0.5 * step.planted().map(|planted| f32::from(u8::from(planted))).iter().sum::<f32>();
    figures.planted_share = all.iter().map(|step| f64::from(planted(step))).sum::<f64>() / all.len() as f64;
    figures.grounded_share = figures.soles[0] as f64 / figures.soles[1].max(1) as f64;
    figures.sparc = walk.bodies.iter().map(|steps| sparc(steps, walk.dt_s)).fold(0.0, f64::min);
    figures
}

impl SequenceWalk {
    /// The steps between two times that every body has.
    fn steps(&self, from_to_s: [f32; 2]) -> Range<usize> {
        let count = self.bodies.iter().map(Vec::len).min().unwrap_or(0);
        let [from, to] = from_to_s.map(|time_s| ((time_s / self.dt_s).round() as usize).min(count));
        from..to
    }
}

impl BodyStep {
    fn planted(&self) -> [bool; 2] {
        self.frame.contacts.map(|contact| contact >= PLANTED_CONTACT)
    }

    fn soles_m(&self, skeleton: &Skeleton, side: usize) -> [Vec3; 3] {
        self.joints.sole_points_m(skeleton, side).map(|point_m| self.frame.root.to_world(point_m))
    }
}

impl QualityFigures {
    /// Adds the slide of all bodies in an interval.
    fn feet(&mut self, bodies: &[&[BodyStep]], skeleton: &Skeleton, dt_s: f32) {
        let mut slide = PlantedSlide::new(bodies.len(), dt_s);
        for step in 0..bodies.first().map_or(0, |steps| steps.len()) {
            let frames: Vec<_> = bodies.iter().map(|steps| steps[step].frame).collect();
            let joints: Vec<_> = bodies.iter().map(|steps| steps[step].joints).collect();
            slide.push(skeleton, &frames, &joints);
        }
        let found = slide.finish();
        let slide_cm_s = found.slide_cm_s.unwrap_or(0.0);
        if slide_cm_s >= self.slide_cm_s {
            self.slide_cm_s = slide_cm_s;
            self.examples_slide_cm_s = found.examples_slide_cm_s.unwrap_or(0.0);
        }
    }

    /// Adds all other measures except accelerations, of one body in an interval.
    fn body(&mut self, steps: &[BodyStep], skeleton: &Skeleton, dt_s: f32) {
        for side in 0..2 {
            self.foot(steps, skeleton, side, dt_s);
            self.knee(steps, side, dt_s);
        }
        let apart_m = steps.iter().map(|step| ankles_apart_m(&step.joints)).fold(f32::INFINITY, f32::min);
        self.ankles_apart_m = self.ankles_apart_m.min(f64::from(apart_m));
    }

    fn foot(&mut self, steps: &[BodyStep], skeleton: &Skeleton, side: usize, dt_s: f32) {
        let soles_m: Vec<[Vec3; 3]> = steps.iter().map(|step| step.soles_m(skeleton, side)).collect();
        let lowest_mm: Vec<f64> = soles_m
            .iter()
            .map(|sole_m| sole_m.iter().map(|point_m| 1e3 * f64::from(point_m.z)).fold(f64::INFINITY, f64::min))
            .collect();
        self.penetration_mm = lowest_mm.iter().fold(self.penetration_mm, |deepest, height| deepest.max(-height));
        let mut start = 0;
        for contact in steps.chunk_by(|a, b| a.planted()[side] == b.planted()[side]) {
            let (first, margin) = (start, (contact.len() as f64 * TRIMMED_SHARE).round() as usize);
            start += contact.len();
            if contact[0].planted()[side] {
                let middle = &lowest_mm[first + margin..start - margin];
                self.soles[0] += middle.iter().filter(|&&height_mm| height_mm <= GROUNDED_MM).count();
                self.soles[1] += middle.len();
            }
        }
        for ((pair, both), lowest_mm) in soles_m.windows(2).zip(steps.windows(2)).zip(&lowest_mm) {
            let swings = both.iter().all(|step| !step.planted()[side]);
            let speed_mps = (pair[1][1] - pair[0][1]).truncate().length() / dt_s;
            self.foot_speed_max_mps = self.foot_speed_max_mps.max(f64::from((pair[1][1] - pair[0][1]).length() / dt_s));
            if swings && speed_mps > SWING_MPS {
                self.clearance_mm = self.clearance_mm.min(*lowest_mm);
            }
        }
    }

    fn knee(&mut self, steps: &[BodyStep], side: usize, dt_s: f32) {
        let flexions_rad: Vec<f32> = steps.iter().map(|step| step.frame.pose.knee_flexion_rad(side)).collect();
        let least_rad = flexions_rad.iter().copied().fold(f32::INFINITY, f32::min);
        self.knee_min_deg = self.knee_min_deg.min(f64::from(least_rad.to_degrees()));
        for pair in flexions_rad.windows(2) {
            self.knee_speed_max_rad_s = self.knee_speed_max_rad_s.max(f64::from((pair[1] - pair[0]).abs() / dt_s));
        }
    }

    /// Adds the accelerations of one body in the intervals. The ratios are those of the whole walk: a change of
    /// synthesis at the border of an interval shows on both sides of it.
    fn accelerations(&mut self, steps: &[BodyStep], intervals: &[Range<usize>], dt_s: f32, peaks_mps2: &[f32]) {
        let [before, after] = SWITCH_S.map(|seconds| (seconds / dt_s).ceil() as usize);
        let ratios = acceleration_ratios(steps, after, dt_s, peaks_mps2);
        for step in intervals.iter().cloned().flatten() {
            self.acceleration_ratio = self.acceleration_ratio.max(ratios[step]);
            if steps[step].frame.mode != steps[step - 1].frame.mode {
                let about = &ratios[step.saturating_sub(before)..(step + after).min(steps.len())];
                let greatest = about.iter().copied().fold(self.switch_acceleration_ratio.unwrap_or(0.0), f64::max);
                self.switch_acceleration_ratio = Some(greatest);
            }
        }
    }
}

/// For each step, the greatest acceleration of a joint, divided by that of the examples in use within some steps; 0 at
/// the ends.
fn acceleration_ratios(steps: &[BodyStep], within: usize, dt_s: f32, peaks_mps2: &[f32]) -> Vec<f64> {
    let greatest = |values: &[f32]| values.iter().copied().fold(0.0, f32::max);
    let peaks: Vec<f32> =
        steps.iter().map(|step| step.examples.iter().map(|&example| peaks_mps2[example]).fold(0.0, f32::max)).collect();
    let mut ratios = vec![0.0; steps.len()];
    for (step, three) in (1_usize..).zip(steps.windows(3)) {
        let about = &peaks[step.saturating_sub(within)..(step + within).min(peaks.len())];
        let joints = [&three[0].joints, &three[1].joints, &three[2].joints];
        ratios[step] = f64::from(acceleration_mps2(joints, dt_s) / greatest(about));
    }
    ratios
}

/// Acceleration of the joint that accelerates most, by second differences in the root's frame, m/s².
fn acceleration_mps2([before, at, after]: [&Joints; 3], dt_s: f32) -> f32 {
    let joints = before.positions_m.iter().zip(&at.positions_m).zip(&after.positions_m);
    joints.map(|((&a, &b), &c)| (a - 2.0 * b + c).length() / (dt_s * dt_s)).fold(0.0, f32::max)
}

/// Distance of the left ankle to the left of the right one, m.
pub(crate) fn ankles_apart_m(joints: &Joints) -> f32 {
    let [left_m, right_m] = Joint::FEET.map(|foot| joints.positions_m[foot.index()]);
    left_m.y - right_m.y
}

/// Spectral arc length of the root's speed, SPARC (Balasubramanian et al. 2015).
fn sparc(steps: &[BodyStep], dt_s: f32) -> f64 {
    let dt_s = f64::from(dt_s);
    let speeds_mps: Vec<f64> = steps.iter().map(|step| f64::from(step.speed_mps)).collect();
    let magnitude = |hz: f64| {
        let terms = speeds_mps.iter().enumerate().map(|(step, speed_mps)| {
            let (sin, cos) = libm::sincos(TAU * hz * step as f64 * dt_s);
            (speed_mps * cos, speed_mps * sin)
        });
        let (re, im) = terms.fold((0.0, 0.0), |sum, term| (sum.0 + term.0, sum.1 + term.1));
        libm::hypot(re, im)
    };
    let mean = speeds_mps.iter().sum::<f64>().max(f64::MIN_POSITIVE);
    let top_hz = SPARC_MAX_HZ.min(0.5 / dt_s);
    let spectrum: Vec<f64> =
        (0..=(top_hz / SPARC_STEP_HZ) as usize).map(|bin| magnitude(bin as f64 * SPARC_STEP_HZ) / mean).collect();
    let last = spectrum.iter().rposition(|&share| share >= SPARC_LEAST).unwrap_or(0).max(1);
    let step = 1.0 / last as f64;
    -spectrum[..=last].windows(2).map(|pair| libm::hypot(step, pair[1] - pair[0])).sum::<f64>()
}

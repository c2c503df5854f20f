//! What is measured on the bodies of an errand. Every figure is the worst of all bodies and measured stretches, at one
//! dt.

use std::f64::consts::TAU;
use std::ops::Range;

use fbcrowd_sim::measures::PlantedSlide;
use fbcrowd_sim::planning::PLANTED_CONTACT;
use fbcrowd_sim::synthesis::blending::{BlendDomain, ExampleMix};
use glam::Vec3;
use motiondb::body::{Joint, Joints, Skeleton};
use motiondb::motion::MotionDb;
use serde::Serialize;

use crate::cmd::bench::quality_errands::Errand;
use crate::cmd::bench::quality_walk::{Step, Walk};

/// Of each end of a contact, left out.
const TRIMMED_SHARE: f64 = 0.1;
/// A sole no higher than this is on the ground, mm.
const GROUNDED_MM: f64 = 5.0;
/// A foot that moves faster than this swings, m/s.
const SWING_MPS: f32 = 1.0;
/// Slower than this, what corrects the root is no share of its speed, m/s.
const STILL_MPS: f64 = 0.01;
/// What a switch does shows from so long before it until so long after it, s.
const SWITCH_S: [f32; 2] = [0.08, 0.35];
/// Up to this frequency a speed is judged for smoothness, Hz …
const SPARC_MAX_HZ: f64 = 10.0;
/// … in steps of this, Hz, …
const SPARC_STEP_HZ: f64 = 0.05;
/// … and no further than where its spectrum has last this share of its mean.
const SPARC_LEAST: f64 = 0.05;

/// What one errand showed at one dt.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub(super) struct Figures {
    /// Of the stretch in which feet slide most, and of its examples, cm/s.
    pub(super) slide_cm_s: f64,
    pub(super) examples_slide_cm_s: f64,
    /// Of feet and frames that are planted, and of the examples in use.
    pub(super) planted_share: f64,
    pub(super) examples_planted_share: f64,
    /// Share of planted soles that stand on the ground, and how deep any sole is under it.
    pub(super) grounded_share: f64,
    pub(super) penetration_mm: f64,
    /// Least height of a swinging sole.
    pub(super) clearance_mm: f64,
    /// Least flexion of a knee, negative where it is hyperextended.
    pub(super) knee_min_deg: f64,
    pub(super) knee_speed_max_rad_s: f64,
    pub(super) foot_speed_max_mps: f64,
    /// How far the left ankle keeps to the left of the right one, at least.
    pub(super) ankles_apart_m: f64,
    /// Greatest acceleration of a joint in the root's frame over that of the examples in use shortly before and after:
    /// always, and about switches.
    pub(super) acceleration_ratio: f64,
    pub(super) switch_acceleration_ratio: Option<f64>,
    /// What the root moves beyond the rows, as the phase catches up with the feet: the mean of its size, and that over
    /// the mean speed.
    pub(super) correction_mps: f64,
    pub(super) correction_share: f64,
    /// Likewise with its sign, so that what is caught up on balances: how much faster the root goes in the long run.
    pub(super) signed_correction_share: f64,
    /// Planted soles that stand on the ground, and all of them.
    #[serde(skip)]
    soles: [usize; 2],
    /// Of the root's speed: 0 were it one bump, the lower the less smooth.
    pub(super) sparc: f64,
}

/// Greatest acceleration of a joint in the root's frame within each example, played in steps of dt, m/s².
pub(super) fn example_peaks_mps2(db: &MotionDb, space: &BlendDomain, dt_s: f32) -> Vec<f32> {
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

/// Everything.
pub(super) fn figures(walk: &Walk, errand: &Errand, skeleton: &Skeleton, peaks_mps2: &[f32]) -> Figures {
    let mut figures = Figures { knee_min_deg: 180.0, clearance_mm: 1e3, ankles_apart_m: 1.0, ..Figures::default() };
    let stretches: Vec<Range<usize>> = errand.measured_s().iter().map(|&from_to_s| walk.stretch(from_to_s)).collect();
    for stretch in &stretches {
        let bodies: Vec<&[Step]> = walk.bodies.iter().map(|steps| &steps[stretch.clone()]).collect();
        figures.feet(&bodies, skeleton, walk.dt_s);
        bodies.iter().for_each(|steps| figures.body(steps, skeleton, walk.dt_s));
    }
    walk.bodies.iter().for_each(|steps| figures.accelerations(steps, &stretches, walk.dt_s, peaks_mps2));
    let measured = |steps| stretches.iter().flat_map(move |stretch| &Vec::as_slice(steps)[stretch.clone()]);
    let all: Vec<&Step> = walk.bodies.iter().flat_map(measured).collect();
    let mean = |of: fn(&Step) -> f32| all.iter().map(|step| f64::from(of(step))).sum::<f64>() / all.len() as f64;
    let speed_mps = mean(|step| step.speed_mps).max(STILL_MPS);
    figures.correction_mps = mean(|step| step.correction_mps.abs());
    figures.correction_share = figures.correction_mps / speed_mps;
    figures.signed_correction_share = -mean(|step| step.correction_mps) / speed_mps;
    figures.examples_planted_share = mean(|step| step.examples_planted_share);
    let planted = |step: &Step| 0.5 * step.planted().map(|planted| f32::from(u8::from(planted))).iter().sum::<f32>();
    figures.planted_share = all.iter().map(|step| f64::from(planted(step))).sum::<f64>() / all.len() as f64;
    figures.grounded_share = figures.soles[0] as f64 / figures.soles[1].max(1) as f64;
    figures.sparc = walk.bodies.iter().map(|steps| sparc(steps, walk.dt_s)).fold(0.0, f64::min);
    figures
}

impl Walk {
    /// The steps between two times, which every body has.
    fn stretch(&self, from_to_s: [f32; 2]) -> Range<usize> {
        let count = self.bodies.iter().map(Vec::len).min().unwrap_or(0);
        let [from, to] = from_to_s.map(|time_s| ((time_s / self.dt_s).round() as usize).min(count));
        from..to
    }
}

impl Step {
    fn planted(&self) -> [bool; 2] {
        self.frame.contacts.map(|contact| contact >= PLANTED_CONTACT)
    }

    fn soles_m(&self, skeleton: &Skeleton, side: usize) -> [Vec3; 3] {
        self.joints.sole_points_m(skeleton, side).map(|point_m| self.frame.root.to_world(point_m))
    }
}

impl Figures {
    /// Slide, over all bodies of a stretch.
    fn feet(&mut self, bodies: &[&[Step]], skeleton: &Skeleton, dt_s: f32) {
        let mut slide = PlantedSlide::new(skeleton, bodies.len(), dt_s);
        for step in 0..bodies.first().map_or(0, |steps| steps.len()) {
            let frames: Vec<_> = bodies.iter().map(|steps| steps[step].frame).collect();
            let joints: Vec<_> = bodies.iter().map(|steps| steps[step].joints).collect();
            slide.push(&frames, &joints);
        }
        let found = slide.finish();
        let slide_cm_s = found.slide_cm_s.unwrap_or(0.0);
        if slide_cm_s >= self.slide_cm_s {
            self.slide_cm_s = slide_cm_s;
            self.examples_slide_cm_s = found.examples_slide_cm_s.unwrap_or(0.0);
        }
    }

    /// Everything else but accelerations, of one body in a stretch.
    fn body(&mut self, steps: &[Step], skeleton: &Skeleton, dt_s: f32) {
        for side in 0..2 {
            self.foot(steps, skeleton, side, dt_s);
            self.knee(steps, side, dt_s);
        }
        let apart_m = steps.iter().map(|step| ankles_apart_m(&step.joints)).fold(f32::INFINITY, f32::min);
        self.ankles_apart_m = self.ankles_apart_m.min(f64::from(apart_m));
    }

    fn foot(&mut self, steps: &[Step], skeleton: &Skeleton, side: usize, dt_s: f32) {
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

    fn knee(&mut self, steps: &[Step], side: usize, dt_s: f32) {
        let flexions_rad: Vec<f32> = steps.iter().map(|step| step.frame.pose.knee_flexion_rad(side)).collect();
        let least_rad = flexions_rad.iter().copied().fold(f32::INFINITY, f32::min);
        self.knee_min_deg = self.knee_min_deg.min(f64::from(least_rad.to_degrees()));
        for pair in flexions_rad.windows(2) {
            self.knee_speed_max_rad_s = self.knee_speed_max_rad_s.max(f64::from((pair[1] - pair[0]).abs() / dt_s));
        }
    }

    /// Of one body in the stretches. Ratios are those of its whole walk: a switch at the border of a stretch shows on
    /// both sides of it.
    fn accelerations(&mut self, steps: &[Step], stretches: &[Range<usize>], dt_s: f32, peaks_mps2: &[f32]) {
        let [before, after] = SWITCH_S.map(|seconds| (seconds / dt_s).ceil() as usize);
        let ratios = acceleration_ratios(steps, after, dt_s, peaks_mps2);
        for step in stretches.iter().cloned().flatten() {
            self.acceleration_ratio = self.acceleration_ratio.max(ratios[step]);
            if steps[step].frame.mode != steps[step - 1].frame.mode {
                let about = &ratios[step.saturating_sub(before)..(step + after).min(steps.len())];
                let greatest = about.iter().copied().fold(self.switch_acceleration_ratio.unwrap_or(0.0), f64::max);
                self.switch_acceleration_ratio = Some(greatest);
            }
        }
    }
}

/// By step: the greatest acceleration of a joint over that of the examples in use within so many steps; 0 at the ends.
fn acceleration_ratios(steps: &[Step], within: usize, dt_s: f32, peaks_mps2: &[f32]) -> Vec<f64> {
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

/// Of the joint that accelerates most, by second differences in the root's frame.
fn acceleration_mps2([before, at, after]: [&Joints; 3], dt_s: f32) -> f32 {
    let joints = before.positions_m.iter().zip(&at.positions_m).zip(&after.positions_m);
    joints.map(|((&a, &b), &c)| (a - 2.0 * b + c).length() / (dt_s * dt_s)).fold(0.0, f32::max)
}

/// How far the left ankle is to the left of the right one.
pub(super) fn ankles_apart_m(joints: &Joints) -> f32 {
    let [left_m, right_m] = Joint::FEET.map(|foot| joints.positions_m[foot.index()]);
    left_m.y - right_m.y
}

/// Spectral arc length of the root's speed, SPARC (Balasubramanian et al. 2015).
fn sparc(steps: &[Step], dt_s: f32) -> f64 {
    let dt_s = f64::from(dt_s);
    let speeds_mps: Vec<f64> = steps.iter().map(|step| f64::from(step.speed_mps)).collect();
    let magnitude = |hz: f64| {
        let terms = speeds_mps.iter().enumerate().map(|(step, speed_mps)| {
            let (sin, cos) = (TAU * hz * step as f64 * dt_s).sin_cos();
            (speed_mps * cos, speed_mps * sin)
        });
        let (re, im) = terms.fold((0.0, 0.0), |sum, term| (sum.0 + term.0, sum.1 + term.1));
        re.hypot(im)
    };
    let mean = speeds_mps.iter().sum::<f64>().max(f64::MIN_POSITIVE);
    let top_hz = SPARC_MAX_HZ.min(0.5 / dt_s);
    let spectrum: Vec<f64> =
        (0..=(top_hz / SPARC_STEP_HZ) as usize).map(|bin| magnitude(bin as f64 * SPARC_STEP_HZ) / mean).collect();
    let last = spectrum.iter().rposition(|&share| share >= SPARC_LEAST).unwrap_or(0).max(1);
    let step = 1.0 / last as f64;
    -spectrum[..=last].windows(2).map(|pair| step.hypot(pair[1] - pair[0])).sum::<f64>()
}

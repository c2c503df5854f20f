//! One random combination of clip, skeleton, rest pose and file, and what its import must report.

use std::path::Path;

use glam::{DQuat, DVec3};
use motiondb::body::{JOINT_COUNT, Joint};
use motiondb::diagnostic::{ClipEnd, Diagnostic, Note, Unfit};
use motiondb_compiler::read::bvh;
use motiondb_compiler::rig::find_roles;
use motiondb_compiler::{Axis, HumanClip, import_bytes};

use super::body::Performance;
use super::file::{self, File, RootOffset};
use super::names::{Names, tools};
use super::rig::{self, EXTRAS, Extra, Rest, Rig};

/// Clips of every gait.
const CLIPS: [&str; 14] = [
    "walk_050",
    "walk_080",
    "walk_110",
    "walk_180",
    "jog_240",
    "run_350",
    "turn_060_left",
    "turn_130_left",
    "jog_turn_110_left",
    "side_060_left",
    "shuffle_120_left",
    "diagonal_080_040_left",
    "backward_080_bvh",
    "backward_110",
];
/// Name, metres.
const UNITS: [(&str, f64); 6] =
    [("m", 1.0), ("cm", 0.01), ("mm", 0.001), ("inch", 0.0254), ("dm", 0.1), ("1/0.45 inch", 0.0564444)];

/// What is done to the performance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Change {
    Plain,
    /// One T-pose, then a jump.
    TPoseFirst,
    /// So many seconds of motion into which the T-pose is blended.
    BlendsOut(f64),
    /// So many seconds in a T-pose before and after.
    Calibrated([f64; 2]),
    /// The root's displacement is removed.
    InPlace,
    /// Written by a tool of the other handedness, names and all.
    LeftHanded,
    /// Up or down so many metres a metre.
    Sloping(f64),
    /// The frame time is so many times too long.
    WrongFrameTime(f64),
}

/// A repeatable source of choices (splitmix64).
pub(crate) struct Dice(u64);

impl Dice {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0xd134_2543_de82_ef95).rotate_left(29))
    }

    pub(crate) fn below(&mut self, count: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut word = self.0;
        word = (word ^ (word >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        word = (word ^ (word >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((word ^ (word >> 31)) % count as u64) as usize
    }

    pub(crate) fn unit(&mut self) -> f64 {
        self.below(1 << 30) as f64 / f64::from(1 << 30)
    }

    fn pick<T: Copy>(&mut self, things: &[T]) -> T {
        things[self.below(things.len())]
    }

    fn chance(&mut self, share: f64) -> bool {
        self.unit() < share
    }

    fn turn(&mut self) -> DQuat {
        let [x, y, z, w] = std::array::from_fn(|_| self.unit() - 0.5);
        DQuat::from_xyzw(x, y, z, w + 0.01).normalize()
    }
}

#[derive(Clone, Debug)]
pub(crate) struct Combination {
    pub clip: &'static str,
    pub is_mirrored: bool,
    pub frame_rate_hz: f64,
    pub names: Names,
    pub extras: Vec<Extra>,
    pub rest: Rest,
    pub unit: (&'static str, f64),
    pub up: Axis,
    pub file: File,
    pub change: Change,
    pub seed: u64,
}

impl Combination {
    pub(crate) fn thrown(dice: &mut Dice) -> Self {
        let clip = if dice.chance(0.1) { "idle" } else { dice.pick(&CLIPS) };
        let clip = if clip == "backward_080_bvh" { "backward_040" } else { clip };
        let mut all = tools();
        let mut names = all.swap_remove(dice.below(all.len()));
        if dice.chance(0.15) {
            names.sides = [names.sides[1], names.sides[0]];
            names.sides = if dice.chance(0.5) { ["A", "B"] } else { [names.sides[1], names.sides[0]] };
        }
        let extras = if dice.chance(0.3) {
            Vec::new()
        } else {
            let share = 0.1 + 0.4 * dice.unit();
            EXTRAS.into_iter().filter(|_| dice.chance(share)).collect()
        };
        let rest = match dice.below(6) {
            0 | 1 => Rest::TPose,
            2 => Rest::APose,
            3 => Rest::ArmsDown,
            4 => Rest::Along(dice.below(6)),
            _ => Rest::Any,
        };
        let unit = dice.pick(&UNITS);
        let up = if dice.chance(0.5) { 2 } else { dice.below(6) };
        let axes = [DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Y, DVec3::Z, DVec3::NEG_Z];
        let to_up = DQuat::from_rotation_arc(DVec3::Y, axes[up]);
        let heading = if dice.chance(0.5) { dice.below(4) as f64 * 90.0 } else { 360.0 * dice.unit() };
        // A tall adult in inches has the numbers of a child of four in centimetres, and is taken for that.
        let size = match unit.0 {
            "cm" | "m" => 0.75 + 0.45 * dice.unit(),
            "inch" => 0.9 + 0.1 * dice.unit(),
            _ => 0.9 + 0.25 * dice.unit(),
        };
        let file = File {
            axes: to_up * DQuat::from_rotation_y(heading.to_radians()),
            shift_m: if dice.chance(0.5) {
                DVec3::ZERO
            } else {
                DVec3::new(6.0 * dice.unit() - 3.0, 0.6 * dice.unit() - 0.3, 6.0 * dice.unit() - 3.0)
            },
            order: dice.below(6),
            rotations_first: dice.chance(0.15),
            positions_everywhere: dice.chance(0.25),
            root_offset: dice.pick(&[RootOffset::Zero, RootOffset::Replaced, RootOffset::Added]),
            ..File::plain(1.0 / unit.1, size)
        };
        let frame_rate_hz = dice.pick(&[24.0, 25.0, 30.0, 30.0, 50.0, 60.0, 60.0, 100.0, 120.0]);
        let is_mirrored = dice.chance(0.4);
        let is_walk = ["walk_080", "walk_110", "walk_180", "jog_240", "run_350"].contains(&clip);
        let change = match dice.below(16) {
            0 => Change::TPoseFirst,
            1 => Change::BlendsOut(0.2 + 0.4 * dice.unit()),
            2 => Change::Calibrated([dice.unit() + 0.5, 0.0]),
            3 => Change::Calibrated([4.0 * dice.unit(), 3.0 * dice.unit()]),
            4 => Change::InPlace,
            5 => Change::LeftHanded,
            6 => Change::Sloping(0.5 * dice.unit() - 0.25),
            // A slow walk, four times slower, is still plausible.
            7 if is_walk => Change::WrongFrameTime(dice.pick(&[4.8, 1.0 / 4.8, 0.25])),
            _ => Change::Plain,
        };
        let seed = dice.below(1 << 40) as u64;
        Self {
            clip,
            is_mirrored,
            frame_rate_hz,
            names,
            extras,
            rest,
            unit,
            up: Axis::nearest(axes[up]),
            file,
            change,
            seed,
        }
    }

    /// Properties by which failures are counted.
    pub(crate) fn words(&self) -> Vec<String> {
        let mut words: Vec<String> = self.extras.iter().map(|extra| format!("extra {extra:?}")).collect();
        words.push(format!("tool {}", self.names.tool));
        words.push(format!("clip {}", self.clip));
        words.push(format!("rest {:?}", self.rest));
        words.push(format!("unit {}", self.unit.0));
        words.push(format!("up {}", self.up.name()));
        words.push(format!("change {:?}", self.change).split(['(', '[']).next().unwrap_or_default().to_owned());
        words.push(format!("everywhere {}", self.file.positions_everywhere));
        words.push(format!("root {:?}", self.file.root_offset));
        words
    }

    fn performance(&self) -> Performance {
        let body = Performance::read(self.clip).resampled(self.frame_rate_hz);
        let mut body = if self.is_mirrored { body.mirrored() } else { body };
        match self.change {
            Change::TPoseFirst => body.stand_before(1.0 / body.frame_rate_hz, 0.0),
            Change::BlendsOut(blend_s) => body.blend_out(blend_s),
            Change::Calibrated([before_s, after_s]) => {
                body.stand_before(before_s, 0.5);
                if after_s > 0.0 {
                    body.stand_after(after_s, 0.5);
                }
            }
            Change::InPlace => body.stay_in_place(),
            Change::Sloping(slope) => body.slope(slope),
            Change::WrongFrameTime(factor) => body.frame_rate_hz /= factor,
            Change::Plain | Change::LeftHanded => {}
        }
        body
    }

    pub(crate) fn check(&self) -> Result<(), String> {
        let body = self.performance();
        let mut dice = Dice::new(self.seed);
        let rig = rig::build(&body, &self.names, &self.extras, self.rest, || dice.turn());
        let file = File { is_left_handed: self.change == Change::LeftHanded, ..self.file };
        let text = file::write(&body, &rig, &file);
        if !file.is_left_handed {
            self.check_roles(&text, &rig)?;
        }
        let imports = import_bytes(Path::new("zoo.bvh"), text.as_bytes()).map_err(|error| error.to_string())?;
        let human = imports.into_iter().next().unwrap().outcome.map_err(|reason| reason.to_string())?;
        let record = &human.source;
        if record.up_axis != self.up_in_file().name()
            || (f64::from(record.metres_per_unit) / self.unit.1 - 1.0).abs() > 1e-3
        {
            return Err(format!("{} up, {} m a unit", record.up_axis, record.metres_per_unit));
        }
        self.check_diagnostics(&human)?;
        let found = [record.speed_mps, record.turn_rate_rad_s.to_degrees(), record.strafe_mps].map(f64::from);
        self.check_parameters(&body, found)
    }

    /// The up axis; a file of the wrong handedness has x mirrored.
    fn up_in_file(&self) -> Axis {
        let flip = if self.change == Change::LeftHanded { DVec3::new(-1.0, 1.0, 1.0) } else { DVec3::ONE };
        Axis::nearest(flip * self.up.direction())
    }

    fn check_parameters(&self, body: &Performance, found: [f64; 3]) -> Result<(), String> {
        let [forward, turn, left] = [body.parameters[0], body.turn_rate(), body.parameters[2]];
        let (size, duration_s) = (self.file.size, body.poses.len() as f64 / body.frame_rate_hz);
        let wanted = match self.change {
            Change::WrongFrameTime(factor) => [size * forward / factor, turn / factor, size * left / factor],
            Change::LeftHanded => [size * forward, -turn, -size * left],
            _ => [size * forward, turn, size * left],
        };
        let wider = if self.change == Change::InPlace { 3.0 } else { 1.0 };
        let tolerances = [
            wider * f64::max(0.03 * wanted[0].abs(), 0.03),
            wider * f64::max(3.0, 15.0 / duration_s),
            wider * f64::max(0.03 * wanted[2].abs(), 0.04),
        ];
        let fits = (0..3).all(|k| (found[k] - wanted[k]).abs() <= tolerances[k]);
        fits.then_some(()).ok_or_else(|| format!("{found:.3?}, not {wanted:.3?}"))
    }

    fn is_long_walk(&self) -> bool {
        ["walk_080", "walk_110", "walk_180", "jog_240", "run_350"].contains(&self.clip)
    }

    /// Checks that all is reported that must be, and nothing else.
    fn check_diagnostics(&self, human: &HumanClip) -> Result<(), String> {
        let label = |found: &Diagnostic| match found {
            Diagnostic::Note(Note::TPoseCut { end: ClipEnd::First, .. }) => "first T-pose",
            Diagnostic::Note(Note::TPoseCut { end: ClipEnd::Last, .. }) => "last T-pose",
            other => other.code(),
        };
        // Of inches the doubt is right: see the sizes that are drawn.
        let is_expected_doubt = |found: &&str| self.unit.0 == "inch" && *found == "unit_doubtful";
        let found: Vec<&str> =
            human.source.diagnostics.iter().map(label).filter(|found| !is_expected_doubt(found)).collect();
        let found = [&found[..], human.unfit.as_ref().map(Unfit::code).as_slice()].concat();
        let expected: &[&str] = match self.change {
            Change::TPoseFirst => &["first_pose_cut"],
            Change::BlendsOut(_) | Change::Calibrated([_, 0.0]) => &["first T-pose"],
            Change::Calibrated(_) => &["first T-pose", "last T-pose"],
            Change::LeftHanded if self.names.states_sides() => &["sides_exchanged"],
            Change::WrongFrameTime(_) => &["inhuman_gait"],
            // Short paths and curved ones may end as high as they began.
            Change::Sloping(slope) if slope.abs() > 0.1 && self.is_long_walk() => &["slope"],
            Change::Sloping(_) => return Ok(()),
            _ => &[],
        };
        (found == expected).then_some(()).ok_or_else(|| format!("{found:?}, not {expected:?}"))
    }

    /// Checks that hips, knees, ankles, shoulders, elbows and wrists are found, each on its side.
    fn check_roles(&self, text: &str, rig: &Rig) -> Result<(), String> {
        let clip = bvh::read(Path::new("zoo.bvh"), text.as_bytes()).map_err(|error| error.to_string())?;
        let roles = find_roles(&clip, &[None; JOINT_COUNT]).map_err(|reason| reason.to_string())?;
        let depth_first = depth_first(rig);
        let source: Vec<usize> = (0..clip.joints.len()).filter(|&joint| !clip.joints[joint].is_end).collect();
        let joint_of = |bone: usize| source[depth_first.iter().position(|&other| other == bone).unwrap()];
        let wanted = [
            (Joint::LeftThigh, rig.legs[0][0]),
            (Joint::LeftShank, rig.legs[0][1]),
            (Joint::LeftFoot, rig.legs[0][2]),
            (Joint::RightThigh, rig.legs[1][0]),
            (Joint::RightFoot, rig.legs[1][2]),
            (Joint::LeftUpperArm, rig.arms[0][0]),
            (Joint::LeftForearm, rig.arms[0][1]),
            (Joint::LeftHand, rig.arms[0][2]),
            (Joint::RightUpperArm, rig.arms[1][0]),
            (Joint::RightHand, rig.arms[1][2]),
        ];
        let near = 0.01 * self.file.units_per_m;
        for (role, bone) in wanted {
            let found = roles.required(role);
            if (clip.position(0, found) - clip.position(0, joint_of(bone))).length() > near {
                return Err(format!("{role:?} is `{}`, not `{}`", clip.joints[found].name, rig.bones[bone].name));
            }
        }
        Ok(())
    }
}

fn depth_first(rig: &Rig) -> Vec<usize> {
    fn visit(rig: &Rig, bone: usize, order: &mut Vec<usize>) {
        order.push(bone);
        for child in (0..rig.bones.len()).filter(|&child| rig.bones[child].parent == Some(bone)) {
            visit(rig, child, order);
        }
    }
    let mut order = Vec::new();
    visit(rig, 0, &mut order);
    order
}

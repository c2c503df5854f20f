//! Parameters of clips that others measured: the `index.csv` of a folder of clips, row by row.
//!
//! A row holds a clip's (v_f, ω_t, ω_s) as an independent script measured them (m/s, °/s, m/s), its up axis and its
//! unit. For clips that walk in place it holds `implied_*`, the speed at which their stance feet slide back. Tolerances
//! are max(3 %, 0.03 m/s), max(3 °/s, 15°/duration: clips of less than two strides sway with the gait), 0.04 m/s, and
//! three times that in place. Clips under a second are not judged.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::{fs, io};

use motiondb::motion::SourceRecord;
use motiondb_compiler::retarget::HumanClip;

/// Least duration of a clip that is judged, s.
const JUDGED_FROM_S: f64 = 1.0;
/// Greatest difference of a unit, as a share of it.
const UNIT_TOLERANCE: f64 = 1e-5;

/// The recordings that make the paper's 19 examples (`FbCrowd` §6; Shapiro 2011).
const MARINE: [&str; 12] = [
    "Idle01",
    "Jog01",
    "Meander01",
    "Run01",
    "RunCircleRt01",
    "RunTightCircleRt01",
    "StrafeFastRt01",
    "StrafeSlowRt01",
    "Turn360Rt01",
    "Walk01",
    "WalkCircleRt01",
    "WalkTightCircleRt01",
];

/// Measured parameters of one clip of human locomotion.
#[derive(Clone, Debug)]
pub struct GroundTruth {
    /// File, relative to the folder.
    pub file: String,
    /// Name of the clip within the file; empty where the file holds one.
    pub clip: String,
    /// Duration, s.
    pub duration_s: f64,
    /// Up axis of the file, `+X` … `-Z`.
    pub up_axis: String,
    /// Metres per unit of the file.
    pub metres_per_unit: f64,
    /// (v_f, ω_t, ω_s) of the root, m/s, °/s, m/s.
    pub measured: [f64; 3],
    /// (v_f, ω_t, ω_s) of a clip that walks in place, m/s, °/s, m/s.
    pub implied: [f64; 3],
}

/// An imported clip against its measured parameters.
#[derive(Clone, Debug)]
pub struct Judgement {
    /// (v_f, ω_t, ω_s) of the import, m/s, °/s, m/s.
    pub found: [f64; 3],
    /// Measured (v_f, ω_t, ω_s), m/s, °/s, m/s.
    pub wanted: [f64; 3],
    /// Tolerances of (v_f, ω_t, ω_s), m/s, °/s, m/s.
    pub tolerances: [f64; 3],
    /// Whether the clip is long enough.
    pub is_judged: bool,
    /// Whether up axis and unit are right.
    pub units_hold: bool,
}

impl Judgement {
    /// Greatest difference, divided by its tolerance.
    pub fn excess(&self) -> f64 {
        (0..3).map(|k| (self.found[k] - self.wanted[k]).abs() / self.tolerances[k]).fold(0.0, f64::max)
    }

    /// Whether every difference is within its tolerance.
    pub fn holds(&self) -> bool {
        self.excess() <= 1.0
    }
}

impl GroundTruth {
    /// Compares an imported clip with these parameters.
    pub fn judge(&self, human: &HumanClip) -> Judgement {
        let SourceRecord { speed_mps, turn_rate_rad_s, strafe_mps, .. } = human.source;
        let found = [speed_mps, turn_rate_rad_s.to_degrees(), strafe_mps].map(f64::from);
        let is_in_place = human.in_place_mps.is_some();
        let wanted = if is_in_place { self.implied } else { self.measured };
        let wider = if is_in_place { 3.0 } else { 1.0 };
        let tolerances = [f64::max(0.03 * wanted[0].abs(), 0.03), f64::max(3.0, 15.0 / self.duration_s), 0.04];
        Judgement {
            found,
            wanted,
            tolerances: tolerances.map(|tolerance| wider * tolerance),
            is_judged: self.duration_s >= JUDGED_FROM_S,
            units_hold: human.source.up_axis == self.up_axis
                && (f64::from(human.source.metres_per_unit) / self.metres_per_unit - 1.0).abs() < UNIT_TOLERANCE,
        }
    }
}

/// The paper's own clips in a folder of clips.
pub fn marine_files(mocap: &Path) -> Vec<PathBuf> {
    MARINE.iter().map(|name| mocap.join(format!("smartbody_converted/ChrMarine_{name}.bvh"))).collect()
}

/// All rows of human locomotion in a folder's `index.csv`.
///
/// # Errors
/// If the file cannot be read, or lacks a column.
pub fn read(folder: &Path) -> io::Result<Vec<GroundTruth>> {
    let path = folder.join("index.csv");
    let text = fs::read_to_string(&path)?;
    let mut lines = text.lines().map(fields);
    let header = lines.next().unwrap_or_default();
    let rows = lines.map(|fields| header.iter().cloned().zip(fields).collect::<IndexRow>());
    let human = rows.filter(|row| row.get("locomotion").is_some_and(|value| value == "yes"));
    human.map(|row| ground_truth(&row)).collect()
}

/// Values of a row by column.
type IndexRow = BTreeMap<String, String>;

fn ground_truth(row: &IndexRow) -> io::Result<GroundTruth> {
    let text = |column: &str| {
        let missing = || io::Error::other(format!("index.csv has no column `{column}` in a row of locomotion"));
        row.get(column).cloned().ok_or_else(missing)
    };
    // A clip that does not walk in place has no implied speed.
    let number = |column: &str| Ok::<f64, io::Error>(text(column)?.parse().unwrap_or(0.0));
    let turn_deg_s = number("turn_degps")?;
    Ok(GroundTruth {
        file: text("file")?,
        clip: text("clip")?,
        duration_s: number("duration_s")?,
        up_axis: text("up")?,
        metres_per_unit: number("m_per_unit")?,
        measured: [number("v_fwd_mps")?, turn_deg_s, number("v_left_mps")?],
        implied: [number("implied_fwd_mps")?, turn_deg_s, number("implied_left_mps")?],
    })
}

/// The fields of one line; commas within quotes separate nothing.
fn fields(line: &str) -> Vec<String> {
    let (mut fields, mut is_quoted) = (vec![String::new()], false);
    for letter in line.chars() {
        match (letter, fields.last_mut()) {
            ('"', _) => is_quoted = !is_quoted,
            (',', _) if !is_quoted => fields.push(String::new()),
            (letter, Some(field)) => field.push(letter),
            (_, None) => {}
        }
    }
    fields
}

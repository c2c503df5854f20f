//! Bundled clips with made-up hands.
//!
//! The clips face z, x is to the left, y up, the arms straight out: a left finger points along x, and curls about −z.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use motiondb::body::Side;

const CLIPS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets/clips");

/// A joint that is added to a clip.
pub(crate) struct Bone {
    pub(crate) name: String,
    pub(crate) offset_cm: [f64; 3],
    /// Axis about which it turns.
    pub(crate) axis: char,
    /// Rotation at a time, degrees.
    pub(crate) turn_deg: Box<dyn Fn(f64) -> f64>,
    pub(crate) children: Vec<Bone>,
}

impl Bone {
    fn write_joint(&self, out: &mut String) {
        let [x, y, z] = self.offset_cm;
        write!(out, "JOINT {}\n{{\nOFFSET {x} {y} {z}\nCHANNELS 1 {}rotation\n", self.name, self.axis).unwrap();
        self.children.iter().for_each(|child| child.write_joint(out));
        if self.children.is_empty() {
            write!(out, "End Site\n{{\nOFFSET {x} {y} {z}\n}}\n").unwrap();
        }
        out.push_str("}\n");
    }

    fn write_values(&self, time_s: f64, out: &mut String) {
        write!(out, " {:.4}", (self.turn_deg)(time_s)).unwrap();
        self.children.iter().for_each(|child| child.write_values(time_s, out));
    }
}

/// The text of a bundled clip.
pub(crate) fn bundled(name: &str) -> String {
    fs::read_to_string(Path::new(CLIPS).join(format!("{name}.bvh"))).unwrap()
}

/// The text of a bundled clip whose hands, `[left, right]`, have these joints.
pub(crate) fn text_with_hands(name: &str, hands: &[Vec<Bone>; 2]) -> String {
    let mut text = bundled(name);
    for (hand, bones) in ["JOINT LeftHand", "JOINT RightHand"].into_iter().zip(hands) {
        if !bones.is_empty() {
            let end = text.find(hand).unwrap() + text[text.find(hand).unwrap()..].find("End Site").unwrap();
            let after = end + text[end..].find('}').unwrap() + 1;
            text.replace_range(end..after, "");
            text = with_joints(&text, end, bones);
        }
    }
    text
}

/// A BVH text with further joints at a position of its hierarchy.
pub(crate) fn with_joints(text: &str, position: usize, bones: &[Bone]) -> String {
    let (before, after) = text.split_at(position);
    let counts = before.lines().filter_map(|line| line.trim().strip_prefix("CHANNELS "));
    let channels: usize = counts.map(|rest| rest.split(' ').next().unwrap().parse::<usize>().unwrap()).sum();
    let mut joints = String::new();
    bones.iter().for_each(|bone| bone.write_joint(&mut joints));
    let (skeleton, motion) = after.split_once("Frame Time: ").unwrap();
    let (frame_time_s, rows) = motion.split_once('\n').unwrap();
    let row = |(frame, row): (usize, &str)| {
        let values: Vec<&str> = row.split_whitespace().collect();
        let mut added = String::new();
        let time_s = frame as f64 * frame_time_s.trim().parse::<f64>().unwrap();
        bones.iter().for_each(|bone| bone.write_values(time_s, &mut added));
        format!("{}{added} {}\n", values[..channels].join(" "), values[channels..].join(" "))
    };
    let rows: String = rows.lines().enumerate().map(row).collect();
    format!("{before}{joints}{skeleton}Frame Time: {frame_time_s}\n{rows}")
}

/// Words of the fingers.
pub(crate) const FINGERS: [&str; 5] = ["Thumb", "Index", "Middle", "Ring", "Pinky"];

/// The five fingers of a hand; each joint curls by an angle, degrees, of the finger and the time.
pub(crate) fn fingers(side: Side, curl_deg: fn(usize, f64) -> f64) -> Vec<Bone> {
    let (sign, word) = (f64::from(side.sign()), ["Left", "Right"][side.index()]);
    let finger = |finger: usize| {
        let bone = |joint: usize, children: Vec<Bone>| Bone {
            name: format!("{word}Hand{}{}", FINGERS[finger], joint + 1),
            offset_cm: match (finger, joint) {
                (0, 0) => [sign * 3.0, -1.0, 3.0],
                (0, _) => [sign * 2.5, 0.0, 2.5],
                (_, 0) => [sign * 9.0, 0.0, 5.0 - 2.0 * finger as f64],
                _ => [sign * 3.5, 0.0, 0.0],
            },
            axis: 'Z',
            turn_deg: Box::new(move |time_s| -sign * curl_deg(finger, time_s)),
            children,
        };
        bone(0, vec![bone(1, vec![bone(2, Vec::new())])])
    };
    (0..5).map(finger).collect()
}

/// The fingers of both hands.
pub(crate) fn both(curl_deg: fn(usize, f64) -> f64) -> [Vec<Bone>; 2] {
    Side::BOTH.map(|side| fingers(side, curl_deg))
}

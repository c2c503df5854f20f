//! Bodies that do not stand on two legs: each is refused by name, unless names tell its two legs.

use motiondb_compiler::character::CharacterReason;

use crate::figure::{ADULT, Bone, Figure};
use crate::support::{compiled, reason};

/// The adult's trunk, head and arms: the hips and all joints above.
const ABOVE_HIPS: usize = 13;

fn leaked(name: String) -> &'static str {
    name.leak()
}

/// Appends a leg of three joints below a joint: side 1 or −1, hip, knee and foot.
fn push_leg(bones: &mut Vec<Bone>, parent: usize, name: &str, points_m: [[f32; 3]; 3]) {
    for (index, point_m) in points_m.into_iter().enumerate() {
        let parent = if index == 0 { parent } else { bones.len() - 1 };
        bones.push((leaked(format!("{name}_{index}")), Some(parent), point_m));
    }
}

/// A body with so many pairs of legs around it. Their names hold a word.
fn spider(pairs: usize, word: &str) -> Figure {
    let mut bones: Vec<Bone> = vec![
        ("Root", None, [0.0, 0.4, 0.0]),
        ("Thorax", Some(0), [0.0, 0.45, 0.1]),
        ("Head", Some(1), [0.0, 0.5, 0.35]),
        ("Abdomen", Some(0), [0.0, 0.5, -0.4]),
    ];
    for pair in 0..pairs {
        let ahead_m = pair as f32 - 0.5 * (pairs - 1) as f32;
        for (side, name) in [(1.0, "L"), (-1.0, "R")] {
            let hip_m = [side * 0.12, 0.4, 0.12 * ahead_m];
            let knee_m = [side * 0.45, 0.65, 0.3 * ahead_m];
            let foot_m = [side * 0.8, 0.03, 0.5 * ahead_m];
            push_leg(&mut bones, 1, &format!("{word}{pair}.{name}"), [hip_m, knee_m, foot_m]);
        }
    }
    Figure::of(&bones)
}

/// A horse's body below the trunk of a human.
fn centaur(words: [&str; 2]) -> Figure {
    let mut bones = ADULT[..ABOVE_HIPS].to_vec();
    bones.push(("HorseSpine", Some(0), [0.0, 0.95, -0.5]));
    bones.push(("HorseHips", Some(13), [0.0, 0.95, -1.0]));
    for (side, name) in [(1.0, "L"), (-1.0, "R")] {
        for (parent, word, at_m) in [(0, words[0], 0.0), (14, words[1], -1.0)] {
            let point = |height_m: f32, ahead_m: f32| [side * 0.12, height_m, at_m + ahead_m];
            push_leg(
                &mut bones,
                parent,
                &format!("{word}.{name}"),
                [point(0.9, 0.0), point(0.48, 0.03), point(0.08, 0.0)],
            );
        }
    }
    Figure::of(&bones)
}

#[track_caller]
fn check_many_legs(figure: &Figure) {
    let found = reason(&figure.glb());
    let is_refused = matches!(found, CharacterReason::ManyLegs { .. } | CharacterReason::FourLegs { .. });
    assert!(is_refused, "{}: {found}", figure.bones.last().unwrap().0);
}

#[test]
fn spiders_are_refused_with_any_number_of_legs() {
    for pairs in 2..=5 {
        for word in ["Leg", "Bone", "Arm"] {
            check_many_legs(&spider(pairs, word));
        }
    }
}

#[test]
fn centaurs_are_refused() {
    for words in [["FrontLeg", "BackLeg"], ["Foreleg", "Hindleg"], ["Bone1", "Bone2"], ["UpLeg", "Hind"]] {
        check_many_legs(&centaur(words));
    }
}

#[test]
fn bodies_without_legs_are_refused() {
    let mut wheeled = ADULT[..ABOVE_HIPS].to_vec();
    for (name, point_m) in [("Wheel.L", [0.2, 0.15, 0.0]), ("Wheel.R", [-0.2, 0.15, 0.0])] {
        wheeled.push((name, Some(0), point_m));
    }
    let mut snake: Vec<Bone> = vec![("Root", None, [0.0, 0.1, 0.0])];
    for index in 1..20 {
        snake.push((leaked(format!("Spine{index}")), Some(index - 1), [0.0, 0.1, 0.15 * index as f32]));
    }
    let mut mermaid = ADULT[..ABOVE_HIPS].to_vec();
    for index in 0..6 {
        let parent = if index == 0 { 0 } else { mermaid.len() - 1 };
        mermaid.push((leaked(format!("Tail{index}")), Some(parent), [0.0, 0.8 - 0.15 * index as f32, 0.0]));
    }
    for bones in [wheeled, snake, mermaid] {
        let found = reason(&Figure::of(&bones).glb());
        let is_refused = matches!(found, CharacterReason::NoLegs | CharacterReason::NoArms { .. });
        assert!(is_refused, "{found}");
    }
}

#[test]
fn skirts_plaits_and_hanging_arms_are_no_legs() {
    let mut figure = Figure::adult();
    for (side, name) in [(1.0, "L"), (-1.0, "R")] {
        for (ring, ahead_m) in [0.15_f32, 0.0, -0.15].into_iter().enumerate() {
            let across_m = side * (0.1 + 0.5 * (0.15 - ahead_m.abs()));
            let point = |height_m: f32, share: f32| [share * across_m, height_m, share * ahead_m];
            let points_m = [point(0.93, 1.0), point(0.5, 1.4), point(0.1, 2.0)];
            push_leg(&mut figure.bones, 0, &format!("Skirt{ring}.{name}"), points_m);
        }
        let plait_m = [[side * 0.1, 1.6, -0.1], [side * 0.25, 0.9, -0.2], [side * 0.35, 0.1, -0.3]];
        push_leg(&mut figure.bones, 4, &format!("Plait.{name}"), plait_m);
    }
    for (first, side) in [(6, 1.0), (10, -1.0)] {
        for (joint, height_m) in [(first, 1.43), (first + 1, 1.15), (first + 2, 0.9)] {
            figure.bones[joint].2 = [side * 0.2, height_m, 0.0];
        }
    }
    compiled(&figure.glb());
}

//! Made-up creatures that are not walking humans: every joint swings a little, and the body moves along z. Centimetres,
//! Y up.

use std::fmt::Write as _;

/// Name, parent, offset at rest.
pub(crate) type Joint = (String, usize, [f64; 3]);

pub(crate) struct Creature {
    pub(crate) name: &'static str,
    pub(crate) joints: Vec<Joint>,
}

impl Creature {
    fn new(name: &'static str, height: f64) -> Self {
        Self { name, joints: vec![("Hips".to_owned(), 0, [0.0, height, 0.0])] }
    }

    fn add(&mut self, name: &str, parent: usize, offset: [f64; 3]) -> usize {
        self.joints.push((name.to_owned(), parent, offset));
        self.joints.len() - 1
    }

    fn chain(&mut self, name: &str, parent: usize, offsets: &[[f64; 3]]) -> usize {
        let mut tail = parent;
        for (index, offset) in offsets.iter().enumerate() {
            tail = self.add(&format!("{name}{index}"), tail, *offset);
        }
        tail
    }

    fn both(&mut self, name: &str, parent: usize, offsets: &[[f64; 3]]) {
        let mirrored: Vec<[f64; 3]> = offsets.iter().map(|[x, y, z]| [-x, *y, *z]).collect();
        self.chain(&format!("Left{name}"), parent, offsets);
        self.chain(&format!("Right{name}"), parent, &mirrored);
    }

    /// Two seconds of motion as BVH.
    pub(crate) fn text(&self) -> String {
        let mut text = String::from("HIERARCHY\n");
        self.hierarchy(&mut text, 0);
        text.push_str("MOTION\nFrames: 60\nFrame Time: 0.0333333\n");
        for frame in 0..60 {
            let _ = write!(text, "0 {} {}", self.joints[0].2[1], 3.0 * f64::from(frame));
            self.numbers(&mut text, 0, frame);
            text.push('\n');
        }
        text
    }

    fn children(&self, joint: usize) -> impl Iterator<Item = usize> {
        (1..self.joints.len()).filter(move |&child| self.joints[child].1 == joint)
    }

    fn hierarchy(&self, text: &mut String, joint: usize) {
        let (name, _, [x, y, z]) = &self.joints[joint];
        let (keyword, channels) = match joint {
            0 => ("ROOT", "6 Xposition Yposition Zposition"),
            _ => ("JOINT", "3"),
        };
        let _ = writeln!(text, "{keyword} {name}\n{{\nOFFSET {x} {y} {z}");
        let _ = writeln!(text, "CHANNELS {channels} Zrotation Xrotation Yrotation");
        self.children(joint).for_each(|child| self.hierarchy(text, child));
        text.push_str("}\n");
    }

    fn numbers(&self, text: &mut String, joint: usize, frame: i32) {
        let phase = f64::from(frame) * 0.2 + 2.4 * joint as f64;
        let swing = if joint == 0 { 0.0 } else { 12.0 * libm::sin(phase) };
        let _ = write!(text, " 0 {swing:.4} 0");
        self.children(joint).for_each(|child| self.numbers(text, child, frame));
    }
}

/// All creatures.
pub(crate) fn all() -> Vec<Creature> {
    vec![dog(), crawler(), swimmer(), spider(), snake(), cart(), hand(), face(), upper_body(), legs_alone()]
}

fn dog() -> Creature {
    let mut dog = Creature::new("dog", 55.0);
    let chest = dog.chain("Spine", 0, &[[0.0, 3.0, 15.0], [0.0, 0.0, 20.0], [0.0, 0.0, 15.0]]);
    dog.chain("Neck", chest, &[[0.0, 10.0, 12.0], [0.0, 8.0, 10.0]]);
    dog.both("Arm", chest, &[[8.0, -2.0, 5.0], [0.0, -18.0, -4.0], [0.0, -18.0, 2.0], [0.0, -15.0, 0.0]]);
    dog.both("Leg", 0, &[[8.0, 0.0, 0.0], [0.0, -20.0, 4.0], [0.0, -18.0, -8.0], [0.0, -15.0, 2.0]]);
    dog.chain("Tail", 0, &[[0.0, 0.0, -10.0], [0.0, -5.0, -12.0]]);
    dog
}

/// A human on hands and knees.
fn crawler() -> Creature {
    let mut human = Creature::new("crawler", 48.0);
    let chest = human.chain("Spine", 0, &[[0.0, 0.0, 12.0], [0.0, 0.0, 15.0], [0.0, 0.0, 15.0]]);
    human.chain("Neck", chest, &[[0.0, 4.0, 18.0], [0.0, 6.0, 10.0], [0.0, 5.0, 15.0]]);
    human.both("Arm", chest, &[[17.0, 0.0, 12.0], [0.0, -28.0, 0.0], [0.0, -25.0, 0.0], [0.0, 0.0, 10.0]]);
    human.both("Leg", 0, &[[9.0, 0.0, 0.0], [0.0, -42.0, 0.0], [0.0, 0.0, -42.0], [0.0, -8.0, -10.0]]);
    human
}

/// A human stretched out along the path.
fn swimmer() -> Creature {
    let mut human = Creature::new("swimmer", 20.0);
    let chest = human.chain("Spine", 0, &[[0.0, 0.0, 12.0], [0.0, 0.0, 15.0], [0.0, 0.0, 15.0]]);
    human.chain("Neck", chest, &[[0.0, 0.0, 18.0], [0.0, 0.0, 10.0], [0.0, 0.0, 15.0]]);
    human.both("Arm", chest, &[[17.0, 0.0, 12.0], [10.0, 0.0, -26.0], [0.0, 0.0, -25.0]]);
    human.both("Leg", 0, &[[9.0, 0.0, 0.0], [0.0, 0.0, -42.0], [0.0, 0.0, -42.0], [0.0, -10.0, -8.0]]);
    human
}

fn spider() -> Creature {
    let mut spider = Creature::new("spider", 30.0);
    for pair in 0..4 {
        let z = 20.0 - 13.0 * f64::from(pair);
        let legs = [[8.0, 0.0, z / 2.0], [25.0, 20.0, z], [25.0, -15.0, z], [15.0, -35.0, 0.0]];
        spider.both(&format!("Leg{pair}_"), 0, &legs);
    }
    spider
}

fn snake() -> Creature {
    let mut snake = Creature::new("snake", 3.0);
    snake.chain("Spine", 0, &[[0.0, 0.0, 10.0]; 20]);
    snake
}

fn cart() -> Creature {
    let mut cart = Creature::new("cart", 60.0);
    cart.both("WheelFront", 0, &[[70.0, -30.0, 120.0]]);
    cart.both("WheelBack", 0, &[[70.0, -30.0, -120.0]]);
    cart.chain("Body", 0, &[[0.0, 60.0, 0.0], [0.0, 40.0, 0.0]]);
    cart
}

fn hand() -> Creature {
    let mut hand = Creature::new("hand", 100.0);
    for finger in 0..5 {
        let x = 2.0 * f64::from(finger) - 4.0;
        hand.chain(&format!("Finger{finger}_"), 0, &[[x, 0.0, 9.0], [0.0, 0.0, 4.0], [0.0, 0.0, 3.0], [0.0, 0.0, 2.0]]);
    }
    hand
}

fn face() -> Creature {
    let mut face = Creature::new("face", 160.0);
    for (name, y) in [("Brow", 8.0), ("Lid", 6.0), ("Cheek", 2.0), ("Lip", -2.0), ("Jaw", -5.0)] {
        face.both(name, 0, &[[1.0, y, 8.0], [1.5, 0.2, -0.2], [1.5, -0.3, -0.5], [1.0, -0.5, -0.6]]);
    }
    face
}

fn upper_body() -> Creature {
    let mut human = Creature::new("upper body", 95.0);
    let chest = human.chain("Spine", 0, &[[0.0, 12.0, 0.0], [0.0, 15.0, 0.0], [0.0, 15.0, 0.0]]);
    human.chain("Neck", chest, &[[0.0, 18.0, 0.0], [0.0, 10.0, 0.0], [0.0, 15.0, 0.0]]);
    for (side, sign) in [("Left", 1.0), ("Right", -1.0)] {
        let arm = [[17.0 * sign, 12.0, 0.0], [28.0 * sign, 0.0, 0.0], [25.0 * sign, 0.0, 0.0]];
        let wrist = human.chain(&format!("{side}Arm"), chest, &arm);
        for finger in 0..5 {
            let finger_m =
                [[8.0 * sign, 0.0, 4.0 - 2.0 * f64::from(finger)], [3.0 * sign, 0.0, 0.0], [3.0 * sign, 0.0, 0.0]];
            human.chain(&format!("{side}Finger{finger}_"), wrist, &finger_m);
        }
    }
    human
}

fn legs_alone() -> Creature {
    let mut human = Creature::new("legs alone", 95.0);
    human.both("Leg", 0, &[[9.0, 0.0, 0.0], [0.0, -42.0, 0.0], [0.0, -42.0, 0.0], [0.0, -8.0, 13.0]]);
    human
}

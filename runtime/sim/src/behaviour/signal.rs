//! A signal that is green and red in turn: a traffic light, or the opening hours of a door. Seconds.

use serde::{Deserialize, Serialize};

/// A signal; its first green phase begins at `offset_s`, and the cycle also runs before it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Signal {
    /// Name of the signal.
    pub name: String,
    /// Duration of the green phase, s.
    pub green_s: f32,
    /// Duration of the red phase, s.
    pub red_s: f32,
    /// Time at which a green phase begins, s.
    pub offset_s: f32,
}

impl Signal {
    /// Whether the signal is green at a time.
    pub fn is_green(&self, time_s: f64) -> bool {
        let [green_s, red_s, offset_s] = [self.green_s, self.red_s, self.offset_s].map(f64::from);
        (time_s - offset_s).rem_euclid(green_s + red_s) < green_s
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn phases_take_turns() {
        let signal = Signal { name: "crossing".into(), green_s: 20.0, red_s: 40.0, offset_s: 10.0 };
        let green = [0.0, 9.9, 10.0, 29.9, 30.0, 69.9, 70.0].map(|time_s| signal.is_green(time_s));
        assert_eq!(green, [false, false, true, true, false, false, true]);
    }
}

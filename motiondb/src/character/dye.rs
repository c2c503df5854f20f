//! What changes the colours of a character that is worn: a turn of the hue, or a colour that shows a quantity.

use glam::Vec3;

/// Share of light of a black surface that shows a colour; of a white one it is 1.
const DARKEST: f32 = 0.22;
/// Share of a shown colour on what keeps its hue: skin, eyes, hair.
const ON_SKIN: f32 = 0.55;
/// Luminance of linear Rec. 709.
const LUMINANCE: Vec3 = Vec3::new(0.2126, 0.7152, 0.0722);

/// What changes the colours of a character.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Dye {
    /// Turn of the hue of clothes; none where it stays.
    hue: Option<HueTurn>,
    /// A colour that replaces hues while light and dark stay, linear Rec. 709.
    shown: Option<Vec3>,
}

/// A turn of hues about the grey axis (1, 1, 1), Rodrigues' formula.
#[derive(Clone, Copy, Debug, PartialEq)]
struct HueTurn {
    sin: f32,
    cos: f32,
}

impl Dye {
    /// A dye that turns the hue of clothes by a share of the full circle, or shows a colour, linear Rec. 709, instead.
    pub fn new(hue_turn: f32, shown: Option<Vec3>) -> Self {
        Self { hue: (hue_turn != 0.0).then(|| HueTurn::new(hue_turn)), shown }
    }

    /// A dyed colour, linear Rec. 709. `keeps_hue` marks skin, eyes and hair.
    #[inline]
    pub fn applied(&self, colour: Vec3, keeps_hue: bool) -> Vec3 {
        if let Some(shown) = self.shown {
            // As light and dark look: the root of luminance.
            let light = DARKEST + (1.0 - DARKEST) * colour.dot(LUMINANCE).max(0.0).sqrt();
            return colour.lerp(light * shown, if keeps_hue { ON_SKIN } else { 1.0 });
        }
        match self.hue.filter(|_| !keeps_hue) {
            Some(hue) => hue.applied(colour),
            None => colour,
        }
    }
}

impl HueTurn {
    /// A turn by a share of the full circle.
    fn new(turn: f32) -> Self {
        let (sin, cos) = libm::sincosf(turn * std::f32::consts::TAU);
        Self { sin, cos }
    }

    /// A linear colour with its hue turned; its grey stays. The result is in [0, 1].
    fn applied(self, colour: Vec3) -> Vec3 {
        const ROOT_THIRD: f32 = 0.577_350_26;
        let Self { sin, cos } = self;
        let [red, green, blue] = colour.to_array();
        let grey = (1.0 - cos) * (red + green + blue) / 3.0;
        let turned = |own: f32, before: f32, after: f32| cos * own + sin * ROOT_THIRD * (before - after) + grey;
        Vec3::from(
            [turned(red, blue, green), turned(green, red, blue), turned(blue, green, red)]
                .map(|part| part.clamp(0.0, 1.0)),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shown_colour_keeps_light_and_dark() {
        let dye = Dye::new(0.3, Some(Vec3::new(0.8, 0.1, 0.1)));
        let [dark, light] = [0.05, 0.9].map(|grey| dye.applied(Vec3::splat(grey), false));
        assert!(dark.x < 0.6 * light.x && light.x < 0.8, "{dark} {light}");
        assert!([dark, light].iter().all(|colour| (colour.x / colour.y - 8.0).abs() < 1e-3), "{dark} {light}");
        let skin = dye.applied(Vec3::new(0.6, 0.4, 0.3), true);
        assert!(skin.y > dye.applied(Vec3::new(0.6, 0.4, 0.3), false).y);
    }

    #[test]
    fn without_a_dye_colours_stay() {
        let colour = Vec3::new(0.3, 0.6, 0.2);
        assert_eq!(Dye::default().applied(colour, false), colour);
        assert_eq!(Dye::new(0.4, None).applied(colour, true), colour);
    }

    #[test]
    fn a_whole_turn_leaves_the_colour() {
        let colour = Vec3::new(0.6, 0.2, 0.1);
        assert!((Dye::new(1.0, None).applied(colour, false) - colour).abs().max_element() < 1e-6);
        // A third of a turn: red becomes green.
        let green = Dye::new(1.0 / 3.0, None).applied(Vec3::new(0.9, 0.0, 0.0), false);
        assert!(green.y > 0.89 && green.x < 0.01);
    }
}

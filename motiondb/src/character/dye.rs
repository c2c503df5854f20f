//! What changes the colours of a character that is worn: a turn of the hue, or a colour that shows a quantity.

use glam::Vec3;

use crate::character::choice::with_turned_hue;

/// Share of light of a black surface that shows a colour; of a white one it is 1.
const DARKEST: f32 = 0.22;
/// Share of a shown colour on what keeps its hue: skin, eyes, hair.
const ON_SKIN: f32 = 0.55;
/// Luminance of linear Rec. 709.
const LUMINANCE: Vec3 = Vec3::new(0.2126, 0.7152, 0.0722);

/// What changes the colours of a character.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Dye {
    /// Turn of the hue of clothes, as a share of the full circle.
    pub hue_turn: f32,
    /// A colour that replaces hues while light and dark stay, linear Rec. 709.
    pub shown: Option<Vec3>,
}

impl Dye {
    /// A dyed colour, linear Rec. 709. `keeps_hue` marks skin, eyes and hair.
    pub fn applied(&self, colour: Vec3, keeps_hue: bool) -> Vec3 {
        if let Some(shown) = self.shown {
            // As light and dark look: the root of luminance.
            let light = DARKEST + (1.0 - DARKEST) * colour.dot(LUMINANCE).max(0.0).sqrt();
            return colour.lerp(light * shown, if keeps_hue { ON_SKIN } else { 1.0 });
        }
        match self.hue_turn != 0.0 && !keeps_hue {
            true => with_turned_hue(colour.to_array(), self.hue_turn).into(),
            false => colour,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shown_colour_keeps_light_and_dark() {
        let dye = Dye { hue_turn: 0.3, shown: Some(Vec3::new(0.8, 0.1, 0.1)) };
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
        assert_eq!(Dye { hue_turn: 0.4, shown: None }.applied(colour, true), colour);
    }
}

//! How an agent is dressed and combed: drawn from its id, so that it stays when agents are added.

use fbcrowd_sim::maths::SplitMix64;
use glam::Vec3;

use crate::raster::palette::{Look, Rgb, SHOE, decode_srgb};

/// Stream of the generator of styles.
const STREAM: u64 = 0x7374_796c;

/// Build of a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Sex {
    Male,
    Female,
}

/// A way to wear hair.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum HairStyle {
    Short,
    Full,
    Receding,
    Bob,
    Long,
    Bun,
}

impl HairStyle {
    pub(crate) const ALL: [Self; 6] = [Self::Short, Self::Full, Self::Receding, Self::Bob, Self::Long, Self::Bun];
}

/// What the surface of a vertex is made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub(crate) enum Cloth {
    Shirt,
    /// Below the elbow: the shirt's where sleeves are long.
    Sleeve,
    Collar,
    Trousers,
    Skin,
    Lips,
    Hair,
    Shoe,
    Sole,
    Eye,
}

/// Number of kinds of [`Cloth`].
pub(crate) const CLOTHS: usize = 10;

/// Style of an agent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Style {
    pub(crate) sex: Sex,
    pub(crate) hair: HairStyle,
    has_long_sleeves: bool,
    shoe: Rgb,
}

/// Colours of shoes.
const SHOES: [Rgb; 4] = [SHOE, Rgb::new(0.36, 0.25, 0.18), Rgb::new(0.78, 0.76, 0.73), Rgb::new(0.20, 0.22, 0.30)];

impl Style {
    /// The style of an agent, by its id.
    pub(crate) fn of(agent: u32) -> Self {
        let mut random = SplitMix64::new(STREAM, agent.into());
        let mut below = |count: usize| (random.unit() * count as f64) as usize;
        let sex = if below(2) == 0 { Sex::Male } else { Sex::Female };
        let styles = match sex {
            Sex::Male => [HairStyle::Short, HairStyle::Short, HairStyle::Full, HairStyle::Receding],
            Sex::Female => [HairStyle::Bob, HairStyle::Long, HairStyle::Long, HairStyle::Bun],
        };
        let shoes = if sex == Sex::Male { 4 } else { 3 };
        Self { sex, hair: styles[below(4)], has_long_sleeves: below(5) < 3, shoe: SHOES[below(shoes)] }
    }

    /// Linear colours of the kinds of cloth.
    pub(crate) fn colours(&self, look: &Look) -> [Vec3; CLOTHS] {
        let linear = |rgb: Rgb| rgb.map(decode_srgb).clamp(Vec3::ZERO, Vec3::ONE);
        // Fabric reflects less than paint.
        let (shirt, skin) = (0.82 * linear(look.shirt), 0.92 * linear(look.skin));
        let sleeve = if self.has_long_sleeves { shirt } else { skin };
        let lips = skin * Vec3::new(0.78, 0.55, 0.53);
        let shoe = linear(self.shoe);
        let sole = if self.shoe == SHOES[2] { 0.8 * shoe } else { 0.35 * shoe };
        let trousers = 0.8 * linear(look.trousers);
        [shirt, sleeve, 0.8 * shirt, trousers, skin, lips, linear(look.hair), shoe, sole, Vec3::splat(0.02)]
    }
}

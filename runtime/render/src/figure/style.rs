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

/// Age of a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Age {
    Child,
    Adult,
    Elder,
}

/// What is worn on the legs, and over the hips.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Clothes {
    Trousers,
    Shorts,
    /// A skirt in the colour of trousers.
    Skirt,
    /// Skirt and shirt of one colour.
    Dress,
    /// A coat in the colour of the shirt, over trousers.
    Coat,
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
    /// The legs below the knee: the trousers' where they are long.
    Shank,
    /// A skirt, or the lower part of a coat.
    Skirt,
    Skin,
    Lips,
    Hair,
    Shoe,
    Sole,
    Eye,
}

/// Number of kinds of [`Cloth`].
pub(crate) const CLOTHS: usize = 12;

/// Size relative to the crowd's body below which an agent is a child: 1.5 m of 1.775 m.
const CHILD_STATURE: f32 = 0.85;
/// Height of a head of a body of no size, relative to an adult's: heads grow less than bodies. A child of 1.07 m has nine
/// tenths of an adult's head.
const LEAST_HEAD: f32 = 0.72;
/// Hair of elders, sRGB-encoded.
const GREY: Rgb = Rgb::new(0.74, 0.73, 0.71);

/// Hair of children whose own colour would be grey, sRGB-encoded.
const BROWN: Rgb = Rgb::new(0.340, 0.235, 0.165);

/// Style of an agent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Style {
    pub(crate) sex: Sex,
    pub(crate) age: Age,
    pub(crate) hair: HairStyle,
    pub(crate) clothes: Clothes,
    pub(crate) has_long_sleeves: bool,
    shoe: Rgb,
    /// Share of grey in the hair.
    grey: f32,
}

/// Colours of shoes.
const SHOES: [Rgb; 4] = [SHOE, Rgb::new(0.36, 0.25, 0.18), Rgb::new(0.78, 0.76, 0.73), Rgb::new(0.20, 0.22, 0.30)];

/// Size of a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct BodySize {
    /// Relative to the crowd's body.
    pub(crate) stature: f32,
    /// Relative to the size of bodies of its age.
    pub(crate) deviation: f32,
}

/// Share of men among people whose size deviates from the usual one by a factor: of two normal distributions whose means
/// are 8.4 % apart and whose deviations are 4.2 %, as in the United States (Fryar et al. 2021, *Vital Health Stat.*
/// 3(46)).
fn male_share(deviation: f32) -> f64 {
    1.0 / (1.0 + libm::exp(-0.084 / (0.042 * 0.042) * f64::from(deviation - 1.0)))
}

impl Style {
    /// The style of an agent, by its id and its size.
    pub(crate) fn of(agent: u32, BodySize { stature, deviation }: BodySize) -> Self {
        let mut random = SplitMix64::new(STREAM, agent.into());
        let sex = if random.unit() < male_share(deviation) { Sex::Male } else { Sex::Female };
        let mut below = |count: usize| (random.unit() * count as f64) as usize;
        let (hair, is_bare, shoe) = (below(4), below(5) >= 3, below(if sex == Sex::Male { 4 } else { 3 }));
        let (aged, dressed, grey) = (below(7), below(10), below(3));
        let age = match stature < CHILD_STATURE {
            true => Age::Child,
            false if aged == 0 => Age::Elder,
            false => Age::Adult,
        };
        let clothes = clothes(sex, age, dressed);
        Self {
            sex,
            age,
            hair: hair_styles(sex, age)[hair],
            clothes,
            has_long_sleeves: !is_bare || clothes == Clothes::Coat,
            shoe: SHOES[shoe],
            grey: if age == Age::Elder { 0.55 + 0.2 * grey as f32 } else { 0.0 },
        }
    }

    /// The sex whose build the body has: children have one.
    pub(crate) fn build(&self) -> Sex {
        if self.age == Age::Child { Sex::Male } else { self.sex }
    }

    /// Size of the head relative to the body's, of a body of a size.
    pub(crate) fn head(&self, stature: f32) -> f32 {
        if self.age == Age::Child { (LEAST_HEAD + (1.0 - LEAST_HEAD) * stature) / stature.max(0.3) } else { 1.0 }
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
        let shank = if self.has_bare_legs() { skin } else { trousers };
        let skirt = match self.clothes {
            Clothes::Dress | Clothes::Coat => 0.94 * shirt,
            Clothes::Skirt | Clothes::Shorts | Clothes::Trousers => trousers,
        };
        let trousers = if self.clothes == Clothes::Dress { skirt } else { trousers };
        let is_grey = look.hair.max_element() - look.hair.min_element() < 0.06 && look.hair.x > 0.4;
        let own = if self.age == Age::Child && is_grey { BROWN } else { look.hair };
        let hair = linear(own.lerp(GREY, self.grey));
        [shirt, sleeve, 0.8 * shirt, trousers, shank, skirt, skin, lips, hair, shoe, sole, Vec3::splat(0.02)]
    }

    /// Whether the legs are bare below the knee.
    pub(crate) fn has_bare_legs(&self) -> bool {
        matches!(self.clothes, Clothes::Shorts | Clothes::Skirt | Clothes::Dress)
    }

    /// Whether cloth hangs around the thighs.
    pub(crate) fn has_skirt(&self) -> bool {
        matches!(self.clothes, Clothes::Skirt | Clothes::Dress | Clothes::Coat)
    }
}

fn hair_styles(sex: Sex, age: Age) -> [HairStyle; 4] {
    match (sex, age) {
        (Sex::Male, Age::Child) => [HairStyle::Short, HairStyle::Short, HairStyle::Full, HairStyle::Full],
        (Sex::Male, Age::Adult) => [HairStyle::Short, HairStyle::Short, HairStyle::Full, HairStyle::Receding],
        (Sex::Male, Age::Elder) => [HairStyle::Short, HairStyle::Receding, HairStyle::Receding, HairStyle::Receding],
        (Sex::Female, Age::Elder) => [HairStyle::Bob, HairStyle::Bun, HairStyle::Bob, HairStyle::Bun],
        (Sex::Female, _) => [HairStyle::Bob, HairStyle::Long, HairStyle::Long, HairStyle::Bun],
    }
}

/// Clothes by a number below 10.
fn clothes(sex: Sex, age: Age, drawn: usize) -> Clothes {
    match (sex, age, drawn) {
        (Sex::Female, _, 0 | 1) => Clothes::Skirt,
        (Sex::Female, _, 2) | (Sex::Female, Age::Child, 3) => Clothes::Dress,
        (_, Age::Child, 4..=6) | (_, Age::Adult, 8) => Clothes::Shorts,
        (_, Age::Adult | Age::Elder, 9) | (_, Age::Elder, 7) => Clothes::Coat,
        _ => Clothes::Trousers,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn style(agent: u32, stature: f32) -> Style {
        Style::of(agent, BodySize { stature, deviation: 1.0 })
    }

    #[test]
    fn a_crowd_has_all_ages_and_clothes() {
        let styles: Vec<Style> = (0..400).map(|agent| style(agent, 1.0)).collect();
        let share = |holds: &dyn Fn(&Style) -> bool| styles.iter().filter(|style| holds(style)).count() as f32 / 400.0;
        assert!((0.1..0.2).contains(&share(&|style| style.age == Age::Elder)));
        assert!((0.1..0.35).contains(&share(&Style::has_skirt)));
        assert!(share(&|style| style.clothes == Clothes::Shorts) > 0.05);
        assert!(!styles.iter().any(|style| style.age == Age::Child));
        assert!((0..400).all(|agent| style(agent, 0.7).age == Age::Child));
        // A child keeps its sex.
        assert!((0..400).all(|agent| style(agent, 0.7).sex == styles[agent as usize].sex));
    }

    #[test]
    fn most_tall_adults_are_men() {
        let is_male = |agent: &u32, deviation| Style::of(*agent, BodySize { stature: 1.1, deviation }).sex == Sex::Male;
        let males = |deviation: f32| (0..400).filter(|agent| is_male(agent, deviation)).count();
        assert!(males(0.93) < 40 && males(1.07) > 360, "{} {}", males(0.93), males(1.07));
        assert!((170..230).contains(&males(1.0)), "{}", males(1.0));
    }

    #[test]
    fn heads_grow_less_than_bodies() {
        let child = style(1, 0.6);
        assert!((0.85..0.95).contains(&(0.6 * child.head(0.6))), "{}", child.head(0.6));
        assert_eq!(style(1, 1.0).head(1.0), 1.0);
    }
}

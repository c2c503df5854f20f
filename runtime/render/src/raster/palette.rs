//! Colours: one hue an agent, evenly spread to the eye, and neutrals for all that is not an agent.
//!
//! Colours are sRGB-encoded, 0 to 1. Hues are chosen in `OKLCh` (Ottosson 2020, "A perceptual color space for image
//! processing"), where equal lightness looks equally light, so that no agent shouts.

use std::f32::consts::TAU;

use glam::{Mat3, Vec3};

/// sRGB-encoded red, green, blue, 0 to 1.
pub type Rgb = Vec3;

/// Ground: a warm light grey, on which both light and dark clothes stand out.
pub(crate) const GROUND: Rgb = Rgb::new(0.925, 0.918, 0.902);
/// Lines every metre.
pub(crate) const GRID_FINE: Rgb = Rgb::new(0.885, 0.876, 0.857);
/// Lines every five metres.
pub(crate) const GRID_COARSE: Rgb = Rgb::new(0.828, 0.816, 0.793);
/// Tops of obstacles.
pub(crate) const OBSTACLE: Rgb = Rgb::new(0.690, 0.678, 0.655);
/// Rims of obstacles.
pub(crate) const OBSTACLE_RIM: Rgb = Rgb::new(0.470, 0.458, 0.440);
/// Shade: bluish, as shade under an open sky is.
pub(crate) const SHADE: Rgb = Rgb::new(0.165, 0.175, 0.240);
/// Writing and axes.
pub(crate) const INK: Rgb = Rgb::new(0.200, 0.196, 0.190);
/// Shoes.
pub(crate) const SHOE: Rgb = Rgb::new(0.215, 0.205, 0.205);
/// Plot paper.
pub(crate) const PAPER: Rgb = Rgb::new(0.992, 0.990, 0.985);
/// Left and right of a body: green and violet, as port and starboard would have it.
pub(crate) const SIDES: [Rgb; 2] = [Rgb::new(0.13, 0.55, 0.30), Rgb::new(0.52, 0.27, 0.68)];

/// Measures from good to bad, light enough for marks in ink to stand on.
const HEAT: [Rgb; 3] = [Rgb::new(0.62, 0.82, 0.66), Rgb::new(0.98, 0.90, 0.60), Rgb::new(0.86, 0.36, 0.22)];

/// Skin and hair that go together, light to dark; hair is muted, so that no head competes with the clothes.
const SKIN_AND_HAIR: [[Rgb; 2]; 9] = [
    [Rgb::new(0.945, 0.800, 0.690), Rgb::new(0.500, 0.375, 0.245)],
    [Rgb::new(0.945, 0.800, 0.690), Rgb::new(0.340, 0.235, 0.165)],
    [Rgb::new(0.920, 0.765, 0.650), Rgb::new(0.225, 0.165, 0.130)],
    [Rgb::new(0.882, 0.706, 0.576), Rgb::new(0.140, 0.120, 0.115)],
    [Rgb::new(0.882, 0.706, 0.576), Rgb::new(0.340, 0.235, 0.165)],
    [Rgb::new(0.900, 0.740, 0.620), Rgb::new(0.560, 0.545, 0.525)],
    [Rgb::new(0.760, 0.570, 0.435), Rgb::new(0.175, 0.140, 0.125)],
    [Rgb::new(0.620, 0.445, 0.335), Rgb::new(0.140, 0.120, 0.115)],
    [Rgb::new(0.480, 0.335, 0.255), Rgb::new(0.115, 0.100, 0.100)],
];
/// The golden angle as a share of a turn: any number of consecutive indices spreads evenly, neighbours lie far apart.
const GOLDEN_SHARE: f32 = 0.381_966;
/// Hue of agent 0: a blue.
const FIRST_HUE_SHARE: f32 = 0.70;
/// Lightness of consecutive agents: a second cue where hues come close.
const LIGHTNESS: [f32; 3] = [0.66, 0.74, 0.58];
/// Chroma of clothes; reduced where sRGB has no such colour.
const CHROMA: f32 = 0.145;

/// What one agent wears and is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Look {
    /// The agent's colour: shirt, trail, goal.
    pub shirt: Rgb,
    /// The same hue, darker and duller.
    pub trousers: Rgb,
    /// Hands, forearms, face.
    pub skin: Rgb,
    /// Hair.
    pub hair: Rgb,
}

/// The look of an agent by its index.
pub(crate) fn look(agent: usize) -> Look {
    let hue_rad = agent_hue_rad(agent);
    let lightness = LIGHTNESS[agent % LIGHTNESS.len()];
    let [skin, hair] = SKIN_AND_HAIR[scramble(agent as u32) as usize % SKIN_AND_HAIR.len()];
    Look {
        shirt: oklch(lightness, CHROMA, hue_rad),
        trousers: oklch(0.62 * lightness, 0.35 * CHROMA, hue_rad),
        skin,
        hair,
    }
}

/// The colour of one of a series in a plot: the agents' colours, darker, to stand on white as lines.
pub(crate) fn line_colour(index: usize) -> Rgb {
    oklch(LIGHTNESS[index % LIGHTNESS.len()] - 0.06, CHROMA, agent_hue_rad(index))
}

fn agent_hue_rad(agent: usize) -> f32 {
    let turns = FIRST_HUE_SHARE + GOLDEN_SHARE * agent as f32;
    TAU * (turns - libm::floorf(turns))
}

/// A measure's colour at a share from 0, good, to 1, bad: pale green over pale yellow to orange red.
pub(crate) fn heat(share: f32) -> Rgb {
    let share = 2.0 * share.clamp(0.0, 1.0);
    if share < 1.0 { HEAT[0].lerp(HEAT[1], share) } else { HEAT[1].lerp(HEAT[2], share - 1.0) }
}

/// A fixed, well-mixed number for each index (the finaliser of `MurmurHash3`).
fn scramble(index: u32) -> u32 {
    let mut hash = index.wrapping_add(0x9e37_79b9);
    hash = (hash ^ (hash >> 16)).wrapping_mul(0x85eb_ca6b);
    hash = (hash ^ (hash >> 13)).wrapping_mul(0xc2b2_ae35);
    hash ^ (hash >> 16)
}

/// `OKLCh` to sRGB, with the greatest chroma up to the one asked for that sRGB can show.
pub(crate) fn oklch(lightness: f32, chroma: f32, hue_rad: f32) -> Rgb {
    let (sin, cos) = libm::sincosf(hue_rad);
    let linear_at = |chroma: f32| oklab_to_linear(Vec3::new(lightness, chroma * cos, chroma * sin));
    let in_gamut = |linear: &Vec3| linear.min_element() >= 0.0 && linear.max_element() <= 1.0;
    let linear = (0..=20)
        .map(|step| linear_at(chroma * (1.0 - step as f32 / 20.0)))
        .find(in_gamut)
        .unwrap_or_else(|| linear_at(0.0).clamp(Vec3::ZERO, Vec3::ONE));
    linear.map(encode_srgb)
}

/// Ottosson's matrices, from OKLab to linear sRGB.
fn oklab_to_linear(lab: Vec3) -> Vec3 {
    let to_cone_roots = Mat3::from_cols_array_2d(&[
        [1.0, 1.0, 1.0],
        [0.396_337_78, -0.105_561_346, -0.089_484_18],
        [0.215_803_76, -0.063_854_17, -1.291_485_5],
    ]);
    let to_linear = Mat3::from_cols_array_2d(&[
        [4.076_741_7, -1.268_438, -0.004_196_086_3],
        [-3.307_711_6, 2.609_757_4, -0.703_418_6],
        [0.230_969_94, -0.341_319_4, 1.707_614_7],
    ]);
    let roots = to_cone_roots * lab;
    to_linear * (roots * roots * roots)
}

/// The transfer function of sRGB (IEC 61966-2-1), linear light to code value.
pub(crate) fn encode_srgb(linear: f32) -> f32 {
    if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * libm::powf(linear, 1.0 / 2.4) - 0.055 }
}

/// Its inverse, code value to linear light.
pub fn decode_srgb(code: f32) -> f32 {
    if code <= 0.040_45 { code / 12.92 } else { libm::powf((code + 0.055) / 1.055, 2.4) }
}

/// Eight-bit code values.
pub(crate) fn to_bytes(colour: Rgb) -> [u8; 3] {
    (colour.clamp(Vec3::ZERO, Vec3::ONE) * 255.0 + 0.5).to_array().map(|value| value as u8)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn transfer_function_and_its_inverse_meet() {
        for step in 0..=1000 {
            let value = step as f32 / 1000.0;
            assert!((encode_srgb(decode_srgb(value)) - value).abs() < 1e-5);
        }
    }

    #[test]
    fn white_and_grey_have_no_hue() {
        assert!((oklch(1.0, 0.0, 0.0) - Vec3::ONE).abs().max_element() < 1e-3);
        let grey = oklch(0.6, 0.0, 1.0);
        assert!((grey.x - grey.y).abs() < 1e-3 && (grey.y - grey.z).abs() < 1e-3);
    }

    #[test]
    fn seventeen_agents_have_clearly_different_colours() {
        let shirts: Vec<Rgb> = (0..17).map(|agent| look(agent).shirt).collect();
        for (index, one) in shirts.iter().enumerate() {
            for other in &shirts[..index] {
                assert!((*one - *other).length() > 0.08, "{one} {other}");
            }
        }
    }
}

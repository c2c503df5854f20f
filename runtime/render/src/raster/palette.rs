//! Colours: one hue per agent, spread evenly for the eye, and neutral colours for everything else.
//!
//! Colours are sRGB-encoded, 0 to 1. Hues are chosen in `OKLCh` (Ottosson 2020, "A perceptual color space for image
//! processing"), where equal lightness looks equally light: no agent stands out.

use std::f32::consts::TAU;

use glam::{Mat3, Vec3};

/// sRGB-encoded red, green, blue, 0 to 1.
pub(crate) type Rgb = Vec3;

/// Ground: a warm light grey that contrasts with light and dark clothes.
pub(crate) const GROUND: Rgb = Rgb::new(0.925, 0.918, 0.902);
/// Fine grid lines.
pub(crate) const GRID_FINE: Rgb = Rgb::new(0.885, 0.876, 0.857);
/// Coarse grid lines.
pub(crate) const GRID_COARSE: Rgb = Rgb::new(0.828, 0.816, 0.793);
/// Ground that is not walkable: asphalt, or the mass of a building.
pub(crate) const OUTSIDE: Rgb = Rgb::new(0.674, 0.671, 0.671);
/// A signal that is red, and one that is green.
pub(crate) const SIGNAL: [Rgb; 2] = [Rgb::new(0.82, 0.20, 0.16), Rgb::new(0.16, 0.66, 0.32)];
/// Tops of obstacles.
pub(crate) const OBSTACLE: Rgb = Rgb::new(0.690, 0.678, 0.655);
/// Rims of obstacles.
pub(crate) const OBSTACLE_RIM: Rgb = Rgb::new(0.470, 0.458, 0.440);
/// Shade: bluish, as under an open sky.
pub(crate) const SHADE: Rgb = Rgb::new(0.165, 0.175, 0.240);
/// Text and axes.
pub(crate) const INK: Rgb = Rgb::new(0.200, 0.196, 0.190);
/// Shoes.
pub(crate) const SHOE: Rgb = Rgb::new(0.215, 0.205, 0.205);
/// Paper of plots.
pub(crate) const PAPER: Rgb = Rgb::new(0.992, 0.990, 0.985);
/// Left and right side of a body: green and violet.
pub(crate) const SIDES: [Rgb; 2] = [Rgb::new(0.13, 0.55, 0.30), Rgb::new(0.52, 0.27, 0.68)];
/// Turning set: a blue.
pub(crate) const TURNING_SET: Rgb = Rgb::new(0.16, 0.40, 0.72);
/// Holding set: an ochre.
pub(crate) const HOLDING_SET: Rgb = Rgb::new(0.78, 0.52, 0.10);
/// Sharp-turn edges: a red, as in the paper.
pub(crate) const SHARP_TURN_EDGES: Rgb = Rgb::new(0.80, 0.16, 0.16);

/// Levels of service A to F, from free to jammed: blue, cyan, green, yellow, orange, red, as pedestrian programs show
/// Fruin's levels.
pub(crate) const LEVELS_OF_SERVICE: [Rgb; 6] = [
    Rgb::new(0.27, 0.47, 0.84),
    Rgb::new(0.36, 0.76, 0.84),
    Rgb::new(0.42, 0.74, 0.38),
    Rgb::new(0.95, 0.85, 0.32),
    Rgb::new(0.95, 0.60, 0.22),
    Rgb::new(0.84, 0.25, 0.20),
];

/// Heat scale from good to bad, light enough for dark marks on it.
const HEAT: [Rgb; 3] = [Rgb::new(0.62, 0.82, 0.66), Rgb::new(0.98, 0.90, 0.60), Rgb::new(0.86, 0.36, 0.22)];

/// Matching skin and hair, light to dark. Hair is muted, so that clothes dominate.
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
/// Hue step between agents, share of a turn: the golden angle. Any number of agents spreads evenly, neighbours are far
/// apart.
const GOLDEN_SHARE: f32 = 0.381_966;
/// Hue of agent 0, share of a turn: a blue.
const FIRST_HUE_SHARE: f32 = 0.70;
/// Lightness of consecutive agents: distinguishes agents with similar hues.
const LIGHTNESS: [f32; 3] = [0.66, 0.74, 0.58];
/// Chroma of clothes; reduced for colours outside sRGB.
const CHROMA: f32 = 0.145;

/// Colours of one agent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Look {
    /// Colour of the agent: shirt, trail, goal.
    pub(crate) shirt: Rgb,
    /// Colour of the trousers: the shirt's hue, darker and duller.
    pub(crate) trousers: Rgb,
    /// Colour of hands, forearms and face.
    pub(crate) skin: Rgb,
    /// Colour of the hair.
    pub(crate) hair: Rgb,
}

/// Colours of an agent, by its index.
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

/// Colour of a series in a plot, by its index: the agent's colour, darker, for lines on paper.
pub(crate) fn line_colour(index: usize) -> Rgb {
    oklch(LIGHTNESS[index % LIGHTNESS.len()] - 0.06, CHROMA, agent_hue_rad(index))
}

fn agent_hue_rad(agent: usize) -> f32 {
    let turns = FIRST_HUE_SHARE + GOLDEN_SHARE * agent as f32;
    TAU * (turns - libm::floorf(turns))
}

/// Colour of the heat scale at a share from 0 (good, pale green) over pale yellow to 1 (bad, orange red).
pub(crate) fn heat(share: f32) -> Rgb {
    let share = 2.0 * share.clamp(0.0, 1.0);
    if share < 1.0 { HEAT[0].lerp(HEAT[1], share) } else { HEAT[1].lerp(HEAT[2], share - 1.0) }
}

/// A well-mixed hash of an index (the finaliser of `MurmurHash3`).
fn scramble(index: u32) -> u32 {
    let mut hash = index.wrapping_add(0x9e37_79b9);
    hash = (hash ^ (hash >> 16)).wrapping_mul(0x85eb_ca6b);
    hash = (hash ^ (hash >> 13)).wrapping_mul(0xc2b2_ae35);
    hash ^ (hash >> 16)
}

/// `OKLCh` to sRGB; the chroma is reduced until sRGB can show the colour.
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

/// OKLab to linear sRGB, by Ottosson's matrices.
fn oklab_to_linear(lab: Vec3) -> Vec3 {
    let to_roots = Mat3::from_cols_array_2d(&[
        [1.0, 1.0, 1.0],
        [0.396_337_78, -0.105_561_346, -0.089_484_18],
        [0.215_803_76, -0.063_854_17, -1.291_485_5],
    ]);
    let to_linear = Mat3::from_cols_array_2d(&[
        [4.076_741_7, -1.268_438, -0.004_196_086_3],
        [-3.307_711_6, 2.609_757_4, -0.703_418_6],
        [0.230_969_94, -0.341_319_4, 1.707_614_7],
    ]);
    let roots = to_roots * lab;
    to_linear * (roots * roots * roots)
}

/// Transfer function of sRGB (IEC 61966-2-1): linear light to code value, both 0 to 1.
pub(crate) fn encode_srgb(linear: f32) -> f32 {
    if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * libm::powf(linear, 1.0 / 2.4) - 0.055 }
}

/// Inverse transfer function of sRGB (IEC 61966-2-1): code value to linear light, both 0 to 1.
pub fn decode_srgb(code: f32) -> f32 {
    if code <= 0.040_45 { code / 12.92 } else { libm::powf((code + 0.055) / 1.055, 2.4) }
}

/// The colour of eight-bit code values.
pub(crate) fn from_bytes(bytes: [u8; 3]) -> Rgb {
    Rgb::from_array(bytes.map(|byte| f32::from(byte) / 255.0))
}

/// Eight-bit code values of a colour.
pub(crate) fn to_bytes(colour: Rgb) -> [u8; 3] {
    (colour.clamp(Vec3::ZERO, Vec3::ONE) * 255.0 + 0.5).to_array().map(|value| value as u8)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_inverse_transfer_function_inverts() {
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
    fn seventeen_agents_have_different_colours() {
        let shirts: Vec<Rgb> = (0..17).map(|agent| look(agent).shirt).collect();
        for (index, one) in shirts.iter().enumerate() {
            for other in &shirts[..index] {
                assert!((*one - *other).length() > 0.08, "{one} {other}");
            }
        }
    }
}

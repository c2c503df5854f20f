//! One agent and frame in 200 bytes, before compression.
//!
//! | bytes | field |
//! |---|---|
//! | 12 | root x, y, facing: f32 |
//! | 16 | v_pref, v planned: f32 each |
//! | 16 | phase, strafing time, stepping-back time, examples' slide: f32 |
//! | 4 | contacts left, right: u16, in 1/65535 |
//! | 3 | time to landing: the upper 24 bits of an f32 that has lost its sign (1/131,072 of it a step) |
//! | 1 | bit 0 velocity set, bits 1–7 mode |
//! | 9 | pelvis x, y, z: 24 bits each over ±4 m (0.48 µm a step) |
//! | 139 | rotations, smallest three: 18 bits a component for pelvis, thighs, shanks and feet (7 bytes), 15 for the others (6 bytes) |
//!
//! Little-endian throughout. A smallest-three component is off by at most δ = 2^−b/√2 (b bits), the rotation by at most
//! 2√12·δ: 0.15 mrad at 15 bits, 0.02 mrad at 18. The pelvis and the chain down to the sole are packed finer than the
//! other joints because their steps add up to foot slide: at 15 bits and a 16-bit pelvis a held sole jitters by 0.5
//! cm/s at 120 frames a second, so packed by less than 0.1 cm/s.

use glam::{Quat, Vec2, Vec3};
use motiondb::body::{JOINT_COUNT, Joint, Pose, Root};

use crate::planning::plan::VelocitySet;
use crate::recording::frame::AgentFrame;
use crate::synthesis::Mode;

/// Bytes of one agent in one frame before compression.
pub const PACKED_BYTES: usize = 11 * 4 + 2 * 2 + 3 + 1 + 3 * 3 + FINE_JOINTS * 7 + (JOINT_COUNT - FINE_JOINTS) * 6;

/// Pelvis, thighs, shanks, feet.
const FINE_JOINTS: usize = 7;
const FINE_BITS: u32 = 18;
const COARSE_BITS: u32 = 15;
/// The pelvis stays well within this of its root along every axis, m.
const PELVIS_RANGE_M: f32 = 4.0;
const PELVIS_STEPS: f32 = 8_388_607.0;
const CONTACT_STEPS: f32 = 65_535.0;
/// No metre, second, radian or velocity of a scenario comes near; the largest are the 86,400 s of a day.
const SCALAR_MAX: f32 = 1e5;

/// Appends [`PACKED_BYTES`] bytes; none where a value is not finite, or beyond all scenarios.
pub(crate) fn pack(frame: &AgentFrame, bytes: &mut Vec<u8>) -> Option<()> {
    let scalars = scalars(frame);
    let finite = scalars.iter().all(|value| value.abs() <= SCALAR_MAX)
        && frame.contacts.iter().all(|contact| contact.is_finite())
        && (0.0..=SCALAR_MAX).contains(&frame.time_to_landing_s)
        && frame.pose.pelvis_m.is_finite()
        && frame.pose.rotations.iter().all(|rotation| rotation.is_finite());
    if !finite {
        return None;
    }
    scalars.iter().for_each(|value| bytes.extend(value.to_le_bytes()));
    for contact in frame.contacts {
        bytes.extend(((contact * CONTACT_STEPS).round() as u16).to_le_bytes());
    }
    // Half a step is added, so that what is cut off rounds.
    let landing = (frame.time_to_landing_s.to_bits() << 1) + 0x80;
    bytes.extend(&landing.to_le_bytes()[1..]);
    bytes.push(frame.set as u8 | (frame.mode as u8) << 1);
    for metres in frame.pose.pelvis_m.to_array() {
        let steps = (metres / PELVIS_RANGE_M * PELVIS_STEPS).round().clamp(-PELVIS_STEPS, PELVIS_STEPS) as i32;
        bytes.extend(&steps.to_le_bytes()[..3]);
    }
    for (joint, rotation) in Joint::ALL.into_iter().zip(frame.pose.rotations) {
        let bits = component_bits(joint);
        bytes.extend(&pack_rotation(rotation, bits).to_le_bytes()[..packed_rotation_bytes(bits)]);
    }
    Some(())
}

/// The inverse of `pack`; says what is wrong where the bytes are no frame.
///
/// # Errors
/// Bytes run out, a value is not finite or beyond all scenarios, or a mode is unknown.
pub fn unpack(bytes: &[u8]) -> Result<AgentFrame, &'static str> {
    let rest = &mut &*bytes;
    let root = Root { position_m: take_vec2(rest)?, facing_rad: take_f32(rest)? };
    let (preferred_mps, planned_mps) = (take_vec2(rest)?, take_vec2(rest)?);
    let (phase, strafing_s) = (take_f32(rest)?, take_f32(rest)?);
    let (stepping_back_s, examples_slide_cm_s) = (take_f32(rest)?, take_f32(rest)?);
    let contacts = [take_contact(rest)?, take_contact(rest)?];
    let time_to_landing_s = take_duration(rest)?;
    let [flags] = take(rest)?;
    let pose = Pose {
        pelvis_m: Vec3::new(take_metres(rest)?, take_metres(rest)?, take_metres(rest)?),
        rotations: unpack_rotations(rest)?,
    };
    Ok(AgentFrame {
        root,
        preferred_mps,
        planned_mps,
        phase,
        mode: unpack_mode(flags >> 1)?,
        contacts,
        time_to_landing_s,
        set: if flags & 1 == 0 { VelocitySet::Turning } else { VelocitySet::Holding },
        strafing_s,
        stepping_back_s,
        examples_slide_cm_s,
        pose,
    })
}

fn scalars(frame: &AgentFrame) -> [f32; 11] {
    [
        frame.root.position_m.x,
        frame.root.position_m.y,
        frame.root.facing_rad,
        frame.preferred_mps.x,
        frame.preferred_mps.y,
        frame.planned_mps.x,
        frame.planned_mps.y,
        frame.phase,
        frame.strafing_s,
        frame.stepping_back_s,
        frame.examples_slide_cm_s,
    ]
}

/// Takes the first N bytes off.
fn take<const N: usize>(rest: &mut &[u8]) -> Result<[u8; N], &'static str> {
    let (first, others) = rest.split_first_chunk().ok_or("the frame is too short")?;
    *rest = others;
    Ok(*first)
}

fn take_f32(rest: &mut &[u8]) -> Result<f32, &'static str> {
    let value = f32::from_le_bytes(take(rest)?);
    if value.abs() <= SCALAR_MAX { Ok(value) } else { Err("a value is not finite, or beyond all scenarios") }
}

fn take_vec2(rest: &mut &[u8]) -> Result<Vec2, &'static str> {
    Ok(Vec2::new(take_f32(rest)?, take_f32(rest)?))
}

fn take_contact(rest: &mut &[u8]) -> Result<f32, &'static str> {
    Ok(f32::from(u16::from_le_bytes(take(rest)?)) / CONTACT_STEPS)
}

/// Seconds, not negative.
fn take_duration(rest: &mut &[u8]) -> Result<f32, &'static str> {
    let [low, middle, high] = take(rest)?;
    let value = f32::from_bits(u32::from_le_bytes([0, low, middle, high]) >> 1);
    if value <= SCALAR_MAX { Ok(value) } else { Err("a duration is not finite, or beyond all scenarios") }
}

/// Metres along one axis of the pelvis.
fn take_metres(rest: &mut &[u8]) -> Result<f32, &'static str> {
    let [low, middle, high] = take(rest)?;
    // Into the upper three bytes and back, so that the sign is kept.
    let steps = i32::from_le_bytes([0, low, middle, high]) >> 8;
    Ok(steps as f32 / PELVIS_STEPS * PELVIS_RANGE_M)
}

fn unpack_mode(code: u8) -> Result<Mode, &'static str> {
    match code {
        0 => Ok(Mode::Blending),
        1 => Ok(Mode::SemiProcedural),
        _ => Err("the mode is unknown"),
    }
}

fn unpack_rotations(rest: &mut &[u8]) -> Result<[Quat; JOINT_COUNT], &'static str> {
    let mut rotations = [Quat::IDENTITY; JOINT_COUNT];
    for (joint, rotation) in Joint::ALL.into_iter().zip(&mut rotations) {
        let bits = component_bits(joint);
        let (packed, others) = rest.split_at_checked(packed_rotation_bytes(bits)).ok_or("the frame is too short")?;
        *rest = others;
        let mut wide = [0; 8];
        wide[..packed.len()].copy_from_slice(packed);
        *rotation = unpack_rotation(u64::from_le_bytes(wide), bits);
    }
    Ok(rotations)
}

/// Bits of each of a joint's three components.
fn component_bits(joint: Joint) -> u32 {
    use Joint::{LeftFoot, LeftShank, LeftThigh, Pelvis, RightFoot, RightShank, RightThigh};
    match joint {
        Pelvis | LeftThigh | LeftShank | LeftFoot | RightThigh | RightShank | RightFoot => FINE_BITS,
        _ => COARSE_BITS,
    }
}

/// Two bits name the component that is left out.
const fn packed_rotation_bytes(bits: u32) -> usize {
    (2 + 3 * bits as usize).div_ceil(8)
}

/// Steps on either side of zero: the identity is exact.
fn component_steps(bits: u32) -> f32 {
    ((1_u32 << (bits - 1)) - 1) as f32
}

/// Smallest three: of q and −q the one whose largest component is positive, without that component. From the low bits:
/// its index, then the other three in order, each in steps over ±1/√2.
fn pack_rotation(rotation: Quat, bits: u32) -> u64 {
    let components = rotation.normalize().to_array();
    let largest = (1..4).fold(0, |best, i| if components[i].abs() > components[best].abs() { i } else { best });
    let scale = component_steps(bits) * std::f32::consts::SQRT_2 * components[largest].signum();
    let mut packed = largest as u64;
    let others = components.into_iter().enumerate().filter(|&(i, _)| i != largest);
    for (place, (_, component)) in others.enumerate() {
        let steps = (component * scale).round().clamp(-component_steps(bits), component_steps(bits)) as i64;
        packed |= (steps as u64 & ((1 << bits) - 1)) << (2 + place as u32 * bits);
    }
    packed
}

fn unpack_rotation(packed: u64, bits: u32) -> Quat {
    let largest = (packed & 3) as usize;
    let mut components = [0.0; 4];
    let mut squares = 0.0;
    for (place, i) in (0..4).filter(|&i| i != largest).enumerate() {
        let field = packed >> (2 + place as u32 * bits);
        // Into the top bits and back, so that the sign is kept.
        let steps = ((field << (64 - bits)) as i64 >> (64 - bits)) as f32;
        components[i] = steps / (component_steps(bits) * std::f32::consts::SQRT_2);
        squares += components[i] * components[i];
    }
    // Of a valid rotation the rest is at least ½; altered bytes may leave less than nothing.
    components[largest] = libm::sqrtf((1.0 - squares).max(0.0));
    Quat::from_array(components).normalize()
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn rotation() -> impl Strategy<Value = Quat> {
        proptest::array::uniform4(-1.0_f32..1.0)
            .prop_filter("has a direction", |components| components.iter().map(|c| c * c).sum::<f32>() > 1e-3)
            .prop_map(|components| Quat::from_array(components).normalize())
    }

    fn round_trip(frame: &AgentFrame) -> AgentFrame {
        let mut bytes = Vec::new();
        pack(frame, &mut bytes).unwrap();
        assert_eq!(bytes.len(), PACKED_BYTES);
        unpack(&bytes).unwrap()
    }

    #[test]
    fn an_agent_fits_the_budget_of_200_bytes() {
        assert_eq!(PACKED_BYTES, 200);
    }

    #[test]
    fn the_resting_body_comes_back_unchanged() {
        let frame = AgentFrame::default();
        assert_eq!(round_trip(&frame), frame);
    }

    proptest! {
        #[test]
        fn rotations_come_back_within_the_documented_bound(rotation in rotation()) {
            for (bits, bound_rad) in [(COARSE_BITS, 1.5e-4), (FINE_BITS, 2.0e-5)] {
                let back = unpack_rotation(pack_rotation(rotation, bits), bits);
                let rotation = rotation.as_dquat().normalize();
                let off = (back.as_dquat().normalize() * rotation.inverse()).xyz().length() * 2.0;
                prop_assert!(off < bound_rad, "{off} rad at {bits} bits");
            }
        }

        #[test]
        fn any_bytes_unpack_to_something_finite_or_are_refused(bytes in proptest::collection::vec(any::<u8>(), 0..400)) {
            if let Ok(frame) = unpack(&bytes) {
                prop_assert!(pack(&frame, &mut Vec::new()).is_some());
            }
        }

        #[test]
        fn scalars_come_back_exactly_landings_nearly_and_contacts_keep_their_side_of_a_half(
            values in proptest::array::uniform11(-1e4_f32..1e4), contact in 0.0_f32..1.0, landing in 0.0_f32..1e5,
        ) {
            let frame = AgentFrame {
                root: Root { position_m: Vec2::new(values[0], values[1]), facing_rad: values[2] },
                preferred_mps: Vec2::new(values[3], values[4]),
                planned_mps: Vec2::new(values[5], values[6]),
                phase: values[7],
                set: VelocitySet::Holding,
                strafing_s: values[8],
                stepping_back_s: values[9],
                examples_slide_cm_s: values[10],
                contacts: [contact, 0.5],
                time_to_landing_s: landing,
                ..AgentFrame::default()
            };
            let back = round_trip(&frame);
            prop_assert!((back.time_to_landing_s - landing).abs() <= landing / 131_072.0);
            prop_assert_eq!(AgentFrame { contacts: frame.contacts, time_to_landing_s: landing, ..back }, frame);
            prop_assert!((back.contacts[0] - contact).abs() < 1e-5 && back.contacts[1] >= 0.5);
        }
    }
}

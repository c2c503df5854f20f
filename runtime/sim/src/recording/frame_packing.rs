//! One agent in one frame in 200 bytes, before compression.
//!
//! | bytes | field |
//! |---|---|
//! | 12 | root x, y, facing: f32 |
//! | 16 | v_pref, planned velocity: f32 each |
//! | 12 | phase, strafing time, stepping-back time: f32 |
//! | 2 | examples' slide: u16, in 0.01 cm/s; of more than 655 cm/s, 655.35 |
//! | 2 | angle from v_pref to the direction of the route: i16, in π/32767 |
//! | 4 | contacts left, right: u16, in 1/65535 |
//! | 3 | time to landing: the upper 24 bits of an f32 that has lost its sign (1/131,072 of it a step) |
//! | 1 | bit 0 velocity set, bits 1–7 mode |
//! | 9 | pelvis x, y, z: 24 bits each over ±4 m (0.48 µm a step) |
//! | 139 | rotations: 7 bytes for pelvis, thighs, shanks and feet, 6 for the others (`rotation_packing`) |
//!
//! Little-endian throughout. The pelvis and the chain down to the sole are packed finer than the other joints because
//! their steps add up to foot slide: with 15 bits and a 16-bit pelvis a held sole jitters by 0.5 cm/s at 120 frames a
//! second, packed so by less than 0.1 cm/s.
//!
//! Before version 3 the slide was an f32 in the four bytes of slide and angle.

use std::f32::consts::PI;

use glam::{Quat, Vec2, Vec3};
use motiondb::body::{JOINT_COUNT, Joint, Pose, Root};

use crate::planning::plan::VelocitySet;
use crate::recording::frame::AgentFrame;
use crate::recording::rotation_packing::{
    FINE_JOINTS, component_bits, pack_rotation, packed_rotation_bytes, unpack_rotation,
};
use crate::synthesis::Mode;

/// Bytes of one agent in one frame before compression.
pub const PACKED_BYTES: usize =
    10 * 4 + 2 + 2 + 2 * 2 + 3 + 1 + 3 * 3 + FINE_JOINTS * 7 + (JOINT_COUNT - FINE_JOINTS) * 6;

/// Greatest offset of the pelvis from its root along an axis, m.
const PELVIS_RANGE_M: f32 = 4.0;
/// Steps of the pelvis on either side of zero: 24 bits.
const PELVIS_STEPS: f32 = 8_388_607.0;
/// Steps of a slide of 1 cm/s.
const SLIDE_STEPS: f32 = 100.0;
/// Steps of an angle of π: 15 bits and the sign.
const ANGLE_STEPS: f32 = 32_767.0;
/// Steps of a contact: 16 bits.
const CONTACT_STEPS: f32 = 65_535.0;
/// Greatest metre, second, radian or velocity; the largest of any scenario are the 86,400 s of a day.
pub(crate) const SCALAR_MAX: f32 = 1e5;

/// What is wrong with the bytes of an agent in a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum FrameFault {
    /// Fewer than [`PACKED_BYTES`] bytes.
    #[error("bytes are missing")]
    TooShort,
    /// A value is not finite, or beyond all scenarios.
    #[error("a value is not finite, or beyond all scenarios")]
    ValueOutOfRange,
    /// The time to landing is not finite, or beyond all scenarios.
    #[error("the time to landing is not finite, or beyond all scenarios")]
    TimeToLandingOutOfRange,
    /// The id of the agent is beyond all ids.
    #[error("the id is beyond all ids")]
    IdOutOfRange,
    /// The code of the active mode is not known.
    #[error("the synthesis mode {0} is unknown")]
    UnknownMode(u8),
}

/// Appends [`PACKED_BYTES`] bytes; none where a value is not finite, or beyond all scenarios.
pub(crate) fn pack(frame: &AgentFrame, bytes: &mut Vec<u8>) -> Option<()> {
    let scalars = scalars(frame);
    let finite = scalars.iter().all(|value| value.abs() <= SCALAR_MAX)
        && (0.0..=SCALAR_MAX).contains(&frame.examples_slide_cm_s)
        && frame.facing_offset_rad.abs() <= PI
        && frame.contacts.iter().all(|contact| contact.is_finite())
        && (0.0..=SCALAR_MAX).contains(&frame.time_to_landing_s)
        && frame.pose.pelvis_m.is_finite()
        && frame.pose.rotations.iter().all(|rotation| rotation.is_finite());
    if !finite {
        return None;
    }
    scalars.iter().for_each(|value| bytes.extend(value.to_le_bytes()));
    bytes.extend(((frame.examples_slide_cm_s * SLIDE_STEPS).round() as u16).to_le_bytes());
    bytes.extend(angle_steps(frame.facing_offset_rad).to_le_bytes());
    for contact in frame.contacts {
        bytes.extend(((contact * CONTACT_STEPS).round() as u16).to_le_bytes());
    }
    // Half a step is added, so that cutting off rounds.
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

/// The angle from v_pref to the direction of the route as a recording keeps it, rad.
pub(crate) fn recorded_offset_rad(offset_rad: f32) -> f32 {
    angle_rad(angle_steps(offset_rad))
}

fn angle_steps(angle_rad: f32) -> i16 {
    (angle_rad / PI * ANGLE_STEPS).round() as i16
}

fn angle_rad(steps: i16) -> f32 {
    f32::from(steps.max(-i16::MAX)) / ANGLE_STEPS * PI
}

/// The inverse of `pack`; id and state, which are not packed, are 0.
///
/// # Errors
/// If the bytes are not a frame of an agent.
pub fn unpack(bytes: &[u8]) -> Result<AgentFrame, FrameFault> {
    unpack_with(bytes, |rest| {
        let slide_cm_s = f32::from(u16::from_le_bytes(take(rest)?)) / SLIDE_STEPS;
        Ok([slide_cm_s, angle_rad(i16::from_le_bytes(take(rest)?))])
    })
}

/// As [`unpack`], from bytes of versions 1 and 2.
pub(crate) fn unpack_version_2(bytes: &[u8]) -> Result<AgentFrame, FrameFault> {
    unpack_with(bytes, |rest| Ok([take_f32(rest)?, 0.0]))
}

/// As [`unpack`]; `take_slide_and_offset` takes the examples' slide, cm/s, and the angle from v_pref to the direction of
/// the route, rad.
fn unpack_with(
    bytes: &[u8],
    take_slide_and_offset: impl Fn(&mut &[u8]) -> Result<[f32; 2], FrameFault>,
) -> Result<AgentFrame, FrameFault> {
    let rest = &mut &*bytes;
    let root = Root { position_m: take_vec2(rest)?, facing_rad: take_f32(rest)? };
    let (preferred_mps, planned_mps) = (take_vec2(rest)?, take_vec2(rest)?);
    let (phase, strafing_s) = (take_f32(rest)?, take_f32(rest)?);
    let stepping_back_s = take_f32(rest)?;
    let [examples_slide_cm_s, facing_offset_rad] = take_slide_and_offset(rest)?;
    let contacts = [take_contact(rest)?, take_contact(rest)?];
    let time_to_landing_s = take_time_to_landing(rest)?;
    let [flags] = take(rest)?;
    let pose = Pose {
        pelvis_m: Vec3::new(take_metres(rest)?, take_metres(rest)?, take_metres(rest)?),
        rotations: take_rotations(rest)?,
    };
    Ok(AgentFrame {
        root,
        preferred_mps,
        facing_offset_rad,
        planned_mps,
        phase,
        mode: mode(flags >> 1)?,
        contacts,
        time_to_landing_s,
        set: if flags & 1 == 0 { VelocitySet::Turning } else { VelocitySet::Holding },
        strafing_s,
        stepping_back_s,
        examples_slide_cm_s,
        pose,
        ..AgentFrame::default()
    })
}

/// The values packed as f32, in order.
fn scalars(frame: &AgentFrame) -> [f32; 10] {
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
    ]
}

/// Takes the first N bytes off.
fn take<const N: usize>(rest: &mut &[u8]) -> Result<[u8; N], FrameFault> {
    let (first, others) = rest.split_first_chunk().ok_or(FrameFault::TooShort)?;
    *rest = others;
    Ok(*first)
}

fn take_f32(rest: &mut &[u8]) -> Result<f32, FrameFault> {
    let value = f32::from_le_bytes(take(rest)?);
    if value.abs() <= SCALAR_MAX { Ok(value) } else { Err(FrameFault::ValueOutOfRange) }
}

fn take_vec2(rest: &mut &[u8]) -> Result<Vec2, FrameFault> {
    Ok(Vec2::new(take_f32(rest)?, take_f32(rest)?))
}

fn take_contact(rest: &mut &[u8]) -> Result<f32, FrameFault> {
    Ok(f32::from(u16::from_le_bytes(take(rest)?)) / CONTACT_STEPS)
}

/// Seconds, not negative.
fn take_time_to_landing(rest: &mut &[u8]) -> Result<f32, FrameFault> {
    let [low, middle, high] = take(rest)?;
    let value = f32::from_bits(u32::from_le_bytes([0, low, middle, high]) >> 1);
    if value <= SCALAR_MAX { Ok(value) } else { Err(FrameFault::TimeToLandingOutOfRange) }
}

/// Metres along one axis of the pelvis.
fn take_metres(rest: &mut &[u8]) -> Result<f32, FrameFault> {
    let [low, middle, high] = take(rest)?;
    // Into the upper three bytes and back, so that the sign is kept.
    let steps = i32::from_le_bytes([0, low, middle, high]) >> 8;
    Ok(steps as f32 / PELVIS_STEPS * PELVIS_RANGE_M)
}

fn mode(code: u8) -> Result<Mode, FrameFault> {
    match code {
        0 => Ok(Mode::Blending),
        1 => Ok(Mode::SemiProcedural),
        2 => Ok(Mode::Transition),
        _ => Err(FrameFault::UnknownMode(code)),
    }
}

fn take_rotations(rest: &mut &[u8]) -> Result<[Quat; JOINT_COUNT], FrameFault> {
    let mut rotations = [Quat::IDENTITY; JOINT_COUNT];
    for (joint, rotation) in Joint::ALL.into_iter().zip(&mut rotations) {
        let bits = component_bits(joint);
        let (packed, others) = rest.split_at_checked(packed_rotation_bytes(bits)).ok_or(FrameFault::TooShort)?;
        *rest = others;
        let mut wide = [0; 8];
        wide[..packed.len()].copy_from_slice(packed);
        *rotation = unpack_rotation(u64::from_le_bytes(wide), bits);
    }
    Ok(rotations)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn round_trip(frame: &AgentFrame) -> AgentFrame {
        unpack(&packed(frame)).unwrap()
    }

    fn packed(frame: &AgentFrame) -> Vec<u8> {
        let mut bytes = Vec::new();
        pack(frame, &mut bytes).unwrap();
        assert_eq!(bytes.len(), PACKED_BYTES);
        bytes
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

    #[test]
    fn earlier_versions_held_the_slide_alone() {
        let frame = AgentFrame { phase: 0.25, facing_offset_rad: 0.5, ..AgentFrame::default() };
        let mut bytes = packed(&frame);
        bytes[40..44].copy_from_slice(&1.25_f32.to_le_bytes());
        let expected = AgentFrame { facing_offset_rad: 0.0, examples_slide_cm_s: 1.25, ..frame };
        assert_eq!(unpack_version_2(&bytes), Ok(expected));
    }

    #[test]
    fn every_fault_has_its_name() {
        let bytes = packed(&AgentFrame::default());
        let check = |at: usize, value: &[u8], fault: FrameFault| {
            let mut bytes = bytes.clone();
            bytes[at..at + value.len()].copy_from_slice(value);
            assert_eq!(unpack(&bytes), Err(fault));
        };
        assert_eq!(unpack(&bytes[..PACKED_BYTES - 1]), Err(FrameFault::TooShort));
        check(0, &f32::NAN.to_le_bytes(), FrameFault::ValueOutOfRange);
        check(48, &[0xff; 3], FrameFault::TimeToLandingOutOfRange);
        check(51, &[6], FrameFault::UnknownMode(3));
    }

    proptest! {
        #[test]
        fn any_bytes_unpack_to_finite_or_error(bytes in proptest::collection::vec(any::<u8>(), 0..400)) {
            if let Ok(frame) = unpack(&bytes) {
                prop_assert!(pack(&frame, &mut Vec::new()).is_some());
            }
        }

        #[test]
        fn scalars_come_back_exactly_and_contacts_keep_their_side(
            values in proptest::array::uniform10(-1e4_f32..1e4),
            contact in 0.0_f32..1.0,
            landing in 0.0_f32..1e5,
            slide_cm_s in 0.0_f32..600.0,
            offset_rad in -PI..PI,
        ) {
            let frame = AgentFrame {
                root: Root { position_m: Vec2::new(values[0], values[1]), facing_rad: values[2] },
                preferred_mps: Vec2::new(values[3], values[4]),
                planned_mps: Vec2::new(values[5], values[6]),
                phase: values[7],
                set: VelocitySet::Holding,
                strafing_s: values[8],
                stepping_back_s: values[9],
                examples_slide_cm_s: slide_cm_s,
                facing_offset_rad: recorded_offset_rad(offset_rad),
                contacts: [contact, 0.5],
                time_to_landing_s: landing,
                ..AgentFrame::default()
            };
            let back = round_trip(&frame);
            prop_assert!((back.time_to_landing_s - landing).abs() <= landing / 131_072.0);
            prop_assert!((back.examples_slide_cm_s - slide_cm_s).abs() < 0.006);
            prop_assert!((back.facing_offset_rad - offset_rad).abs() < 1e-4);
            let rounded = AgentFrame {
                contacts: frame.contacts,
                time_to_landing_s: landing,
                examples_slide_cm_s: slide_cm_s,
                ..back
            };
            prop_assert_eq!(rounded, frame);
            prop_assert!((back.contacts[0] - contact).abs() < 1e-5 && back.contacts[1] >= 0.5);
        }
    }
}

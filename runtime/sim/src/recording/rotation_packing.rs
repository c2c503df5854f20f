//! Rotations in smallest-three packing: 6 or 7 bytes a joint.
//!
//! q and −q are the same rotation; the one whose largest component is positive is packed, without that component. From
//! the low bits: its index (2 bits), then the other three in order, each in steps over ±1/√2. With b bits a component
//! is off by at most δ = 2^−b/√2, the rotation by at most 2√12·δ: 0.15 mrad at 15 bits, 0.02 mrad at 18.

use glam::Quat;
use motiondb::body::Joint;

/// Joints packed finely: pelvis, thighs, shanks, feet.
pub(crate) const FINE_JOINTS: usize = 7;
/// Bits per component of a fine joint.
const FINE_BITS: u32 = 18;
/// Bits per component of the other joints.
pub(crate) const COARSE_BITS: u32 = 15;

/// Bits of each of a joint's three components.
pub(crate) fn component_bits(joint: Joint) -> u32 {
    use Joint::{LeftFoot, LeftShank, LeftThigh, Pelvis, RightFoot, RightShank, RightThigh};
    match joint {
        Pelvis | LeftThigh | LeftShank | LeftFoot | RightThigh | RightShank | RightFoot => FINE_BITS,
        _ => COARSE_BITS,
    }
}

/// Bytes of a packed rotation.
pub(crate) const fn packed_rotation_bytes(bits: u32) -> usize {
    (2 + 3 * bits as usize).div_ceil(8)
}

/// Steps on either side of zero: the identity is exact.
fn component_steps(bits: u32) -> f32 {
    ((1_u32 << (bits - 1)) - 1) as f32
}

/// Packs a rotation with some bits per component.
pub(crate) fn pack_rotation(rotation: Quat, bits: u32) -> u64 {
    let components = rotation.normalize().to_array();
    let largest = (1..4).fold(0, |best, i| if components[i].abs() > components[best].abs() { i } else { best });
    let scale = component_steps(bits) * std::f32::consts::SQRT_2 * components[largest].signum();
    let mut packed = largest as u64;
    let others = components.into_iter().enumerate().filter(|&(i, _)| i != largest);
    for (field, (_, component)) in others.enumerate() {
        let steps = (component * scale).round().clamp(-component_steps(bits), component_steps(bits)) as i64;
        packed |= (steps as u64 & ((1 << bits) - 1)) << (2 + field as u32 * bits);
    }
    packed
}

/// The inverse of [`pack_rotation`]; any bits give a rotation.
pub(crate) fn unpack_rotation(packed: u64, bits: u32) -> Quat {
    let largest = (packed & 3) as usize;
    let mut components = [0.0; 4];
    let mut squares = 0.0;
    for (field, i) in (0..4).filter(|&i| i != largest).enumerate() {
        let shifted = packed >> (2 + field as u32 * bits);
        // Into the top bits and back, so that the sign is kept.
        let steps = ((shifted << (64 - bits)) as i64 >> (64 - bits)) as f32;
        components[i] = steps / (component_steps(bits) * std::f32::consts::SQRT_2);
        squares += components[i] * components[i];
    }
    // At least ½ in a valid rotation; altered bytes may leave less than 0.
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
    }
}

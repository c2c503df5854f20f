//! Fingers, toes and twist bones of figures: found, posed, kept in files.

use std::path::Path;

use glam::{Quat, Vec2, Vec3};
use motiondb::body::{ExtraJoint, Joint, RootFrame, Side};
use motiondb::character::{Character, CharacterFit, EXTRA_VERSION, VERSION, first_fault, from_bytes, to_bytes};

use crate::figure::{ADULT, Figure, glb};
use crate::support::{compiled, joint_name, rest, skeleton};
use crate::vrm::{VRM_BONES, figure_with_table};

/// Name of the joint that is an extra joint.
fn extra_name(character: &Character, extra: ExtraJoint) -> &str {
    character.extra_joint(extra).map_or("", |joint| &character.joints[joint].name)
}

/// Positions of all joints at the skeleton's rest, with these rotations of extra joints.
fn posed_m(character: &Character, rotation: impl Fn(ExtraJoint) -> Option<Quat>) -> Vec<Vec3> {
    let (skeleton, frame) = (skeleton(), RootFrame { position_m: Vec2::ZERO, forward: Vec2::X });
    let fit = CharacterFit::new(character, &skeleton);
    let mut transforms = Vec::new();
    fit.pose(&skeleton, &rest(&skeleton).forward_kinematics(&skeleton), frame, &mut transforms);
    let stiff = transforms.clone();
    fit.pose_extra(|_| None, &mut transforms);
    assert_eq!(transforms, stiff);
    fit.pose_extra(rotation, &mut transforms);
    let at_m = |(joint, transform): (usize, &motiondb::character::JointTransform)| {
        transform.point_m(character.joints[joint].position_m)
    };
    transforms.iter().enumerate().map(at_m).collect()
}

/// Direction of the bone from one joint of a finger to the next.
fn bone(character: &Character, posed_m: &[Vec3], side: Side, finger: usize, joint: usize) -> Vec3 {
    let at_m = |joint| posed_m[character.extra_joint(ExtraJoint::finger(side, finger, joint)).unwrap()];
    (at_m(joint + 1) - at_m(joint)).normalize()
}

#[track_caller]
fn check_direction(found: Vec3, wanted: Vec3) {
    let error_deg = found.angle_between(wanted).to_degrees();
    assert!(error_deg < 0.5, "{found} is {error_deg}° off {wanted}");
}

/// Every finger joint curls by 40°, every joint of the thumb moves towards the fingers.
fn curl(joint: ExtraJoint) -> Option<Quat> {
    let angle_rad = -joint.side().sign() * 40_f32.to_radians();
    let is_thumb = joint.index() / 6 == 0;
    Some(if is_thumb { Quat::from_rotation_z(-angle_rad) } else { Quat::from_rotation_x(angle_rad) })
}

/// The palms face down: curled fingers point down, back towards the palm.
fn check_curl(character: &Character) {
    let open_m = posed_m(character, |_| Some(Quat::IDENTITY));
    let curled_m = posed_m(character, curl);
    for side in Side::BOTH {
        let out = Vec3::Y * side.sign();
        for finger in 1..5 {
            for joint in 0..2 {
                check_direction(bone(character, &open_m, side, finger, joint), out);
                let angle_rad = 40_f32.to_radians() * (joint + 1) as f32;
                let wanted = out * libm::cosf(angle_rad) - Vec3::Z * libm::sinf(angle_rad);
                check_direction(bone(character, &curled_m, side, finger, joint), wanted);
            }
        }
        // Fingers keep their lengths and their knuckles.
        for joint in 0..3 {
            let at = |joint| character.extra_joint(ExtraJoint::finger(side, 1, joint)).unwrap();
            if joint == 0 {
                assert!(open_m[at(0)].distance(curled_m[at(0)]) < 1e-5);
            } else {
                let length_m = |posed_m: &[Vec3]| posed_m[at(joint)].distance(posed_m[at(joint - 1)]);
                assert!((length_m(&open_m) - length_m(&curled_m)).abs() < 1e-5);
            }
        }
    }
}

#[test]
fn fingers_of_a_figure_are_found_and_curl() {
    let character = compiled(&Figure::adult().with_fingers().glb()).character;
    assert_eq!(character.extra.len(), 30);
    assert_eq!(extra_name(&character, ExtraJoint::finger(Side::Left, 1, 0)), "LeftHandIndex1");
    assert_eq!(extra_name(&character, ExtraJoint::finger(Side::Right, 0, 2)), "RightHandThumb3");
    check_curl(&character);
}

#[test]
fn axes_of_an_armature_do_not_matter() {
    for (armature, is_z_up) in [(0.01, false), (100.0, true)] {
        let figure = Figure { armature, is_z_up, ..Figure::adult().with_fingers() };
        check_curl(&compiled(&figure.glb()).character);
    }
}

/// Robots have bones of the palm beside the hand.
#[test]
fn fingers_may_hang_from_the_forearm() {
    let mut figure = Figure::adult().with_fingers();
    for (name, parent, _) in &mut figure.bones {
        match *name {
            "LeftHandIndex1" | "LeftHandThumb1" => *parent = Some(7),
            "RightHandPinky1" => *parent = Some(11),
            _ => {}
        }
    }
    let character = compiled(&figure.glb()).character;
    assert_eq!(character.extra.len(), 30);
    check_curl(&character);
}

#[test]
fn fingers_may_precede_their_hand() {
    let mut figure = Figure::adult().with_fingers();
    // The left hand and its thumb, which hangs from the forearm, change places.
    let (hand, thumb) = (8, 21);
    figure.bones[thumb].1 = Some(7);
    figure.bones.swap(hand, thumb);
    for (_, parent, _) in &mut figure.bones {
        *parent = match *parent {
            Some(joint) if joint == hand => Some(thumb),
            Some(joint) if joint == thumb => Some(hand),
            other => other,
        };
    }
    let character = compiled(&figure.glb()).character;
    let place = |name: &str| character.joints.iter().position(|joint| joint.name == name).unwrap();
    assert!(place("LeftHandThumb1") < place("LeftHand"));
    assert_eq!(character.extra.len(), 30);
    check_curl(&character);
}

/// Hands whose fingers are bound bent by an angle at each joint but the knuckle.
fn bound_bent(bend_deg: f32) -> Character {
    let mut figure = Figure::adult().with_fingers();
    for index in 21..figure.bones.len() {
        let (name, parent, _) = figure.bones[index];
        let joint = name.chars().last().and_then(|digit| digit.to_digit(10)).unwrap();
        if joint > 1 && !name.contains("Thumb") {
            let [x, y, z] = figure.bones[parent.unwrap()].2;
            let angle_rad = bend_deg.to_radians() * (joint - 1) as f32;
            let (along_m, down_m) = (0.03 * libm::cosf(angle_rad), 0.03 * libm::sinf(angle_rad));
            figure.bones[index].2 = [x + x.signum() * along_m, y - down_m, z];
        }
    }
    compiled(&figure.glb()).character
}

#[test]
fn fingers_that_are_bound_curled_are_straight_at_rest() {
    check_curl(&bound_bent(30.0));
}

#[test]
fn flat_hands_bend_a_little_and_fists_stay() {
    let skeleton = skeleton();
    for (bend_deg, wanted_deg) in [(0.0, 28.0), (70.0, 70.0)] {
        let character = bound_bent(bend_deg);
        let fit = CharacterFit::new(&character, &skeleton);
        let rested_m = posed_m(&character, |joint| fit.resting(joint));
        for side in Side::BOTH {
            assert!(fit.resting(ExtraJoint::finger(side, 0, 1)).is_none());
            for finger in 1..5 {
                let [near, far] = [0, 1].map(|joint| bone(&character, &rested_m, side, finger, joint));
                let bent_deg = near.angle_between(far).to_degrees();
                assert!((bent_deg - wanted_deg).abs() < 0.5, "{bent_deg}° instead of {wanted_deg}°");
                assert!(near.z < -0.3, "{near}");
            }
        }
    }
}

#[test]
fn a_thumb_bends_towards_the_fingers() {
    let character = compiled(&Figure::adult().with_fingers().glb()).character;
    for side in Side::BOTH {
        let out = Vec3::Y * side.sign();
        // A thumb's bone is along the hand at rest, as its canonical joint.
        let open_m = posed_m(&character, |_| Some(Quat::IDENTITY));
        check_direction(bone(&character, &open_m, side, 0, 1), out);
        let aside = Quat::from_rotation_z(-side.sign() * 45_f32.to_radians());
        let thumb = ExtraJoint::finger(side, 0, 0);
        let aside_m = posed_m(&character, |joint| (joint == thumb).then_some(aside));
        check_direction(bone(&character, &aside_m, side, 0, 0), (out + Vec3::X).normalize());
        // The other fingers stay as they are bound, and what is not turned follows.
        check_direction(bone(&character, &aside_m, side, 0, 1), (out + Vec3::X).normalize());
        check_direction(bone(&character, &aside_m, side, 1, 0), out);
    }
}

/// The bone table of the adult with fingers.
fn table(version: usize) -> Vec<(String, usize)> {
    let mut table: Vec<(String, usize)> = VRM_BONES.into_iter().map(|(bone, node)| (bone.to_owned(), node)).collect();
    for (hand, side) in ["left", "right"].into_iter().enumerate() {
        for (finger, name) in ["Thumb", "Index", "Middle", "Ring", "Little"].into_iter().enumerate() {
            let parts = match (finger, version) {
                (0, 1) => ["Metacarpal", "Proximal", "Distal"],
                _ => ["Proximal", "Intermediate", "Distal"],
            };
            let first = 21 + 15 * hand + 3 * finger;
            table.extend(
                parts.into_iter().enumerate().map(|(joint, part)| (format!("{side}{name}{part}"), first + joint)),
            );
        }
    }
    table
}

#[test]
fn bone_tables_of_vrm_name_the_fingers() {
    let figure = Figure::adult().with_fingers();
    let named = compiled(&figure.glb()).character;
    for version in [0, 1] {
        let (json, bytes) = figure_with_table(&figure, version, &table(version));
        let character = compiled(&glb(&json, &bytes)).character;
        assert_eq!(character.extra, named.extra, "VRM {version}");
        check_curl(&character);
    }
    // A table whose sides are exchanged: the fingers are those of the hand that they hang from.
    let exchanged = |(bone, node): &(String, usize)| {
        let other = bone.strip_prefix("left").map(|rest| format!("right{rest}"));
        let other = other.or_else(|| bone.strip_prefix("right").map(|rest| format!("left{rest}")));
        (other.unwrap_or_else(|| bone.clone()), *node)
    };
    let exchanged: Vec<(String, usize)> = table(1).iter().map(exchanged).collect();
    let (json, bytes) = figure_with_table(&figure, 1, &exchanged);
    assert_eq!(compiled(&glb(&json, &bytes)).character.extra, named.extra);
    // Fingers that hang from one another, from elsewhere, or are hands, are none.
    let mut wrong = table(1);
    for (bone, node) in &mut wrong {
        match bone.as_str() {
            "leftIndexIntermediate" => *node = 24,
            "leftMiddleProximal" => *node = 4,
            "leftRingProximal" => *node = 8,
            _ => {}
        }
    }
    let (json, bytes) = figure_with_table(&figure, 1, &wrong);
    let character = compiled(&glb(&json, &bytes)).character;
    assert_eq!(first_fault(&character), None);
    assert_eq!(extra_name(&character, ExtraJoint::finger(Side::Left, 1, 1)), "J_26");
}

#[test]
fn hands_without_names_are_where_fingers_begin() {
    let longer = |factor: f32| {
        let mut figure = Figure::adult().with_fingers();
        for joint in ADULT.len()..figure.bones.len() {
            let wrist = if figure.bones[joint].2[0] > 0.0 { 0.7 } else { -0.7 };
            let along = &mut figure.bones[joint].2[0];
            *along = wrist + factor * (*along - wrist);
        }
        figure
    };
    for factor in [1.0, 1.4, 1.8] {
        let mut figure = longer(factor);
        for (index, (name, ..)) in figure.bones.iter_mut().enumerate() {
            *name = Box::leak(format!("J_{index}").into_boxed_str());
        }
        let character = compiled(&figure.glb()).character;
        let mut arms = [Joint::LeftForearm, Joint::LeftHand, Joint::RightForearm, Joint::RightHand]
            .map(|role| joint_name(&character, role));
        arms.sort_unstable();
        assert_eq!(arms, ["J_11", "J_12", "J_7", "J_8"], "fingers {factor} times as long");
    }
}

#[test]
fn toes_and_twist_bones_turn_with_foot_and_limb() {
    let mut figure = Figure::adult();
    figure.bones.push(("LeftForeArmTwist", Some(7), [0.58, 1.43, 0.0]));
    for (name, z_m) in [("LeftBigToe1", 0.02), ("LeftIndexToe1", 0.0)] {
        figure.bones.push((name, Some(16), [0.09 + z_m, 0.02, 0.16]));
    }
    let character = compiled(&figure.glb()).character;
    let twist = ExtraJoint::twist(Joint::LeftForearm).unwrap();
    let names = [twist, ExtraJoint::toe(Side::Left, 0), ExtraJoint::toe(Side::Left, 1)];
    assert_eq!(names.map(|extra| extra_name(&character, extra)), ["LeftForeArmTwist", "LeftBigToe1", "LeftIndexToe1"]);
    let quarter = Quat::from_rotation_y(std::f32::consts::FRAC_PI_2);
    let [still, turned] =
        [Quat::IDENTITY, quarter].map(|turn| posed_m(&character, |extra| (extra == twist).then_some(turn)));
    // About its own axis a twist bone stays where it is.
    assert!(still.iter().zip(&turned).all(|(still, turned)| still.distance(*turned) < 1e-5));
}

#[test]
fn files_of_figures_with_fingers_have_a_version_of_their_own() {
    let version = |bytes: &[u8]| motiondb::files::container::stated_version(bytes);
    let plain = compiled(&Figure::adult().glb()).character;
    assert_eq!((version(&to_bytes(&plain)), plain.extra.len()), (Some(VERSION), 0));
    let mut character = compiled(&Figure::adult().with_fingers().glb()).character;
    let bytes = to_bytes(&character);
    assert_eq!(version(&bytes), Some(EXTRA_VERSION));
    assert_eq!(from_bytes(Path::new("figure.fbchar"), &bytes).unwrap().0, character);
    character.extra.swap(0, 7);
    let error = from_bytes(Path::new("figure.fbchar"), &to_bytes(&character)).unwrap_err().to_string();
    assert!(error.contains("extra joints are not in order") || error.contains("parent after it"), "{error}");
    character.extra.sort_by_key(|known| known.extra);
    character.extra[3].joint = 4000;
    let error = from_bytes(Path::new("figure.fbchar"), &to_bytes(&character)).unwrap_err().to_string();
    assert!(error.contains("names no joint") && error.contains("compile it again"), "{error}");
}

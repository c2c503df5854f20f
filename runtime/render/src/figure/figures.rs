//! All templates of one skeleton, and the figure of an agent from them. World, metres.

use fbcrowd_sim::recording::AgentFrame;
use glam::{Mat3, Vec3};
use motiondb::body::{Side, Skeleton};

use crate::figure::build::{Build, Fineness, rest_positions};
use crate::figure::cone_figure::ConeFigure;
use crate::figure::style::{HairStyle, Sex, Style};
use crate::figure::template::{PosedJoint, Template};
use crate::raster::palette::Look;
use crate::visibility::{Owner, SceneParts};

/// Height in the picture up to which a body is drawn by cones, pixels.
const CONES_PX: f32 = 46.0;
/// Heights in the picture up to which surfaces are coarse and middling, pixels.
const COARSE_PX: [f32; 2] = [110.0, 300.0];
/// Material of bodies.
const BODY: u32 = 1;

/// Templates of a skeleton: bodies by sex and fineness, hair by sex, style and fineness.
#[derive(Clone, Debug)]
pub(crate) struct Figures {
    skeleton: Skeleton,
    rest: Vec<Vec3>,
    bodies: Vec<Template>,
    hair: Vec<Template>,
}

impl Figures {
    pub(crate) fn new(skeleton: &Skeleton) -> Self {
        let (mut bodies, mut hair) = (Vec::new(), Vec::new());
        for sex in [Sex::Male, Sex::Female] {
            for fineness in Fineness::ALL {
                let build = Build::new(skeleton, sex, fineness);
                bodies.push(body(&build));
                for style in HairStyle::ALL {
                    let mut template = Template::default();
                    template.add_hair(&build, style);
                    hair.push(template.finish());
                }
            }
        }
        Self { skeleton: skeleton.clone(), rest: rest_positions(skeleton), bodies, hair }
    }

    /// Appends the parts of one agent's body, which is `height_px` high in the picture.
    pub(crate) fn append(&self, parts: &mut SceneParts, frame: &AgentFrame, look: &Look, height_px: f32) {
        let style = Style::of(frame.id.0);
        let (joints, colours) = (self.posed(frame), style.colours(look));
        let owner = Owner { agent: frame.id.0, material: BODY };
        let cones = ConeFigure { skeleton: &self.skeleton, joints: &joints, colours: &colours, owner };
        if height_px < CONES_PX {
            cones.append(&mut parts.cones);
            cones.append(&mut parts.occluders);
            return;
        }
        cones.append(&mut parts.occluders);
        let fineness = COARSE_PX.iter().filter(|limit| height_px > **limit).count();
        let index = style.sex as usize * Fineness::ALL.len() + fineness;
        self.bodies[index].append(&mut parts.meshes, &joints, &colours, owner);
        let hair = index * HairStyle::ALL.len() + style.hair as usize;
        self.hair[hair].append(&mut parts.meshes, &joints, &colours, owner);
    }

    /// The joints of a frame, in the world.
    fn posed(&self, frame: &AgentFrame) -> Vec<PosedJoint> {
        let joints = frame.pose.forward_kinematics(&self.skeleton);
        let (root, ahead) = (frame.root.frame(), frame.root.forward());
        let to_world = Mat3::from_cols(ahead.extend(0.0), ahead.perp().extend(0.0), Vec3::Z);
        let posed = joints.positions_m.iter().zip(&joints.orientations).zip(&self.rest);
        posed
            .map(|((position, orientation), rest)| PosedJoint {
                rotation: to_world * Mat3::from_quat(*orientation),
                rest: *rest,
                position: root.to_world(*position),
            })
            .collect()
    }
}

fn body(build: &Build) -> Template {
    let mut template = Template::default();
    template.add_trunk(build);
    template.add_head(build);
    for side in Side::BOTH {
        template.add_arm(build, side);
        template.add_hand(build, side);
        template.add_leg(build, side);
        template.add_shoe(build, side);
    }
    template.finish()
}

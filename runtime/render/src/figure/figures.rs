//! All templates of one skeleton, and the figure of an agent from them. World, metres.

use fbcrowd_sim::recording::AgentFrame;
use glam::{Mat3, Quat, Vec3};
use motiondb::body::{Joint, Side, Skeleton};

use crate::figure::build::{Build, Fineness, rest_positions};
use crate::figure::cone_figure::ConeFigure;
use crate::figure::style::{Age, BodySize, Clothes, HairStyle, Sex, Style};
use crate::figure::template::{PosedJoint, Template};
use crate::raster::palette::Look;
use crate::visibility::{MeshSize, Owner, SceneParts};

/// Height in the picture up to which a body is drawn by cones, pixels.
const CONES_PX: f32 = 46.0;
/// Heights in the picture up to which surfaces are coarse and middling, pixels.
const COARSE_PX: [f32; 2] = [110.0, 300.0];
/// Turns of the joints of an elder, about the axis to the left, rad: the back bends, the head stays level, arms hang.
const STOOP_RAD: [(Joint, f32); 6] = [
    (Joint::SpineMiddle, 0.07),
    (Joint::SpineUpper, 0.08),
    (Joint::Neck, 0.04),
    (Joint::Head, -0.17),
    (Joint::LeftClavicle, -0.10),
    (Joint::RightClavicle, -0.10),
];
/// Material of bodies.
const BODY: u32 = 1;

/// A part of a body that some agents have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Piece {
    /// Trunk, head, hands and shoes.
    Core,
    LongSleeves,
    /// Short sleeves, and bare forearms.
    ShortSleeves,
    TrouserLegs,
    BareLegs,
    ShortLegs,
    Skirt,
    Coat,
    Hair(HairStyle),
}

impl Piece {
    const ALL: [Self; 14] = [
        Self::Core,
        Self::LongSleeves,
        Self::ShortSleeves,
        Self::TrouserLegs,
        Self::BareLegs,
        Self::ShortLegs,
        Self::Skirt,
        Self::Coat,
        Self::Hair(HairStyle::Short),
        Self::Hair(HairStyle::Full),
        Self::Hair(HairStyle::Receding),
        Self::Hair(HairStyle::Bob),
        Self::Hair(HairStyle::Long),
        Self::Hair(HairStyle::Bun),
    ];

    /// Whether an agent of a style has it.
    fn is_of(self, style: &Style) -> bool {
        match self {
            Self::Core => true,
            Self::LongSleeves => style.has_long_sleeves,
            Self::ShortSleeves => !style.has_long_sleeves,
            Self::TrouserLegs => !style.has_bare_legs(),
            Self::BareLegs => style.has_bare_legs(),
            Self::ShortLegs => style.clothes == Clothes::Shorts,
            Self::Skirt => matches!(style.clothes, Clothes::Skirt | Clothes::Dress),
            Self::Coat => style.clothes == Clothes::Coat,
            Self::Hair(hair) => style.hair == hair,
        }
    }

    fn template(self, build: &Build) -> Template {
        let mut template = Template::default();
        match self {
            Self::Core => template.add_core(build),
            Self::LongSleeves => Side::BOTH.into_iter().for_each(|side| template.add_long_sleeve(build, side)),
            Self::ShortSleeves => Side::BOTH.into_iter().for_each(|side| template.add_short_sleeve(build, side)),
            Self::TrouserLegs => Side::BOTH.into_iter().for_each(|side| template.add_trouser_leg(build, side)),
            Self::BareLegs => Side::BOTH.into_iter().for_each(|side| template.add_bare_leg(build, side)),
            Self::ShortLegs => Side::BOTH.into_iter().for_each(|side| template.add_short_leg(build, side)),
            Self::Skirt => template.add_skirt(build),
            Self::Coat => template.add_coat(build),
            Self::Hair(style) => template.add_hair(build, style),
        }
        template.finish()
    }
}

impl Template {
    fn add_core(&mut self, build: &Build) {
        self.add_trunk(build);
        self.add_head(build);
        for side in Side::BOTH {
            self.add_hand(build, side);
            self.add_shoe(build, side);
        }
    }
}

/// Templates of a skeleton: pieces by sex and fineness.
#[derive(Clone, Debug)]
pub(crate) struct Figures {
    skeleton: Skeleton,
    rest: Vec<Vec3>,
    pieces: Vec<Template>,
}

/// One body to draw.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Wanted<'a> {
    pub(crate) agent: &'a AgentFrame,
    pub(crate) look: Look,
    /// Size of the body.
    pub(crate) size: BodySize,
    /// Height in the picture, pixels.
    pub(crate) height_px: f32,
}

impl Figures {
    pub(crate) fn new(skeleton: &Skeleton) -> Self {
        let mut pieces = Vec::new();
        for sex in [Sex::Male, Sex::Female] {
            for fineness in Fineness::ALL {
                let build = Build::new(skeleton, sex, fineness);
                pieces.extend(Piece::ALL.map(|piece| piece.template(&build)));
            }
        }
        Self { skeleton: skeleton.clone(), rest: rest_positions(skeleton), pieces }
    }

    /// Appends the parts of one agent's body, as large as the crowd's.
    pub(crate) fn append(&self, parts: &mut SceneParts, wanted: &Wanted) {
        let Wanted { agent, look, size, height_px } = wanted;
        let style = Style::of(agent.id.0, *size);
        let head = style.head(size.stature);
        let (joints, colours) = (self.posed(agent, style.age, head), style.colours(look));
        let owner = Owner { agent: agent.id.0, material: BODY };
        let cones = ConeFigure { skeleton: &self.skeleton, joints: &joints, colours: &colours, owner, style, head };
        cones.append(&mut parts.occluders);
        if *height_px < CONES_PX {
            cones.append(&mut parts.cones);
            return;
        }
        for template in self.templates(&style, *height_px) {
            template.append(&mut parts.meshes, &joints, &colours, owner);
        }
    }

    /// Size of the mesh that [`Self::append`] appends.
    pub(crate) fn mesh_size(&self, wanted: &Wanted) -> MeshSize {
        if wanted.height_px < CONES_PX {
            return MeshSize::default();
        }
        let style = Style::of(wanted.agent.id.0, wanted.size);
        self.templates(&style, wanted.height_px).map(Template::size).sum()
    }

    /// The templates of a style's pieces, as fine as a height in the picture needs.
    fn templates(&self, style: &Style, height_px: f32) -> impl Iterator<Item = &Template> {
        let fineness = COARSE_PX.iter().filter(|limit| height_px > **limit).count();
        let first = (style.build() as usize * Fineness::ALL.len() + fineness) * Piece::ALL.len();
        let pieces = Piece::ALL.iter().zip(&self.pieces[first..]);
        pieces.filter(|(piece, _)| piece.is_of(style)).map(|(_, template)| template)
    }

    /// The joints of a frame, in the world, with a head of a size. Elders stoop.
    fn posed(&self, frame: &AgentFrame, age: Age, head: f32) -> Vec<PosedJoint> {
        let mut pose = frame.pose;
        if age == Age::Elder {
            for (joint, angle_rad) in STOOP_RAD {
                pose.rotations[joint.index()] *= Quat::from_rotation_y(angle_rad);
            }
        }
        let joints = pose.forward_kinematics(&self.skeleton);
        let (root, ahead) = (frame.root.frame(), frame.root.forward());
        let to_world = Mat3::from_cols(ahead.extend(0.0), ahead.perp().extend(0.0), Vec3::Z);
        let posed = joints.positions_m.iter().zip(&joints.orientations).zip(&self.rest);
        let mut posed: Vec<PosedJoint> = posed
            .map(|((position, orientation), rest)| PosedJoint {
                rotation: to_world * Mat3::from_quat(*orientation),
                rest: *rest,
                position: root.to_world(*position),
            })
            .collect();
        posed[Joint::Head.index()].rotation *= head;
        posed
    }
}

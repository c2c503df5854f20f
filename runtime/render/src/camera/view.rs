//! One frame of a camera: bodies, walls and ground in scene-linear light.
//!
//! Enters: agents of a frame and a lens, world metres. Leaves: a [`LinearPicture`]. [`CameraView::new`] prepares what
//! all frames share; [`CameraView::draw`] depends only on time, lens and bodies, so frames can be drawn in any order.

use std::ops::Range;

use exr::prelude::f16;
use fbcrowd_sim::Population;
use fbcrowd_sim::recording::{AgentFrame, ExtraFrame, Header};
use glam::Vec3;
use motiondb::character::Character;

use crate::camera::blocks::{append_doors, still_blocks};
use crate::camera::bodies::Dresser;
use crate::camera::colour_by::{ColourBy, shown};
use crate::camera::options::Quality;
use crate::camera::worn::Wardrobe;
use crate::figure::Figures;
use crate::passes::motion::PartPlaces;
use crate::shading::ground_plan::GroundPlan;
use crate::shading::linear_picture::LinearPicture;
use crate::shading::occlusion::{Occlusion, OcclusionGrid};
use crate::shading::shader::Shader;
use crate::shading::shadow_map::ShadowMap;
use crate::visibility::{Lens, MeshSize, Meshes, PreparedTiles, SamplePattern, SceneParts, TILE_PX, TileSamples};

/// Distance from the eye up to which walls throw shadows, m.
const WALL_SHADOW_M: f32 = 45.0;

/// What all frames of a camera sequence share.
#[derive(Clone, Debug)]
pub struct CameraView<'a> {
    header: &'a Header,
    population: &'a Population,
    figures: Figures,
    wardrobe: Option<Wardrobe<'a>>,
    blocks: Meshes,
    ground: GroundPlan,
    quality: Quality,
    colour_by: ColourBy,
}

/// A scene with its light, ready to be drawn tile by tile.
pub(crate) struct PreparedFrame<'a> {
    shot: &'a Shot,
    scene: &'a SceneParts,
    ground: &'a GroundPlan,
    quality: Quality,
    layer_colours: Vec<Vec3>,
    shadow: Option<ShadowMap>,
    occluders: Option<OcclusionGrid>,
    tiles: PreparedTiles<'a>,
}

impl PreparedFrame<'_> {
    /// Pixels of each tile of some rows of tiles, and the result of a function of it, row by row.
    pub(crate) fn shaded<T: Send>(
        &self,
        rows: Range<u32>,
        of_tile: impl Fn(&TileSamples<'_>) -> T + Sync,
    ) -> Vec<(Vec<[f16; 4]>, T)> {
        let Shot { lens, fog_m, .. } = self.shot;
        let shader = Shader {
            scene: self.scene,
            lens,
            ground: self.ground,
            layer_colours: &self.layer_colours,
            shadow: self.shadow.as_ref(),
            occluders: self.occluders.as_ref(),
            occlusion: self.quality.occlusion,
            fog_m: *fog_m,
        };
        self.tiles.draw(Some(lens.ground()), rows, |tile| (shader.tile(tile), of_tile(tile)))
    }
}

/// Number of rows of tiles in a lens's picture.
pub(crate) fn tile_rows(lens: &Lens) -> u32 {
    lens.size_px[1].div_ceil(TILE_PX)
}

/// The moment and conditions of a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shot {
    /// The lens.
    pub lens: Lens,
    /// Time, s.
    pub time_s: f64,
    /// Id of the agent whose eyes are the camera: its body is not drawn.
    pub eyes_of: Option<u32>,
    /// Distance at which fog leaves a third of the light, m.
    pub fog_m: Option<f32>,
}

impl<'a> CameraView<'a> {
    /// The view of a recording.
    pub fn new(header: &'a Header, population: &'a Population, quality: Quality, colour_by: ColourBy) -> Self {
        let (blocks, ground) = (still_blocks(&header.scenario), GroundPlan::new(&header.scenario));
        let figures = Figures::new(header.skeleton());
        Self { header, figures, wardrobe: None, population, blocks, ground, quality, colour_by }
    }

    /// The same with the recording's characters, in its order. Colours that show a quantity dye them.
    pub fn with_characters(mut self, characters: &'a [Character]) -> Self {
        self.wardrobe = (!characters.is_empty()).then(|| Wardrobe::new(self.header, characters));
        self
    }

    /// The cones and triangles of a frame. `extra` holds the rotations of the agents' extra joints.
    pub fn scene(&self, shot: &Shot, agents: &[AgentFrame], extra: &ExtraFrame) -> SceneParts {
        let shown = shown(self.colour_by, agents, self.population);
        let mut scene = self.dresser(extra).body_parts(agents, &shown, &shot.lens, shot.eyes_of);
        scene.meshes.extend(&self.blocks);
        self.append_doors(&mut scene.meshes, shot);
        scene
    }

    /// Size of the meshes of [`Self::scene`].
    pub(crate) fn mesh_size(&self, shot: &Shot, agents: &[AgentFrame]) -> MeshSize {
        let bodies = self.dresser(&ExtraFrame::default()).mesh_size(agents, &shot.lens, shot.eyes_of);
        [bodies, self.blocks.size()].into_iter().sum()
    }

    /// Where the parts of [`Self::scene`] are at another time: `posed` holds the agents of `agents` then,
    /// `extra` their extra joints.
    pub(crate) fn places(
        &self,
        shot: &Shot,
        agents: &[AgentFrame],
        posed: &[AgentFrame],
        extra: &ExtraFrame,
    ) -> PartPlaces {
        let mut places = self.dresser(extra).body_places(agents, posed, &shot.lens, shot.eyes_of);
        let mut standing = SceneParts { meshes: self.blocks.clone(), ..SceneParts::default() };
        self.append_doors(&mut standing.meshes, shot);
        places.extend(&PartPlaces::of(standing));
        places
    }

    fn dresser<'s>(&'s self, extra: &'s ExtraFrame) -> Dresser<'s> {
        Dresser { figures: &self.figures, wardrobe: self.wardrobe.as_ref(), population: self.population, extra }
    }

    fn append_doors(&self, meshes: &mut Meshes, shot: &Shot) {
        let frame = (shot.time_s / f64::from(self.header.scenario.dt_s) + 1e-3) as u32;
        append_doors(meshes, &self.header.scenario, self.population, frame);
    }

    /// Picture of all agents at a time, with the rotations of their extra joints.
    pub fn draw(&self, shot: &Shot, agents: &[AgentFrame], extra: &ExtraFrame) -> LinearPicture {
        self.draw_scene(shot, &self.scene(shot, agents, extra))
    }

    /// Picture of a scene that is made already.
    pub fn draw_scene(&self, shot: &Shot, scene: &SceneParts) -> LinearPicture {
        self.draw_with(shot, scene, |_| ()).0
    }

    /// Picture of a scene, and the results of a function of each tile, row by row.
    pub(crate) fn draw_with<T: Send>(
        &self,
        shot: &Shot,
        scene: &SceneParts,
        of_tile: impl Fn(&TileSamples<'_>) -> T + Sync,
    ) -> (LinearPicture, Vec<T>) {
        let lens = &shot.lens;
        let tiles = self.prepare(shot, scene).shaded(0..tile_rows(lens), of_tile);
        let (tiles, results): (Vec<_>, Vec<T>) = tiles.into_iter().unzip();
        (LinearPicture::from_tiles(lens.size_px, &tiles), results)
    }

    /// A scene with its light, ready to be drawn.
    pub(crate) fn prepare<'s>(&'s self, shot: &'s Shot, scene: &'s SceneParts) -> PreparedFrame<'s> {
        let shadow = if self.quality.shadow { ShadowMap::new(scene, &self.shaded_walls_m(&shot.lens)) } else { None };
        let occluders = (self.quality.occlusion > Occlusion::None).then(|| OcclusionGrid::new(scene));
        PreparedFrame {
            layer_colours: self.ground.colours(&self.header.scenario, shot.time_s),
            tiles: PreparedTiles::new(scene, &shot.lens, self.quality.samples),
            ground: &self.ground,
            quality: self.quality,
            shadow,
            occluders,
            shot,
            scene,
        }
    }

    /// The recorded agents.
    pub(crate) fn population(&self) -> &'a Population {
        self.population
    }

    /// Samples of a pixel.
    pub(crate) fn samples(&self) -> SamplePattern {
        self.quality.samples
    }

    /// Corners of walls near the eye, whose shadows are seen.
    fn shaded_walls_m(&self, lens: &Lens) -> Vec<Vec3> {
        let near = |position_m: &&Vec3| position_m.truncate().distance(lens.eye_m.truncate()) < WALL_SHADOW_M;
        self.blocks.positions_m.iter().filter(near).copied().collect()
    }
}

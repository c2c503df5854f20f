//! One frame of a camera as EXR: the picture and its passes. World, metres, seconds.
//!
//! A sharp frame is drawn and written strip by strip. A blurred one is the mean of its moments: of the light, and of the
//! coverages of mattes. All other passes are those of the frame's own time, in the middle of the shutter's opening.

use std::path::Path;

use fbcrowd_sim::recording::{AgentFrame, duration_s};

use crate::camera::take::{Moment, Take};
use crate::error::RenderError;
use crate::passes::mattes::{MatteIds, Matted};
use crate::passes::motion::OtherFrame;
use crate::passes::multi_channel_exr::{self, DrawnTile, PassFrame};
use crate::passes::pass::Pass;
use crate::passes::tile_mattes::TileMattes;
use crate::passes::tile_passes::{FramePasses, channels};
use crate::shading::LinearPicture;
use crate::shading::linear_picture::LinearSum;
use crate::visibility::{PreparedTiles, SceneParts, TILE_PX};

/// Draws a frame with its passes, and writes it.
///
/// # Errors
/// If the recording is damaged, or the file cannot be written.
pub(crate) fn write(take: &Take<'_>, path: &Path, number: u32) -> Result<(), RenderError> {
    let frame = PassedFrame::new(take, number)?;
    match take.moments_s(number)[..] {
        [_] => frame.write_sharp(path),
        ref moments_s => frame.write_blurred(path, moments_s),
    }
}

/// A frame at its own time.
struct PassedFrame<'a> {
    take: &'a Take<'a>,
    number: u32,
    moment: Moment,
    scene: SceneParts,
    others: Option<[OtherFrame; 2]>,
}

impl<'a> PassedFrame<'a> {
    fn new(take: &'a Take<'a>, number: u32) -> Result<Self, RenderError> {
        let moment = take.moment(take.times.time_s(number), number)?;
        let scene = take.view.scene(&moment.shot, &moment.agents, &moment.extra);
        let others = match take.options.passes.holds(Pass::Motion) {
            true => Some([other_frame(take, &moment, 1.0)?, other_frame(take, &moment, -1.0)?]),
            false => None,
        };
        Ok(Self { take, number, moment, scene, others })
    }

    fn write_sharp(&self, path: &Path) -> Result<(), RenderError> {
        let view = &self.take.view;
        let (of_samples, matted) = (view.samples().count(), Matted::new(&self.scene, view.population()));
        let ids = matted.ids();
        let passes = self.passes(&self.scene, &ids);
        let prepared = view.prepare(&self.moment.shot, &self.scene);
        self.write(path, &matted, of_samples, |rows| {
            prepared.shaded(rows, |tile| passes.tile(tile, &passes.mattes(tile), of_samples))
        })
    }

    fn write_blurred(&self, path: &Path, moments_s: &[f64]) -> Result<(), RenderError> {
        let view = &self.take.view;
        let of_samples = view.samples().count() * moments_s.len();
        let mut matted = Matted::new(&self.scene, view.population());
        let (picture, mattes) = self.exposed(moments_s, &mut matted)?;
        let (lens, ids) = (&self.moment.shot.lens, matted.ids());
        let passes = self.passes(&self.scene, &ids);
        let tiles = PreparedTiles::new(&self.scene, lens, view.samples());
        let columns = lens.size_px[0].div_ceil(TILE_PX);
        self.write(path, &matted, of_samples, |rows| {
            tiles.draw(Some(lens.ground()), rows, |tile| {
                let [column, row] = tile.corner_px.map(|corner_px| corner_px / TILE_PX);
                let mattes = &mattes[(row * columns + column) as usize];
                (picture.tile(column as usize, row as usize), passes.tile(tile, mattes, of_samples))
            })
        })
    }

    /// Mean light and summed mattes of all moments; what they show is added to `matted`.
    fn exposed(&self, moments_s: &[f64], matted: &mut Matted) -> Result<(LinearPicture, Vec<TileMattes>), RenderError> {
        let (mut sum, mut mattes) = (LinearSum::default(), Vec::new());
        for time_s in moments_s {
            let Moment { shot, agents, extra } = self.take.moment(*time_s, self.number)?;
            let scene = self.take.view.scene(&shot, &agents, &extra);
            let shown = Matted::new(&scene, self.take.view.population());
            let ids = shown.ids();
            let passes = FramePasses { lens: &shot.lens, ..self.passes(&scene, &ids) };
            let (picture, tiles) = self.take.view.draw_with(&shot, &scene, |tile| passes.mattes(tile));
            sum.add(&picture);
            mattes.resize(tiles.len(), TileMattes::default());
            mattes.iter_mut().zip(tiles).for_each(|(sum, tile)| sum.add(tile));
            matted.add(&shown);
        }
        Ok((sum.mean(), mattes))
    }

    fn passes<'s>(&'s self, scene: &'s SceneParts, ids: &'s MatteIds) -> FramePasses<'s> {
        FramePasses {
            passes: &self.take.options.passes,
            scene,
            lens: &self.moment.shot.lens,
            population: self.take.view.population(),
            ids,
            others: self.others.as_ref(),
        }
    }

    fn write(
        &self,
        path: &Path,
        matted: &Matted,
        of_samples: usize,
        draw: impl FnMut(std::ops::Range<u32>) -> Vec<DrawnTile>,
    ) -> Result<(), RenderError> {
        let (take, options) = (self.take, self.take.options);
        let frame = PassFrame {
            channels: &channels(&options.passes, of_samples),
            metadata: matted.metadata(&options.passes),
            lens: &self.moment.shot.lens,
            number: self.number,
            rate: take.times.rate,
            time_s: take.is_shot_stated.then_some(self.moment.shot.time_s),
            colour_space: options.colour_space,
            compression: options.compression,
        };
        multi_channel_exr::write(path, &frame, draw)
    }
}

/// Where the parts of a moment are, a number of frames later.
fn other_frame(take: &Take<'_>, moment: &Moment, frames: f64) -> Result<OtherFrame, RenderError> {
    let Moment { shot, agents, extra } = moment;
    let time_s = shot.time_s + frames / take.times.rate.hz();
    let time_s = time_s.clamp(0.0, duration_s(take.recording));
    let posed = posed_then(agents, &take.agents_at(time_s)?);
    let extra = take.extra_at(time_s)?.completed(extra);
    // A camera at an agent that is not present then stays.
    let lens = take.lens_at(time_s).unwrap_or(shot.lens);
    Ok(OtherFrame { places: take.view.places(shot, agents, &posed, &extra), lens })
}

/// The agents of a frame as they are at another time; as they are now where they are not present then.
fn posed_then(agents: &[AgentFrame], then: &[AgentFrame]) -> Vec<AgentFrame> {
    let posed = |agent: &AgentFrame| {
        let found = then.binary_search_by_key(&agent.id, |other| other.id);
        found.map_or(*agent, |index| then[index])
    };
    agents.iter().map(posed).collect()
}

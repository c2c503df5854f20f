//! The passes of one tile, pixel by pixel, from its samples. World, metres.

use fbcrowd_sim::Population;
use glam::Vec3;

use crate::passes::cryptomatte::ranks;
use crate::passes::mattes::{GROUND_MATERIAL, MatteIds, matte_layer};
use crate::passes::motion::{OtherFrame, displacement_px};
use crate::passes::pass::{Pass, PassSet};
use crate::passes::tile_mattes::TileMattes;
use crate::shading::surface::SurfacePoint;
use crate::visibility::{Fragment, Lens, Owner, PartId, SceneParts, TileSamples};

/// Depth where there is only sky, m: a large finite number, as in Blender.
const SKY_DEPTH_M: f32 = 1e10;

/// Type of a channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ChannelKind {
    Half,
    Float,
    Uint,
}

/// A channel of the file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Channel {
    pub(crate) name: String,
    pub(crate) kind: ChannelKind,
}

/// What the passes of a frame depend on, besides the samples.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FramePasses<'a> {
    pub(crate) passes: &'a PassSet,
    pub(crate) scene: &'a SceneParts,
    pub(crate) lens: &'a Lens,
    pub(crate) population: &'a Population,
    pub(crate) ids: &'a MatteIds,
    /// The frame after this one, and the one before; only for motion.
    pub(crate) others: Option<&'a [OtherFrame; 2]>,
}

/// The nearest sample of a pixel as a fragment of its own: the mean of samples would lie between near and far.
fn nearest_sample(tile: &TileSamples<'_>, pixel: usize) -> Fragment {
    let samples = pixel * tile.pattern.count()..(pixel + 1) * tile.pattern.count();
    let nearer = |a: usize, b: usize| if tile.depths_m[b] < tile.depths_m[a] { b } else { a };
    let nearest = samples.clone().reduce(nearer).unwrap_or(samples.start);
    let (part, depth_m, uv) = (tile.parts[nearest], tile.depths_m[nearest], tile.uv(nearest));
    let point_m = if part == PartId::SKY { uv.extend(1.0) } else { tile.lens.at_depth(uv, depth_m) };
    Fragment { part, samples: 1, depth_m, point_m }
}

/// The channels of passes, in the order in which [`FramePasses::tile`] appends their values.
pub(crate) fn channels(passes: &PassSet, samples: usize) -> Vec<Channel> {
    use ChannelKind::{Float, Half, Uint};
    let mut channels = Vec::new();
    let mut add = |kind, names: &[&str]| {
        channels.extend(names.iter().map(|&name| Channel { name: name.to_owned(), kind }));
    };
    for pass in Pass::ALL.into_iter().filter(|pass| passes.holds(*pass)) {
        match pass {
            Pass::Depth => add(Float, &["Z"]),
            Pass::Normal => add(Half, &["N.X", "N.Y", "N.Z"]),
            Pass::Position => add(Float, &["P.X", "P.Y", "P.Z"]),
            Pass::Motion => add(Half, &["forward.u", "forward.v", "backward.u", "backward.v"]),
            Pass::Id => add(Uint, &["agent.id"]),
            Pass::Agent | Pass::Group | Pass::Material => {
                let layer = matte_layer(pass).unwrap_or_default();
                for pair in 0..ranks(samples) / 2 {
                    add(
                        Float,
                        &["R", "G", "B", "A"]
                            .map(|side| format!("{layer}{pair:02}.{side}"))
                            .each_ref()
                            .map(String::as_str),
                    );
                }
            }
        }
    }
    channels
}

impl FramePasses<'_> {
    /// Samples of each id in each pixel of a tile, for each matte.
    pub(crate) fn mattes(&self, tile: &TileSamples<'_>) -> TileMattes {
        let mattes: Vec<Pass> = self.passes.mattes().collect();
        let (mut fragments, mut counted) = (Vec::new(), TileMattes::new(mattes.len()));
        if mattes.is_empty() {
            return counted;
        }
        for pixel in 0..tile.size_px[0] * tile.size_px[1] {
            tile.fragments(pixel as usize, &mut fragments);
            for fragment in &fragments {
                for (matte, pass) in mattes.iter().enumerate() {
                    let id = self.matte_id(*pass, fragment);
                    id.into_iter().for_each(|id| counted.count(matte, pixel, id, fragment.samples));
                }
            }
        }
        counted.merge();
        counted
    }

    /// Values of all channels of a tile's pixels, pixel by pixel; mattes are counted already, in a number of samples a
    /// pixel. Whole numbers and ids are stored as bits.
    pub(crate) fn tile(&self, tile: &TileSamples<'_>, mattes: &TileMattes, of_samples: usize) -> Vec<f32> {
        let (mut values, mut coverage) = (Vec::new(), mattes.coverages(of_samples));
        let pixels = tile.size_px[0] * tile.size_px[1];
        for pixel in 0..pixels {
            if pixel == 1 {
                // All pixels have as many values as the first one.
                values.reserve_exact(values.len() * (pixels as usize - 1));
            }
            let nearest = &nearest_sample(tile, pixel as usize);
            for pass in Pass::ALL.into_iter().filter(|pass| self.passes.holds(*pass)) {
                match pass {
                    Pass::Depth if nearest.part == PartId::SKY => values.push(SKY_DEPTH_M),
                    Pass::Depth => values.push(nearest.depth_m),
                    Pass::Normal => values.extend(self.normal(nearest).to_array()),
                    Pass::Position if nearest.part == PartId::SKY => values.extend([0.0; 3]),
                    Pass::Position => values.extend(self.lens.to_world(nearest.point_m).to_array()),
                    Pass::Motion => self.append_motion(nearest, &mut values),
                    Pass::Id => values.push(f32::from_bits(self.agent(nearest).map_or(0, |agent| agent + 1))),
                    Pass::Agent | Pass::Group | Pass::Material => {
                        let matte = self.passes.mattes().take_while(|other| *other != pass).count();
                        coverage.append(matte, pixel, &mut values);
                    }
                }
            }
        }
        values
    }

    fn append_motion(&self, fragment: &Fragment, values: &mut Vec<f32>) {
        match self.others {
            Some(others) => others.iter().for_each(|other| {
                values.extend(displacement_px(fragment, self.scene, self.lens, other).to_array());
            }),
            None => values.extend([0.0; 4]),
        }
    }

    fn agent(&self, fragment: &Fragment) -> Option<u32> {
        self.scene.owner(fragment.part).map(|owner| owner.agent).filter(|agent| *agent != Owner::NO_AGENT)
    }

    /// Id in a matte; none of what the matte does not hold.
    fn matte_id(&self, pass: Pass, fragment: &Fragment) -> Option<u32> {
        match pass {
            Pass::Agent => self.ids.agent(self.agent(fragment)?),
            Pass::Group => {
                let life = self.population.agents.get(self.agent(fragment)? as usize)?;
                self.ids.group(life.group?)
            }
            _ if fragment.part == PartId::SKY => None,
            _ => {
                let material = self.scene.owner(fragment.part).map_or(GROUND_MATERIAL, |owner| owner.material);
                self.ids.material(material)
            }
        }
    }

    /// Unit normal of a fragment, world; 0 of the sky.
    fn normal(&self, fragment: &Fragment) -> Vec3 {
        let surface = SurfacePoint::of(fragment, self.scene, self.lens);
        let otherwise = if fragment.part == PartId::SKY { Vec3::ZERO } else { Vec3::Z };
        surface.map_or(otherwise, |surface| surface.normal)
    }
}

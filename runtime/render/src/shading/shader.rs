//! From the samples of a tile to its pixels: one shade for each pixel and distinct part.
//!
//! World, metres; linear Rec. 709.

use exr::prelude::f16;
use glam::Vec3;

use crate::shading::grid_lines::{footprint_m, grid_share};
use crate::shading::ground_plan::GroundPlan;
use crate::shading::light::{SUN, TO_SUN, ambient, sky, through_air};
use crate::shading::linear_picture::opaque;
use crate::shading::occlusion::{Occlusion, OcclusionGrid};
use crate::shading::shadow_map::ShadowMap;
use crate::shading::surface::SurfacePoint;
use crate::visibility::{Fragment, Lens, Owner, PartId, SceneParts, TileSamples};

/// Share of the sun's light that comes round the edge of a surface.
const WRAP: f32 = 0.12;

/// All that decides the colour of a fragment.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shader<'a> {
    pub(crate) scene: &'a SceneParts,
    pub(crate) lens: &'a Lens,
    pub(crate) ground: &'a GroundPlan,
    /// Colours of the ground's layers.
    pub(crate) layer_colours: &'a [Vec3],
    pub(crate) shadow: Option<&'a ShadowMap>,
    pub(crate) occluders: Option<&'a OcclusionGrid>,
    pub(crate) occlusion: Occlusion,
    /// Distance at which fog leaves a third of the light, m.
    pub(crate) fog_m: Option<f32>,
}

impl Shader<'_> {
    /// Colours of a tile's pixels.
    pub(crate) fn tile(&self, tile: &mut TileSamples<'_>) -> Vec<[f16; 4]> {
        self.put_layers(tile);
        let mut fragments = Vec::new();
        let pixels = (tile.size_px[0] * tile.size_px[1]) as usize;
        let samples = tile.pattern.count() as f32;
        let pixel = |pixel: usize| {
            tile.fragments(pixel, &mut fragments);
            let sum = fragments.iter().map(|fragment| self.shade(fragment) * fragment.samples as f32);
            opaque(sum.sum::<Vec3>() / samples)
        };
        (0..pixels).map(pixel).collect()
    }

    /// Replaces the ground of each sample by its uppermost layer.
    fn put_layers(&self, tile: &mut TileSamples<'_>) {
        if self.layer_colours.len() < 2 {
            return;
        }
        for sample in 0..tile.parts.len() {
            if tile.parts[sample] == PartId::GROUND {
                let point_m = tile.lens.to_world(tile.lens.at_depth(tile.uv(sample), tile.depths_m[sample]));
                tile.parts[sample] = PartId(PartId::GROUND.0 + self.ground.layer_at(point_m.truncate()));
            }
        }
    }

    fn shade(&self, fragment: &Fragment) -> Vec3 {
        let distance_m = fragment.point_m.length();
        let colour = match (SurfacePoint::of(fragment, self.scene, self.lens), fragment.part.ground_layer()) {
            (Some(surface), _) => self.surface_colour(&surface),
            (None, Some(layer)) => self.ground_colour(layer, self.lens.to_world(fragment.point_m)),
            (None, None) => return sky(self.lens.ray(fragment.point_m.truncate())),
        };
        through_air(colour, distance_m, self.fog_m)
    }

    fn ground_colour(&self, layer: u32, point_m: Vec3) -> Vec3 {
        let mut colour = self.layer_colours[layer as usize];
        if layer == 0 {
            colour *= grid_share(point_m.truncate(), footprint_m(self.lens, point_m));
        }
        let open = match self.occluders {
            Some(occluders) if self.occlusion >= Occlusion::Ground => occluders.on_ground(point_m),
            _ => 1.0,
        };
        // Feet hide a little of the sun's halo too.
        let sun = TO_SUN.z * self.sun_at(point_m, Vec3::Z) * (0.7 + 0.3 * open);
        colour * (sun * SUN + open * ambient(Vec3::Z))
    }

    fn surface_colour(&self, surface: &SurfacePoint) -> Vec3 {
        let open = match self.occluders {
            Some(occluders) if self.occlusion == Occlusion::Full && surface.owner.agent != Owner::NO_AGENT => {
                occluders.on_body(surface.owner.agent, surface.point_m, surface.normal)
            }
            _ => 1.0,
        };
        let facing = surface.normal.dot(TO_SUN);
        let lit = ((facing + WRAP) / (1.0 + WRAP)).max(0.0);
        let sun = if lit > 0.0 { lit * self.sun_at(surface.point_m, surface.normal) } else { 0.0 };
        surface.colour * (sun * SUN + open * ambient(surface.normal))
    }

    fn sun_at(&self, point_m: Vec3, normal: Vec3) -> f32 {
        self.shadow.map_or(1.0, |shadow| shadow.light_at(point_m, normal))
    }
}

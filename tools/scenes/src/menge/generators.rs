//! Generators of agents: explicit positions, rows and columns, hexagonal lattices. World, metres.

use crate::error::SceneError;
use crate::menge::files::ProjectFiles;
use crate::menge::xml::Element;
use crate::random::Random;
use crate::scene::{DrawnNumber, Grid, Point, Scene, Starts, round_to_mm};

/// Relative difference up to which the distances of a grid are one.
const SAME: f64 = 1e-6;

/// The starts that a generator makes, at most `room` agents.
pub(crate) fn read_starts(
    files: &mut ProjectFiles,
    generator: &Element<'_>,
    room: usize,
    scene: &mut Scene,
) -> Result<Starts, SceneError> {
    let displaced_m = generator.drawn("displace_")?;
    if let Some(DrawnNumber::Normal { .. } | DrawnNumber::Uniform { .. } | DrawnNumber::Constant(_)) = displaced_m
        && displaced_m.is_some_and(|drawn| drawn.bounds().iter().any(|metres| metres.abs() > 100.0))
    {
        return Err(generator.fault("the displacement is more than 100 m", "give metres"));
    }
    let points_m = match generator.kind() {
        "explicit" => explicit(generator, room)?,
        "nav_mesh_explicit" => {
            files.find(generator, "file_name")?;
            explicit(generator, room)?
        }
        "rect_grid" => match rect_grid(generator, displaced_m, room)? {
            Starts::Points(points_m) => points_m,
            starts => {
                if displaced_m.is_some() {
                    let what = "displacements are drawn in a square with the spread of the source's disc";
                    scene.notes.add(&generator.file.shown, generator.line(), what, false);
                }
                return Ok(starts);
            }
        },
        "hex_lattice" => hexagonal_lattice(generator, room)?,
        kind => {
            let what = format!("the generator \"{kind}\" is unknown; its agents are left out");
            scene.notes.add(&generator.file.shown, generator.line(), what, true);
            Vec::new()
        }
    };
    Ok(Starts::Points(displaced(points_m, displaced_m, generator.line())))
}

fn too_many(generator: &Element<'_>, count: f64) -> SceneError {
    let message = format!("with the {count} agents of this generator the scene has more than a million");
    generator.fault(message, "reduce the number of agents")
}

fn explicit(generator: &Element<'_>, room: usize) -> Result<Vec<Point>, SceneError> {
    let count = generator.named("Agent").count();
    if count > room {
        return Err(too_many(generator, count as f64));
    }
    generator.named("Agent").map(|agent| agent.point("p_x", "p_y")).collect()
}

/// A grid of the scenario where its keys can state it, otherwise its positions.
fn rect_grid(generator: &Element<'_>, displaced_m: Option<DrawnNumber>, room: usize) -> Result<Starts, SceneError> {
    let anchor_m = generator.point("anchor_x", "anchor_y")?;
    let offset_m = generator.point("offset_x", "offset_y")?;
    let rotation_deg = generator.number("rotation")?.unwrap_or_default();
    let counts = [generator.count("count_x")?.unwrap_or(0), generator.count("count_y")?.unwrap_or(0)];
    let count = counts[0] as f64 * counts[1] as f64;
    if count > room as f64 {
        return Err(too_many(generator, count));
    }
    let [columns, rows] = counts.map(|count| count as usize);
    let spacings_m = offset_m.map(f64::abs);
    let spacing_m = match (columns, rows) {
        (_, 1) => spacings_m[0],
        (1, _) => spacings_m[1],
        _ if (spacings_m[0] - spacings_m[1]).abs() <= SAME * spacings_m[0] => spacings_m[0],
        _ => 0.0,
    };
    if rotation_deg == 0.0 && spacing_m > 0.0 && columns * rows > 1 {
        let middle_m =
            |axis: usize, count: usize| round_to_mm(anchor_m[axis] + 0.5 * (count as f64 - 1.0) * offset_m[axis]);
        // The square whose variance is that of the displacement in a disc.
        let jitter_m = round_to_mm(displaced_m.map_or(0.0, |drawn| (1.5 * drawn.mean_square()).sqrt()));
        let centre_m = [middle_m(0, columns), middle_m(1, rows)];
        return Ok(Starts::Grid(Grid { columns, rows, spacing_m, centre_m, jitter_m }));
    }
    let (sin, cos) = libm::sincos(rotation_deg.to_radians());
    let position_m = |index: usize| {
        let [x, y] = [(index % columns) as f64 * offset_m[0], (index / columns) as f64 * offset_m[1]];
        [anchor_m[0] + cos * x - sin * y, anchor_m[1] + sin * x + cos * y].map(round_to_mm)
    };
    Ok(Starts::Points((0..columns * rows).map(position_m).collect()))
}

/// Layout of a hexagonal lattice: rows of n and n − 1 agents in turn, or columns of n.
fn hexagonal_lattice(generator: &Element<'_>, room: usize) -> Result<Vec<Point>, SceneError> {
    let anchor_m = generator.point("anchor_x", "anchor_y")?;
    let (density, width_m) = (generator.required_number("density")?, generator.metres("width")?);
    if !(1e-4..=1e3).contains(&density) || width_m < 0.0 {
        return Err(
            generator.fault("the lattice needs a density above 0, and a width", "give agents per m², and metres")
        );
    }
    let population = generator.count("population")?.unwrap_or(0);
    if population > room as u64 {
        return Err(too_many(generator, population as f64));
    }
    let lattice = Lattice::new(generator.text("row_direction") != Some("y"), density, width_m, population as usize);
    if lattice.total > room {
        return Err(too_many(generator, lattice.total as f64));
    }
    let (sin, cos) = libm::sincos(generator.number("rotation")?.unwrap_or_default().to_radians());
    let before_m = match generator.text("alignment") {
        Some("left") => 0.0,
        Some("right") => lattice.width_m,
        _ => 0.5 * lattice.width_m,
    };
    let position_m = |index: usize| {
        let [x, y] = lattice.position_m(index);
        let x = x - before_m;
        [anchor_m[0] + cos * x - sin * y, anchor_m[1] + sin * x + cos * y].map(round_to_mm)
    };
    Ok((0..lattice.total).map(position_m).collect())
}

/// A lattice about the origin, not turned.
struct Lattice {
    is_in_rows: bool,
    /// Distance between neighbours, m.
    spacing_m: f64,
    /// Distance between rows, or columns, m.
    row_m: f64,
    /// Agents of the longer row, or of a column.
    row_count: usize,
    total: usize,
    width_m: f64,
}

impl Lattice {
    fn new(is_in_rows: bool, density: f64, width_m: f64, population: usize) -> Self {
        let radius_m = 1.0 / (2.0 * density * 3.0_f64.sqrt()).sqrt();
        let (spacing_m, row_m) = (2.0 * radius_m, radius_m * 3.0_f64.sqrt());
        if !is_in_rows {
            let columns = ((width_m / row_m) as usize).max(1);
            let row_count = population / columns + 1;
            let total = columns.saturating_mul(row_count);
            return Self { is_in_rows, spacing_m, row_m, row_count, total, width_m: (columns - 1) as f64 * row_m };
        }
        let row_count = ((width_m / spacing_m) as usize).max(1);
        let pair = 2 * row_count - 1;
        let pairs = population / pair + 1;
        let total = pair.saturating_mul(pairs);
        // The last row is left out where the population needs no more.
        let total = if total - (row_count - 1) > population { total - (row_count - 1) } else { total };
        Self { is_in_rows, spacing_m, row_m, row_count, total, width_m: (row_count - 1) as f64 * spacing_m }
    }

    fn position_m(&self, index: usize) -> Point {
        let half_m = 0.5 * self.spacing_m;
        if !self.is_in_rows {
            let (column, row) = (index / self.row_count, index % self.row_count);
            let aside_m = if column % 2 == 1 { half_m } else { 0.0 };
            return [column as f64 * self.row_m, row as f64 * self.spacing_m + aside_m];
        }
        let pair = 2 * self.row_count - 1;
        let (band, within) = (index / pair, index % pair);
        let up_m = 2.0 * band as f64 * self.row_m;
        match within.checked_sub(self.row_count) {
            None => [within as f64 * self.spacing_m, up_m],
            Some(within) => [half_m + within as f64 * self.spacing_m, up_m + self.row_m],
        }
    }
}

/// Each position moved by a drawn distance in a drawn direction.
fn displaced(points_m: Vec<Point>, displaced_m: Option<DrawnNumber>, seed: usize) -> Vec<Point> {
    let Some(drawn) = displaced_m else { return points_m };
    let mut random = Random::new(seed as u64);
    let moved = |[x, y]: Point| {
        let distance_m = random.draw(drawn);
        let (sin, cos) = libm::sincos(std::f64::consts::TAU * random.unit());
        [x + distance_m * cos, y + distance_m * sin].map(round_to_mm)
    };
    points_m.into_iter().map(moved).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_of_a_lattice_hold_n_and_n_less_one() {
        let lattice = Lattice::new(true, 1.8, 4.0, 44);
        assert_eq!(lattice.row_count, 4);
        assert!(lattice.total >= 44, "{}", lattice.total);
        let row = |index: usize| (lattice.position_m(index)[1] / lattice.row_m).round() as usize;
        let rows: Vec<usize> = (0..14).map(row).collect();
        assert_eq!(rows, [0, 0, 0, 0, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3]);
    }

    #[test]
    fn columns_of_a_lattice_are_equal() {
        let lattice = Lattice::new(false, 1.8, 4.0, 100);
        assert_eq!(lattice.total % lattice.row_count, 0);
        assert!(lattice.position_m(lattice.row_count)[1] > 0.0);
    }
}

//! The least error of any blend: how near a weighted mean of examples comes to another example if its weights know it.
//!
//! Pose weights w_i ≥ 0 with Σ w_i = 1 keep planted feet where the root moves at (v_f, ω_t, ω_s) = p only if
//!
//! ```text
//! Σ w_i·P_i·(p_i − p) = 0,        P_i: period of example i, p_i: its parameters
//! ```
//!
//! (shares of time are u_i ∝ w_i·P_i, docs/definitions.md, "Blend"; half-strides of unequal duration are left out of
//! account). Among these weights, those with the least sum of squared distances between the mean joint positions and the
//! example's are found by non-negative least squares (Lawson and Hanson 1974, *Solving Least Squares Problems*, ch. 23).
//! So a choice of neighbours, or a rule for weights, hardly comes nearer at the pace of the clips. Hardly, because bodies
//! blend rotations: a mean of positions shortens bones. Of the Marine clips the best weights for positions are 5.3 cm off
//! in the median, the best for rotations 5.4. Root frame, metres.

use motiondb::body::JOINT_COUNT;
use motiondb::motion::{MotionDb, MotionExample, PHASE_COUNT};

/// Weight of the conditions against 1 m² of squared distance: they hold to a thousandth of an axis' range.
const CONDITION_WEIGHT: f64 = 1e6;
/// Greatest error of a condition, as a share of the axis' range times a second, at which weights exist.
const CONDITION_ERROR_MAX: f64 = 1e-3;
/// Gain below which a further example helps no more, as a share of the greatest at first.
const GAIN_MIN: f64 = 1e-9;
/// Greatest number of rounds of the search; each adds one example.
const ROUNDS_MAX: usize = 500;
/// Number of conditions: three axes, and the sum of the weights.
const CONDITIONS: usize = 4;

/// Least RMSE over all joints and phases between an example and a weighted mean of the examples of other windows, m;
/// `None` where no weights move the root as the example does.
pub(crate) fn least_rmse_m(db: &MotionDb, example: &MotionExample, positions_m: &[Vec<f64>]) -> Option<f64> {
    let index = db.examples.iter().position(|other| other.name == example.name)?;
    let is_other = |other: &usize| !db.examples[*other].is_of_one_window_with(example);
    let others: Vec<usize> = (0..db.examples.len()).filter(is_other).collect();
    let columns: Vec<Column> = others
        .iter()
        .map(|&other| Column {
            positions_m: &positions_m[other],
            conditions: conditions(db, &db.examples[other], example),
        })
        .collect();
    let goal = Column { positions_m: &positions_m[index], conditions: [0.0, 0.0, 0.0, 1.0] };
    let weights = non_negative_least_squares(&columns, &goal);
    let condition =
        |row: usize| columns.iter().zip(&weights).map(|(column, w)| w * column.conditions[row]).sum::<f64>();
    let hold = (0..CONDITIONS).all(|row| (condition(row) - goal.conditions[row]).abs() < CONDITION_ERROR_MAX);
    let off_m = |row: usize| {
        let mean_m: f64 = columns.iter().zip(&weights).map(|(column, w)| w * column.positions_m[row]).sum();
        mean_m - goal.positions_m[row]
    };
    let squares: f64 = (0..goal.positions_m.len()).map(|row| off_m(row) * off_m(row)).sum();
    hold.then(|| (squares / (PHASE_COUNT * JOINT_COUNT) as f64).sqrt())
}

/// Coordinates of all joints in all rows of each example, m.
pub(crate) fn positions_m(db: &MotionDb) -> Vec<Vec<f64>> {
    let of_example = |example: usize| {
        let rows = db.posed_rows(example);
        rows.iter().flat_map(|joints| joints.positions_m).flat_map(|at_m| at_m.to_array()).map(f64::from).collect()
    };
    (0..db.examples.len()).map(of_example).collect()
}

/// One example in the least squares.
struct Column<'a> {
    positions_m: &'a [f64],
    conditions: [f64; CONDITIONS],
}

impl Column<'_> {
    fn dot(&self, other: &Self) -> f64 {
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        dot(self.positions_m, other.positions_m) + CONDITION_WEIGHT * dot(&self.conditions, &other.conditions)
    }
}

/// P_i·(p_i − p), each axis divided by its range, and 1.
fn conditions(db: &MotionDb, other: &MotionExample, example: &MotionExample) -> [f64; CONDITIONS] {
    let [own, wanted] = [other, example].map(|example| db.blend_space.scaled(example.parameters).as_dvec3());
    let strides = f64::from(other.phase_map.period_s) * (own - wanted);
    [strides.x, strides.y, strides.z, 1.0]
}

/// Weights w ≥ 0 of the columns for which |Σ w·column − goal|² is least. Method: weights enter one by one, the one that
/// gains most first, and leave where the best solution would make them negative.
fn non_negative_least_squares(columns: &[Column], goal: &Column) -> Vec<f64> {
    let products: Vec<Vec<f64>> = columns.iter().map(|a| columns.iter().map(|b| a.dot(b)).collect()).collect();
    let wanted: Vec<f64> = columns.iter().map(|column| column.dot(goal)).collect();
    let gain_min = GAIN_MIN * wanted.iter().fold(0.0, |greatest: f64, gain| greatest.max(gain.abs()));
    let (mut weights, mut used) = (vec![0.0; columns.len()], Vec::new());
    for _ in 0..ROUNDS_MAX {
        let gain = |column: usize| {
            wanted[column] - weights.iter().zip(&products[column]).map(|(w, product)| w * product).sum::<f64>()
        };
        let unused = (0..columns.len()).filter(|column| !used.contains(column));
        let best = unused.map(|column| (gain(column), column)).max_by(|a, b| a.0.total_cmp(&b.0));
        let Some((_, column)) = best.filter(|best| best.0 > gain_min) else { break };
        used.push(column);
        settle(&products, &wanted, &mut used, &mut weights);
    }
    weights
}

/// Moves the weights of the used columns to their best solution; those that reach 0 on the way are used no more.
fn settle(products: &[Vec<f64>], wanted: &[f64], used: &mut Vec<usize>, weights: &mut [f64]) {
    loop {
        let solution = solved(products, wanted, used);
        let steps = used.iter().zip(&solution).filter(|(_, to)| **to <= 0.0);
        let share = steps.map(|(&column, to)| weights[column] / (weights[column] - to)).fold(1.0, f64::min);
        for (&column, to) in used.iter().zip(&solution) {
            weights[column] += share * (to - weights[column]);
        }
        if share == 1.0 {
            return;
        }
        used.retain(|&column| weights[column] > f64::EPSILON);
        (0..weights.len()).filter(|column| !used.contains(column)).for_each(|column| weights[column] = 0.0);
    }
}

/// Best weights of the used columns alone, of either sign: Gauss elimination with pivots from the diagonal, since the
/// products are positive definite.
fn solved(products: &[Vec<f64>], wanted: &[f64], used: &[usize]) -> Vec<f64> {
    let count = used.len();
    let row = |&column: &usize| used.iter().map(|&other| products[column][other]).chain([wanted[column]]).collect();
    let mut rows: Vec<Vec<f64>> = used.iter().map(row).collect();
    for pivot in 0..count {
        let (above, below) = rows.split_at_mut(pivot + 1);
        for row in below {
            let factor = row[pivot] / above[pivot][pivot];
            row.iter_mut().zip(&above[pivot]).skip(pivot).for_each(|(entry, of_pivot)| *entry -= factor * of_pivot);
        }
    }
    let mut solution = vec![0.0; count];
    for row in (0..count).rev() {
        let known: f64 = (row + 1..count).map(|column| rows[row][column] * solution[column]).sum();
        solution[row] = (rows[row][count] - known) / rows[row][row];
    }
    solution
}

#[cfg(test)]
mod tests {
    use super::*;

    fn column(positions_m: &[f64], condition: f64) -> Column<'_> {
        Column { positions_m, conditions: [condition, 0.0, 0.0, 1.0] }
    }

    #[track_caller]
    fn check_weights(columns: &[Column], goal: &Column, expected: &[f64]) {
        let weights = non_negative_least_squares(columns, goal);
        let off = weights.iter().zip(expected).map(|(found, wanted)| (found - wanted).abs()).fold(0.0, f64::max);
        assert!(off < 1e-5, "{weights:?}, not {expected:?}");
    }

    #[test]
    fn weights_are_never_negative() {
        let columns = [column(&[0.0, 0.0], 0.0), column(&[1.0, 0.0], 0.0), column(&[0.0, 1.0], 0.0)];
        check_weights(&columns, &column(&[0.25, 0.5], 0.0), &[0.25, 0.25, 0.5]);
        check_weights(&columns, &column(&[-1.0, 0.5], 0.0), &[0.5, 0.0, 0.5]);
    }

    #[test]
    fn conditions_hold_before_positions_fit() {
        let columns = [column(&[0.0, 0.0], -1.0), column(&[1.0, 0.0], 1.0), column(&[0.0, 1.0], 1.0)];
        check_weights(&columns, &column(&[0.9, 0.1], 0.0), &[0.5, 0.5, 0.0]);
    }
}

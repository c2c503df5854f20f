//! A grid in (v_f, ω_t, ω_s) that says which rates are near-equal.
//!
//! A cell is as wide as twice what the strides of one steady window may differ from their mean
//! ([`crate::gait::stride_spread`]): two windows in one cell differ no more than two strides of one window. Straight
//! ahead and standing are middles of cells.

use std::f64::consts::PI;

use glam::DVec3;

use crate::ground::root_arc::Rates;

/// Width of a cell in v_f and in ω_s, m/s.
const CELL_SPEED_MPS: f64 = 0.25;
/// Width of a cell in ω_t, rad/s: 30 °/s.
const CELL_TURN_RAD_S: f64 = 30.0 * PI / 180.0;

/// Rates (v_f, ω_t, ω_s) in widths of a cell.
pub(crate) fn in_cells(rates: &Rates) -> DVec3 {
    let widths = DVec3::new(CELL_SPEED_MPS, CELL_TURN_RAD_S, CELL_SPEED_MPS);
    DVec3::new(rates.speed_mps, rates.turn_rate_rad_s, rates.strafe_mps) / widths
}

/// The middle of the cell that some rates lie in, in widths of a cell.
pub(crate) fn cell_middle(rates: &Rates) -> DVec3 {
    in_cells(rates).round()
}

/// Distance of rates from the middle of their cell: 1 at its border.
pub(crate) fn distance_from_middle(rates: &Rates) -> f64 {
    2.0 * (in_cells(rates) - cell_middle(rates)).abs().max_element()
}

/// Whether rates differ by no more than half a cell on every axis, wherever the borders of the cells lie.
pub(crate) fn are_near_equal(a: &Rates, b: &Rates) -> bool {
    (in_cells(a) - in_cells(b)).abs().max_element() <= 0.5
}

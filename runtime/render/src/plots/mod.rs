//! Plots. `chart` draws axes, marks and labels; `crowd` and `database` draw what people look at.

pub mod chart;
pub mod crowd;
pub mod database;

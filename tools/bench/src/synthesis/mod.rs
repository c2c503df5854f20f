//! Benches of synthesis: single bodies on open ground, each of which follows commands.
//!
//! Enters: a database. Leaves: whether bodies reach their commands ([`blend`]), how closely they follow ([`tracking`]),
//! how far one walk can be deformed ([`reach`]), and whether bodies keep human poses ([`quality`]; the commands are in
//! [`command_sequences`], the steps in [`sequence_walk`], the measures in [`quality_figures`]).

pub mod blend;
pub(crate) mod command_sequences;
pub mod quality;
pub mod quality_figures;
pub mod reach;
pub(crate) mod sequence_walk;
pub mod tracking;

//! Claims about the simulation that need compiled clips or generated worlds.

mod augmented_database;
mod clips;
mod crowds;
mod generated;
mod hybrid;
mod linear_programs;
mod random_plans;
mod replay;
mod semi_procedural;
mod stops;
#[path = "../support/mod.rs"]
mod support;
mod synthesis;

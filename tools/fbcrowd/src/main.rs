//! The command line over clips, databases, simulations and pictures.
fn main() {}

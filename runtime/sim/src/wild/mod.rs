//! Worlds and programs that nobody would make, drawn by chance, and what is wrong with what is planned in them: for
//! tests, and in full for `fbcrowd bench soak`.

pub mod program;
pub mod turned_world;
pub mod world;

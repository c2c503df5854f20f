//! The motion database: examples of human motion, and everything that the offline compiler and the runtime share.
//!
//! A database holds closed, phase-aligned cycles of motion (the *examples*), recorded motions that are no cycles (the
//! *actions*), the velocities at which a body can move with them ([`VelocityHull`]), the simplices between them
//! ([`BlendSpace`]) and the times in the cycle at which synthesis can switch from one example to another
//! ([`Correspondence`]). The file format is `.fbdb`.
//!
//! Load a database, print its examples, blend a turn, and print the coverage gaps:
//!
//! ```no_run
//! use std::path::Path;
//!
//! use motiondb::files::database_file::{self, FileError};
//! use motiondb::quality::coverage::coverage;
//! use motiondb::Parameters;
//!
//! fn main() -> Result<(), FileError> {
//!     let (db, _checksum) = database_file::load(Path::new("motion.fbdb"))?;
//!     for example in &db.examples {
//!         let Parameters { speed_mps, turn_rate_rad_s, strafe_mps } = example.parameters;
//!         println!("{}: {speed_mps:.2} m/s, {turn_rate_rad_s:.2} rad/s, {strafe_mps:.2} m/s", example.name);
//!     }
//!
//!     // Which examples make a slow left turn, and with which shares?
//!     let turn = Parameters { speed_mps: 1.0, turn_rate_rad_s: 0.5, strafe_mps: 0.0 };
//!     match db.locator().locate_inside(turn) {
//!         Some(shares) => println!("blended from examples {:?}, shares {:?}", shares.examples, shares.shares),
//!         None => println!("outside the examples"),
//!     }
//!     for gap in coverage(&db) {
//!         println!("{}", gap.sentence);
//!     }
//!     Ok(())
//! }
//! ```
//!
//! Chapters, in reading order: [`body`] (skeleton, poses, forward kinematics), [`diagnostic`] (what the compiler
//! reports about clips), [`motion`] (parameters, examples, the database, switching times), [`velocity_sets`] (`FbCrowd`
//! §4.1), [`blend_space`] (§5), [`quality`], [`validate`] (the invariants), [`character`]
//! (meshes that bodies wear), [`files`], [`memory`] and [`statistics`].
//!
//! Conventions: metres, seconds, radians; x and y on the ground, z up, right-handed. A body's frame: x forward, y left.
//! Angles are counter-clockwise seen from above. Pairs of sides are `[left, right]`.

pub mod blend_space;
pub mod body;
pub mod character;
pub mod diagnostic;
pub mod files;
pub mod memory;
pub mod motion;
pub mod quality;
pub mod statistics;
pub mod validate;
pub mod velocity_sets;

pub use blend_space::{BlendSpace, Locator, Shares};
pub use body::{Foot, JOINT_COUNT, Joint, Joints, Pose, Root, RootFrame, Side, Skeleton};
pub use diagnostic::Diagnostic;
pub use files::atomic_file::AtomicFile;
pub use motion::{
    Action, ActionKind, Correspondence, MotionDb, MotionExample, PHASE_COUNT, Parameters, PhaseMap, Rows, SourceRecord,
};
pub use velocity_sets::velocity_hull::{Construction, VelocityHull};

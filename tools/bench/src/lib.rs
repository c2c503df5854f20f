//! Benches: what a release must meet, each a function from its arguments to a report.
//!
//! A bench measures one thing and holds it against *criteria*, which decide whether the release is good, and *goals*:
//! durations and sizes that depend on the machine. It prints nothing; its progress goes to an observer.
//!
//! ```no_run
//! use clap::Parser;
//! use fbcrowd_bench::Bench;
//!
//! #[derive(Parser)]
//! struct Command {
//!     #[command(subcommand)]
//!     bench: Bench,
//! }
//!
//! # fn main() -> Result<(), fbcrowd_bench::BenchError> {
//! let report = Command::parse_from(["bench", "reach"]).bench.run(&|_| ())?;
//! println!("{}", report.text);
//! assert!(report.all_met);
//! # Ok(())
//! # }
//! ```
//!
//! Read in this order: [`kit`], which all benches share; the compiler's benches ([`compiler`]); durations ([`speed`]);
//! single bodies ([`synthesis`]); crowds ([`paper`], [`pedestrians`]); bodies as people ([`people`]); hostile input ([`soak`]).

#![allow(rustdoc::private_intra_doc_links, reason = "the docs of a folder name all of its files")]

pub mod compiler;
pub mod error;
pub mod kit;
pub mod paper;
pub mod pedestrians;
pub mod people;
pub mod soak;
pub mod speed;
pub mod synthesis;

/// The example of the README, which must compile.
#[cfg(doctest)]
#[doc = include_str!("../../../README.md")]
struct ReadmeExample;

use fbcrowd_jobs::Observer;
use fbcrowd_jobs::json_schema::document;

use crate::compiler::{clips, compile, gait, import, leave_one_out};
pub use crate::error::BenchError;
use crate::kit::report::{BenchReport, PrintableReport};
use crate::paper::{coupled, course, figure6, figure7, scenes, table1};
use crate::pedestrians::{emergence, rimea};
use crate::people::as_people;
use crate::speed::{blend_space, bodies, plan, render, routes};
use crate::synthesis::{blend, quality, reach, tracking};

/// Makes [`Bench`] from the table of benches: variant, name on the command line, module.
macro_rules! benches {
    ($($variant:ident, $name:literal => $bench:ident;)*) => {
        /// Every bench, with its arguments.
        #[derive(clap::Subcommand)]
        #[allow(missing_docs, reason = "the arguments are documented in their modules")]
        pub enum Bench {
            $(#[command(name = $name)] $variant($bench::Args),)*
        }

        impl Bench {
            /// Name and JSON schema of every bench.
            pub fn schemas() -> Vec<(&'static str, serde_json::Value)> {
                vec![$((
                    $name,
                    document::<BenchReport<$bench::Details>>(concat!("fbcrowd bench ", $name, " --json")),
                )),*]
            }

            /// Runs the bench.
            ///
            /// # Errors
            /// If its input cannot be read, or an output cannot be written.
            pub fn run(&self, observer: &Observer) -> Result<PrintableReport, BenchError> {
                match self {
                    $(Self::$variant(args) => Ok($bench::run(args, observer)?.into()),)*
                }
            }
        }
    };
}

benches! {
    Import, "import" => import;
    Compile, "compile" => compile;
    LeaveOneOut, "leave-one-out" => leave_one_out;
    Gait, "gait" => gait;
    Clips, "clips" => clips;
    BlendSpace, "blend-space" => blend_space;
    Plan, "plan" => plan;
    Bodies, "bodies" => bodies;
    Routes, "routes" => routes;
    Render, "render" => render;
    Figure6, "figure6" => figure6;
    Blend, "blend" => blend;
    Tracking, "tracking" => tracking;
    Reach, "reach" => reach;
    Quality, "quality" => quality;
    People, "people" => as_people;
    Table1, "table1" => table1;
    Figure7, "figure7" => figure7;
    Course, "course" => course;
    Scenes, "scenes" => scenes;
    Coupled, "coupled" => coupled;
    Rimea, "rimea" => rimea;
    Emergence, "emergence" => emergence;
    Soak, "soak" => soak;
}

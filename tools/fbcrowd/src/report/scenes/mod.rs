//! The report of a converted scene.
//!
//! In: a scene and the paths of what was written. Out: a struct that serialises, and its text.

mod convert_report;

pub(crate) use convert_report::ConvertReport;

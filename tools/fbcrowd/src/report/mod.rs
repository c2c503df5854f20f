//! Reports: the JSON of each command for programs, and its text for people.
//!
//! In: values of the libraries and jobs. Out: structs that serialise (`…_report`), and texts (`…_text`, `…_table`).
//! Field names carry their units. Nothing here prints.
//!
//! Read in this order: [`plain_text`]; the report of a compilation ([`compile_report`], [`compile_text`] with
//! [`example_table`], [`motion`] and [`sentence_groups`], [`next_steps`]); of an inspection ([`inspect_report`],
//! [`inspect_text`], [`correspondence_table`], [`leave_one_out_text`]; [`json_diagnostic`] is a part of both); of a
//! character ([`character_report`]); of a validation ([`validation_report`]); of a converted scene ([`scenes`]); of
//! scenarios, simulations and recordings ([`crowd`]).

pub(crate) mod character_report;
pub(crate) mod compile_report;
pub(crate) mod compile_text;
pub(crate) mod correspondence_table;
pub(crate) mod crowd;
pub(crate) mod example_table;
pub(crate) mod inspect_report;
pub(crate) mod inspect_text;
pub(crate) mod json_diagnostic;
pub(crate) mod leave_one_out_text;
pub(crate) mod motion;
pub(crate) mod next_steps;
pub(crate) mod plain_text;
pub(crate) mod scenes;
pub(crate) mod sentence_groups;
pub(crate) mod validation_report;

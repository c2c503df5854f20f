//! What a database holds, as the reports of a compilation and of an inspection both show it.
//!
//! In: a database. Out: its actions ([`action_report`]), its joints beside the 22 roles ([`extra_joint_report`]) and its
//! styles ([`style_report`]).

pub(crate) mod action_report;
pub(crate) mod extra_joint_report;
pub(crate) mod style_report;

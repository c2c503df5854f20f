//! JSON schemas of the reports: derived from their structs, whose doc comments become the descriptions.
//!
//! The structs of the libraries below derive no schema, so that the runtime does not depend on `schemars`. Instead each
//! has a mirror here: a struct of the same fields with a description each, which is never made. A field of a library
//! type names its mirror (`#[schemars(with = "…")]`). The tests of the command line validate real output against the
//! schemas, which allow no other keys and no missing ones; so a mirror that differs from its original fails.
//!
//! Read [`document`] first; then the mirrors: [`measures`] and [`people`] (simulation), [`motion`] (motion databases), [`survey`]
//! (compiler).

pub mod measures;
pub mod motion;
pub mod people;
pub mod survey;

use schemars::generate::SchemaSettings;
use schemars::transform::{RecursiveTransform, Transform};
use schemars::{JsonSchema, Schema};
use serde_json::Value;

/// The schema of a report, under a title. Objects have exactly the keys of the schema.
pub fn document<T: JsonSchema>(title: &str) -> Value {
    let mut schema = SchemaSettings::draft2020_12().for_serialize().into_generator().into_root_schema_for::<T>();
    RecursiveTransform(close_object).transform(&mut schema);
    schema.insert("title".to_owned(), title.into());
    schema.to_value()
}

/// Allows no other keys in an object.
fn close_object(schema: &mut Schema) {
    if schema.get("properties").is_some() {
        schema.insert("additionalProperties".to_owned(), false.into());
    }
}

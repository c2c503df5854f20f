//! The `[[characters]]` tables of a scenario file, and `characters` of agents, sources and profiles.
//!
//! ```toml
//! [[characters]]
//! file = "figures/woman.glb"          # *.glb, *.gltf, *.vrm or *.fbchar, relative to this file
//! name = "woman"                      # default: the file's stem
//! weight = 2                          # default 1
//! hue_variation_deg = 20              # default 0
//! hide = ["Sword"]                    # meshes that are left out; default none
//! [profiles.adult]
//! characters = ["woman"]              # default: all
//! ```

use std::path::{Path, PathBuf};

use motiondb::files::SourceText;
use serde::Deserialize;
use toml::Spanned;

use crate::scenario::characters::character_check::check_characters;
use crate::scenario::characters::character_spec::CharacterSpec;
use crate::scenario::error::ScenarioError;
use crate::scenario::fault::{ScenarioFault, TableFault};

/// One `[[characters]]` table, as written.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct CharacterTable {
    file: Spanned<PathBuf>,
    name: Option<String>,
    weight: Option<f32>,
    hue_variation_deg: Option<f32>,
    #[serde(default)]
    hide: Vec<String>,
}

/// The file of a character, and the meshes of it that are left out.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CharacterFile {
    /// The file, relative to the scenario's folder or absolute.
    pub path: PathBuf,
    /// Names of the meshes that are left out.
    pub hide: Vec<String>,
}

/// The characters of all tables.
pub(crate) fn characters(tables: &[Spanned<CharacterTable>]) -> Result<Vec<CharacterSpec>, ScenarioFault> {
    let specs: Vec<CharacterSpec> = tables.iter().map(|table| spec(table.get_ref())).collect();
    check_characters(&specs)?;
    Ok(specs)
}

fn spec(table: &CharacterTable) -> CharacterSpec {
    let stem = || table.file.get_ref().file_stem().unwrap_or_default().to_string_lossy().into_owned();
    CharacterSpec {
        name: table.name.clone().unwrap_or_else(stem),
        weight: table.weight.unwrap_or(1.0),
        hue_variation_deg: table.hue_variation_deg.unwrap_or(0.0),
        size: None,
    }
}

/// The files of all tables, in their order.
///
/// # Errors
/// Where one does not exist.
pub(crate) fn files(
    source: &SourceText,
    tables: &[Spanned<CharacterTable>],
) -> Result<Vec<CharacterFile>, ScenarioError> {
    let file = |table: &Spanned<CharacterTable>| {
        let named = &table.get_ref().file;
        let path = source.beside(Path::new(named.get_ref()));
        match path.is_file() {
            true => Ok(CharacterFile { path, hide: table.get_ref().hide.clone() }),
            false => {
                let message = format!("{} is no file", path.display());
                Err(source.invalid(named.span(), message, "give a path relative to the scenario file").into())
            }
        }
    };
    tables.iter().map(file).collect()
}

/// The set of characters that a list names, as bits.
pub(crate) fn set_of(names: &[String], characters: &[CharacterSpec]) -> Result<u64, TableFault> {
    let bit = |name: &String| match characters.iter().position(|character| character.name == *name) {
        Some(index) => Ok(1 << index),
        None => Err((format!("there is no character `{name}`"), "name a `[[characters]]` table")),
    };
    if names.is_empty() {
        return Err(("`characters` names none".into(), "name one or more, or leave the key out"));
    }
    names.iter().map(bit).try_fold(0, |set, bit| Ok(set | bit?))
}

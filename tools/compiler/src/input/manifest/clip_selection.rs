//! `[[clips]]` tables and the folder of the manifest → settings of every clip that is used.

use std::path::{Component, Path, PathBuf};

use motiondb::files::{Invalid, SourceText};
use toml::Spanned;

use crate::error::CompileError;
use crate::input::clip_files;
use crate::input::clip_settings::ClipSettings;
use crate::input::manifest::clips_table::ClipsTable;

/// Settings of all clips below the manifest's folder or named by a table, except those whose innermost table skips
/// them.
pub(crate) fn selected_clips(
    source: &SourceText,
    tables: &[Spanned<ClipsTable>],
) -> Result<Vec<ClipSettings>, CompileError> {
    let (mut files, mut folder_tables, mut own_tables) = (Vec::new(), Vec::new(), Vec::new());
    for table in tables {
        let path = existing_path(source, table)?;
        if or_current_folder(&path).is_dir() {
            table.get_ref().check_folder(source)?;
            files.extend(clips_below(&path)?);
            folder_tables.push((path, table));
        } else {
            own_tables.push((path, Some(table)));
        }
    }
    files.extend(clips_below(&normal_path(&source.beside(Path::new(""))))?);
    // A later table overrides an earlier one: the innermost folder comes last.
    folder_tables.sort_by_key(|(folder, _)| folder.components().count());
    files.retain(|file| !own_tables.iter().any(|(path, _)| path == file));
    files.sort();
    files.dedup();
    let all = own_tables.into_iter().chain(files.into_iter().map(|file| (file, None)));
    let mut clips: Vec<ClipSettings> =
        all.filter_map(|(path, own_table)| settings(path, own_table, &folder_tables)).collect();
    sort(&mut clips);
    Ok(clips)
}

/// Sorts clips by file name, then by path. Clips of one file keep their order.
pub(crate) fn sort(clips: &mut [ClipSettings]) {
    clips.sort_by(|a, b| (a.path.file_name(), &a.path).cmp(&(b.path.file_name(), &b.path)));
}

/// The path without `.`, so that each file has one path.
pub(crate) fn normal_path(path: &Path) -> PathBuf {
    path.components().filter(|part| !matches!(part, Component::CurDir)).collect()
}

/// A stated path that is absolute or leads over `..`, as the listing of the manifest's folder has it; none for other paths,
/// and for what is not in that folder.
fn below_manifest(source: &SourceText, stated: &Path) -> Option<PathBuf> {
    if !stated.components().any(|part| matches!(part, Component::ParentDir | Component::RootDir)) {
        return None;
    }
    let folder = normal_path(&source.beside(Path::new("")));
    let path = source.beside(stated);
    let real_folder = or_current_folder(&folder).canonicalize().ok()?;
    // The last part may be a link, which the listing has by its own name.
    let real_path = match (path.parent(), path.file_name()) {
        (Some(parent), Some(name)) => parent.canonicalize().ok()?.join(name),
        _ => path.canonicalize().ok()?,
    };
    Some(folder.join(real_path.strip_prefix(real_folder).ok()?))
}

/// The file or folder that a table names.
fn existing_path(source: &SourceText, table: &Spanned<ClipsTable>) -> Result<PathBuf, Invalid> {
    let stated = &table.get_ref().path;
    let path =
        below_manifest(source, stated.get_ref()).unwrap_or_else(|| normal_path(&source.beside(stated.get_ref())));
    if or_current_folder(&path).exists() {
        return Ok(path);
    }
    let message = format!("there is no {}", path.display());
    Err(source.invalid(stated.span(), message, "correct the path; it is relative to the manifest"))
}

/// Settings of a file by the tables of its folders, then by its own table; none where the last table skips the file.
fn settings(
    path: PathBuf,
    own_table: Option<&Spanned<ClipsTable>>,
    folder_tables: &[(PathBuf, &Spanned<ClipsTable>)],
) -> Option<ClipSettings> {
    let outer = folder_tables.iter().filter(|(folder, _)| path.starts_with(folder)).map(|(_, table)| *table);
    let tables: Vec<&Spanned<ClipsTable>> = outer.chain(own_table).collect();
    if tables.last().is_some_and(|table| table.get_ref().skip) {
        return None;
    }
    let mut settings = ClipSettings::from(path);
    for table in tables {
        table.get_ref().override_settings(table.span(), &mut settings);
    }
    Some(settings)
}

fn clips_below(folder: &Path) -> Result<Vec<PathBuf>, CompileError> {
    Ok(clip_files::clip_files(&or_current_folder(folder))?.iter().map(|file| normal_path(file)).collect())
}

/// The current folder in place of an empty path.
fn or_current_folder(path: &Path) -> PathBuf {
    if path.as_os_str().is_empty() { PathBuf::from(".") } else { path.to_owned() }
}

//! Files that a project names: relative to the file that names them, inside the project's folder, within limits.

use std::path::{Path, PathBuf};

use motiondb::files::SourceText;

use crate::error::{SceneError, read_text};
use crate::menge::xml::{Element, XmlFile};

/// Greatest length of all files together, bytes: that of the agent files of a scenario.
const TEXT_MAX_BYTES: usize = 64 << 20;

/// The files of a project.
pub(crate) struct ProjectFiles {
    /// The folder, with all links followed.
    root: PathBuf,
    /// The folder as it was named.
    folder: PathBuf,
    allow_outside: bool,
    /// All files that were read or only found, which no output may replace.
    pub(crate) inputs: Vec<PathBuf>,
    bytes: usize,
}

impl ProjectFiles {
    /// The files beside and below a project file.
    pub(crate) fn new(project: &Path, allow_outside: bool) -> Result<Self, SceneError> {
        let folder = project.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let unreadable = |source| SceneError::Unreadable { path: project.to_owned(), source };
        let root = folder.canonicalize().map_err(unreadable)?;
        Ok(Self { root, folder: folder.to_owned(), allow_outside, inputs: vec![project.to_owned()], bytes: 0 })
    }

    /// The project file.
    pub(crate) fn project(&mut self, path: &Path) -> Result<XmlFile, SceneError> {
        let source = read_text(path)?;
        self.bytes += source.text.len();
        let shown = self.shown(path);
        Ok(XmlFile::new(source, shown))
    }

    /// The XML file that an attribute names.
    pub(crate) fn xml(&mut self, element: &Element<'_>, attribute: &str) -> Result<XmlFile, SceneError> {
        let source = self.text(element, attribute)?;
        let shown = self.shown(&source.path);
        Ok(XmlFile::new(source, shown))
    }

    /// The text that an attribute names.
    pub(crate) fn text(&mut self, element: &Element<'_>, attribute: &str) -> Result<SourceText, SceneError> {
        let path = self.find(element, attribute)?;
        let source = read_text(&path)?;
        self.bytes += source.text.len();
        if self.bytes > TEXT_MAX_BYTES {
            let message = format!("with this file the project has more than {} MiB", TEXT_MAX_BYTES >> 20);
            return Err(element.attribute_fault(attribute, message, "name smaller files"));
        }
        Ok(source)
    }

    /// The path that an attribute names; the file exists.
    pub(crate) fn find(&mut self, element: &Element<'_>, attribute: &str) -> Result<PathBuf, SceneError> {
        // Projects that were written on Windows.
        let named = element.required(attribute)?.trim().replace('\\', "/");
        let path = element.file.source.beside(Path::new(&named));
        let Ok(found) = path.canonicalize() else {
            let message = format!("{} does not exist", path.display());
            return Err(element.attribute_fault(attribute, message, "give a path relative to this file"));
        };
        if !self.allow_outside && !found.starts_with(&self.root) {
            let message = format!("{} lies outside the project's folder {}", path.display(), self.folder.display());
            return Err(element.attribute_fault(attribute, message, "allow it with --allow-outside"));
        }
        if !self.inputs.contains(&path) {
            self.inputs.push(path.clone());
        }
        Ok(path)
    }

    /// A path as notes show it: relative to the project's folder.
    pub(crate) fn shown(&self, path: &Path) -> String {
        path.strip_prefix(&self.folder).unwrap_or(path).display().to_string()
    }
}

//! XML of a project: elements with typed attributes; every mistake is shown at its line.

use motiondb::files::{Invalid, SourceText};
use roxmltree::{Document, Node, ParsingOptions};

use crate::error::SceneError;
use crate::scene::DrawnNumber;

/// Greatest number of nodes of a file: a million agents, each between two texts.
const NODES_MAX: u32 = 4_000_000;
/// Greatest number: whole numbers up to it are exact in f64 and TOML.
const NUMBER_MAX: f64 = 1e15;
/// Greatest coordinate, m; that of scenario files.
const COORDINATE_MAX_M: f64 = 10_000.0;

/// An XML file of a project.
pub(crate) struct XmlFile {
    /// The text.
    pub(crate) source: SourceText,
    /// Path as notes show it, relative to the project's folder.
    pub(crate) shown: String,
    /// First byte of each line.
    lines: Vec<usize>,
}

impl XmlFile {
    pub(crate) fn new(source: SourceText, shown: String) -> Self {
        let breaks = source.text.bytes().enumerate().filter(|(_, byte)| *byte == b'\n').map(|(index, _)| index + 1);
        Self { lines: [0].into_iter().chain(breaks).collect(), source, shown }
    }

    /// The parsed file. Entities of a document type are refused: they may grow without bound.
    pub(crate) fn document(&self) -> Result<Document<'_>, SceneError> {
        let options = ParsingOptions { allow_dtd: false, nodes_limit: NODES_MAX, ..ParsingOptions::default() };
        Document::parse_with_options(&self.source.text, options).map_err(|error| {
            let position = error.pos();
            let line = (position.row as usize).clamp(1, self.lines.len());
            let begin = self.lines[line - 1];
            let length = self.source.text[begin..].lines().next().map_or(0, str::len);
            let help = "correct the file, or name another one; a document type is not read";
            let message = format!("this is no XML that can be read: {error}");
            let is_quotable = self.source.text.trim_start().starts_with('<');
            Invalid { is_quotable, ..self.source.invalid(begin..begin + length, message, help) }.into()
        })
    }

    /// The first element of a kind, as the root of the file.
    pub(crate) fn root<'a>(&'a self, document: &'a Document<'_>, name: &str) -> Result<Element<'a>, SceneError> {
        let root = Element { node: document.root_element(), file: self };
        if root.name() == name {
            return Ok(root);
        }
        let message = format!("the file begins with <{}>, not with <{name}>", root.name());
        Err(root.fault(message, "name the project file of a Menge scene, or the file that belongs here"))
    }
}

/// An element, its file and its position.
#[derive(Clone, Copy)]
pub(crate) struct Element<'a> {
    node: Node<'a, 'a>,
    pub(crate) file: &'a XmlFile,
}

impl<'a> Element<'a> {
    pub(crate) fn name(&self) -> &'a str {
        self.node.tag_name().name()
    }

    /// The elements inside, in order; text between them is ignored.
    pub(crate) fn children(&self) -> impl Iterator<Item = Element<'a>> + use<'a> {
        let file = self.file;
        self.node.children().filter(Node::is_element).map(move |node| Element { node, file })
    }

    /// The elements inside that have a name.
    pub(crate) fn named(&self, name: &'static str) -> impl Iterator<Item = Element<'a>> + use<'a> {
        self.children().filter(move |child| child.name() == name)
    }

    /// The first element inside that has a name.
    pub(crate) fn child(&self, name: &'static str) -> Option<Element<'a>> {
        self.named(name).next()
    }

    /// Line of the element, from 1.
    pub(crate) fn line(&self) -> usize {
        self.file.lines.partition_point(|begin| *begin <= self.node.range().start)
    }

    /// "file:line".
    pub(crate) fn origin(&self) -> String {
        format!("{}:{}", self.file.shown, self.line())
    }

    /// The value of `type`; empty without it.
    pub(crate) fn kind(&self) -> &'a str {
        self.text("type").unwrap_or_default()
    }

    pub(crate) fn text(&self, attribute: &str) -> Option<&'a str> {
        self.node.attribute(attribute)
    }

    pub(crate) fn required(&self, attribute: &str) -> Result<&'a str, SceneError> {
        self.text(attribute).ok_or_else(|| {
            let message = format!("<{}> has no attribute `{attribute}`", self.name());
            self.fault(message, "add the attribute")
        })
    }

    pub(crate) fn number(&self, attribute: &str) -> Result<Option<f64>, SceneError> {
        let Some(text) = self.text(attribute) else { return Ok(None) };
        match text.trim().parse::<f64>() {
            Ok(number) if number.abs() <= NUMBER_MAX => Ok(Some(number)),
            _ => {
                let message = format!("`{attribute}` of <{}> is no finite number, or too great", self.name());
                Err(self.attribute_fault(attribute, message, "write a decimal number"))
            }
        }
    }

    pub(crate) fn required_number(&self, attribute: &str) -> Result<f64, SceneError> {
        self.required(attribute)?;
        Ok(self.number(attribute)?.unwrap_or_default())
    }

    /// A coordinate or length, m.
    pub(crate) fn metres(&self, attribute: &str) -> Result<f64, SceneError> {
        let metres = self.required_number(attribute)?;
        if metres.abs() <= COORDINATE_MAX_M {
            return Ok(metres);
        }
        let message = format!("`{attribute}` is {metres} m, not within 10 km of the origin");
        Err(self.attribute_fault(attribute, message, "give metres, near the origin"))
    }

    /// Two coordinates, m.
    pub(crate) fn point(&self, x: &str, y: &str) -> Result<[f64; 2], SceneError> {
        Ok([self.metres(x)?, self.metres(y)?])
    }

    pub(crate) fn count(&self, attribute: &str) -> Result<Option<u64>, SceneError> {
        let Some(number) = self.number(attribute)? else { return Ok(None) };
        if number >= 0.0 && number.fract() == 0.0 {
            return Ok(Some(number as u64));
        }
        let message = format!("`{attribute}` of <{}> is {number}, no count", self.name());
        Err(self.attribute_fault(attribute, message, "write a whole number, 0 or more"))
    }

    /// A flag: `1`, `true`, `0`, `false`.
    pub(crate) fn flag(&self, attribute: &str, default: bool) -> Result<bool, SceneError> {
        match self.text(attribute).map(str::trim) {
            None => Ok(default),
            Some("true") => Ok(true),
            Some("false") => Ok(false),
            Some(_) => Ok(self.number(attribute)?.unwrap_or_default() != 0.0),
        }
    }

    /// A number that is fixed or drawn: `dist`, and `value`, or `min` and `max`, or `mean` and `stddev`, each behind a
    /// prefix.
    pub(crate) fn drawn(&self, prefix: &str) -> Result<Option<DrawnNumber>, SceneError> {
        let key = |name: &str| format!("{prefix}{name}");
        let Some(kind) = self.text(&key("dist")) else { return Ok(None) };
        let drawn = match kind {
            "c" => DrawnNumber::Constant(self.required_number(&key("value"))?),
            "u" => {
                let [a, b] = [self.required_number(&key("min"))?, self.required_number(&key("max"))?];
                DrawnNumber::Uniform { from: a.min(b), to: a.max(b) }
            }
            "n" => {
                let (mean, deviation) = (self.required_number(&key("mean"))?, self.required_number(&key("stddev"))?);
                let (mut min, mut max) = (self.number(&key("min"))?, self.number(&key("max"))?);
                if min.zip(max).is_some_and(|(min, max)| min > max) {
                    (min, max) = (max, min);
                }
                DrawnNumber::Normal { mean, deviation: deviation.abs(), min, max }
            }
            _ => {
                let message = format!("the distribution `{kind}` is unknown");
                let help = "write `c` (constant), `u` (uniform) or `n` (normal)";
                return Err(self.attribute_fault(&key("dist"), message, help));
            }
        };
        Ok(Some(drawn))
    }

    /// A mistake of this element, at its start tag.
    pub(crate) fn fault(&self, message: impl Into<String>, help: &str) -> SceneError {
        let start = self.node.range().start;
        self.file.source.invalid(start..start + 1 + self.name().len(), message, help).into()
    }

    /// A mistake of an attribute.
    pub(crate) fn attribute_fault(&self, attribute: &str, message: impl Into<String>, help: &str) -> SceneError {
        match self.node.attribute_node(attribute) {
            Some(found) => self.file.source.invalid(found.range(), message, help).into(),
            None => self.fault(message, help),
        }
    }
}

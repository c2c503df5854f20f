//! Notes: what a scenario cannot say as the source says it.

/// One note.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Note {
    /// File of the source.
    pub file: String,
    /// Its line, from 1; 0: the whole file.
    pub line: usize,
    /// Number of lines that give the same note.
    pub count: usize,
    /// What is not supported, and what the scenario says instead.
    pub what: String,
    /// Whether it changes what happens.
    pub changes: bool,
}

/// Greatest number of different notes; the rest is counted.
const NOTES_MAX: usize = 1_000;

/// The notes of a scene, in order; equal ones of a file are counted.
#[derive(Clone, Debug, Default)]
pub struct Notes {
    notes: Vec<Note>,
    left_out: usize,
    left_out_changes: bool,
}

impl Notes {
    /// Adds a note.
    pub fn add(&mut self, file: &str, line: usize, what: impl Into<String>, changes: bool) {
        let what = what.into();
        let same = |note: &&mut Note| note.file == file && note.what == what && note.changes == changes;
        if let Some(note) = self.notes.iter_mut().find(same) {
            note.count += 1;
        } else if self.notes.len() < NOTES_MAX {
            self.notes.push(Note { file: file.to_owned(), line, count: 1, what, changes });
        } else {
            self.left_out += 1;
            self.left_out_changes |= changes;
        }
    }

    /// All notes.
    pub fn list(&self) -> Vec<Note> {
        let mut notes = self.notes.clone();
        if self.left_out > 0 {
            notes.push(Note {
                file: String::new(),
                line: 0,
                count: self.left_out,
                what: "further notes are left out".to_owned(),
                changes: self.left_out_changes,
            });
        }
        notes
    }

    /// Whether a note changes what happens.
    pub fn change_what_happens(&self) -> bool {
        self.left_out_changes || self.notes.iter().any(|note| note.changes)
    }
}

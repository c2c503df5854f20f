//! Findings: measures beyond their thresholds, of an example or of an action.

use serde::Serialize;

/// A measure beyond its threshold.
///
/// ```no_run
/// use motiondb::MotionDb;
/// use motiondb::quality::example_quality::lint;
///
/// fn print_findings(db: &MotionDb) {
///     for finding in lint(db) {
///         println!("{}: {}", finding.example, finding.sentence);
///     }
/// }
/// ```
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Finding {
    /// Name of the example, or of the action.
    pub example: String,
    /// Name of the measure: its field in [`ExampleQuality`](crate::quality::example_quality::ExampleQuality) or
    /// [`ActionQuality`](crate::quality::action_quality::ActionQuality).
    pub measure: &'static str,
    /// Value of the measure.
    pub value: f32,
    /// Threshold of the measure.
    pub threshold: f32,
    /// Unit of value and threshold; empty for ratios and shares.
    pub unit: &'static str,
    /// The finding as a text for people, without the name.
    pub sentence: String,
}

/// A measure, its usual range, and the sentence of the finding beyond that range.
pub(crate) struct FigureLimit {
    /// Name of the measure.
    pub(crate) measure: &'static str,
    /// Unit of value and range.
    pub(crate) unit: &'static str,
    /// Value of the measure.
    pub(crate) value: f32,
    /// Least and greatest usual value.
    pub(crate) range: [f32; 2],
    /// The sentence.
    pub(crate) sentence: String,
}

impl FigureLimit {
    /// The finding about a named example or action, if the value is beyond its range.
    pub(crate) fn finding(self, name: &str) -> Option<Finding> {
        let Self { measure, unit, value, range: [least, greatest], sentence } = self;
        let threshold = if value < least { least } else { greatest };
        let is_beyond = value < least || value > greatest;
        is_beyond.then(|| Finding { example: name.to_owned(), measure, value, threshold, unit, sentence })
    }
}

/// The range below a value.
pub(crate) fn up_to(greatest: f32) -> [f32; 2] {
    [f32::NEG_INFINITY, greatest]
}

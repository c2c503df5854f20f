//! A diagnostic in JSON: `{severity, code, arguments, text}`.

use fbcrowd_jobs::json_schema::motion::SeverityMirror;
use motiondb::diagnostic::{Diagnostic, Severity};
use schemars::JsonSchema;
use serde::{Serialize, Serializer};
use serde_json::{Map, Value};

/// A diagnostic of a clip.
#[derive(Debug, PartialEq, JsonSchema, Serialize)]
#[schemars(rename = "Diagnostic")]
pub(crate) struct JsonDiagnostic {
    /// Whether the diagnostic only informs, warns, or states why the clip gives no example.
    #[schemars(with = "SeverityMirror")]
    severity: Severity,
    /// Name of the finding; it does not change between versions.
    code: &'static str,
    /// Figures of the finding by name, units last; absent where it has none.
    #[serde(skip_serializing_if = "Option::is_none")]
    arguments: Option<Map<String, Value>>,
    /// The diagnostic as a sentence.
    text: String,
}

impl From<&Diagnostic> for JsonDiagnostic {
    fn from(diagnostic: &Diagnostic) -> Self {
        // `{severity: {code: arguments}}`; read from text, where an f32 has no more digits than it needs.
        let json = serde_json::to_string(diagnostic).expect("plain data encodes");
        let tree: Value = serde_json::from_str(&json).expect("it is JSON");
        let finding = tree.as_object().and_then(|tree| tree.values().next());
        let (severity, code) = (diagnostic.severity(), diagnostic.code());
        let arguments = finding.and_then(|finding| finding.get(code)).and_then(Value::as_object).cloned();
        Self { severity, code, arguments, text: diagnostic.to_string() }
    }
}

/// Serialises a field of type [`Diagnostic`] as a [`JsonDiagnostic`].
pub(crate) fn serialize<S: Serializer>(diagnostic: &Diagnostic, serializer: S) -> Result<S::Ok, S::Error> {
    JsonDiagnostic::from(diagnostic).serialize(serializer)
}

#[cfg(test)]
mod tests {
    use motiondb::diagnostic::{Unfit, Warning};
    use serde_json::json;

    use super::*;

    #[track_caller]
    fn check(diagnostic: &Diagnostic, expected: Value) {
        let json = serde_json::to_string(&JsonDiagnostic::from(diagnostic)).unwrap();
        assert_eq!(serde_json::from_str::<Value>(&json).unwrap(), expected);
    }

    #[test]
    fn json_has_severity_code_arguments_and_sentence() {
        check(
            &Diagnostic::Warning(Warning::FeetSlide { slide_cm_s: 26.1, from_s: None }),
            json!({
                "severity": "warning", "code": "feet_slide", "arguments": { "slide_cm_s": 26.1, "from_s": null },
                "text": "planted feet slide by 26 cm/s; repair the clip, or use another one",
            }),
        );
        check(
            &Diagnostic::NoExample(Unfit::NoStep),
            json!({ "severity": "no_example", "code": "no_step", "text": Unfit::NoStep.to_string() }),
        );
    }
}

//! A diagnostic as programs read it: `{severity, code, arguments, text}`.

use motiondb::diagnostic::{Diagnostic, Severity};
use serde::{Serialize, Serializer};
use serde_json::Value;

/// A diagnostic in JSON.
#[derive(Debug, PartialEq, Serialize)]
pub(crate) struct Readable {
    severity: Severity,
    code: &'static str,
    /// By name, with their units; absent where the code says it all.
    #[serde(skip_serializing_if = "Option::is_none")]
    arguments: Option<Value>,
    text: String,
}

impl From<&Diagnostic> for Readable {
    fn from(diagnostic: &Diagnostic) -> Self {
        // `{severity: {code: arguments}}`; read from text, where an f32 has no more digits than it needs.
        let json = serde_json::to_string(diagnostic).expect("plain data encodes");
        let tree: Value = serde_json::from_str(&json).expect("it is JSON");
        let finding = tree.as_object().and_then(|tree| tree.values().next());
        let (severity, code) = (diagnostic.severity(), diagnostic.code());
        let arguments = finding.and_then(|finding| finding.get(code)).cloned();
        Self { severity, code, arguments, text: diagnostic.to_string() }
    }
}

/// For fields that hold the diagnostic itself.
pub(crate) fn serialize<S: Serializer>(diagnostic: &Diagnostic, serializer: S) -> Result<S::Ok, S::Error> {
    Readable::from(diagnostic).serialize(serializer)
}

#[cfg(test)]
mod tests {
    use motiondb::diagnostic::{Unfit, Warning};
    use serde_json::json;

    use super::*;

    fn check(diagnostic: &Diagnostic, wanted: Value) {
        let json = serde_json::to_string(&Readable::from(diagnostic)).unwrap();
        assert_eq!(serde_json::from_str::<Value>(&json).unwrap(), wanted);
    }

    #[test]
    fn programs_read_severity_code_arguments_and_sentence() {
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

//! Schemas → Markdown: one section for each output, one line for each key.

use serde_json::{Map, Value};

use crate::docs::schemas::OutputSchema;

const HEAD: &str = "\
# JSON of the command line

`fbcrowd COMMAND --json` prints one object on standard output, whether the answer is yes or no. With exit code 2
or 3 standard error holds the reason, and nothing is printed, except that `compile` and `inspect` still list what was
refused.

Keys are stable: they keep their names and types. A name carries its unit (`speed_mps`, `time_s`); shares are
between 0 and 1. `key[]` is an array and `key[].name` a key of each of its objects. Speeds are along the facing, turn
rates counter-clockwise from above, side speeds to the left. A schema for each output is in [schemas](schemas); the test
`stable_json` validates real output against it. [measures.md](measures.md) defines the measures of a recording, and the
text formats of `fbcrowd measure`.

This file is generated from the report structs; do not edit it.
";

const BENCHES: &str = "\
## Benches

Every bench prints what it measured (the tables below), and after it:
";

/// Keys that all benches share.
const OF_EVERY_BENCH: [&str; 2] = ["goals", "bars"];

/// The whole document.
pub(super) fn document(schemas: &[OutputSchema]) -> String {
    let (benches, commands): (Vec<&OutputSchema>, Vec<&OutputSchema>) =
        schemas.iter().partition(|schema| schema.name.starts_with("bench-"));
    let mut text = HEAD.to_owned();
    for schema in commands {
        text += &section("##", schema, |_| true);
    }
    let is_shared = |key: &str| OF_EVERY_BENCH.iter().any(|shared| key.starts_with(shared));
    text +=
        &format!("\n{BENCHES}{}", benches.first().map(|bench| table(&bench.content, is_shared)).unwrap_or_default());
    for schema in benches {
        text += &section("###", schema, |key| !is_shared(key));
    }
    text
}

fn section(level: &str, schema: &OutputSchema, is_shown: impl Fn(&str) -> bool) -> String {
    let title = schema.content["title"].as_str().unwrap_or_default();
    let name = &schema.name;
    let head = format!("\n{level} `{title}`\n\nSchema: [{name}.schema.json](schemas/{name}.schema.json)\n");
    match schema.content["anyOf"].as_array() {
        None => head + &table(&schema.content, is_shown),
        Some(variants) => {
            let variant = |variant: &Value| {
                let description = variant["description"].as_str().unwrap_or_default();
                format!("\n{description}\n{}", table_of(variant, &schema.content, &is_shown))
            };
            head + &variants.iter().map(variant).collect::<String>()
        }
    }
}

fn table(root: &Value, is_shown: impl Fn(&str) -> bool) -> String {
    table_of(root, root, &is_shown)
}

/// A line for each key of an object and of the objects within it.
fn table_of(object: &Value, root: &Value, is_shown: &impl Fn(&str) -> bool) -> String {
    let mut lines = Vec::new();
    add_keys(resolved(object, root), "", root, &mut lines);
    let shown = lines.into_iter().filter(|(key, _)| is_shown(key)).map(|(_, line)| line);
    format!("\n| key | type | meaning |\n|---|---|---|\n{}", shown.collect::<String>())
}

fn add_keys(object: &Value, prefix: &str, root: &Value, lines: &mut Vec<(String, String)>) {
    for (name, property) in in_order(object) {
        let key = format!("{prefix}{name}");
        let Described { words, inner, depth } = described(property, root);
        let description = property["description"].as_str().unwrap_or_default().replace('\n', " ");
        lines.push((key.clone(), format!("| `{key}{}` | {words} | {description} |\n", "[]".repeat(depth))));
        if let Some(inner) = inner {
            add_keys(inner, &format!("{key}{}.", "[]".repeat(depth)), root, lines);
        }
    }
}

/// The properties of an object: the required ones in the order of the output, then the others.
fn in_order(object: &Value) -> Vec<(&String, &Value)> {
    let required: Vec<&str> = object["required"].as_array().into_iter().flatten().filter_map(Value::as_str).collect();
    let mut properties: Vec<(&String, &Value)> =
        object["properties"].as_object().into_iter().flat_map(Map::iter).collect();
    properties.sort_by_key(|(name, _)| required.iter().position(|other| other == name).unwrap_or(required.len()));
    properties
}

/// A type in words, the object within it, and the number of arrays around that object.
struct Described<'a> {
    words: String,
    inner: Option<&'a Value>,
    depth: usize,
}

fn described<'a>(property: &'a Value, root: &'a Value) -> Described<'a> {
    let property = resolved(property, root);
    if let Some(variants) = property["anyOf"].as_array() {
        let some = variants.iter().find(|variant| variant["type"] != "null").unwrap_or(property);
        let found = described(some, root);
        return Described { words: format!("{} or null", found.words), ..found };
    }
    if let Some(choices) = property["oneOf"].as_array() {
        let words = choices.iter().map(|choice| format!("`{}`", choice["const"])).collect::<Vec<_>>().join(", ");
        return Described { words, inner: None, depth: 0 };
    }
    if property["properties"].is_object() {
        return Described { words: "object".to_owned(), inner: Some(property), depth: 0 };
    }
    match type_words(&property["type"]) {
        (word, is_nullable) if word == "array" => {
            let items = described(&property["items"], root);
            let count = property["maxItems"].as_u64().map(|count| format!("{count} ")).unwrap_or_default();
            let or_null = if is_nullable { " or null" } else { "" };
            let words = format!("array of {count}{}{or_null}", plural(&items.words));
            let depth = if items.inner.is_some() { items.depth + 1 } else { 0 };
            Described { words, inner: items.inner, depth }
        }
        (word, true) => Described { words: format!("{word} or null"), inner: None, depth: 0 },
        (word, false) => Described { words: word, inner: None, depth: 0 },
    }
}

/// The name of a type, and whether it may be null.
fn type_words(types: &Value) -> (String, bool) {
    match types {
        Value::Array(types) => {
            let named = types.iter().filter_map(Value::as_str);
            let word = named.clone().find(|name| *name != "null").unwrap_or_default();
            (word.to_owned(), named.into_iter().any(|name| name == "null"))
        }
        other => (other.as_str().unwrap_or_default().to_owned(), false),
    }
}

fn plural(words: &str) -> String {
    match words.split_once(' ') {
        Some(("array", rest)) => format!("arrays {rest}"),
        Some(_) => words.to_owned(),
        None => format!("{words}s"),
    }
}

/// A schema, or the one that it refers to.
fn resolved<'a>(schema: &'a Value, root: &'a Value) -> &'a Value {
    let pointer = schema["$ref"].as_str().and_then(|reference| reference.strip_prefix('#'));
    pointer.and_then(|pointer| root.pointer(pointer)).unwrap_or(schema)
}

//! The schema of scenario files, which editors read: it accepts what the reader accepts, and knows the same keys.

mod support;

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use fbcrowd_sim::scenario;
use motiondb::files::SourceText;
use serde_json::Value;
use support::repository;

fn schema() -> Value {
    serde_json::from_str(&fs::read_to_string(repository().join("docs/scenario.schema.json")).unwrap()).unwrap()
}

fn as_json(toml: &str) -> Value {
    toml::from_str(toml).unwrap()
}

/// Scenario files of a folder.
fn files(folder: &str) -> Vec<PathBuf> {
    let entries = fs::read_dir(repository().join(folder)).unwrap().map(|entry| entry.unwrap().path());
    let mut files: Vec<PathBuf> = entries.filter(|path| path.extension() == Some("toml".as_ref())).collect();
    files.sort();
    files
}

#[test]
fn bundled_scenarios_fit_the_schema() {
    let all = ["assets/scenarios", "assets/scenarios/rimea"].map(files).concat();
    assert!(all.len() > 25, "{}", all.len());
    let validator = jsonschema::validator_for(&schema()).unwrap();
    for path in all.iter().chain(&files("fuzz/corpus/scenario")) {
        let scenario = as_json(&fs::read_to_string(path).unwrap());
        let errors: Vec<String> =
            validator.iter_errors(&scenario).map(|error| format!("{}: {error}", error.instance_path())).collect();
        assert!(errors.is_empty(), "{}:\n{}", path.display(), errors.join("\n"));
    }
}

/// Keys of a table, as the reader lists them where it finds an unknown one.
fn keys_of_reader(text: &str) -> BTreeSet<String> {
    let source = SourceText { path: Path::new("x.toml").to_owned(), text: format!("duration_s = 1\n{text}\n") };
    let message = scenario::parse(&source).unwrap_err().to_string();
    let listed = message.split_once("unknown field `zzz`, expected ").unwrap_or_else(|| panic!("{text}: {message}")).1;
    listed.split('`').skip(1).step_by(2).map(str::to_owned).take_while(|key| !key.contains(' ')).collect()
}

#[test]
fn schema_and_reader_know_the_same_keys() {
    const TABLES: [(&str, &str); 46] = [
        ("zzz = 1", "/properties"),
        ("[[agents]]\nzzz = 1", "/$defs/agents/properties"),
        ("[[agents]]\ncircle = { zzz = 1 }", "/$defs/agents/properties/circle/properties"),
        ("[[agents]]\ngrid = { zzz = 1 }", "/$defs/agents/properties/grid/properties"),
        ("[[agents]]\narea = { zzz = 1 }", "/$defs/agents/properties/area/properties"),
        ("[[sources]]\nzzz = 1", "/properties/sources/items/properties"),
        ("[profiles.x]\nzzz = 1", "/properties/profiles/additionalProperties/properties"),
        ("[signals.x]\nzzz = 1", "/properties/signals/additionalProperties/properties"),
        ("[events.x]\nzzz = 1", "/properties/events/additionalProperties/properties"),
        ("[areas.x]\nzzz = 1", "/$defs/area/properties"),
        ("[goals.x]\nzzz = 1", "/properties/goals/additionalProperties/properties"),
        (
            "[goals.x]\nareas = [{ zzz = 1 }]",
            "/properties/goals/additionalProperties/properties/areas/items/properties",
        ),
        ("[states.x]\nzzz = 1", "/properties/states/additionalProperties/properties"),
        ("[states.x]\nstand = { zzz = 1 }", "/properties/states/additionalProperties/properties/stand/properties"),
        ("[states.x]\nset = { zzz = 1 }", "/properties/states/additionalProperties/properties/set/properties"),
        ("[states.x]\nset = { teleport = { zzz = 1 } }", "/$defs/area/properties"),
        (
            "[states.x]\nthen = [{ zzz = 1 }]",
            "/properties/states/additionalProperties/properties/then/items/properties",
        ),
        ("[states.x]\nthen = [{ when = { zzz = 1 } }]", "/$defs/when/properties"),
        ("[states.x]\nthen = [{ when = { all = [{ zzz = 1 }] } }]", "/$defs/when/properties"),
        ("[states.x]\nthen = [{ when = { not = { zzz = 1 } } }]", "/$defs/when/properties"),
        ("[states.x]\nthen = [{ when = { number = { zzz = 1 } } }]", "/$defs/when/properties/number/properties"),
        (
            "[states.x]\nthen = [{ when = { population = { zzz = 1 } } }]",
            "/$defs/when/properties/population/properties",
        ),
        ("[events.x]\nwhen = { zzz = 1 }", "/$defs/when/properties"),
        ("[events.x]\nwhen = { any = [{ zzz = 1 }] }", "/$defs/when/properties"),
        ("[[zones]]\nzzz = 1", "/properties/zones/items/properties"),
        ("[[measure]]\nzzz = 1", "/properties/measure/items/properties"),
        ("[[obstacles]]\nzzz = 1", "/properties/obstacles/items/properties"),
        ("[[walkable]]\nzzz = 1", "/properties/walkable/items/properties"),
        ("[[markings]]\nzzz = 1", "/properties/markings/items/properties"),
        ("[[characters]]\nzzz = 1", "/properties/characters/items/properties"),
        ("[camera]\nzzz = 1", "/$defs/camera/properties"),
        ("[[cameras]]\nzzz = 1", "/$defs/camera/properties"),
        ("[camera]\nkeys = [{ zzz = 1 }]", "/$defs/camera/properties/keys/items/properties"),
        ("[camera]\norbit = { zzz = 1 }", "/$defs/camera/properties/orbit/properties"),
        ("[camera]\nfollow = { zzz = 1 }", "/$defs/camera/properties/follow/properties"),
        ("[view]\nzzz = 1", "/properties/view/properties"),
        ("[shot]\nzzz = 1", "/properties/shot/properties"),
        ("[variation]\nzzz = 1", "/$defs/variation/properties"),
        ("[params]\nzzz = 1", "/properties/params/properties"),
        ("[params.route]\nzzz = 1", "/properties/params/properties/route/properties"),
        ("[params.planner]\nzzz = 1", "/properties/params/properties/planner/properties"),
        ("[params.planner.parts]\nzzz = 1", "/properties/params/properties/planner/properties/parts/properties"),
        ("[params.orca]\nzzz = 1", "/properties/params/properties/orca/properties"),
        ("[params.social_force]\nzzz = 1", "/properties/params/properties/social_force/properties"),
        ("[params.synthesis]\nzzz = 1", "/properties/params/properties/synthesis/properties"),
        ("agents = { zzz = 1 }", "/$defs/agents/properties"),
    ];
    let schema = schema();
    for (text, place) in TABLES {
        let properties = schema.pointer(place).and_then(Value::as_object).unwrap_or_else(|| panic!("{place}"));
        assert_eq!(properties.keys().cloned().collect::<BTreeSet<_>>(), keys_of_reader(text), "{text}");
    }
}

#[test]
fn the_schema_refuses_what_the_reader_refuses() {
    let validator = jsonschema::validator_for(&schema()).unwrap();
    let wrong = [
        "agents = { at_m = [0, 0], goals_m = [[1, 0]] }",
        "duration_s = 1",
        "duration_s = 1\nagents = { at_m = [0, 0, 0], goals_m = [[1, 0]] }",
        "duration_s = 1\nagents = { at_m = [0, 0], circle = { count = 3, radius_m = 2 } }",
        "duration_s = 1\nplanner = \"mnc\"\nagents = { at_m = [0, 0], goals_m = [[1, 0]] }",
        "duration_s = 1\nsources = [{ at_m = [0, 0], goals_m = [[1, 0]] }]",
        "duration_s = 1\nsources = [{ at_m = [0, 0], goals_m = [[1, 0]], rate_per_s = 1, schedule = [[0, 1]] }]",
        "duration_s = 1\nsources = [{ at_m = [0, 0], goals_m = [[1, 0]], from_s = 1, schedule = [[0, 1]] }]",
        "duration_s = 1\nsources = [{ at_m = [0, 0], goals_m = [[1, 0]], schedule_file = \"a.csv\", schedule = [[0, 1]] }]",
        "duration_s = 1\nsources = [{ at_m = [0, 0], goals_m = [[1, 0]], schedule = [[0, 1], [1, 2, 3]] }]",
        "duration_s = 1\nvariation = 1\nagents = { at_m = [0, 0], goals_m = [[1, 0]] }",
        "duration_s = 1\nvariation = { cadence = 0.5 }\nagents = { at_m = [0, 0], goals_m = [[1, 0]] }",
        "duration_s = 1\nagents = { at_m = [0, 0], state = \"s\" }\nstates = { s = { stand = {}, remove = true } }",
    ];
    for text in wrong {
        assert!(!validator.is_valid(&as_json(text)), "{text}");
        let source = SourceText { path: Path::new("x.toml").to_owned(), text: text.to_owned() };
        assert!(scenario::parse(&source).is_err(), "{text}");
    }
}

//! `[[characters]]`: who wears what, and mistakes at their line.

use std::fs;
use std::path::PathBuf;

use fbcrowd_sim::population::Population;
use fbcrowd_sim::scenario::{self, Scenario};
use motiondb::files::SourceText;

/// The beginning of every scenario here.
const HEAD: &str = "database = 'x.fbdb'\nduration_s = 10\n";

fn parse(text: &str) -> Result<Scenario, String> {
    let source = SourceText { path: PathBuf::from("x.toml"), text: format!("{HEAD}{text}") };
    scenario::parse(&source).map(|(scenario, _)| scenario).map_err(|error| error.to_string())
}

/// Two characters of which one has three quarters, and rows of agents.
fn crowd(rows: usize, keys: &str) -> Scenario {
    let text = format!(
        "[[characters]]\nfile = 'figures/woman.glb'\nweight = 3\nhue_variation_deg = 30\n\
         [[characters]]\nfile = 'man.vrm'\nname = 'guard'\n\
         [[agents]]\ngrid = {{ columns = 20, rows = {rows}, spacing_m = 1, centre_m = [0, {}] }}\n\
         goal_offset_m = [30, 0]\n{keys}",
        rows as f32 / 2.0
    );
    parse(&text).unwrap()
}

fn worn(scenario: &Scenario) -> Vec<Option<u32>> {
    Population::of(scenario).agents.iter().map(|life| life.character).collect()
}

#[test]
fn weights_share_the_characters_out() {
    let scenario = crowd(20, "");
    let names: Vec<&str> = scenario.characters.iter().map(|character| character.name.as_str()).collect();
    assert_eq!(names, ["woman", "guard"]);
    let women = worn(&scenario).iter().filter(|character| **character == Some(0)).count();
    assert!((270..330).contains(&women), "{women} of 400");
    let turns: Vec<f32> = (0..400).map(|id| scenario.hue_turn_of(id, 0)).collect();
    assert!(turns.iter().all(|turn| turn.abs() <= 30.0 / 360.0));
    assert!(turns.iter().any(|turn| *turn > 0.06) && turns.iter().any(|turn| *turn < -0.06));
    assert_eq!(scenario.hue_turn_of(3, 1), 0.0);
}

#[test]
fn appended_agents_change_no_choice() {
    let (few, many) = (worn(&crowd(5, "")), worn(&crowd(10, "")));
    assert_eq!(few[..], many[..100]);
    let other_seed = Scenario { seed: 2, ..crowd(5, "") };
    assert_ne!(few, worn(&other_seed));
}

#[test]
fn agents_and_profiles_name_their_characters() {
    assert!(worn(&crowd(5, "characters = ['guard']")).iter().all(|character| *character == Some(1)));
    let profiles = "[profiles.adult]\ncharacters = ['woman']\n[profiles.guard]\ninherits = 'adult'\nradius_m = 0.3\n";
    assert!(worn(&crowd(5, &format!("profile = 'guard'\n{profiles}"))).iter().all(|worn| *worn == Some(0)));
    // Keys of the table go before those of the profile.
    let both = format!("profile = 'guard'\ncharacters = ['guard']\n{profiles}");
    assert!(worn(&crowd(5, &both)).iter().all(|worn| *worn == Some(1)));
    let source = "[[sources]]\nat_m = [0, -20]\nrate_per_s = 1\ngoals_m = [[9, -20]]\ncharacters = ['guard']\n";
    let scenario = crowd(1, source);
    assert_eq!(scenario.sources[0].drawn(1, 0, 0).characters, 0b10);
    let spec = scenario.sources[0].drawn(1, 0, 0).agent(glam::Vec2::ZERO);
    assert_eq!(scenario.character_of(77, &spec), Some(1));
}

#[test]
fn scenarios_without_characters_have_plain_bodies() {
    let scenario = parse("agents = { circle = { count = 5, radius_m = 4 } }").unwrap();
    assert!(worn(&scenario).iter().all(Option::is_none));
    // Nor does one whose characters all weigh nothing.
    let text = "[[characters]]\nfile = 'a.glb'\nweight = 0\n[[agents]]\ncircle = { count = 5, radius_m = 4 }";
    assert!(worn(&parse(text).unwrap()).iter().all(Option::is_none));
}

#[test]
fn mistakes_are_shown_at_their_line() {
    #[track_caller]
    fn check(text: &str, words: &str) {
        let agents = "[[agents]]\nat_m = [0, 0]\ngoals_m = [[5, 0]]\n";
        let error = parse(&format!("{text}\n{agents}")).unwrap_err();
        assert!(error.contains(words), "{error}");
    }
    check("[[characters]]\nfile = 'a.glb'\nweight = -1", "x.toml:5: weight is -1");
    check("[[characters]]\nfile = 'a.glb'\nhue_variation_deg = 400", "x.toml:5: hue_variation_deg is 400");
    check("[[characters]]\nname = '../a'\nfile = 'a.glb'", "x.toml:4: name \"../a\" cannot name a file");
    check(
        "[[characters]]\nfile = 'a.glb'\n[[characters]]\nfile = 'b'\nname = 'a'",
        "x.toml:7: name `a` is that of two",
    );
    check(
        "[[characters]]\nfile = 'a.glb'\n[[characters]]\nfile = 'b/a.vrm'",
        "x.toml:5: name `a` is that of two characters",
    );
    check("[[characters]]\nname = 'a'", "the key `file` is missing");
    check("[[characters]]\nfile = 'a.glb'\nscale = 2", "unknown field `scale`");
    let many: String = (0..65).map(|index| format!("[[characters]]\nfile = 'a{index}.glb'\n")).collect();
    check(&many, "the number of characters is 65");
    let error = parse("[[agents]]\nat_m = [0, 0]\ngoals_m = [[5, 0]]\ncharacters = ['x']").unwrap_err();
    assert!(error.contains("there is no character `x`"), "{error}");
}

#[test]
fn files_lie_beside_the_scenario() {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("characters");
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    let path = folder.join("x.toml");
    let text = format!("{HEAD}[[characters]]\nfile = 'a.glb'\n[[agents]]\nat_m = [0, 0]\ngoals_m = [[5, 0]]\n");
    fs::write(&path, text).unwrap();
    let error = scenario::character_files(&path).unwrap_err().to_string();
    assert!(error.contains("x.toml:4") && error.contains("a.glb is no file"), "{error}");
    fs::write(folder.join("a.glb"), "").unwrap();
    let file = scenario::CharacterFile { path: folder.join("a.glb"), hide: Vec::new() };
    assert_eq!(scenario::character_files(&path).unwrap(), std::slice::from_ref(&file));
    let hiding = fs::read_to_string(&path).unwrap().replace("'a.glb'", "'a.glb'\nhide = ['Sword', 'Cape']");
    fs::write(&path, hiding).unwrap();
    let hide = vec!["Sword".to_owned(), "Cape".to_owned()];
    assert_eq!(scenario::character_files(&path).unwrap(), [scenario::CharacterFile { hide, ..file }]);
}

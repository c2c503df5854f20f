//! Claims about scenario files that are wrong in their size or in a number: each gives an error at its place.

use std::path::PathBuf;

use fbcrowd_sim::scenario::parse;
use motiondb::files::SourceText;

/// A scenario with every key.
const EVERYTHING: &str = include_str!("../../../fuzz/corpus/scenario/everything.toml");
const AGENT: &str = "duration_s = 5\n[[agents]]\nat_m = [0, 0]\ngoals_m = [[9, 0]]\n";

/// The message of the error; none where the text is accepted.
fn refused(text: String) -> Option<String> {
    parse(&SourceText { path: PathBuf::from("x.toml"), text }).err().map(|error| error.to_string())
}

/// Beginnings and ends of all numbers in a text without numbers in strings.
fn numbers(text: &str) -> Vec<(usize, usize)> {
    let is_part = |byte: u8| byte.is_ascii_digit() || byte == b'.' || byte == b'-';
    let bytes = text.as_bytes();
    let begins = |&at: &usize| {
        let before = bytes[at - 1];
        is_part(bytes[at]) && bytes[at] != b'.' && !is_part(before) && !before.is_ascii_alphanumeric()
    };
    let end = |at: usize| at + bytes[at..].iter().take_while(|byte| is_part(**byte)).count();
    (1..text.len()).filter(begins).map(|at| (at, end(at))).collect()
}

#[test]
fn every_number_must_be_finite() {
    assert_eq!(refused(EVERYTHING.to_owned()), None);
    let numbers = numbers(EVERYTHING);
    assert!(numbers.len() > 130);
    for (from, to) in numbers {
        for value in ["nan", "inf", "-inf"] {
            let text = format!("{}{value}{}", &EVERYTHING[..from], &EVERYTHING[to..]);
            let line = EVERYTHING[..from].lines().count();
            let written = text.lines().nth(line - 1).unwrap().to_owned();
            let message = refused(text).unwrap_or_else(|| panic!("line {line} is accepted: {written}"));
            assert!(message.starts_with("x.toml:"), "{written}: {message}");
        }
    }
}

#[test]
fn corners_of_all_obstacles_have_a_bound() {
    let teeth: String = (0..998).map(|at| format!("[{}, {}],", 300.0 + 0.01 * f64::from(at), 1 + at % 2)).collect();
    let comb = format!("{teeth}[310, 0], [300, 0]");
    let scene = |copies: i32| {
        let copies: String = (0..copies).map(|copy| format!("[{}, 30],", 20 * copy)).collect();
        format!("{AGENT}[[obstacles]]\npolygon_m = [{comb}]\ncopies_m = [{copies}]\n")
    };
    let message = refused(scene(251)).expect("too many corners");
    assert!(message.starts_with("x.toml:5:"), "{message}");
    assert!(message.contains("with this table the obstacles have 251000 corners"), "{message}");
    assert!(refused(scene(20)).is_none_or(|message| !message.contains("obstacles have")));
}

#[test]
fn sizes_have_bounds() {
    let many = |count: usize, item: &dyn Fn(usize) -> String| (0..count).map(item).collect::<String>();
    let state = |then: &str| format!("[states.s]\nwalk_mps = [1, 0]\nthen = [{then}]\n");
    let triangle = "polygon_m = [[3, 3], [4, 3], [3, 4]]\n";
    let enclosure = format!("[[obstacles]]\nkind = 'enclosure'\n{triangle}");
    let source = "[[sources]]\nat_m = [0, 3]\nrate_per_s = 1000\ngoals_m = [[9, 0]]\n";
    let nested = |depth: usize| {
        state(&format!("{{ when = {}{{ after_s = 1 }}{}, to = 's' }}", "{ not = ".repeat(depth), " }".repeat(depth)))
    };
    let cases = [
        (enclosure.repeat(10_001), "with this table there are 10001 obstacles"),
        ("[[obstacles]]\nkind = 'enclosure'\npolygon_m = [[3, 3], [5, 5], [5, 3], [3, 5]]\n".into(), ":5: enclosure 0"),
        ("[[walkable]]\npolygon_m = [[-9, -9], [1e9, -9], [-9, 1e9]]\n".into(), ":5: [1000000000, -9] is not within"),
        (many(4_001, &|index| format!("[states.s{index}]\nwalk_mps = [1, 0]\n")), "4001 states, more than 4000"),
        (state(&"{ when = { after_s = 1 }, to = 's' }, ".repeat(100_001)), ":7: the scenario has more than 100000"),
        (nested(1_000), ":7: cannot recurse further"),
    ];
    for (text, part) in &cases {
        let message = refused(format!("{AGENT}{text}")).unwrap_or_else(|| panic!("accepted: {part}"));
        assert!(message.contains(part), "{message}");
    }
    let day = format!("{AGENT}{source}").replace("duration_s = 5", "duration_s = 86400");
    assert!(refused(day).unwrap().starts_with("x.toml:5: with this source the scenario has more than 1000000 agents"));
    assert_eq!(refused(format!("{AGENT}{}", nested(8))), None);
}

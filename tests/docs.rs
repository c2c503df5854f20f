//! The pages of the repository: their links lead somewhere, the files and commands that they name exist.

mod support;

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use support::{fbcrowd, repository};

/// Path and text of every page: the Markdown files of the root, of `docs` and of `assets`.
fn pages() -> Vec<(PathBuf, String)> {
    let markdown = |folder: &str| {
        let entries = fs::read_dir(repository().join(folder)).unwrap().map(|entry| entry.unwrap().path());
        entries.filter(|path| path.extension().is_some_and(|extension| extension == "md")).collect::<Vec<_>>()
    };
    let mut paths = ["", "docs", "assets/clips"].map(markdown).concat();
    paths.sort();
    paths.into_iter().map(|path| (path.clone(), fs::read_to_string(path).unwrap())).collect()
}

/// The texts between two marks, as often as they occur in a line.
fn between<'a>(line: &'a str, open: &str, close: &str) -> Vec<&'a str> {
    line.split(open).skip(1).filter_map(|rest| rest.split_once(close)).map(|(inner, _)| inner).collect()
}

/// Code spans of a page. Code blocks are left out.
fn code_spans(text: &str) -> Vec<&str> {
    let mut in_block = false;
    let mut spans = Vec::new();
    for line in text.lines() {
        if line.starts_with("```") {
            in_block = !in_block;
        } else if !in_block {
            spans.extend(line.split('`').skip(1).step_by(2));
        }
    }
    spans
}

#[test]
fn links_of_all_pages_lead_to_files() {
    let mut broken = Vec::new();
    for (page, text) in pages() {
        let folder = page.parent().unwrap();
        for target in text.lines().flat_map(|line| between(line, "](", ")")) {
            let file = target.split('#').next().unwrap();
            let is_external = target.contains("://") || target.starts_with("mailto:");
            if !is_external && !file.is_empty() && !folder.join(file).exists() {
                broken.push(format!("{}: {target}", page.display()));
            }
        }
    }
    assert!(broken.is_empty(), "{}", broken.join("\n"));
}

#[test]
fn source_files_that_pages_name_exist() {
    let crates = [
        "",
        "motiondb/src",
        "tools/compiler/src",
        "runtime/sim/src",
        "runtime/render/src",
        "tools/clipgen/src",
        "tools/scenes/src",
    ];
    let mut missing = Vec::new();
    for (page, text) in pages() {
        let is_path = |span: &&str| span.contains('/') && span.ends_with(".rs") && !span.contains(['*', ' ', '…']);
        for span in code_spans(&text).into_iter().filter(is_path) {
            if !crates.iter().any(|folder| repository().join(folder).join(span).is_file()) {
                missing.push(format!("{}: {span}", page.display()));
            }
        }
    }
    assert!(missing.is_empty(), "{}", missing.join("\n"));
}

/// Equation numbers of a text such as `§4.1, Eqs. 2–5`.
fn equations(text: &str) -> Vec<u32> {
    let Some((_, numbers)) = text.split_once("Eq") else { return Vec::new() };
    let numbers = numbers.trim_start_matches(['s', '.', ' ']);
    let number = |text: &str| text.chars().take_while(char::is_ascii_digit).collect::<String>().parse::<u32>();
    let parts: Vec<u32> = numbers.split('–').filter_map(|part| number(part).ok()).collect();
    match parts[..] {
        [first, last] => (first..=last).collect(),
        _ => parts,
    }
}

#[test]
fn the_paper_map_leads_to_every_equation() {
    let map = fs::read_to_string(repository().join("docs/paper-map.md")).unwrap();
    let mut files: BTreeMap<u32, String> = BTreeMap::new();
    for row in map.lines().filter(|line| line.starts_with("| §") || line.starts_with("| App")) {
        let columns: Vec<&str> = row.split('|').map(str::trim).collect();
        let sources = between(columns[3], "[`", "`]").into_iter().map(|path| repository().join(path));
        let text: String = sources.map(|path| fs::read_to_string(path).unwrap()).collect();
        equations(columns[1]).into_iter().for_each(|number| *files.entry(number).or_default() += &text);
    }
    assert_eq!(files.keys().copied().collect::<Vec<u32>>(), (1..=18).collect::<Vec<u32>>());
    for (number, text) in files {
        let cites = text.lines().filter(|line| line.contains("Eq")).any(|line| cites(line, number));
        assert!(cites, "no file of the paper map cites Eq. {number}");
    }
}

/// Whether a line cites an equation, alone, in a list or in a range.
fn cites(line: &str, number: u32) -> bool {
    let digits: Vec<u32> =
        line.split(|letter: char| !letter.is_ascii_digit()).filter_map(|word| word.parse().ok()).collect();
    let in_range =
        |pair: &[u32]| pair[0] <= number && number <= pair[1] && line.contains(&format!("{}–{}", pair[0], pair[1]));
    digits.contains(&number) || digits.windows(2).any(in_range)
}

/// Command lines of a page: lines of code blocks, and code spans, that begin with `fbcrowd`.
fn commands(text: &str) -> Vec<String> {
    let lines = text.lines().filter(|line| line.starts_with("fbcrowd ")).map(str::to_owned);
    let spans = code_spans(text).into_iter().filter(|span| span.starts_with("fbcrowd ")).map(str::to_owned);
    lines.chain(spans).collect()
}

#[test]
fn commands_that_pages_show_exist_with_their_options() {
    let mut help: BTreeMap<Vec<String>, String> = BTreeMap::new();
    let mut wrong = Vec::new();
    for (page, text) in pages() {
        for command in commands(&text) {
            let words: Vec<&str> = command.split('#').next().unwrap().split_whitespace().skip(1).collect();
            let is_name = |word: &&&str| {
                word.chars().all(|letter| letter.is_ascii_lowercase() || letter.is_ascii_digit() || letter == '-')
            };
            let depth = if words.first() == Some(&"bench") { 2 } else { 1 };
            let names: Vec<String> = words.iter().take(depth).filter(is_name).map(|&name| name.to_owned()).collect();
            if names.is_empty() || names.last().is_some_and(|name| name.starts_with('-')) {
                continue;
            }
            let help = help.entry(names.clone()).or_insert_with(|| {
                let arguments: Vec<&str> = names.iter().map(String::as_str).chain(["--help"]).collect();
                let outcome = fbcrowd(&arguments);
                if outcome.code == 0 { outcome.stdout } else { String::new() }
            });
            let options =
                words.iter().filter(|word| word.starts_with("--")).map(|word| word.split('=').next().unwrap());
            let unknown: Vec<&str> = options.filter(|option| !help.contains(*option)).collect();
            if help.is_empty() || !unknown.is_empty() {
                wrong.push(format!("{}: `{command}` {unknown:?}", page.display()));
            }
        }
    }
    assert!(help.len() > 10 && wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn the_readme_is_short() {
    let lines = fs::read_to_string(repository().join(Path::new("README.md"))).unwrap().lines().count();
    assert!(lines <= 120, "README.md has {lines} lines");
}

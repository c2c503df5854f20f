//! One performer in the skeletons, axes, units and channels of other tools, with twist bones, props, skirts, hair and
//! wings: import finds the same body and the same parameters.
//!
//! The performer is a bundled clip with the parameters of `assets/clips/README.md`. A hundred combinations run always;
//! `cargo test --test zoo -- --ignored` runs thousands.

mod zoo {
    pub(crate) mod body;
    pub(crate) mod combination;
    pub(crate) mod creatures;
    pub(crate) mod file;
    pub(crate) mod names;
    pub(crate) mod rig;
}

use std::collections::BTreeMap;
use std::path::Path;

use motiondb_compiler::import_bytes;

use zoo::combination::{Combination, Dice};

/// Combinations that earlier versions imported wrong: a T-pose that blends into an idle, a wrong frame time that moved
/// the unit, or beside which doubts of the unit and jumps of the pose were reported, a short ramp, a T-pose held before a
/// turn, an arm beside a fold of a cape, a cape and held things as limbs.
const MENDED: [u64; 17] =
    [137, 172, 291, 423, 838, 849, 1090, 1219, 1305, 2050, 2604, 2706, 3496, 40366, 41932, 42224, 42916];

fn check_all(seeds: impl IntoIterator<Item = u64>) {
    let mut failures: Vec<String> = Vec::new();
    let mut by_word: BTreeMap<String, [usize; 2]> = BTreeMap::new();
    let mut count = 0;
    for seed in seeds {
        count += 1;
        let combination = Combination::thrown(&mut Dice::new(seed));
        let outcome = combination.check();
        for word in combination.words() {
            by_word.entry(word).or_default()[usize::from(outcome.is_err())] += 1;
        }
        failures
            .extend(outcome.err().map(|problem| format!("{seed}: {problem}\n    {}", combination.words().join(", "))));
    }
    for (word, [good, bad]) in &by_word {
        if *bad > 0 {
            println!("{bad:5} of {:5} {word}", good + bad);
        }
    }
    let shown = failures.iter().take(40).cloned().collect::<Vec<_>>().join("\n");
    assert!(failures.is_empty(), "{} of {count} failed:\n{shown}", failures.len());
}

#[test]
fn humans_of_every_tool_import_right() {
    check_all(0..100);
}

#[test]
fn mended_combinations_stay_mended() {
    check_all(MENDED);
}

#[test]
fn creatures_give_no_example() {
    let is_unfit = |creature: &zoo::creatures::Creature| {
        let imports = import_bytes(Path::new("creature.bvh"), creature.text().as_bytes()).unwrap();
        imports[0].outcome.as_ref().map_or(true, |human| human.unfit.is_some())
    };
    let creatures = zoo::creatures::all();
    let accepted: Vec<&str> = creatures.iter().filter(|it| !is_unfit(it)).map(|it| it.name).collect();
    assert!(accepted.is_empty(), "{accepted:?}");
}

#[test]
#[ignore = "minutes: thousands of combinations"]
fn thousands_of_combinations_import_right() {
    let [first, last] =
        ["ZOO_FIRST", "ZOO_LAST"].map(|name| std::env::var(name).ok().and_then(|text| text.parse().ok()));
    check_all(first.unwrap_or(0)..last.unwrap_or(5000));
}

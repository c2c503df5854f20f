//! Any bytes as a scenario: agents to simulate or an error.
#![no_main]

use std::fs;

use fbcrowd_fuzz::on_disk;
use fbcrowd_sim::scenario_file;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let path = on_disk("toml", bytes);
    let _ = scenario_file::read(&path);
    fs::remove_file(path).expect("it was written just now");
});

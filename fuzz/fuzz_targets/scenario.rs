//! Any bytes as a scenario, and as the file of agents that a scenario names: agents to simulate or an error.
#![no_main]

use std::fs;

use fbcrowd_fuzz::on_disk;
use fbcrowd_sim::scenario;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    read(bytes);
    let lines = on_disk("txt", bytes);
    read(format!("clips = '.'\nduration_s = 1\nagents = {{ file = '{}' }}", lines.display()).as_bytes());
    fs::remove_file(lines).expect("it was written just now");
});

fn read(text: &[u8]) {
    let path = on_disk("toml", text);
    let _ = scenario::read(&path);
    fs::remove_file(path).expect("it was written just now");
}

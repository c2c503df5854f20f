//! SIGINT, SIGTERM and SIGHUP: temporary files are removed, and the process ends with 128 + the signal's number.

use std::fs;
use std::io;
use std::process;
use std::thread;

use motiondb::files::temporary_files;
use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
use signal_hook::iterator::Signals;

/// First exit code of signals: 130 for SIGINT, 143 for SIGTERM, 129 for SIGHUP.
const SIGNAL_CODE: i32 = 128;

/// Waits for the signals in a thread of its own. One that the process was started to ignore (`nohup`) stays ignored.
pub(crate) fn handle() -> io::Result<()> {
    let ignored = ignored_signals();
    let is_ignored = |signal: i32| ignored >> (signal - 1) & 1 == 1;
    let mut signals = Signals::new([SIGINT, SIGTERM, SIGHUP].into_iter().filter(|signal| !is_ignored(*signal)))?;
    thread::Builder::new().name("signals".to_owned()).spawn(move || {
        if let Some(signal) = signals.forever().next() {
            temporary_files::abandon_all();
            process::exit(SIGNAL_CODE + signal);
        }
    })?;
    Ok(())
}

/// Signals that the process ignores, a bit each from signal 1 on; none where the system does not tell (it is Linux's).
fn ignored_signals() -> u64 {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or(0)
}

//! Threads of a bench: pools of a fixed size, and independent runs that are shared out among threads.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

use fbcrowd_jobs::Observer;
use fbcrowd_jobs::observer::Work;
use rayon::ThreadPool;

use crate::error::BenchError;

/// A pool of this many threads.
pub(crate) fn pool(threads: usize) -> Result<ThreadPool, BenchError> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    pool.map_err(|source| BenchError::Threads { threads, source })
}

/// Makes `count` runs, several at a time but each on a single thread; returns their results by index.
///
/// No run is interrupted by another, so that durations within it are those of one thread. Results do not depend on it.
pub(crate) fn run_each_on_one_thread<T: Send>(
    count: usize,
    observer: &Observer,
    run: impl Fn(usize) -> T + Sync,
) -> Result<Vec<T>, BenchError> {
    let (next, work) = (AtomicUsize::new(0), Work::begin(observer, "runs", count));
    let make_runs = || {
        let mut done = Vec::new();
        loop {
            let index = next.fetch_add(1, Ordering::Relaxed);
            if index >= count {
                return done;
            }
            done.push((index, run(index)));
            work.advance();
        }
    };
    let mut runs = on_pools_of_one_thread(make_runs)?;
    work.end();
    runs.sort_by_key(|(index, _)| *index);
    Ok(runs.into_iter().map(|(_, run)| run).collect())
}

/// Calls `make_runs` on as many threads as may be used, each in a pool that has no other thread.
fn on_pools_of_one_thread<T: Send>(make_runs: impl Fn() -> Vec<T> + Sync) -> Result<Vec<T>, BenchError> {
    let pools = (0..rayon::current_num_threads()).map(|_| pool(1)).collect::<Result<Vec<_>, _>>()?;
    Ok(thread::scope(|scope| {
        let threads: Vec<_> = pools.iter().map(|pool| scope.spawn(|| pool.install(&make_runs))).collect();
        threads.into_iter().flat_map(|thread| thread.join().expect("no simulation panics")).collect()
    }))
}

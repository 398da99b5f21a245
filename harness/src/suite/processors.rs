//! Processors, divided among workers: no two compete for one while there are enough.

use std::thread;

use formats::cancel::{self, Flag};

/// The processors of a worker; none is all, and nothing is set.
pub(super) type Processors = Option<Vec<usize>>;

/// Those of each of `jobs` workers.
pub(super) fn of_workers(jobs: usize) -> Vec<Processors> {
    if jobs == 1 {
        return vec![None];
    }
    divided(&all(), jobs).into_iter().map(Some).collect()
}

/// `processors` in as many equal parts as there are workers; all of them to everyone where they are fewer: two of
/// three workers on one of two processors would get half the time of the third.
fn divided(processors: &[usize], jobs: usize) -> Vec<Vec<usize>> {
    let count = processors.len();
    let part = |job: usize| match count < jobs {
        true => processors.to_vec(),
        false => processors[job * count / jobs..(job + 1) * count / jobs].to_vec(),
    };
    (0..jobs).map(part).collect()
}

/// Does `work` on these processors, and so all that it starts. Its threads know the flag `cancel`.
pub(super) fn keep_to<T: Send>(
    processors: &Processors,
    cancel: Option<Flag>,
    work: impl FnOnce() -> T + Send,
) -> T {
    if let Some(processors) = processors {
        pin(processors);
    }
    // A pool of the worker's own, whose threads inherit what was set here.
    match cancel::pool(processors.as_ref().map_or(0, Vec::len), cancel) {
        Ok(pool) => pool.install(work),
        Err(error) => {
            tracing::warn!("no threads of its own for a worker: {error}");
            work()
        }
    }
}

#[cfg(target_os = "linux")]
fn all() -> Vec<usize> {
    use rustix::thread::{CpuSet, sched_getaffinity};
    let found = sched_getaffinity(None).map(|set| {
        (0..CpuSet::MAX_CPU).filter(|processor| set.is_set(*processor)).collect::<Vec<_>>()
    });
    found.ok().filter(|found| !found.is_empty()).unwrap_or_else(counted)
}

#[cfg(not(target_os = "linux"))]
fn all() -> Vec<usize> {
    counted()
}

fn counted() -> Vec<usize> {
    (0..thread::available_parallelism().map_or(1, usize::from)).collect()
}

#[cfg(target_os = "linux")]
fn pin(processors: &[usize]) {
    use rustix::thread::{CpuSet, sched_setaffinity};
    let mut set = CpuSet::new();
    processors.iter().for_each(|processor| set.set(*processor));
    if let Err(error) = sched_setaffinity(None, &set) {
        tracing::debug!("processors are not divided: {error}");
    }
}

#[cfg(not(target_os = "linux"))]
fn pin(_: &[usize]) {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn workers_share_all_processors_and_no_processor_is_two_workers() {
        for (count, jobs) in [(8, 3), (2, 2), (64, 7), (5, 5)] {
            let processors: Vec<usize> = (10..10 + count).collect();
            let parts = divided(&processors, jobs);
            assert_eq!(parts.concat(), processors);
            let sizes: Vec<usize> = parts.iter().map(Vec::len).collect();
            assert!(sizes.iter().max().unwrap() - sizes.iter().min().unwrap() <= 1, "{sizes:?}");
        }
        // More workers than processors: the system shares them out.
        assert_eq!(divided(&[4, 6], 3), [[4, 6], [4, 6], [4, 6]]);
    }

    #[test]
    fn a_worker_and_its_pool_keep_to_their_processors() {
        let own = of_workers(2)[0].clone();
        let seen = thread::scope(|scope| {
            let work = || keep_to(&own, None, || (all(), rayon::current_num_threads()));
            scope.spawn(work).join().unwrap()
        });
        assert_eq!(Some(seen.0), own);
        assert_eq!(seen.1, own.unwrap().len());
    }
}

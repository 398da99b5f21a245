//! Ends a long computation between its parts.
//!
//! Every thread of a pool made by [`pool`] knows one flag. Once the flag is raised, [`check`] unwinds to [`catch`].
//! On threads of other pools [`check`] does nothing.

use std::any::Any;
use std::cell::RefCell;
use std::panic::{self, AssertUnwindSafe};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use rayon::{ThreadPool, ThreadPoolBuildError, ThreadPoolBuilder};

/// Raised to end what the threads that know it compute.
pub type Flag = Arc<AtomicBool>;

thread_local! {
    static FLAG: RefCell<Option<Flag>> = const { RefCell::new(None) };
}

/// The payload with which [`check`] unwinds.
struct Cancelled;

/// A pool of `threads` threads (0: one for each processor) that know `flag`.
pub fn pool(threads: usize, flag: Option<Flag>) -> Result<ThreadPool, ThreadPoolBuildError> {
    let know = move |_| FLAG.with_borrow_mut(|own| own.clone_from(&flag));
    ThreadPoolBuilder::new().num_threads(threads).start_handler(know).build()
}

/// The flag of this thread, for pools that it makes.
pub fn flag() -> Option<Flag> {
    FLAG.with_borrow(Clone::clone)
}

/// Unwinds to [`catch`] if the flag of this thread is raised.
pub fn check() {
    let raised = |flag: &Flag| flag.load(Ordering::Relaxed);
    // No message is printed: the hook of panics is not called.
    if FLAG.with_borrow(|flag| flag.as_ref().is_some_and(raised)) {
        panic::resume_unwind(Box::new(Cancelled));
    }
}

/// The result of `work`; none if [`check`] ended it. Every other panic goes on.
pub fn catch<T>(work: impl FnOnce() -> T) -> Option<T> {
    // What a cancelled computation leaves half done is dropped with it, or lies in a folder that is not committed.
    match panic::catch_unwind(AssertUnwindSafe(work)) {
        Ok(value) => Some(value),
        Err(payload) if is_cancelled(&*payload) => None,
        Err(payload) => panic::resume_unwind(payload),
    }
}

/// Returns whether a panic is that of [`check`].
pub fn is_cancelled(payload: &(dyn Any + Send)) -> bool {
    payload.is::<Cancelled>()
}

#[cfg(test)]
mod tests {
    use super::*;
    use rayon::prelude::*;

    #[test]
    fn a_raised_flag_ends_the_work_of_its_pool_alone() {
        let flag = Flag::default();
        let own = pool(2, Some(flag.clone())).unwrap();
        let work = |end: bool| {
            let part = |at: usize| {
                if end && at == 10 {
                    flag.store(true, Ordering::Relaxed);
                }
                check();
                at
            };
            (0..1000).into_par_iter().map(part).sum::<usize>()
        };
        assert_eq!(own.install(|| catch(|| work(false))), Some(499_500));
        assert_eq!(own.install(|| catch(|| work(true))), None);
        assert_eq!(pool(2, None).unwrap().install(|| catch(|| work(false))), Some(499_500));
    }
}

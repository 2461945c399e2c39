//! Parallel evaluation of a batch.

use super::input::InputError;
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};

/// Number of threads of a batch, and the flag that stops the batch. `Option<usize>` converts to `Threads`
/// without a flag.
#[derive(Clone, Copy, Debug, Default)]
pub struct Threads<'a> {
    /// Number of threads, or `None` for all cores.
    pub count: Option<usize>,
    /// Flag that another thread sets to stop the batch early, or `None`. If the batch is stopped, the
    /// contents of the outputs are undefined.
    pub stop: Option<&'a AtomicBool>,
}

impl From<Option<usize>> for Threads<'_> {
    fn from(count: Option<usize>) -> Self {
        Self { count, stop: None }
    }
}

impl Threads<'_> {
    /// Returns true if the stop flag is set.
    pub(super) fn is_stopped(&self) -> bool {
        self.stop.is_some_and(|stop| stop.load(Ordering::Relaxed))
    }
}

/// Runs `task` for every element until the batch is stopped, with one workspace per thread.
///
/// The number of threads is at most the number of elements and the number of processors. A batch with a
/// single thread runs on the calling thread. The elements are generated on demand, so a long batch needs no
/// memory in advance.
///
/// # Errors
/// [`InputError::NoThreads`] for zero threads.
pub(super) fn for_each<T, W>(
    threads: Threads<'_>,
    tasks: impl IntoIterator<IntoIter: ExactSizeIterator<Item = T> + Send>,
    workspace: impl Fn() -> W + Sync,
    task: impl Fn(&mut W, T) + Sync,
) -> Result<(), InputError> {
    let tasks = tasks.into_iter();
    let processors = std::thread::available_parallelism().map_or(1, usize::from);
    let thread_count = threads.count.unwrap_or(processors).min(tasks.len()).min(processors);
    if threads.count == Some(0) {
        return Err(InputError::NoThreads);
    }
    if thread_count <= 1 {
        let mut workspace = workspace();
        tasks.take_while(|_| !threads.is_stopped()).for_each(|element| task(&mut workspace, element));
        return Ok(());
    }
    let queue = Mutex::new(tasks);
    let next = || queue.lock().unwrap_or_else(PoisonError::into_inner).next();
    let worker = || {
        let mut workspace = workspace();
        while let Some(element) = next().filter(|_| !threads.is_stopped()) {
            task(&mut workspace, element);
        }
    };
    match pool() {
        // `thread_count` workers, even if the pool has more threads
        Some(pool) => pool.scope(|scope| (0..thread_count).for_each(|_| scope.spawn(|_| worker()))),
        None => worker(),
    }
    Ok(())
}

/// Returns the thread pool of this process, created on first use; `None` if the system cannot create threads.
///
/// Rayon's global pool is unsuitable: a child process created by `fork` (multiprocessing in Python) inherits
/// the memory of the pool but not its threads, and would wait for them forever.
fn pool() -> Option<&'static ThreadPool> {
    static POOL: Mutex<Option<(u32, &ThreadPool)>> = Mutex::new(None);
    let mut cached = POOL.lock().unwrap_or_else(PoisonError::into_inner);
    let process = std::process::id();
    match *cached {
        Some((owner, pool)) if owner == process => Some(pool),
        _ => {
            let pool: &ThreadPool = Box::leak(Box::new(ThreadPoolBuilder::new().build().ok()?));
            *cached = Some((process, pool));
            Some(pool)
        }
    }
}

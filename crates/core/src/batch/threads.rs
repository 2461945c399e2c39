//! On how many threads a batch runs.

use super::input::InputError;
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};

/// On how many threads a batch runs, and what ends it early; made from an `Option<usize>` where nothing does.
#[derive(Clone, Copy, Debug, Default)]
pub struct Threads<'a> {
    /// Number of threads; all cores if `None`.
    pub count: Option<usize>,
    /// Set from elsewhere to stop early; what is written then is of no use.
    pub stop: Option<&'a AtomicBool>,
}

impl From<Option<usize>> for Threads<'_> {
    fn from(count: Option<usize>) -> Self {
        Self { count, stop: None }
    }
}

impl Threads<'_> {
    /// Whether the batch is to end early.
    pub(super) fn is_stopped(&self) -> bool {
        self.stop.is_some_and(|stop| stop.load(Ordering::Relaxed))
    }
}

/// Runs `task` on every element until it is stopped, with a workspace per thread: never on more threads than there
/// are elements or processors, and on the calling thread if that is one.
///
/// Elements are made as they are taken, so that a long batch costs no memory before it runs.
///
/// # Errors
/// [`InputError::NoThreads`].
pub(super) fn for_each<T, W>(
    threads: Threads<'_>,
    tasks: impl IntoIterator<IntoIter: ExactSizeIterator<Item = T> + Send>,
    workspace: impl Fn() -> W + Sync,
    task: impl Fn(&mut W, T) + Sync,
) -> Result<(), InputError> {
    let tasks = tasks.into_iter();
    let processors = std::thread::available_parallelism().map_or(1, usize::from);
    let wanted = threads.count.unwrap_or(processors).min(tasks.len()).min(processors);
    if threads.count == Some(0) {
        return Err(InputError::NoThreads);
    }
    if wanted <= 1 {
        let mut space = workspace();
        tasks.take_while(|_| !threads.is_stopped()).for_each(|one| task(&mut space, one));
        return Ok(());
    }
    let queue = Mutex::new(tasks);
    let next = || queue.lock().unwrap_or_else(PoisonError::into_inner).next();
    let strand = || {
        let mut space = workspace();
        while let Some(one) = next().filter(|_| !threads.is_stopped()) {
            task(&mut space, one);
        }
    };
    match pool() {
        // no more strands than wanted, whatever the pool has
        Some(pool) => pool.scope(|scope| (0..wanted).for_each(|_| scope.spawn(|_| strand()))),
        None => strand(),
    }
    Ok(())
}

/// The threads of this process, started when first needed; `None` where the system gives none.
///
/// Not rayon's own: a child that `fork` made (Python's multiprocessing) has the memory of its parent's pool but
/// none of its threads, and would wait for them forever.
fn pool() -> Option<&'static ThreadPool> {
    static POOL: Mutex<Option<(u32, &ThreadPool)>> = Mutex::new(None);
    let mut known = POOL.lock().unwrap_or_else(PoisonError::into_inner);
    let process = std::process::id();
    match *known {
        Some((owner, pool)) if owner == process => Some(pool),
        _ => {
            let pool: &ThreadPool = Box::leak(Box::new(ThreadPoolBuilder::new().build().ok()?));
            *known = Some((process, pool));
            Some(pool)
        }
    }
}

//! On how many threads a batch runs.

use super::input::InputError;

/// Runs `work`, which is cut into `tasks`, on `threads` threads: all cores if `None`, never more
/// than there are tasks or processors.
///
/// # Errors
/// [`InputError::NoThreads`].
pub(super) fn on_threads(
    threads: Option<usize>,
    tasks: usize,
    work: impl FnOnce() + Send,
) -> Result<(), InputError> {
    let Some(threads) = threads else {
        work();
        return Ok(());
    };
    if threads == 0 {
        return Err(InputError::NoThreads);
    }
    let processors = std::thread::available_parallelism().map_or(1, usize::from);
    let threads = threads.min(tasks.max(1)).min(processors);
    match rayon::ThreadPoolBuilder::new().num_threads(threads).build() {
        Ok(pool) => pool.install(work),
        Err(_) => work(), // no threads to be had: the shared pool computes the same
    }
    Ok(())
}

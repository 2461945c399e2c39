//! On how many threads a batch runs.

use super::input::InputError;
use rayon::prelude::*;

/// Runs `task` on every element, with a workspace per thread: on all cores if `threads` is `None`,
/// never on more than there are elements or processors, and on the calling thread if that is one.
///
/// # Errors
/// [`InputError::NoThreads`].
pub(super) fn for_each<T: Send, W>(
    threads: Option<usize>,
    tasks: Vec<T>,
    workspace: impl Fn() -> W + Sync,
    task: impl Fn(&mut W, T) + Sync,
) -> Result<(), InputError> {
    let processors = std::thread::available_parallelism().map_or(1, usize::from);
    let wanted = threads.unwrap_or(processors).min(tasks.len()).min(processors);
    if threads == Some(0) {
        return Err(InputError::NoThreads);
    }
    if wanted <= 1 {
        let mut space = workspace();
        tasks.into_iter().for_each(|one| task(&mut space, one));
        return Ok(());
    }
    let all = || tasks.into_par_iter().for_each_init(&workspace, &task);
    match threads.map(|_| rayon::ThreadPoolBuilder::new().num_threads(wanted).build()) {
        Some(Ok(pool)) => pool.install(all),
        _ => all(), // the shared pool; it computes the same bits
    }
    Ok(())
}

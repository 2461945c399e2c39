//! Ctrl-C during long calls: Python's signal handlers run at regular intervals of wall-clock time.

use crate::errors::{IntoPython, fields, raise};
use onorbit_core::batch::Threads;
use onorbit_core::number_text::short;
use onorbit_core::orbit::Orbit;
use pyo3::prelude::*;
use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError, mpsc};
use std::time::{Duration, Instant};

/// Wall-clock time between two checks for signals.
pub(crate) const PACE: Duration = Duration::from_millis(50);

/// Smallest batch size for which the cost of a separate thread, some tens of microseconds, is negligible.
pub(crate) const LONG_BATCH: usize = 1 << 16;

/// Number of steps of an integrated orbit between two checks for signals.
const STEPS: usize = 16;

/// Converts an interval of wall-clock time in s to a duration; `name` is the name of the argument in
/// messages.
pub(crate) fn period(py: Python<'_>, name: &str, seconds: f64) -> PyResult<Duration> {
    Duration::try_from_secs_f64(seconds).map_err(|_| {
        let message = format!("{name} is {} s; it must be from 0 to 1.8e19 s", short(seconds));
        raise(py, "InputError", &message, &fields!(py, "name": name, "got": seconds))
    })
}

/// Runs a batch without the GIL on `count` threads (default: all cores); Ctrl-C interrupts it if `is_long` is
/// true.
pub(crate) fn batch<R: Send>(
    py: Python<'_>,
    count: Option<usize>,
    is_long: bool,
    work: impl FnOnce(Threads<'_>) -> R + Send,
) -> PyResult<R> {
    if !is_long {
        return Ok(py.detach(|| work(count.into())));
    }
    let stop = AtomicBool::new(false);
    interruptible(py, &stop, || work(Threads { count, stop: Some(&stop) }))
}

/// Runs `work` on a separate thread. A Ctrl-C is raised within [`PACE`]; `work` is then abandoned and
/// finishes in the background.
///
/// This function is for work that cannot be stopped, such as parsing a file or computing a certificate.
pub(crate) fn abandonable<R: Send + 'static>(
    py: Python<'_>,
    work: impl FnOnce() -> R + Send + 'static,
) -> PyResult<R> {
    let (done, finished) = mpsc::channel();
    let worker = std::thread::spawn(move || {
        let result = work();
        let _ = done.send(()); // there is no receiver after a Ctrl-C
        result
    });
    let finished = Mutex::new(finished);
    while py.detach(|| wait(&finished)) == Err(mpsc::RecvTimeoutError::Timeout) {
        py.check_signals()?;
    }
    py.detach(|| worker.join()).map_err(|panic| std::panic::resume_unwind(panic))
}

/// Integrates a numerical orbit over `times`, s; Ctrl-C interrupts the integration. Other orbits do not require
/// an integration.
pub(crate) fn prepare(py: Python<'_>, orbit: &dyn Orbit, times: &[f64]) -> PyResult<()> {
    if orbit.prepare(times, 0) {
        return Ok(());
    }
    while !py.detach(|| orbit.prepare(times, STEPS)) {
        py.check_signals()?;
    }
    Ok(())
}

/// Runs `work` without the GIL on successive ranges of `rows`, with checks for signals in between. The first
/// range has `first` rows; the size of later ranges is adjusted so that each takes about [`PACE`]. Ranges
/// begin at multiples of `first`, a power of two.
pub(crate) fn in_pieces<E: IntoPython + Send>(
    py: Python<'_>,
    rows: usize,
    first: usize,
    mut work: impl FnMut(Range<usize>) -> Result<(), E> + Send,
) -> PyResult<()> {
    if rows <= first {
        return py.detach(|| work(0..rows)).map_err(|error| error.into_python(py));
    }
    let (mut start, mut piece) = (0_usize, first);
    loop {
        let (range, begun) = (start..rows.min(start.saturating_add(piece)), Instant::now());
        start = range.end;
        py.detach(|| work(range)).map_err(|error| error.into_python(py))?;
        if start == rows {
            return Ok(());
        }
        py.check_signals()?;
        let elapsed = begun.elapsed();
        if elapsed < PACE / 4 {
            piece = piece.saturating_mul(2);
        } else if elapsed > PACE {
            piece = first.max(piece / 2);
        }
    }
}

/// Runs `work` on a separate thread. A Ctrl-C sets `stop`, and is raised after `work` has returned.
pub(crate) fn interruptible<R: Send>(
    py: Python<'_>,
    stop: &AtomicBool,
    work: impl FnOnce() -> R + Send,
) -> PyResult<R> {
    std::thread::scope(|scope| {
        let (done, finished) = mpsc::channel();
        let finished = Mutex::new(finished);
        let worker = scope.spawn(move || {
            let result = work();
            let _ = done.send(()); // the receiver outlives the worker
            result
        });
        let mut raised = None;
        while py.detach(|| wait(&finished)) == Err(mpsc::RecvTimeoutError::Timeout) {
            if let Err(error) = py.check_signals() {
                stop.store(true, Ordering::Relaxed);
                raised = Some(error);
            }
        }
        match (raised, py.detach(|| worker.join())) {
            (Some(error), _) => Err(error),
            (None, Ok(result)) => Ok(result),
            (None, Err(panic)) => std::panic::resume_unwind(panic),
        }
    })
}

/// Waits for the worker to finish, at most for [`PACE`].
fn wait(finished: &Mutex<mpsc::Receiver<()>>) -> Result<(), mpsc::RecvTimeoutError> {
    finished.lock().unwrap_or_else(PoisonError::into_inner).recv_timeout(PACE)
}

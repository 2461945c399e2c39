//! Limits of time and memory for one input, and the input on disk before it is tried, whatever kills the process.

use std::alloc::{GlobalAlloc, Layout, System};
use std::fs::File;
use std::io::Write;
use std::path::Path;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering::Relaxed};
use std::thread;
use std::time::{Duration, Instant};

/// Most that an input may take, s and bytes.
const SECONDS: u64 = 5;
const BYTES: usize = 512 << 20;

/// Times as long that it may wait, for a processor that others use.
const WAITING: u32 = 60;

static HELD: AtomicUsize = AtomicUsize::new(0);
static INPUTS: AtomicU64 = AtomicU64::new(0);

/// The system's allocator with a count of what is held.
pub(crate) struct Counting;

// SAFETY: passes every call on
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        let held = HELD.fetch_add(layout.size(), Relaxed) + layout.size();
        if held > BYTES && held - layout.size() <= BYTES {
            stopped("memory");
        }
        // SAFETY: the caller's layout
        unsafe { System.alloc(layout) }
    }
    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        HELD.fetch_sub(layout.size(), Relaxed);
        // SAFETY: the caller's pointer and layout
        unsafe { System.dealloc(pointer, layout) }
    }
}

/// Ends the process with the name of the limit; the driver finds the input where [`Guard::hold`] wrote it.
fn stopped(limit: &str) {
    let _ = writeln!(
        std::io::stderr(),
        "\nlimit of {limit} exceeded: {SECONDS} s and {BYTES} bytes for an input"
    );
    std::process::exit(3);
}

/// Returns the processor time of the main thread, on systems that report it.
fn busy() -> Duration {
    let statistics = std::fs::read_to_string("/proc/self/schedstat").unwrap_or_default();
    let nanoseconds = statistics.split_whitespace().next().and_then(|word| word.parse().ok());
    Duration::from_nanos(nanoseconds.unwrap_or(0))
}

/// Watches inputs.
pub(crate) struct Guard {
    current: File,
}

impl Guard {
    /// Starts the watch; inputs are written to `file`.
    pub(crate) fn new(file: &Path) -> std::io::Result<Self> {
        thread::spawn(|| {
            let (mut last, mut since) = (0, (Instant::now(), busy()));
            loop {
                thread::sleep(Duration::from_millis(200));
                let now = INPUTS.load(Relaxed);
                let limit = Duration::from_secs(SECONDS);
                if now != last {
                    (last, since) = (now, (Instant::now(), busy()));
                } else if now % 2 == 1 && (busy() - since.1 > limit || since.0.elapsed() > WAITING * limit) {
                    stopped("time");
                }
            }
        });
        Ok(Self { current: File::create(file)? })
    }

    /// Before an input: writes its length and bytes.
    pub(crate) fn hold(&mut self, input: &[u8]) -> std::io::Result<()> {
        use std::os::unix::fs::FileExt;
        let mut record = (input.len() as u64).to_le_bytes().to_vec();
        record.extend(input);
        self.current.write_all_at(&record, 0)?;
        INPUTS.fetch_add(1, Relaxed);
        Ok(())
    }

    /// After it.
    pub(crate) fn release(&self) {
        INPUTS.fetch_add(1, Relaxed);
    }
}

//! Which code an input reaches, by the counters of `-C instrument-coverage`, a flag of stable rustc.
//!
//! Built without it (`--cfg coverage_counters` goes with it), nothing is ever new.

/// What was reached so far: for each counter the orders of magnitude it has had, as bits.
#[derive(Default)]
pub(crate) struct Reached(Vec<u8>);

impl Reached {
    /// Forgets the counts before an input.
    pub(crate) fn start(&mut self) {
        let (begin, count) = counters();
        // SAFETY: `count` counters lie there
        unsafe { begin.write_bytes(0, count) }
    }

    /// Whether the input since [`Reached::start`] reached what none had.
    pub(crate) fn is_new(&mut self) -> bool {
        let (begin, count) = counters();
        self.0.resize(count, 0);
        let mut is_new = false;
        for (i, seen) in self.0.iter_mut().enumerate() {
            // SAFETY: `count` counters lie there
            let times = unsafe { begin.add(i).read() };
            if times > 0 {
                let bit = 1_u8 << times.ilog2().min(7);
                is_new |= *seen & bit == 0;
                *seen |= bit;
            }
        }
        is_new
    }

    /// Counters reached, and all there are.
    pub(crate) fn share(&self) -> (usize, usize) {
        (self.0.iter().filter(|seen| **seen > 0).count(), self.0.len())
    }
}

/// Where the counters begin, and how many there are. Instrumented code writes to them: no slice is made of them.
#[cfg(coverage_counters)]
fn counters() -> (*mut u64, usize) {
    // SAFETY: compiler-rt's functions of these names, which the flag links in
    unsafe extern "C" {
        fn __llvm_profile_begin_counters() -> *mut u64;
        fn __llvm_profile_end_counters() -> *mut u64;
    }
    // SAFETY: they are the ends of one array
    unsafe {
        let (begin, end) = (__llvm_profile_begin_counters(), __llvm_profile_end_counters());
        (begin, end.offset_from_unsigned(begin))
    }
}

#[cfg(not(coverage_counters))]
fn counters() -> (*mut u64, usize) {
    (std::ptr::NonNull::dangling().as_ptr(), 0)
}

//! Measurement of the peak throughput of one core, in operations per second, with independent multiply-adds.

use std::error::Error;
use std::hint::black_box;
use std::time::{Duration, Instant};

/// Number of independent chains: enough to hide four cycles of latency on two units.
const CHAINS: usize = 12;
const LINKS: usize = 10_000;

/// Defines a function that computes `x ← a x + b` repeatedly in all chains, each in one register.
macro_rules! chains {
    ($(#[$feature:meta])? $name:ident, $of:expr, |$x:ident, $a:ident, $b:ident| $mul_add:expr) => {
        $(#[$feature])?
        fn $name() {
            let ($a, $b) = ($of(black_box(1.0 - 1e-9)), $of(black_box(1e-9)));
            let mut all = [$of(1.0); CHAINS];
            for _ in 0..LINKS {
                for $x in &mut all {
                    *$x = $mul_add;
                }
            }
            black_box(all);
        }
    };
}

chains!(one, std::convert::identity::<f64>, |x, a, b| *x * a + b);

#[cfg(target_arch = "x86_64")]
mod wide {
    use super::{CHAINS, LINKS, black_box};
    use std::arch::x86_64 as x86;

    chains!(
        #[target_feature(enable = "avx2,fma")]
        four,
        x86::_mm256_set1_pd,
        |x, a, b| x86::_mm256_fmadd_pd(*x, a, b)
    );
    chains!(
        #[target_feature(enable = "avx512f")]
        eight,
        x86::_mm512_set1_pd,
        |x, a, b| x86::_mm512_fmadd_pd(*x, a, b)
    );

    /// Returns the number of lanes in a register of the instruction set, and the function that computes the
    /// chains; `None` if the processor does not have this instruction set.
    pub(super) fn chains(set: &str) -> Option<(usize, fn())> {
        let has_four = is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma");
        // SAFETY of both: the guard on the same line checks that the processor has the instructions
        match set {
            "avx2+fma" if has_four => Some((4, || unsafe { four() })),
            "avx512" if is_x86_feature_detected!("avx512f") => Some((8, || unsafe { eight() })),
            _ => None,
        }
    }
}

#[cfg(not(target_arch = "x86_64"))]
mod wide {
    use super::{CHAINS, LINKS, black_box};

    chains!(two, |x: f64| [x; 2], |x, a, b| [x[0].mul_add(a[0], b[0]), x[1].mul_add(a[1], b[1])]);

    /// Returns the number of lanes in a register of the instruction set, and the function that computes the
    /// chains; `None` if the processor does not have this instruction set.
    pub(super) fn chains(set: &str) -> Option<(usize, fn())> {
        (set == "fma" && cfg!(target_arch = "aarch64")).then_some((2, two))
    }
}

/// Returns the peak throughput with an instruction set, in 1e9 operations per second, as JSON. A multiply-add
/// counts as two operations. `seconds` is the duration of the measurement.
///
/// The throughput of scalar instructions of a wider set is not measured, because the compiler would vectorise
/// chains of single numbers. It is that of one lane.
pub(crate) fn answer(set: &str, seconds: f64) -> Result<String, Box<dyn Error>> {
    let found = if set == "baseline" { Some((1, one as fn())) } else { wide::chains(set) };
    let (lanes, chains) =
        found.ok_or_else(|| format!("this processor does not have the instruction set '{set}'"))?;
    let gflops =
        (2 * CHAINS * LINKS * lanes) as f64 / fastest(chains, Duration::try_from_secs_f64(seconds)?) * 1e-9;
    Ok(format!("{{\"gflops\": {gflops}}}"))
}

/// Calls `chains` repeatedly for `seconds` and returns the shortest time of a call, s.
fn fastest(chains: fn(), seconds: Duration) -> f64 {
    let (end, mut fastest) = (Instant::now() + seconds, f64::INFINITY);
    while Instant::now() < end {
        let started = Instant::now();
        chains();
        fastest = fastest.min(started.elapsed().as_secs_f64());
    }
    fastest
}

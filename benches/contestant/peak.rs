//! The ceiling: how many operations a second one core does when nothing but multiply-adds is asked of it.

use onorbit_core::spatial::{Lanes4, Lanes8, Real};
use std::error::Error;
use std::hint::black_box;
use std::time::{Duration, Instant};

/// Chains that run side by side: enough to hide four cycles of latency on two units.
const CHAINS: usize = 12;
const LINKS: usize = 10_000;

/// Billions of operations per second with the lanes of that instruction set. (Of one number at a time it is the
/// share of a lane: chains of single numbers the compiler would put side by side itself.)
pub(crate) fn answer(set: &str, seconds: f64) -> Result<String, Box<dyn Error>> {
    let seconds = Duration::try_from_secs_f64(seconds)?;
    let gflops = match set {
        "avx2+fma" | "fma" if Lanes4::is_available() => best::<Lanes4>(seconds),
        "avx512" if Lanes8::is_available() => best::<Lanes8>(seconds),
        "baseline" => best::<f64>(seconds),
        _ => return Err(format!("{set} is not here").into()),
    };
    Ok(format!("{{\"gflops\": {gflops}}}"))
}

fn best<S: Real>(seconds: Duration) -> f64 {
    let (end, mut fastest) = (Instant::now() + seconds, f64::INFINITY);
    while Instant::now() < end {
        let started = Instant::now();
        black_box(chains(S::of(black_box(1.0 - 1e-9)), S::of(black_box(1e-9))));
        fastest = fastest.min(started.elapsed().as_secs_f64());
    }
    (2 * CHAINS * LINKS * S::LANES) as f64 / fastest * 1e-9
}

/// `x ← a x + b` in all chains.
fn chains<S: Real>(a: S, b: S) -> [S; CHAINS] {
    S::enter(
        #[inline(always)]
        || {
            let mut x = [S::of(1.0); CHAINS];
            for _ in 0..LINKS {
                for x in &mut x {
                    *x = x.mul_add(a, b);
                }
            }
            x
        },
    )
}

//! Branch-free sine and cosine of scalars with one or several lanes.

use super::scalar::Real;

/// Magnitude of an angle, rad, below which the fast range reduction keeps all digits.
pub(super) const FAST_SINE_LIMIT: f64 = 1e5;

/// Returns the sine and cosine of `x`, rad, for `|x| < 1e5`.
///
/// Reduces the angle to `r = x − k π/2` with `|r| ≤ π/4`, where π/2 is split into three parts (Cody and
/// Waite), then evaluates the minimax polynomials of FreeBSD's `k_sin.c` and `k_cos.c`.
#[inline(always)]
pub(super) fn sin_cos<S: Real>(x: S) -> (S, S) {
    const ROUND: f64 = 6_755_399_441_055_744.0; // 1.5 · 2^52: adding it rounds to an integer
    let k = x.mul_add(S::of(std::f64::consts::FRAC_2_PI), S::of(ROUND)) - S::of(ROUND);
    // the first two parts of π/2 have at most 33 bits, so that k · part is exact
    let r = k.mul_add(S::of(-1.570_796_326_734_125_6), x);
    let r = k.mul_add(S::of(-6.077_100_506_303_966e-11), r);
    let r = k.mul_add(S::of(-2.022_266_248_795_950_6e-21), r);

    let z = r * r;
    let (s, c) = (sine(r, z), cosine(z));

    // k mod 4 determines which of ±s and ±c is the sine
    let quarter = (k * S::of(0.25) + S::of(ROUND)) - S::of(ROUND);
    let m = k - quarter * S::of(4.0); // in -2..=2, where ±2 are the same quadrant
    let is_odd = S::less((m.abs() - S::of(1.0)).abs(), S::of(0.5));
    let (a, b) = (S::select(is_odd, c, s), S::select(is_odd, s, c));
    // sine is negative for m in {-1, ±2}; cosine for m in {1, ±2}
    let is_half = S::less(S::of(1.5), m.abs());
    let flip_sine =
        S::select(is_half, S::of(-1.0), S::select(S::less(m, S::of(-0.5)), S::of(-1.0), S::of(1.0)));
    let flip_cosine =
        S::select(is_half, S::of(-1.0), S::select(S::less(S::of(0.5), m), S::of(-1.0), S::of(1.0)));
    (a * flip_sine, b * flip_cosine)
}

/// Returns `sin r` for `|r| ≤ π/4`, where `z = r²`.
#[inline(always)]
fn sine<S: Real>(r: S, z: S) -> S {
    let p = z.mul_add(S::of(1.589_690_995_211_55e-10), S::of(-2.505_076_025_340_686_3e-8));
    let p = z.mul_add(p, S::of(2.755_731_370_707_006_8e-6));
    let p = z.mul_add(p, S::of(-1.984_126_982_985_795e-4));
    let p = z.mul_add(p, S::of(8.333_333_333_322_49e-3));
    let p = z.mul_add(p, S::of(-1.666_666_666_666_663_2e-1));
    (z * r).mul_add(p, r)
}

/// Returns `cos r` for `|r| ≤ π/4`, where `z = r²`, and compensates the rounding error of `1 - z/2`.
#[inline(always)]
fn cosine<S: Real>(z: S) -> S {
    let p = z.mul_add(S::of(-1.135_964_755_778_819_5e-11), S::of(2.087_572_321_298_175e-9));
    let p = z.mul_add(p, S::of(-2.755_731_435_139_066_3e-7));
    let p = z.mul_add(p, S::of(2.480_158_728_947_673e-5));
    let p = z.mul_add(p, S::of(-1.388_888_888_887_411e-3));
    let p = z.mul_add(p, S::of(4.166_666_666_666_66e-2));
    let half = z * S::of(0.5);
    let w = S::of(1.0) - half;
    w + ((S::of(1.0) - w) - half + z * z * p)
}

#[cfg(test)]
mod tests {
    use super::sin_cos;
    use crate::spatial::{Fused, Real};

    #[test]
    fn agrees_with_the_library_over_all_quadrants_and_far_out() {
        for scale in [1e-8, 1.0, 10.0, 1e3, 9.9e4] {
            for i in -1000..=1000 {
                let x = scale * f64::from(i) / 1000.0;
                let (s, c) = sin_cos(x);
                // 1.2e-16 is half a unit in the last place near 1; the tolerance is twice as large, to allow
                // for the error of the polynomial
                assert!((s - x.sin()).abs() < 2.3e-16, "sin {x}: {s} {}", x.sin());
                assert!((c - x.cos()).abs() < 2.3e-16, "cos {x}: {c} {}", x.cos());
                if Fused::is_available() {
                    let (sf, cf) = Fused::of(x).sin_cos();
                    assert!((sf.0 - s).abs() < 2.3e-16 && (cf.0 - c).abs() < 2.3e-16);
                }
            }
        }
    }

    #[test]
    fn far_angles_fall_back_to_the_library() {
        assert_eq!(Real::sin_cos(3.0e7_f64), 3.0e7_f64.sin_cos());
    }
}

//! Combines errors into a maximum and relates them to a scale.

/// Returns the larger of two numbers, and NaN if either is NaN.
pub(super) fn worst(a: f64, b: f64) -> f64 {
    if b > a || b.is_nan() { b } else { a }
}

/// Returns `error / scale`; zero if the error is zero.
pub(super) fn relative(error: f64, scale: f64) -> f64 {
    if error == 0.0 { 0.0 } else { error / scale.max(f64::MIN_POSITIVE) }
}

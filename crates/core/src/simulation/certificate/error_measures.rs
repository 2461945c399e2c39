//! Functions that combine errors into a maximum and relate them to a scale.

/// Returns the larger of two numbers, or NaN if either is NaN.
pub(super) fn worst(a: f64, b: f64) -> f64 {
    if b > a || b.is_nan() { b } else { a }
}

/// Returns `error / scale`, or zero if the error is zero. The smallest positive normal number replaces a
/// scale of zero.
pub(super) fn relative(error: f64, scale: f64) -> f64 {
    if error == 0.0 { 0.0 } else { error / scale.max(f64::MIN_POSITIVE) }
}

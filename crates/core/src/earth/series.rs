//! Trigonometric series for a coordinate of the Sun or the Moon.

use super::precession::polynomial;

/// Series `Σ cᵢ Tⁱ + Σ (a sin θ + b cos θ)`, in which `T` is in Julian centuries of TT from J2000.0 and each
/// `θ` is a sum of multiples of `l, l', F, D, Ω` and planetary longitudes. Terms in which `l'` has the
/// multiple `k` are multiplied by `(1 - 0.002516 T)` to the power `|k|`.
pub(super) struct Series {
    pub(super) polynomial: &'static [f64],
    /// Multiples of the arguments in `θ`, and the coefficients `a` and `b`, for each term.
    pub(super) terms: &'static [([i8; 8], [f64; 2])],
}

impl Series {
    /// Returns the sum at `t`, Julian centuries, in the unit of the coefficients; `arguments` are in rad.
    pub(super) fn sum(&self, t: f64, arguments: &[f64; 8]) -> f64 {
        // terms with l' decrease with the eccentricity of the Earth's orbit (Meeus, Astronomical Algorithms,
        // ch. 47)
        let decay = 1.0 - 0.002_516 * t;
        let term = |(multiples, [a, b]): &([i8; 8], [f64; 2])| {
            let angle: f64 = multiples.iter().zip(arguments).map(|(k, x)| f64::from(*k) * x).sum();
            let (sine, cosine) = angle.sin_cos();
            (a * sine + b * cosine) * decay.powi(i32::from(multiples[1].abs()))
        };
        polynomial(self.polynomial, t) + self.terms.iter().map(term).sum::<f64>()
    }
}

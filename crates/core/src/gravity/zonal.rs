//! Zonal harmonics up to degree 6 in closed form.

use nalgebra::{Matrix3, Vector3};

/// Highest degree that is evaluated in closed form.
pub(super) const HIGHEST: usize = 6;

/// Unnormalised coefficients `J2` to `J6` of the Earth: `Jn = -√(2n + 1) C̄n0`.
///
/// Source: EGM2008 (tide-free), Pavlis et al., J. Geophysical Research 117, B04406, 2012.
pub(super) const EARTH: [f64; 5] = [
    1.082_626_173_852_223e-3,
    -2.532_410_518_567_722e-6,
    -1.619_897_599_916_973e-6,
    -2.277_535_907_308_361e-7,
    5.406_665_762_838_132e-7,
];

/// Part of a planet's field that is symmetric about the planet's z axis: the potential `U = -(μ/r) Σ Jn
/// (R/r)ⁿ Pn(u)` with `u = z/r`, the Legendre polynomials `Pn`, the gravitational parameter `μ`, m³/s², and
/// the reference radius `R`, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Zonal {
    pub(super) mu: f64,
    pub(super) radius: f64,
    /// Coefficients `J2` to `J6`, not normalised.
    pub(super) j: [f64; 5],
}

impl Zonal {
    /// Returns the factors `cn = Jn (R/r)ⁿ` for `n` from 2 to 6, the direction `r̂`, `u = z/r`, and the
    /// distance `|r|`, m, at position `r` from the planet's centre, m.
    #[inline]
    fn at(&self, r: &Vector3<f64>) -> ([f64; 5], Vector3<f64>, f64, f64) {
        let distance = r.norm();
        let (inverse, mut power) = (1.0 / distance, self.radius / distance);
        let ratio = power;
        let c = self.j.map(|j| {
            power *= ratio;
            j * power
        });
        (c, r * inverse, r.z * inverse, distance)
    }

    /// Returns the acceleration `g = (μ/r²) Σ cn (P'n+1 r̂ - P'n ẑ)`, m/s², at position `r` from the planet's
    /// centre, m, in the axes of `r`.
    pub(super) fn acceleration(&self, r: &Vector3<f64>) -> Vector3<f64> {
        let (c, up, u, distance) = self.at(r);
        let p = first(u);
        let axial = Vector3::new(0.0, 0.0, dot(&c, &p[..5]));
        (up * dot(&c, &p[1..]) - axial) * (self.mu / (distance * distance))
    }

    /// Returns the acceleration `g`, m/s², and its gradient, 1/s², at position `r` from the planet's centre,
    /// m, in the axes of `r`.
    ///
    /// `∂g/∂r = (μ/r³) Σ cn [P'n+1 1 + P''n+1 (r̂ ẑᵀ + ẑ r̂ᵀ) - P''n+2 r̂ r̂ᵀ - P''n ẑ ẑᵀ]` with the unit
    /// matrix `1`.
    pub(super) fn gradient(&self, r: &Vector3<f64>) -> (Vector3<f64>, Matrix3<f64>) {
        let (c, up, u, distance) = self.at(r);
        let (p, pp) = (first(u), second(u));
        let [low, middle, high] = [0, 1, 2].map(|k| dot(&c, &pp[k..k + 5]));
        let along = dot(&c, &p[1..]);
        let z = Vector3::z();
        let mixed = up * z.transpose() * middle;
        let tensor = Matrix3::identity() * along + mixed + mixed.transpose()
            - up * up.transpose() * high
            - z * z.transpose() * low;
        let scale = self.mu / (distance * distance);
        ((up * along - z * dot(&c, &p[..5])) * scale, tensor * (scale / distance))
    }
}

fn dot(a: &[f64; 5], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Returns `P'2(u)` to `P'7(u)`, first derivatives of the Legendre polynomials.
fn first(u: f64) -> [f64; 6] {
    let v = u * u;
    [
        3.0 * u,
        0.5 * (15.0 * v - 3.0),
        0.5 * u * (35.0 * v - 15.0),
        0.125 * (v * (315.0 * v - 210.0) + 15.0),
        0.125 * u * (v * (693.0 * v - 630.0) + 105.0),
        0.0625 * (v * (v * (3003.0 * v - 3465.0) + 945.0) - 35.0),
    ]
}

/// Returns `P''2(u)` to `P''8(u)`, second derivatives of the Legendre polynomials.
fn second(u: f64) -> [f64; 7] {
    let v = u * u;
    [
        3.0,
        15.0 * u,
        0.5 * (105.0 * v - 15.0),
        0.5 * u * (315.0 * v - 105.0),
        0.125 * (v * (3465.0 * v - 1890.0) + 105.0),
        0.125 * u * (v * (9009.0 * v - 6930.0) + 945.0),
        0.0625 * (v * (v * (45045.0 * v - 45045.0) + 10395.0) - 315.0),
    ]
}

//! Earth models in the units of SGP4: Earth radii, minutes, radians.

use crate::spatial::Real;
use std::f64::consts::TAU;

/// Earth model of an element set. Published element sets are fitted with [`EarthModel::Wgs72`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum EarthModel {
    /// WGS-72 with the rounded constants of Spacetrack Report #3.
    Wgs72Old,
    /// WGS-72, with the constant `kₑ = √μ` of SGP4 computed from the gravitational parameter.
    #[default]
    Wgs72,
    /// WGS-84, with `kₑ` computed from the gravitational parameter.
    Wgs84,
}

impl EarthModel {
    /// All models, each with the name used in Python and YAML.
    pub const ALL: [(&'static str, Self); 3] =
        [("wgs72old", Self::Wgs72Old), ("wgs72", Self::Wgs72), ("wgs84", Self::Wgs84)];

    /// Returns the gravitational parameter, m³/s².
    pub fn mu(self) -> f64 {
        match self {
            Self::Wgs72Old => 3.986_007_996_4e14,
            Self::Wgs72 => 3.986_008e14,
            Self::Wgs84 => 3.986_005e14,
        }
    }

    /// Returns the constants of the model in the units of SGP4.
    pub(super) fn earth(self) -> Earth {
        // kₑ = 60/√(aₑ³/μ)
        let ke = |a: f64| 60.0 / (a * a * a / (self.mu() / 1e9)).sqrt();
        let (j2, j3, j4) = (0.001_082_616, -0.000_002_538_81, -0.000_001_655_97);
        match self {
            Self::Wgs72Old => Earth::new(6378.135, 0.074_366_916_1, j2, j3, j4),
            Self::Wgs72 => Earth::new(6378.135, ke(6378.135), j2, j3, j4),
            Self::Wgs84 => Earth::new(
                6378.137,
                ke(6378.137),
                0.001_082_629_989_05,
                -0.000_002_532_153_06,
                -0.000_001_610_987_61,
            ),
        }
    }
}

/// Constants of an Earth model.
///
/// Source: AIAA 2006-6753, table 1 and the constants of its code.
#[derive(Clone, Copy, Debug)]
pub(super) struct Earth {
    /// Equatorial radius `aₑ`, km.
    pub(super) radius_km: f64,
    /// `kₑ = √μ`, Earth radii^{3/2}/min.
    pub(super) ke: f64,
    pub(super) j2: f64,
    pub(super) j3_j2: f64,
    pub(super) j4: f64,
}

impl Earth {
    fn new(radius_km: f64, ke: f64, j2: f64, j3: f64, j4: f64) -> Self {
        Self { radius_km, ke, j2, j3_j2: j3 / j2, j4 }
    }
}

/// Mean elements at one instant; angles in rad, mean motion in rad/min.
#[derive(Clone, Copy, Debug)]
pub(super) struct Mean<S = f64> {
    /// Brouwer's mean motion `n″`.
    pub(super) n: S,
    pub(super) e: S,
    pub(super) i: S,
    /// Right ascension of the ascending node, `Ω`.
    pub(super) node: S,
    /// Argument of perigee, `ω`.
    pub(super) perigee: S,
    /// Mean anomaly, `M`.
    pub(super) anomaly: S,
}

/// Returns the remainder of the division of an angle by 2π. It has the sign of the angle, as Lyddane's
/// variables require. The function is valid up to 2²⁶ turns.
#[inline(always)]
pub(super) fn wrap_angle<S: Real>(angle: S) -> S {
    const ROUND: f64 = 6_755_399_441_055_744.0; // adding 1.5 × 2⁵² rounds to an integer
    // 2π as a sum of two numbers of at most 26 bits, so that multiples of them are exact
    const HEAD: f64 = f64::from_bits(TAU.to_bits() & !((1 << 27) - 1));
    const TAIL: f64 = TAU - HEAD;
    let (zero, turn) = (S::of(0.0), S::of(TAU));
    let k = (angle * S::of(1.0 / TAU) + S::of(ROUND)) - S::of(ROUND);
    let rest = (angle - k * S::of(HEAD)) - k * S::of(TAIL);
    let up = S::select(S::less(rest, zero), rest + turn, rest);
    let down = S::select(S::less(zero, rest), rest - turn, rest);
    S::select(S::less(angle, zero), down, up)
}

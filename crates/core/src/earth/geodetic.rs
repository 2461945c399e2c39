//! Geodetic coordinates.

use nalgebra::Vector3;

use super::error::EarthError;

/// Oblate ellipsoid of revolution with its axis along the Earth's axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ellipsoid {
    /// Radius of the equator, m.
    pub radius: f64,
    /// Flattening `f`: the polar radius is `1 - f` times the equatorial radius.
    pub flattening: f64,
}

/// Ellipsoid of the World Geodetic System 1984.
///
/// Source: NGA.STND.0036, version 1.0.0, 2014, table 3.1.
pub const WGS84: Ellipsoid = Ellipsoid { radius: 6_378_137.0, flattening: 1.0 / 298.257_223_563 };

/// Geodetic latitude, longitude and altitude on an ellipsoid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Geodetic {
    /// Angle between the ellipsoid's normal and the equatorial plane, positive in the north, rad.
    pub latitude: f64,
    /// Longitude east of the zero meridian, -π to π, rad; zero on the axis.
    pub longitude: f64,
    /// Height above the ellipsoid along its normal, m.
    pub altitude: f64,
}

/// Smallest accepted distance from the centre, m. Within `a e²` = 43 km of the centre, with the equatorial
/// radius `a` and the eccentricity `e` of WGS84, normals of the ellipsoid intersect, so latitudes are not
/// unique.
const NEAREST: f64 = 50e3;

impl Geodetic {
    /// Computes the geodetic coordinates on `ellipsoid` of a position relative to the Earth's centre, in
    /// Earth-fixed axes `F`, m.
    ///
    /// # Errors
    /// [`EarthError::NearCentre`] if the position is within 50 km of the centre, and
    /// [`EarthError::NotFinite`] if it is infinite or NaN.
    ///
    /// Source: Bowring, Survey Review 23(181), 1976. The iteration continues until changes are rounding
    /// errors, so the result is accurate at every altitude.
    pub fn of(position_f: &Vector3<f64>, ellipsoid: &Ellipsoid) -> Result<Self, EarthError> {
        let distance = position_f.norm();
        if !distance.is_finite() {
            return Err(EarthError::NotFinite { name: "position", value: distance });
        }
        if distance < NEAREST {
            return Err(EarthError::NearCentre { distance, minimum: NEAREST });
        }
        let Ellipsoid { radius: a, flattening: f } = *ellipsoid;
        let (b, e2) = (a * (1.0 - f), f * (2.0 - f));
        let (p, z) = (position_f.x.hypot(position_f.y), position_f.z);
        // tan β = (1 - f) tan φ,  tan φ = (z + e² a²/b sin³ β)/(p - e² a cos³ β), from tan β₀ = z/((1 - f) p)
        let (mut sin, mut cos) = unit(a * z, b * p);
        for _ in 0..20 {
            let (sin_phi, cos_phi) = unit(z + e2 * a * a / b * sin * sin * sin, p - e2 * a * cos * cos * cos);
            let (s, c) = unit((1.0 - f) * sin_phi, cos_phi);
            let change = (s * cos - c * sin).abs();
            (sin, cos) = (s, c);
            if change < 1e-15 {
                break;
            }
        }
        // h = p cos φ + z sin φ - a √(1 - e² sin² φ)
        let (sin_phi, cos_phi) = unit(a * sin, b * cos);
        let altitude = p * cos_phi + z * sin_phi - a * (1.0 - e2 * sin_phi * sin_phi).sqrt();
        let latitude = sin_phi.atan2(cos_phi);
        let longitude = if p > 0.0 { position_f.y.atan2(position_f.x) } else { 0.0 };
        Ok(Self { latitude, longitude, altitude })
    }

    /// Returns the position from the Earth's centre, in Earth-fixed axes `F`, m, of these coordinates on
    /// `ellipsoid`.
    pub fn position(&self, ellipsoid: &Ellipsoid) -> Vector3<f64> {
        let Ellipsoid { radius: a, flattening: f } = *ellipsoid;
        let e2 = f * (2.0 - f);
        let (sin, cos) = self.latitude.sin_cos();
        // N = a/√(1 - e² sin² φ),  x, y = (N + h) cos φ,  z = ((1 - e²) N + h) sin φ
        let n = a / (1.0 - e2 * sin * sin).sqrt();
        let p = (n + self.altitude) * cos;
        let (s, c) = self.longitude.sin_cos();
        Vector3::new(p * c, p * s, ((1.0 - e2) * n + self.altitude) * sin)
    }
}

/// Returns the sine and cosine of the angle from the x axis to the point `(x, y)`.
fn unit(y: f64, x: f64) -> (f64, f64) {
    let r = (x * x + y * y).sqrt();
    (y / r, x / r)
}

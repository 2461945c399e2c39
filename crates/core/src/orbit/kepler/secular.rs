//! Kepler ellipse with the secular rates caused by the oblateness `J₂`.

use super::Kepler;
use super::conic::Conic;
use crate::orbit::error::{finite, positive};
use crate::orbit::{Orbit, OrbitError, OrbitState};
use nalgebra::{Rotation3, Unit, Vector3};

/// Kepler ellipse with secular rates of first order in J₂; the elements are mean elements.
///
/// `Ω̇ = -3/2 n J₂ (R/p)² cos i`, `ω̇ = 3/4 n J₂ (R/p)² (4 - 5 sin²i)`,
/// `Ṁ - n = 3/4 n J₂ (R/p)² √(1 - e²) (2 - 3 sin²i)`, with the node `Ω`, argument of periapsis `ω`, mean
/// anomaly `M`, mean motion `n`, reference radius `R` of the planet, semi-latus rectum `p`, inclination `i`
/// and eccentricity `e`. The given node and periapsis refer to the epoch, or to the time of periapsis if that
/// is given instead. Velocity and acceleration are the time derivatives of the mean position, which differs
/// from the osculating position by kilometres; they are not those of a body in free fall.
///
/// Source: Vallado, Fundamentals of Astrodynamics and Applications, 4th ed., eqs. 9-38, 9-40 and 9-41.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SecularJ2 {
    kepler: Kepler,
    /// Rate `Ω̇` of the node, rad/s.
    node_rate: f64,
    /// Rate `ω̇` of the argument of periapsis, rad/s.
    periapsis_rate: f64,
    /// Ratio `Ṁ/n` of the rate of the mean anomaly to the mean motion.
    pace: f64,
    /// Unit vector along the angular momentum at the epoch, axes of `I`.
    normal: Unit<Vector3<f64>>,
}

impl Kepler {
    /// Returns this ellipse with the secular rates caused by the oblateness coefficient `j2` of a planet
    /// whose axis is z and whose reference radius is `radius`, m.
    ///
    /// # Errors
    /// [`OrbitError::NotFinite`] and [`OrbitError::TooLarge`] for `j2` and `radius`,
    /// [`OrbitError::NotPositive`] for `radius`, [`OrbitError::OutOfRange`] for a `j2` beyond ±0.1 or a
    /// radius below 1e5 m, and [`OrbitError::NotClosed`] for an open orbit.
    pub fn with_secular_j2(self, j2: f64, radius: f64) -> Result<SecularJ2, OrbitError> {
        if finite("j2", j2)?.abs() > 0.1 {
            return Err(OrbitError::OutOfRange {
                name: "j2",
                value: j2,
                expected: "a number from -0.1 to 0.1",
            });
        }
        if positive("radius", radius)? < 1e5 {
            let expected = "at least 1e5 m (in metres, not kilometres)";
            return Err(OrbitError::OutOfRange { name: "radius", value: radius, expected });
        }
        let Conic::Ellipse { n, .. } = self.conic else {
            return Err(OrbitError::NotClosed { eccentricity: self.eccentricity() });
        };
        let normal = Unit::new_normalize(self.p_i.cross(&self.q_i));
        let (cos, sin2) = (normal.z, normal.x * normal.x + normal.y * normal.y);
        let beta = (self.shape.one_minus_e * (1.0 + self.shape.e)).sqrt();
        let k = 0.75 * j2 * (radius / self.semi_latus_rectum()).powi(2);
        Ok(SecularJ2 {
            kepler: self,
            node_rate: -2.0 * n * k * cos,
            periapsis_rate: n * k * (4.0 - 5.0 * sin2),
            pace: 1.0 + k * beta * (2.0 - 3.0 * sin2),
            normal,
        })
    }
}

impl SecularJ2 {
    /// Returns the rates of the node and of the argument of periapsis, `(Ω̇, ω̇)`, rad/s.
    pub fn rates(&self) -> (f64, f64) {
        (self.node_rate, self.periapsis_rate)
    }
}

impl Orbit for SecularJ2 {
    fn mu(&self) -> Option<f64> {
        self.kepler.mu()
    }

    fn state(&self, t: f64) -> Result<OrbitState, OrbitError> {
        let dt = finite("time", t)? - self.kepler.epoch;
        let s = self.kepler.state(self.kepler.epoch + self.pace * dt)?;
        // rotate about the orbit normal by ω̇ t, then about z by Ω̇ t
        let node = Rotation3::from_axis_angle(&Vector3::z_axis(), self.node_rate * dt);
        let turn = node * Rotation3::from_axis_angle(&self.normal, self.periapsis_rate * dt);
        let (r, v) = (turn * s.position, turn * s.velocity * self.pace);
        let a = turn * s.acceleration * (self.pace * self.pace);
        // w = Ω̇ ẑ + ω̇ n̂ rotates with the node: ẇ = Ω̇ ẑ × ω̇ n̂
        let (about_z, about_n) = (Vector3::z() * self.node_rate, node * *self.normal * self.periapsis_rate);
        let (w, w_dot) = (about_z + about_n, about_z.cross(&about_n));
        let carried = w.cross(&r);
        Ok(OrbitState {
            position: r,
            velocity: v + carried,
            // r̈ = a + 2 w × v + ẇ × r + w × (w × r)
            acceleration: a + w.cross(&v) * 2.0 + w_dot.cross(&r) + w.cross(&carried),
        })
    }
}

//! Gravity as felt in a frame that falls with the reference: the force on each body.

use nalgebra::Vector3;

use super::error::Place;
use super::{Effect, EnvironmentError, Reference, Scene, Wrench};
use crate::gravity::{point_mass, tide};

/// What happens where the reference does not itself fall freely in the field.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ReferenceMotion {
    /// The robot obeys the field and falls away from such a reference, as physics says.
    #[default]
    True,
    /// Tides only: the robot is carried along by the reference.
    Carried,
}

/// The planet's pull on every body, less the acceleration of `W`'s origin.
///
/// `F_k = m_k [g(r_k) - r̈_ref]`, `g(r) = -μ r/|r|³`, `r_k = r_ref + c_k`, with `c_k` the centre of
/// mass of body k in `W`. Where the reference obeys `g` this is the tide, formed without
/// subtracting two nearly equal pulls. A body is taken as a point: the second-order force on
/// an extended one is left out.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct DifferentialGravity {
    /// What to do with the part of `r̈_ref` that is not gravity.
    pub motion: ReferenceMotion,
}

const NAME: &str = "gravity";

impl DifferentialGravity {
    /// The part of gravity that the reference does not follow, `g(r_ref) - r̈_ref`, m/s², `W` axes.
    ///
    /// Zero on a Kepler orbit, bit for bit; `None` around no planet.
    pub fn residual(reference: &Reference<'_>) -> Option<Vector3<f64>> {
        let s = &reference.state;
        Some(point_mass(reference.gravity?.mu(), &s.position) - s.acceleration)
    }
}

impl Effect for DifferentialGravity {
    fn name(&self) -> &str {
        NAME
    }

    fn requires_orbit(&self) -> bool {
        true
    }

    fn reads_velocities(&self) -> bool {
        false
    }

    /// # Errors
    /// [`EnvironmentError::NoPlanet`], and [`EnvironmentError::InsidePlanet`] where the
    /// reference or a body comes nearer to the centre than any planet of that mass allows.
    fn add_wrenches(&self, scene: &Scene<'_>, wrenches: &mut [Wrench]) -> Result<(), EnvironmentError> {
        let planet = scene.planet(NAME)?;
        let residual = match self.motion {
            ReferenceMotion::True => {
                point_mass(planet.mu, &planet.reference.position) - planet.reference.acceleration
            }
            ReferenceMotion::Carried => Vector3::zeros(),
        };
        for (k, (body, wrench)) in scene.paired(wrenches)?.enumerate() {
            let (tide, distance) = tide(planet.mu, &planet.reference.position, &body.com);
            planet.outside(Place::Body(k), distance)?;
            // F = m [(g(r) - g(R)) + (g(R) - r̈_ref)]
            wrench.force += (tide + residual) * body.mass;
        }
        Ok(())
    }
}

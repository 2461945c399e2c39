//! Torque of a spherical planet's field on each extended body.

use super::error::Place;
use super::{Effect, EnvironmentError, Scene, Wrench};

/// Gravity-gradient torque of each body about its own centre of mass, at its own position.
///
/// `T = (3μ/r³) r̂ × I r̂`, all in `W` axes; `r` runs from the planet's centre to the body's centre
/// of mass and `I` is the inertia about that, in kg m². The force that goes with the body's
/// place is [`super::DifferentialGravity`]: an articulated robot needs both.
///
/// Source: Hughes, Spacecraft Attitude Dynamics, Wiley 1986, section 8.1.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct GravityGradient;

const NAME: &str = "gravity gradient";

impl Effect for GravityGradient {
    fn name(&self) -> &str {
        NAME
    }

    fn requires_orbit(&self) -> bool {
        true
    }

    /// # Errors
    /// [`EnvironmentError::NoPlanet`] and [`EnvironmentError::InsidePlanet`].
    fn add_wrenches(&self, scene: &Scene<'_>, wrenches: &mut [Wrench]) -> Result<(), EnvironmentError> {
        let planet = scene.planet(NAME)?;
        for (k, (body, wrench)) in scene.paired(wrenches)?.enumerate() {
            let r = planet.reference.position + body.com;
            let distance = planet.outside(Place::Body(k), r.norm())?;
            // T = (3μ/r³) r̂ × I r̂
            let up = r / distance;
            let rate2 = 3.0 * planet.mu / (distance * distance * distance);
            wrench.torque += up.cross(&(body.inertia * up)) * rate2;
        }
        Ok(())
    }
}

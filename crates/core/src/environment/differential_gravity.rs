//! Gravity as felt in a frame that falls with the reference: the force on each body.

use nalgebra::Vector3;

use super::eight::on_lanes;
use super::wrenches::Push;
use super::{Effect, EnvironmentError, Reference, Scene, Wrenches};
use crate::gravity::{point_mass, tide};
use crate::spatial::{Real, Vec3};

/// What happens where the reference does not itself fall freely in the field.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ReferenceMotion {
    /// The robot obeys the field and falls away from such a reference, as physics says.
    #[default]
    True,
    /// Tides only: the robot is carried along by the reference.
    Carried,
}

/// The pull of planet and third bodies on every body, less the acceleration of `W`'s origin.
///
/// `F_k = m_k [g(r_k) - r̈_ref]`, `g` the full field, `r_k = r_ref + c_k`, with `c_k` the centre of
/// mass of body k in `W`. Where the reference obeys `g`, or carries the robot along, this is the
/// tide `g(r_k) - g(r_ref)`, formed without subtracting two nearly equal pulls. A body is taken as a
/// point: the second-order force on an extended one is left out.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct DifferentialGravity {
    /// What to do with the part of `r̈_ref` that is not gravity.
    pub motion: ReferenceMotion,
}

const NAME: &str = "gravity";

impl DifferentialGravity {
    /// The part of gravity that the reference does not follow, `g(r_ref) - r̈_ref`, m/s², `W` axes, at `t` seconds.
    ///
    /// Zero for a reference that falls freely, bit for bit; `None` around no planet.
    ///
    /// # Errors
    /// What the field says of the reference's place.
    pub fn residual(t: f64, reference: &Reference<'_>) -> Result<Option<Vector3<f64>>, EnvironmentError> {
        let Some(gravity) = reference.gravity else { return Ok(None) };
        if reference.falls_freely {
            return Ok(Some(Vector3::zeros()));
        }
        let state = &reference.state;
        Ok(Some(gravity.acceleration(t, &state.position)? - state.acceleration))
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

    fn counts_once_on(&self, _body: usize) -> bool {
        true
    }

    /// # Errors
    /// [`EnvironmentError::NoPlanet`], [`EnvironmentError::InsidePlanet`] where the reference or a body is below
    /// the lowest ground that a planet of that `μ` can have, and [`EnvironmentError::Gravity`].
    fn add_wrenches(&self, scene: &Scene<'_>, wrenches: &mut Wrenches) -> Result<(), EnvironmentError> {
        on_lanes!(scene.bodies.len(), S => self.add::<S>(scene, wrenches))
    }
}

impl DifferentialGravity {
    fn add<S: Real>(&self, scene: &Scene<'_>, wrenches: &mut Wrenches) -> Result<(), EnvironmentError> {
        let planet = scene.planet(NAME)?;
        let state = &planet.reference;
        let differs = planet.falls_freely || self.motion == ReferenceMotion::Carried;
        let residual = if differs {
            Vector3::zeros()
        } else {
            point_mass(planet.mu, &state.position) - state.acceleration
        };
        let field = scene.nearby(&planet, differs)?;
        let (origin, residual) = (Vec3::from(state.position), Vec3::from(residual));
        scene.push::<S>(
            wrenches,
            #[inline(always)]
            |group| {
                let com = group.coms();
                let (tide, distance) = tide(planet.mu, &origin, com);
                planet.all_outside(group, distance)?;
                let beyond = match field {
                    Some(field) if differs => field.difference(com)?,
                    Some(field) => field.acceleration(com)?,
                    None => Vec3::zero(),
                };
                // F = m [(g(r) - g(R)) + (g(R) - r̈_ref) + gp], g here that of the point mass
                let force = (tide + Vec3::of(&residual) + beyond) * group.masses();
                Ok(Push { force, torque: Vec3::zero() })
            },
        )
    }
}

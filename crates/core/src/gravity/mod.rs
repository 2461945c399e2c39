//! The gravity of a planet and of bodies beyond it.
//!
//! [`Gravity`] is the full field chosen: a point mass at the planet's centre and all that disturbs it.
//! Robot and reference feel the same one.

mod coefficients;
mod error;
mod expansion;
mod field;
mod gfc;
mod harmonics;
mod likeness;
mod nearby;
mod perturber;
mod point_mass;
mod series;
mod sky;
mod third_body;
mod zonal;

pub use coefficients::Coefficients;
pub use error::GravityError;
pub use field::GravityField;
pub(crate) use nearby::{Nearby, Station};
pub use perturber::{Luminary, Perturber};
pub(crate) use point_mass::{lowest_ground_cubed, point_mass, point_mass_gradient, tide};
pub(crate) use sky::Sky;
pub use third_body::ThirdBody;

use crate::earth::{Earth, Epoch};
use crate::spatial::Vec3;
use expansion::Memo;
use nalgebra::{Matrix3, Vector3};
use std::sync::Arc;

/// The full field chosen for a run.
///
/// `g(t, r) = -μ r/|r|³ + rot_if g_F(rot_fi r) + Σ [g_b(r - s_b) - g_b(-s_b)]`: the point mass, the planet's field fixed
/// in the turning planet, and the pull of every third body at `s_b` less what it does to the planet's centre.
#[derive(Clone, Debug)]
pub struct Gravity {
    mu: f64,
    field: Option<Arc<GravityField>>,
    earth: Option<Arc<Earth>>,
    third_bodies: Vec<Arc<dyn ThirdBody>>,
    memo: Memo,
}

impl Gravity {
    /// The field of a point mass with `mu`, m³/s².
    pub fn point_mass(mu: f64) -> Self {
        Self { mu, field: None, earth: None, third_bodies: Vec::new(), memo: Memo::default() }
    }

    /// A planet's field, its point mass (the model's `mu`) included, in a planet that turns as `earth` says.
    ///
    /// A field of order 0 may do without an `earth`: its axis is then z of `I`.
    ///
    /// # Errors
    /// [`GravityError::NeedsEarth`] for a field that is not symmetric about its axis.
    pub fn of_field(field: Arc<GravityField>, earth: Option<Arc<Earth>>) -> Result<Self, GravityError> {
        if earth.is_none() && field.order() > 0 {
            return Err(GravityError::NeedsEarth { field: field.name().to_owned() });
        }
        Ok(Self { field: Some(Arc::clone(&field)), earth, ..Self::point_mass(field.mu()) })
    }

    /// With one more third body.
    #[must_use]
    pub fn and(mut self, body: Arc<dyn ThirdBody>) -> Self {
        self.third_bodies.push(body);
        self
    }

    /// With the Sun or the Moon of this Earth.
    ///
    /// # Errors
    /// [`GravityError::Earth`] where it has no epoch, [`GravityError::BodyTwice`].
    pub fn with(self, body: Luminary, earth: &Arc<Earth>) -> Result<Self, GravityError> {
        let name = body.name();
        if self.third_bodies.iter().any(|known| known.name() == name) {
            return Err(GravityError::BodyTwice { name });
        }
        let gravity = self.and(Arc::new(Perturber::new(body, Arc::clone(earth))?));
        let earth = gravity.earth.clone().or_else(|| gravity.field.is_none().then(|| Arc::clone(earth)));
        Ok(Self { earth, ..gravity })
    }

    /// Gravitational parameter of the planet, m³/s².
    pub fn mu(&self) -> f64 {
        self.mu
    }

    /// Whether there is nothing but the planet's point mass.
    pub fn is_point_mass(&self) -> bool {
        self.field.is_none() && self.third_bodies.is_empty()
    }

    /// The part that is not that of the point mass, where there is one.
    pub fn field(&self) -> Option<&Arc<GravityField>> {
        self.field.as_ref()
    }

    /// The bodies beyond the planet.
    pub fn third_bodies(&self) -> &[Arc<dyn ThirdBody>] {
        &self.third_bodies
    }

    /// Instant of time zero, where the field or the bodies know it.
    pub fn epoch(&self) -> Option<Epoch> {
        self.earth.as_ref().and_then(|earth| earth.epoch())
    }

    /// Whether an orbit around `mu`, m³/s², is one around this planet: values in use for one differ by parts in a million.
    ///
    /// # Errors
    /// [`GravityError::OtherPlanet`] where they differ by more than 1e-5.
    pub fn check_orbit(&self, mu: f64) -> Result<(), GravityError> {
        if (mu - self.mu).abs() <= 1e-5 * self.mu {
            return Ok(());
        }
        Err(GravityError::OtherPlanet { field: self.mu, orbit: mu })
    }

    /// Acceleration at `r` from the planet's centre, m, axes of `I`, at `t` seconds of simulation: m/s².
    ///
    /// # Errors
    /// [`GravityError`] below the surface of a planet with a field, and what a third body says.
    #[inline]
    pub fn acceleration(&self, t: f64, r: &Vector3<f64>) -> Result<Vector3<f64>, GravityError> {
        let mut g = point_mass(self.mu, r);
        if let Some(field) = &self.field {
            g += match self.rot_fi(t) {
                None => field.acceleration(r)?,
                Some(rot_fi) => rot_fi.tr_mul(&field.acceleration(&(rot_fi * r))?),
            };
        }
        for body in &self.third_bodies {
            g += tide(body.mu(), &(-body.position(t)?).into(), Vec3::from(*r)).0.to_nalgebra();
        }
        Ok(g)
    }

    /// Its gradient `∂g/∂r`, symmetric and without trace, axes of `I`, 1/s².
    ///
    /// # Errors
    /// As [`Gravity::acceleration`].
    pub fn gradient(&self, t: f64, r: &Vector3<f64>) -> Result<Matrix3<f64>, GravityError> {
        let mut tensor = point_mass_gradient(self.mu, r);
        if let Some(field) = &self.field {
            tensor += match self.rot_fi(t) {
                None => field.gradient(r)?.1,
                Some(rot_fi) => rot_fi.tr_mul(&field.gradient(&(rot_fi * r))?.1) * rot_fi,
            };
        }
        for body in &self.third_bodies {
            tensor += point_mass_gradient(body.mu(), &(r - body.position(t)?));
        }
        Ok(tensor)
    }

    /// How the planet stands, where it is known and matters.
    #[inline]
    fn rot_fi(&self, t: f64) -> Option<Matrix3<f64>> {
        self.field.as_ref().and(self.earth.as_ref()).map(|earth| earth.rot_fi(t))
    }
}

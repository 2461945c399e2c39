//! Gravity of a planet and of third bodies.
//!
//! [`Gravity`] is the full field of a run: the point mass at the planet's centre and all perturbations. It
//! applies to both the robot and the reference orbit.

mod coefficients;
mod error;
mod expansion;
mod field;
mod gfc;
mod harmonics;
mod local_field;
mod perturber;
mod point_mass;
mod same_gravity;
mod series;
mod sky;
mod third_body;
mod zonal;

pub use coefficients::Coefficients;
pub use error::GravityError;
pub use field::GravityField;
pub(crate) use local_field::{FieldPoint, LocalField};
pub use perturber::{Luminary, Perturber};
pub(crate) use point_mass::{lowest_ground_cubed, point_mass, point_mass_gradient, tide};
pub(crate) use sky::Sky;
pub use third_body::ThirdBody;

use crate::earth::{Earth, Epoch};
use crate::spatial::Vec3;
use expansion::ExpansionCache;
use nalgebra::{Matrix3, Vector3};
use std::sync::Arc;

/// Full gravity field of a run.
///
/// `g(t, r) = -μ r/|r|³ + rot_if g_F(rot_fi r) + Σ [g_b(r - s_b) - g_b(-s_b)]`: the point mass, the
/// perturbing field `g_F` fixed in the rotating planet, and, for every third body at `s_b`, its gravity less
/// its gravity at the planet's centre. More methods are in `local_field.rs`, `sky.rs` and `same_gravity.rs`.
#[derive(Clone, Debug)]
pub struct Gravity {
    mu: f64,
    field: Option<Arc<GravityField>>,
    earth: Option<Arc<Earth>>,
    third_bodies: Vec<Arc<dyn ThirdBody>>,
    expansions: ExpansionCache,
}

impl Gravity {
    /// Creates the field of a point mass with gravitational parameter `mu`, m³/s².
    pub fn point_mass(mu: f64) -> Self {
        Self { mu, field: None, earth: None, third_bodies: Vec::new(), expansions: ExpansionCache::default() }
    }

    /// Creates the gravity of a planet that rotates like `earth`: its `field` plus the point mass with the
    /// field's `mu`.
    ///
    /// `earth` may be omitted for a field of order 0, whose axis is then the z axis of `I`.
    ///
    /// # Errors
    /// [`GravityError::NeedsEarth`] for a field that is not symmetric about its axis.
    pub fn of_field(field: Arc<GravityField>, earth: Option<Arc<Earth>>) -> Result<Self, GravityError> {
        if earth.is_none() && field.order() > 0 {
            return Err(GravityError::NeedsEarth { field: field.name().to_owned() });
        }
        Ok(Self { field: Some(Arc::clone(&field)), earth, ..Self::point_mass(field.mu()) })
    }

    /// Returns this gravity plus that of a third body.
    #[must_use]
    pub fn and(mut self, body: Arc<dyn ThirdBody>) -> Self {
        self.third_bodies.push(body);
        self
    }

    /// Returns this gravity plus that of the Sun or the Moon.
    ///
    /// # Errors
    /// [`GravityError::Earth`] without an epoch or if the position is not known at time zero;
    /// [`GravityError::BodyTwice`] if the body is already included.
    pub fn with(self, body: Luminary, earth: &Arc<Earth>) -> Result<Self, GravityError> {
        let name = body.name();
        if self.third_bodies.iter().any(|known| known.name() == name) {
            return Err(GravityError::BodyTwice { name });
        }
        let gravity = self.and(Arc::new(Perturber::new(body, Arc::clone(earth))?));
        let earth = gravity.earth.clone().or_else(|| gravity.field.is_none().then(|| Arc::clone(earth)));
        Ok(Self { earth, ..gravity })
    }

    /// Returns the gravitational parameter of the planet, m³/s².
    pub fn mu(&self) -> f64 {
        self.mu
    }

    /// Returns true if the field is only the point mass of the planet.
    pub fn is_point_mass(&self) -> bool {
        self.field.is_none() && self.third_bodies.is_empty()
    }

    /// Returns the planet's field without its point mass; `None` if the gravity has no such field.
    pub fn field(&self) -> Option<&Arc<GravityField>> {
        self.field.as_ref()
    }

    /// Returns the third bodies whose gravity is included.
    pub fn third_bodies(&self) -> &[Arc<dyn ThirdBody>] {
        &self.third_bodies
    }

    /// Returns the epoch at time zero; `None` if it is not known. It is the epoch of the Earth with which the
    /// field rotates or, if there is no field, the epoch of the positions of Sun and Moon.
    pub fn epoch(&self) -> Option<Epoch> {
        self.earth.as_ref().and_then(|earth| earth.epoch())
    }

    /// Checks that an orbit with gravitational parameter `mu`, m³/s², is around this planet. Published values
    /// for one planet differ by a fraction of about 1e-6.
    ///
    /// # Errors
    /// [`GravityError::OtherPlanet`] if the relative difference exceeds 1e-5.
    pub fn check_orbit(&self, mu: f64) -> Result<(), GravityError> {
        if (mu - self.mu).abs() <= 1e-5 * self.mu {
            return Ok(());
        }
        Err(GravityError::OtherPlanet { field: self.mu, orbit: mu })
    }

    /// Returns the acceleration, m/s², at position `r` from the planet's centre, m, and simulation time `t`,
    /// s; axes of `I`.
    ///
    /// # Errors
    /// If the planet has a field, [`GravityError::BelowSurface`] below its surface and
    /// [`GravityError::NotFinite`] for an `r` that is not finite; also the errors of third bodies.
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

    /// Returns the gradient `∂g/∂r` of the acceleration, 1/s², at position `r` from the planet's centre, m,
    /// and simulation time `t`, s; axes of `I`. The gradient is symmetric and has zero trace.
    ///
    /// # Errors
    /// The errors of [`Gravity::acceleration`].
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

    /// Returns the rotation from `I` to axes fixed in the planet at simulation time `t`, s; `None` without a
    /// field or an Earth.
    #[inline]
    fn rot_fi(&self, t: f64) -> Option<Matrix3<f64>> {
        self.field.as_ref().and(self.earth.as_ref()).map(|earth| earth.rot_fi(t))
    }
}

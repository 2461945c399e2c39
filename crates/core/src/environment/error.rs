//! Errors of effects and of the scenes in which they are evaluated.

use super::atmosphere::AtmosphereError;
use super::body_index::BodyIndex;
use super::surfaces::SurfaceError;
use crate::earth::EarthError;
use crate::gravity::GravityError;
use crate::number_text::{choice, short, unlike};
use std::error::Error;
use std::sync::Arc;

/// Errors of effects of the environment.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum EnvironmentError {
    /// The gravity of the planet and third bodies cannot be evaluated.
    #[error(transparent)]
    Gravity(#[from] GravityError),
    /// An effect that requires a planet is used without a planet.
    #[error(
        "the effect '{effect}' requires an orbit around a planet, but this run has none; give the run such \
         an orbit, or remove the effect"
    )]
    NoPlanet {
        /// Name of the effect.
        effect: &'static str,
    },
    /// An effect that requires the rotation of the Earth is used without an Earth.
    #[error(
        "the effect '{effect}' requires the rotation of the Earth, but this run has no Earth; pass 'earth' \
         to the run (in YAML, give an epoch)"
    )]
    NoEarth {
        /// Name of the effect.
        effect: &'static str,
    },
    /// The reference or a body is inside the planet.
    #[error(
        "the effect '{effect}' cannot be evaluated, because {what} is below ground, {distance} m from the \
         planet's centre; expected at least {minimum} m; end the run earlier or raise the orbit",
        distance = unlike(*distance, &[*minimum]), minimum = short(*minimum)
    )]
    InsidePlanet {
        /// Name of the effect.
        effect: &'static str,
        /// Point inside the planet: the reference or a body.
        what: ScenePoint,
        /// Distance from the planet's centre, m.
        distance: f64,
        /// Smallest accepted distance from the planet's centre, m.
        minimum: f64,
    },
    /// An input holds an infinite value or NaN.
    #[error("{name} holds {value}; expected finite numbers", value = short(*value))]
    NotFinite {
        /// Name of the input.
        name: &'static str,
        /// Given value: infinite or NaN.
        value: f64,
    },
    /// The interval of a wrench is empty.
    #[error(
        "the wrench is active from {start} s to {end} s; the start must be before the end",
        start = unlike(*start, &[*end]), end = short(*end)
    )]
    EmptyInterval {
        /// Start of the interval, s.
        start: f64,
        /// End of the interval, s.
        end: f64,
    },
    /// A wrench acts on a body that does not exist.
    #[error("the wrench acts on {body}, but {known}")]
    UnknownBody {
        /// Given body.
        body: BodyIndex,
        /// Bodies that exist, as text with the suggested fix.
        known: String,
    },
    /// A wrench acts on a frame that does not exist.
    #[error(
        "the wrench acts on frame {frame}, but the robot has {known}",
        known = choice(*count, "frame")
    )]
    UnknownFrame {
        /// Index of the given frame.
        frame: usize,
        /// Number of frames that exist.
        count: usize,
    },
    /// The density of the atmosphere cannot be evaluated.
    #[error(transparent)]
    Atmosphere(#[from] AtmosphereError),
    /// A surface is invalid.
    #[error(transparent)]
    Surface(#[from] SurfaceError),
    /// The position of the Sun or the time is unknown.
    #[error(transparent)]
    Earth(#[from] EarthError),
    /// A user-defined effect failed.
    #[error(transparent)]
    User(#[from] UserError),
    /// The wrenches belong to other bodies than those of the scene.
    #[error(
        "the wrenches are for {got}, but the scene has {expected}; create wrenches for the bodies of the \
         scene"
    )]
    OtherBodies {
        /// Numbers of bodies of the systems of the scene, as text.
        expected: String,
        /// Numbers of bodies of the systems to which the wrenches belong, as text.
        got: String,
    },
}

/// Error of a user-defined effect. Clones refer to the same error object, and two values are equal if they
/// refer to the same object.
#[derive(Clone, Debug, thiserror::Error)]
#[error("{0}")]
pub struct UserError(pub Arc<dyn Error + Send + Sync>);

impl PartialEq for UserError {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

/// Point of a scene to which an error refers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ScenePoint {
    /// The reference orbit.
    Reference,
    /// The centre of mass of this body.
    Body(BodyIndex),
}

impl std::fmt::Display for ScenePoint {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Reference => write!(f, "the reference orbit"),
            Self::Body(body) => write!(f, "{body}"),
        }
    }
}

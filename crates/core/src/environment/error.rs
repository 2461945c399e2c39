//! What can be wrong with an effect or with the place it is asked to act in.

use super::atmosphere::AtmosphereError;
use super::surfaces::SurfaceError;
use crate::earth::EarthError;
use crate::gravity::GravityError;
use crate::number_text::{short, unlike};

/// Refusals of the `environment` module; each carries the offending numbers.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum EnvironmentError {
    /// The gravity of planet and third bodies has no answer.
    #[error(transparent)]
    Gravity(#[from] GravityError),
    /// An effect of the planet is on where there is no planet.
    #[error(
        "{effect} needs an orbit around a planet, this run has none: give an orbit or leave the effect out"
    )]
    NoPlanet {
        /// Name of the effect.
        effect: &'static str,
    },
    /// An effect of the turning Earth is on where nobody said how it turns.
    #[error("{effect} needs to know how the Earth turns: give the run an earth (in YAML an epoch)")]
    NoEarth {
        /// Name of the effect.
        effect: &'static str,
    },
    /// A path runs through the planet.
    #[error(
        "{effect}: {what} is below ground, {distance} m from the planet's centre where at least {minimum} m are needed: \
         end the run earlier, or raise the orbit",
        distance = unlike(*distance, &[*minimum]), minimum = short(*minimum)
    )]
    InsidePlanet {
        /// Name of the effect.
        effect: &'static str,
        /// What is there: the reference, or a body by its index.
        what: Place,
        /// Distance from the planet's centre, m.
        distance: f64,
        /// Smallest distance accepted, m.
        minimum: f64,
    },
    /// An input is infinite or not a number.
    #[error("{name} holds {value}, finite numbers are needed", value = short(*value))]
    NotFinite {
        /// Which input.
        name: &'static str,
        /// What was given.
        value: f64,
    },
    /// A wrench ends before it starts.
    #[error(
        "wrench is on from {start} s to {end} s: the start must come before the end",
        start = unlike(*start, &[*end]), end = short(*end)
    )]
    EmptyInterval {
        /// Start, s.
        start: f64,
        /// End, s.
        end: f64,
    },
    /// A wrench acts on a body that the robot does not have.
    #[error("wrench acts on body {body}, the robot has bodies 0 to {last}", last = count.saturating_sub(1))]
    UnknownBody {
        /// Index given.
        body: usize,
        /// Number of bodies.
        count: usize,
    },
    /// A wrench acts on a frame that the robot does not have.
    #[error("wrench acts on frame {frame}, the robot has frames 0 to {last}", last = count.saturating_sub(1))]
    UnknownFrame {
        /// Index given.
        frame: usize,
        /// Number of frames.
        count: usize,
    },
    /// The air cannot be told.
    #[error(transparent)]
    Atmosphere(#[from] AtmosphereError),
    /// A surface makes no sense.
    #[error(transparent)]
    Surface(#[from] SurfaceError),
    /// The Earth cannot say where the Sun is, or what time it is.
    #[error(transparent)]
    Earth(#[from] EarthError),
    /// Bodies and wrenches do not pair up.
    #[error("{got} wrenches are given for {expected} bodies, one per body is needed")]
    WrongLength {
        /// Number of bodies.
        expected: usize,
        /// Number of wrenches.
        got: usize,
    },
}

/// Which point of a scene an error speaks of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// The reference orbit.
    Reference,
    /// The centre of mass of the body with this index.
    Body(usize),
}

impl std::fmt::Display for Place {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Reference => write!(f, "the reference"),
            Self::Body(k) => write!(f, "body {k}"),
        }
    }
}

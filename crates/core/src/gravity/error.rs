//! What can be wrong with a gravity field or with the place where it is asked for.

use crate::earth::EarthError;
use crate::number_text::{count, short, unlike};

/// Refusals of the `gravity` module; each carries the offending numbers.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
#[allow(missing_docs)] // the fields are what the messages say
pub enum GravityError {
    #[error("{name} holds {value}, finite numbers are needed", value = short(*value))]
    NotFinite { name: &'static str, value: f64 },
    #[error("{name} is {value}, it must be positive and finite", value = short(*value))]
    NotPositive { name: &'static str, value: f64 },
    #[error(
        "zonal harmonics in closed form go from degree 2 to 6, {degree} is asked for: take a model of harmonics"
    )]
    ZonalDegree { degree: usize },
    #[error("order {order} is above degree {degree}: ask for an order of at most the degree")]
    OrderAboveDegree { degree: usize, order: usize },
    #[error(
        "degree {degree} and order {order} are asked for, {model} goes to degree {highest}: ask for less, \
         or read a larger model from a .gfc file"
    )]
    BeyondModel { model: String, degree: usize, order: usize, highest: usize },
    #[error("degree {degree} is asked for, from 2 to 2700 are supported")]
    Degree { degree: usize },
    #[error("no gravity model is named '{name}'; there are {known}, and .gfc files", known = known.join(", "))]
    UnknownModel { name: String, known: Vec<&'static str> },
    #[error("{name} has {got}, expected {expected}", got = count(*got, "number"))]
    WrongLength { name: &'static str, expected: usize, got: usize },
    #[error(
        "the coefficients of {model} are not fully normalised ({found}): multiply each by \
         √((n + m)!/((2n + 1) k (n - m)!)), k = 1 for m = 0, else 2"
    )]
    NotNormalised { model: String, found: String },
    #[error(
        "{name} is {value}, {expected}: m³/s² and m are needed (are these kilometres?)",
        value = short(*value)
    )]
    Units { name: &'static str, value: f64, expected: &'static str },
    #[error(
        "{model}: the coefficients of degree {degree}, order {order} reach {value}, those of planets stay below \
         {limit} (is a row cut short, or is its centre not that of mass?)",
        value = unlike(*value, &[*limit]), limit = short(*limit)
    )]
    Implausible { model: String, degree: usize, order: usize, value: f64, limit: f64 },
    #[error(
        "{name}[{degree}, {order}] is {value}: no such term exists, rows are degrees and columns orders, s[:, 0] is zero",
        value = short(*value)
    )]
    NoSuchTerm { name: &'static str, degree: usize, order: usize, value: f64 },
    #[error("{file}: there is no such file")]
    NotFound { file: String },
    #[error("{file}: cannot be read: {reason}")]
    Unreadable { file: String, reason: String },
    #[error("{file}: {key} is {got}, {expected} is needed")]
    Header { file: String, key: &'static str, got: String, expected: &'static str },
    #[error("{file}:{line}: '{got}' is no row of coefficients, 'gfc degree order C S' is needed")]
    Row { file: String, line: usize, got: String },
    #[error(
        "{file}:{line}: the file ends within '{got}', whose last number may be cut short: get it again, or end the line if it is \
         whole"
    )]
    CutRow { file: String, line: usize, got: String },
    #[error("{file}:{line}: degree {degree}, order {order} is given twice")]
    Twice { file: String, line: usize, degree: usize, order: usize },
    #[error(
        "{file}:{line}: '{key}' makes the field vary with time: evaluate the model at your epoch and write it \
         with rows 'gfc', or ask for a degree below"
    )]
    VariesWithTime { file: String, line: usize, key: String },
    #[error(
        "{file} has no coefficients of degree {degree}, order {order}: the file is cut short, get it again or \
         ask for a degree below {degree}"
    )]
    Truncated { file: String, degree: usize, order: usize },
    #[error(
        "a point {distance} m from the planet's centre lies below the surface, the field holds from {minimum} m on",
        distance = unlike(*distance, &[*minimum]), minimum = short(*minimum)
    )]
    BelowSurface { distance: f64, minimum: f64 },
    #[error(
        "{field} turns with the planet, which way is not known: give an earth, such as one that turns about z, \
         or take a zonal field"
    )]
    NeedsEarth { field: String },
    #[error(
        "the orbit is one around μ = {orbit} m³/s², the gravity field has {field} m³/s²: give the orbit the \
         field's mu, or take the field of its planet",
        field = short(*field), orbit = unlike(*orbit, &[*field])
    )]
    OtherPlanet { field: f64, orbit: f64 },
    #[error(
        "the run and its reference orbit disagree on {what}: give both the same, or leave gravity out of the \
         run's environment, which then takes the orbit's"
    )]
    OtherGravity { what: &'static str },
    #[error("the {name} is given twice as a third body")]
    BodyTwice { name: &'static str },
    #[error(transparent)]
    Earth(#[from] EarthError),
}

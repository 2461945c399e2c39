//! Errors of gravity fields.

use crate::earth::EarthError;
use crate::number_text::{count, short, unlike};

/// Errors of gravity models and of their files.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
#[allow(missing_docs)] // the fields are what the messages say
pub enum GravityError {
    #[error("{name} holds {value}; expected finite numbers", value = short(*value))]
    NotFinite { name: &'static str, value: f64 },
    #[error("{name} is {value} {unit}; it must be positive and finite", value = short(*value))]
    NotPositive { name: &'static str, value: f64, unit: &'static str },
    #[error(
        "the degree of a zonal field is {degree}; it must be from 2 to 6 (J2 to J6); use a gravity model for higher \
         harmonics"
    )]
    ZonalDegree { degree: usize },
    #[error("order is {order}; it must be at most the degree, which is {degree}")]
    OrderAboveDegree { degree: usize, order: usize },
    #[error(
        "degree {degree} and order {order} are requested, but {model} ends at degree {highest}; request at most degree \
         {highest}, or read a larger model from a .gfc file"
    )]
    BeyondModel { model: String, degree: usize, order: usize, highest: usize },
    #[error("degree is {degree}; it must be from 2 to 2700")]
    Degree { degree: usize },
    #[error(
        "no gravity model is named '{name}'; give one of the names {known}, or the path of a .gfc file (in \
         Python, use GravityField.zonal for zonal, and GravityField.from_gfc for a file)",
        known = known.join(", ")
    )]
    UnknownModel { name: String, known: Vec<&'static str> },
    #[error("the array '{name}' has {got}; expected {expected}", got = count(*got, "number"))]
    WrongLength { name: &'static str, expected: usize, got: usize },
    #[error(
        "the coefficients of {model} are not fully normalised ({found}); multiply each by \
         √((n + m)!/((2n + 1) k (n - m)!)), with k = 1 for m = 0 and k = 2 otherwise"
    )]
    NotNormalised { model: String, found: String },
    #[error(
        "{name} is {value}; expected {expected} (are mu in m³/s² and radius in m, not in kilometres?)",
        value = short(*value)
    )]
    Units { name: &'static str, value: f64, expected: String },
    #[error(
        "{model}: a coefficient of degree {degree}, order {order} is {value}, but those of planets have \
         magnitudes below {limit} (is a row truncated, or is the origin not the centre of mass?)",
        value = unlike(*value, &[*limit]), limit = short(*limit)
    )]
    Implausible { model: String, degree: usize, order: usize, value: f64, limit: f64 },
    #[error(
        "{name}[{degree}, {order}] is {value}, but this term does not exist (rows are degrees, columns are orders, \
         and s[:, 0] is zero); set it to 0",
        value = short(*value)
    )]
    NoSuchTerm { name: &'static str, degree: usize, order: usize, value: f64 },
    #[error("{file}: there is no such file; check the path")]
    NotFound { file: String },
    #[error("{file} cannot be read: {reason}")]
    Unreadable { file: String, reason: String },
    #[error("{file}: {key} is {got}; expected {expected}")]
    Header { file: String, key: &'static str, got: String, expected: &'static str },
    #[error(
        "{file}:{line}: the row is '{got}'; expected 'gfc degree order C S' with finite C and S, and \
         order ≤ degree ≤ {max_degree}, which is the max_degree of the header"
    )]
    Row { file: String, line: usize, got: String, max_degree: usize },
    #[error(
        "{file}:{line}: the file ends without a line break after '{got}', so the last number may be truncated; \
         download the file again, or add a line break if the row is complete"
    )]
    CutRow { file: String, line: usize, got: String },
    #[error("{file}:{line}: degree {degree}, order {order} is given twice; remove one of the two rows")]
    Twice { file: String, line: usize, degree: usize, order: usize },
    #[error(
        "{file}:{line}: '{key}' makes the field vary with time; evaluate the model at your epoch and write it \
         with 'gfc' rows only{lower}",
        lower = lower_degree(*degree)
    )]
    VariesWithTime { file: String, line: usize, key: String, degree: usize },
    #[error(
        "{file} has no coefficients of degree {degree}, order {order}; the file may be truncated; download it \
         again{lower}",
        lower = lower_degree(*degree)
    )]
    Truncated { file: String, degree: usize, order: usize },
    #[error(
        "a point {distance} m from the planet's centre is below the surface; the field is valid from \
         {minimum} m outwards; give positions relative to the centre, in m",
        distance = unlike(*distance, &[*minimum]), minimum = short(*minimum)
    )]
    BelowSurface { distance: f64, minimum: f64 },
    #[error(
        "{field} rotates with the planet, but the orientation of the planet is unknown; give an 'earth', for \
         example with rotation about_z, or use a zonal field (order 0)"
    )]
    NeedsEarth { field: String },
    #[error(
        "mu of the orbit is {orbit} m³/s², but that of the gravity field is {field} m³/s²; give the orbit the \
         field's mu, or use the field of its planet",
        field = short(*field), orbit = unlike(*orbit, &[*field])
    )]
    OtherPlanet { field: f64, orbit: f64 },
    #[error(
        "the gravity of the run and that of its reference orbit differ in {what}; give both the same gravity, \
         or remove gravity from the run's environment, so that the run uses that of the orbit"
    )]
    OtherGravity { what: &'static str },
    #[error("the {name} is given twice as a third body; name it only once")]
    BodyTwice { name: &'static str },
    #[error(transparent)]
    Earth(#[from] EarthError),
}

/// Returns the advice to request a degree below `degree`, or an empty text if there is no such degree.
fn lower_degree(degree: usize) -> String {
    if degree > 2 { format!(", or request a degree below {degree}") } else { String::new() }
}

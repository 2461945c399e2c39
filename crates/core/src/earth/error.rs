//! What can be wrong with the turning Earth, its time or its sky.

use crate::number_text::{count, short, unlike};

/// Refusals of the `earth` module; each carries the offending values.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum EarthError {
    /// A text is no instant.
    #[error(
        "epoch is '{text}': an instant and its time scale are needed, such as '2024-03-01T12:00:00 UTC' \
         (or TAI, TT, TDB; Z is UTC)"
    )]
    Epoch {
        /// What was given.
        text: String,
    },
    /// UTC before it had leap seconds.
    #[error(
        "epoch is '{text}': UTC has whole leap seconds from 1972 on, give an earlier instant in TAI or TT"
    )]
    BeforeUtc {
        /// What was given.
        text: String,
    },
    /// Something of the sky is asked for, and nobody said when the run takes place.
    #[error("{what} needs an epoch: give the run one, such as '2024-03-01T12:00:00 UTC'")]
    NeedsEpoch {
        /// What was asked for.
        what: &'static str,
    },
    /// An instant is outside the times for which something is known.
    #[error("{what}: {time} s after the epoch {epoch} is outside of {from} to {to}", time = short(*time))]
    OutsideSpan {
        /// What is not known then.
        what: &'static str,
        /// Instant, s of simulation.
        time: f64,
        /// Epoch of the run.
        epoch: String,
        /// First instant known.
        from: String,
        /// Last instant known.
        to: String,
    },
    /// A time or an input is infinite or not a number.
    #[error("{name} is {value}, a finite number is needed", value = short(*value))]
    NotFinite {
        /// Which input.
        name: &'static str,
        /// What was given.
        value: f64,
    },
    /// Earth-orientation parameters that cannot be true.
    #[error("{name} is {value} in row {row}, {expected}", value = short(*value))]
    Parameter {
        /// Which parameter.
        name: &'static str,
        /// What was given.
        value: f64,
        /// Row of the table, from 0.
        row: usize,
        /// What is accepted.
        expected: &'static str,
    },
    /// A table of Earth-orientation parameters cannot be read.
    #[error("line {line} of the Earth-orientation table: {problem}")]
    Table {
        /// Line, from 1.
        line: usize,
        /// What is wrong there.
        problem: String,
    },
    /// A position is so near the Earth's centre that it has no latitude.
    #[error(
        "position is {distance} m from the Earth's centre, geodetic coordinates need at least {minimum} m",
        distance = unlike(*distance, &[*minimum]), minimum = short(*minimum)
    )]
    NearCentre {
        /// Distance, m.
        distance: f64,
        /// Smallest distance accepted, m.
        minimum: f64,
    },
    /// The orbit's epoch and the Earth's differ.
    #[error("the orbit's epoch is {orbit}, the run's is {run}: time zero of both must be the same instant")]
    OtherEpoch {
        /// Epoch of the orbit.
        orbit: String,
        /// Epoch of the Earth.
        run: String,
    },
    /// The orbit's axes and the Earth's differ.
    #[error("the orbit has {orbit} axes, the Earth was made for {run}: make it in the orbit's")]
    OtherAxes {
        /// Axes of the orbit.
        orbit: &'static str,
        /// Axes of the Earth.
        run: &'static str,
    },
    /// A number of a segment of a kernel that no ephemeris has.
    #[error("{name} of a segment of the kernel is {value}, {expected}")]
    Segment {
        /// Which number.
        name: &'static str,
        /// What was given.
        value: f64,
        /// What is accepted.
        expected: &'static str,
    },
    /// Numbers do not come in the right amount.
    #[error("{name} holds {got}, expected {expected}", got = count(*got, "number"))]
    WrongLength {
        /// Which array.
        name: &'static str,
        /// Length needed.
        expected: usize,
        /// Length given.
        got: usize,
    },
}

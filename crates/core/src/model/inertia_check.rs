//! Validation of the mass and inertia of a link.

use super::description::Inertial;
use super::error::ModelError;
use crate::spatial::Sym3;
use nalgebra::Matrix3;

/// Relative tolerance of the checks of an inertia matrix. It covers the rounding of numbers printed with six
/// digits. It is a fraction of the largest principal moment for the triangle inequality, and of the largest
/// entry for the symmetry and for negative principal moments.
const PRINTED_DIGITS: f64 = 1e-6;

/// Squared radius of gyration, m², below which a moment of inertia is treated as rounding error; the radius
/// is 10 nm. CAD programs print moments of small parts as 0 or as ±1e-20.
const LEAST_GYRATION: f64 = 1e-16;

/// Largest accepted magnitude of a coordinate of a centre of mass or of the origin of a joint, m; about seven
/// astronomical units.
pub(super) const LONGEST: f64 = 1e12;

/// Classification of an inertia by its principal moments (kg m², ascending).
pub(super) enum Sense {
    /// Inertia of a real body, or no mass and no inertia.
    Physical,
    /// Inertia that violates the triangle inequality, so that no body with positive density has it.
    BreaksTriangle([f64; 3]),
    /// Inertia with a principal moment that is negative by more than [`PRINTED_DIGITS`] permits, but within
    /// the tolerance [`LEAST_GYRATION`].
    Rounded([f64; 3]),
    /// Indefinite inertia, for which some rotation has negative kinetic energy.
    Indefinite([f64; 3]),
    /// Inertia without a mass, which is valid as part of a body that has mass.
    Massless,
}

/// Checks the inertial properties of the link `link` and classifies its inertia.
///
/// # Errors
/// [`ModelError`] for a number that is not finite or out of range, a negative mass, or an asymmetric inertia.
pub(super) fn check_inertial(link: &str, inertial: &Inertial) -> Result<Sense, ModelError> {
    let link = || link.to_owned();
    let Inertial { mass, com, inertia } = inertial;
    if !mass.is_finite() || !com.iter().chain(inertia.iter()).all(|x| x.is_finite()) {
        return Err(ModelError::NotFinite { what: "the mass, centre of mass or inertia", name: link() });
    }
    check_ranges(link(), inertial)?;
    let scale = inertia.amax();
    if *mass < 0.0 {
        return Err(ModelError::MassNotPositive { link: link(), mass: *mass });
    }
    if *mass == 0.0 && scale == 0.0 {
        return Ok(Sense::Physical);
    }
    let difference = (inertia - inertia.transpose()).amax();
    if difference > PRINTED_DIGITS * scale + LEAST_GYRATION * mass {
        return Err(ModelError::AsymmetricInertia { link: link(), difference });
    }
    Ok(if *mass == 0.0 { Sense::Massless } else { sense(inertia, *mass) })
}

/// Returns the inertia used in the dynamics, which differs from the given one only for [`Sense::Rounded`]:
/// negative principal moments are then set to zero.
pub(super) fn usable_inertia(inertial: &Inertial) -> Matrix3<f64> {
    match sense(&inertial.inertia, inertial.mass) {
        Sense::Rounded(_) => without_negative_moments(&inertial.inertia),
        _ => inertial.inertia,
    }
}

fn without_negative_moments(inertia: &Matrix3<f64>) -> Matrix3<f64> {
    let mut eigen = inertia.symmetric_eigen();
    eigen.eigenvalues.apply(|moment| *moment = moment.max(0.0));
    let result = eigen.recompose();
    (result + result.transpose()) * 0.5
}

/// Checks that mass, centre of mass and inertia are small enough that their products over a whole robot do
/// not overflow, and that the mass is large enough that they do not underflow.
fn check_ranges(name: String, inertial: &Inertial) -> Result<(), ModelError> {
    let Inertial { mass, com, inertia } = inertial;
    let is_mass = *mass <= 0.0 || (1e-20..=1e20).contains(mass);
    for (is_fine, what, value, expected) in [
        (is_mass, "the mass", *mass, "1e-20 kg to 1e20 kg"),
        (com.amax() <= LONGEST, "the centre of mass", com.amax(), "at most 1e12 m"),
        (inertia.amax() <= 1e40, "the inertia", inertia.amax(), "at most 1e40 kg m2"),
    ] {
        if !is_fine {
            return Err(ModelError::OutOfRange { what, name, value, expected });
        }
    }
    Ok(())
}

/// Returns true if no principal moment of the inertia of a whole body, which may consist of several links, is
/// negative by more than the rounding tolerance.
pub(super) fn is_definite(about_com: &Sym3<f64>, mass: f64) -> bool {
    !matches!(sense(&about_com.to_nalgebra(), mass), Sense::Indefinite(_))
}

/// Returns the principal moments of inertia, kg m², in ascending order.
pub(super) fn principal_moments(inertia: &Matrix3<f64>) -> [f64; 3] {
    let mut moments: [f64; 3] = inertia.symmetric_eigenvalues().into();
    moments.sort_by(f64::total_cmp);
    moments
}

fn sense(inertia: &Matrix3<f64>, mass: f64) -> Sense {
    let scale = inertia.amax();
    let moments = principal_moments(inertia);
    let [a, b, c] = moments;
    if a < -(PRINTED_DIGITS * scale).max(LEAST_GYRATION * mass) {
        Sense::Indefinite(moments)
    } else if a < -PRINTED_DIGITS * scale {
        Sense::Rounded(moments)
    } else if a + b < c * (1.0 - PRINTED_DIGITS) {
        Sense::BreaksTriangle(moments)
    } else {
        Sense::Physical
    }
}

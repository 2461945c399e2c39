//! Physical sense of a link's mass and inertia.

use super::description::Inertial;
use super::error::{ModelError, ModelWarning};

/// Principal moments may miss the triangle inequality, and matrices their symmetry, by this share
/// of the largest entry: what six printed digits leave.
const PRINTED_DIGITS: f64 = 1e-6;

/// Refuses what no body has, warns of what only a careless file has.
pub(super) fn check_inertial(link: &str, inertial: &Inertial) -> Result<Option<ModelWarning>, ModelError> {
    let link = || link.to_owned();
    let Inertial { mass, com, inertia } = inertial;
    if !mass.is_finite() || !com.iter().chain(inertia.iter()).all(|x| x.is_finite()) {
        return Err(ModelError::NotFinite { what: "the inertial", name: link() });
    }
    let scale = inertia.amax();
    if *mass < 0.0 {
        return Err(ModelError::MassNotPositive { link: link(), mass: *mass });
    }
    if *mass == 0.0 {
        return if scale == 0.0 { Ok(None) } else { Err(ModelError::InertiaWithoutMass { link: link() }) };
    }
    let difference = (inertia - inertia.transpose()).amax();
    if difference > PRINTED_DIGITS * scale {
        return Err(ModelError::AsymmetricInertia { link: link(), difference });
    }
    let mut moments: [f64; 3] = inertia.symmetric_eigenvalues().into();
    moments.sort_by(f64::total_cmp);
    let [a, b, c] = moments;
    if a < -PRINTED_DIGITS * scale {
        return Err(ModelError::IndefiniteInertia { link: link(), moments });
    }
    let breaks_triangle = a + b < c * (1.0 - PRINTED_DIGITS);
    Ok(breaks_triangle.then(|| ModelWarning::TriangleInequality { link: link(), moments }))
}

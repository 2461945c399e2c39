//! Relative orbital elements.

use super::{Any, Pair, with_shape};
use crate::arrays::{Input, fresh, wrong_shape, zeros};
use crate::interrupt::in_pieces;
use onorbit_core::orbit::relative;
use pyo3::prelude::*;

/// Return the relative orbital elements of a deputy with respect to a chief.
///
/// ``δa = (a_d - a)/a``, ``δλ = u_d - u + (Ω_d - Ω) cos i``, ``δe = e_d (cos ω_d, sin ω_d) - e (cos ω, sin
/// ω)`` and ``δi = (i_d - i, (Ω_d - Ω) sin i)``, with the semi-major axis ``a``, the mean argument of
/// latitude ``u``, the eccentricity ``e``, the argument of periapsis ``ω``, the inclination ``i`` and the
/// right ascension ``Ω`` of the node; the index ``d`` denotes the deputy. Source: D'Amico and Montenbruck, J.
/// Guidance, Control and Dynamics 29(3), 2006.
///
/// Parameters
/// ----------
/// r, v : (3,) or (B, 3) array
///     State of the chief, inertial axes, m and m/s.
/// deputy_r, deputy_v : (3,) or (B, 3) array
///     State of the deputy, inertial axes, m and m/s.
/// mu : float
///     Gravitational parameter, m³/s²; default: that of the Earth.
///
/// Returns
/// -------
/// (6,) or (B, 6) array
///     Relative elements ``(δa, δλ, δex, δey, δix, δiy)``: ``δa`` and ``δe`` are dimensionless, ``δλ`` and
///     ``δi`` are in rad. Multiplied by the chief's semi-major axis, they are lengths.
///
/// Raises
/// ------
/// OrbitError
///     If the chief's orbit is equatorial, if an orbit is open, or if position and velocity are parallel or
///     zero.
#[pyfunction]
#[pyo3(signature = (r, v, deputy_r, deputy_v, *, mu=3.986004418e14))]
pub(super) fn relative_elements<'py>(
    py: Python<'py>,
    r: Any<'_, 'py>,
    v: Any<'_, 'py>,
    deputy_r: Any<'_, 'py>,
    deputy_v: Any<'_, 'py>,
    mu: f64,
) -> PyResult<Bound<'py, PyAny>> {
    let (r, batch) = chief_positions(r)?;
    let shape: Vec<usize> = batch.iter().copied().chain([3]).collect();
    let v = with_shape(v, "v", &shape)?;
    let (deputy_r, deputy_v) =
        (with_shape(deputy_r, "deputy_r", &shape)?, with_shape(deputy_v, "deputy_v", &shape)?);
    let out = zeros(py, &batch.into_iter().chain([6]).collect::<Vec<_>>())?;
    let (chief, deputy, to) = ([r.data(), v.data()], [deputy_r.data(), deputy_v.data()], fresh(&out));
    in_pieces(py, r.data().len() / 3, 4096, |range| {
        let (rows, into) = (3 * range.start..3 * range.end, 6 * range.start..6 * range.end);
        let [chief, deputy] = [chief, deputy].map(|pair| pair.map(|values| &values[rows.clone()]));
        relative::relative_elements_rows(chief, deputy, mu, &mut to[into])
    })?;
    Ok(out.into_any())
}

/// Return the state of a deputy from its relative orbital elements.
///
/// This is the inverse of :func:`relative_elements`.
///
/// Parameters
/// ----------
/// r, v : (3,) or (B, 3) array
///     State of the chief, inertial axes, m and m/s.
/// elements : (6,) or (B, 6) array
///     Relative orbital elements in the order and units of :func:`relative_elements`.
/// mu : float
///     Gravitational parameter, m³/s²; default: that of the Earth.
///
/// Returns
/// -------
/// deputy_r, deputy_v : (3,) or (B, 3) array
///     State of the deputy, inertial axes, m and m/s.
///
/// Raises
/// ------
/// OrbitError
///     If the chief's orbit is equatorial or open, or the elements do not describe an ellipse.
#[pyfunction]
#[pyo3(signature = (r, v, elements, *, mu=3.986004418e14))]
pub(super) fn deputy_state<'py>(
    py: Python<'py>,
    r: Any<'_, 'py>,
    v: Any<'_, 'py>,
    elements: Any<'_, 'py>,
    mu: f64,
) -> PyResult<Pair<'py>> {
    let (r, batch) = chief_positions(r)?;
    let with = |last: usize| batch.iter().copied().chain([last]).collect::<Vec<usize>>();
    let (v, elements) = (with_shape(v, "v", &with(3))?, with_shape(elements, "elements", &with(6))?);
    let (to_r, to_v) = (zeros(py, &with(3))?, zeros(py, &with(3))?);
    let (chief, elements, out_r, out_v) = ([r.data(), v.data()], elements.data(), fresh(&to_r), fresh(&to_v));
    in_pieces(py, r.data().len() / 3, 4096, |range| {
        let (rows, six) = (3 * range.start..3 * range.end, 6 * range.start..6 * range.end);
        let chief = chief.map(|values| &values[rows.clone()]);
        let out = [&mut out_r[rows.clone()], &mut out_v[rows]];
        relative::deputy_states(chief, &elements[six], mu, out)
    })?;
    Ok((to_r.into_any(), to_v.into_any()))
}

/// Reads the positions `r` of the chief, (3,) or (B, 3), and returns them with their shape without the last
/// axis.
fn chief_positions<'py>(r: Any<'_, 'py>) -> PyResult<(Input<'py>, Vec<usize>)> {
    let input = Input::new(r, "r")?;
    let batch = match input.shape() {
        [3] => Vec::new(),
        [count, 3] => vec![*count],
        other => return Err(wrong_shape(r.py(), "r", "(3,) or (B, 3)", other)),
    };
    Ok((input, batch))
}

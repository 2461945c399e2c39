//! States on Kepler ellipses from orbital elements.

use super::input::{InputError, check_finite, check_whole};
use super::threads::{Threads, for_each};
use crate::orbit::kepler::ellipse_state;
use crate::spatial::{InstructionSet, Lanes4, Lanes8, Real};

/// Number of states per task.
const CHUNK: usize = 4096;

/// Computes positions (m) from the planet's centre and velocities (m/s) on Kepler ellipses in inertial axes,
/// each an (N, 3) array.
///
/// `elements`: semi-major axis (m), eccentricity, inclination, right ascension of the node, argument of
/// periapsis and mean anomaly at time zero (rad), and time (s). Each has one value for all states or one
/// value per state. `mu` is in m³/s².
///
/// # Errors
/// [`InputError`] for wrong lengths, numbers that are not finite, elements that do not describe an ellipse,
/// `mu` that is not positive, or zero threads.
pub fn kepler_states<'a>(
    elements: [&[f64]; 7],
    mu: f64,
    positions: &mut [f64],
    velocities: &mut [f64],
    threads: impl Into<Threads<'a>>,
) -> Result<(), InputError> {
    let threads = threads.into();
    let count = positions.len() / 3;
    check_whole("positions", positions, 3)?;
    check_elements(&elements, mu, count)?;
    if velocities.len() != positions.len() {
        let (expected, got) = (positions.len(), velocities.len());
        return Err(InputError::WrongTotal { name: "velocities", expected, got });
    }
    match InstructionSet::current() {
        InstructionSet::Baseline => compute_all::<f64>(elements, mu, positions, velocities, threads),
        InstructionSet::Fused => compute_all::<Lanes4>(elements, mu, positions, velocities, threads),
        InstructionSet::Wide => compute_all::<Lanes8>(elements, mu, positions, velocities, threads),
    }
}

const NAMES: [&str; 7] =
    ["semi_major_axis", "eccentricity", "inclination", "raan", "argument_of_periapsis", "mean_anomaly", "t"];

fn check_elements(elements: &[&[f64]; 7], mu: f64, count: usize) -> Result<(), InputError> {
    for (name, values) in NAMES.into_iter().zip(elements) {
        if values.len() != count && values.len() != 1 {
            return Err(InputError::WrongElements { name, states: count, got: values.len() });
        }
        check_finite(name, values, 1)?;
    }
    let check = |name, values: &[f64], is_valid: fn(f64) -> bool, expected| match values
        .iter()
        .position(|&value| !is_valid(value))
    {
        Some(index) => {
            let state = (values.len() > 1).then_some(index);
            Err(InputError::NotAnEllipse { name, state, value: values[index], expected })
        }
        None => Ok(()),
    };
    check("mu", &[mu], |mu| mu > 0.0 && mu.is_finite(), "positive and finite (m³/s²)")?;
    check(NAMES[0], elements[0], |a| a > 0.0, "positive (m); use Kepler for a hyperbola")?;
    check(NAMES[1], elements[1], |e| (0.0..1.0).contains(&e), "in [0, 1); use Kepler for an open orbit")
}

fn compute_all<S: Real>(
    elements: [&[f64]; 7],
    mu: f64,
    positions: &mut [f64],
    velocities: &mut [f64],
    threads: Threads<'_>,
) -> Result<(), InputError> {
    let rows = positions.chunks_mut(3 * CHUNK).zip(velocities.chunks_mut(3 * CHUNK));
    for_each(
        threads,
        rows.enumerate(),
        || (),
        |(), (chunk, (positions, velocities))| {
            S::enter(
                #[inline(always)]
                || compute_chunk::<S>(&elements, mu, chunk * CHUNK, positions, velocities),
            );
        },
    )
}

#[inline(always)]
fn compute_chunk<S: Real>(
    elements: &[&[f64]; 7],
    mu: f64,
    first: usize,
    positions: &mut [f64],
    velocities: &mut [f64],
) {
    let width = 3 * S::LANES;
    for (group, (r, v)) in positions.chunks_mut(width).zip(velocities.chunks_mut(width)).enumerate() {
        // lanes without a state repeat the last state
        let (from, last) = (first + group * S::LANES, r.len() / 3 - 1);
        let pick = [0, 1, 2, 3, 4, 5, 6].map(
            #[inline(always)]
            |k: usize| pick::<S>(elements[k], from, last),
        );
        let [a, e, inclination, raan, argument, anomaly, t] = pick;
        let (position, velocity) = ellipse_state([a, e, inclination, raan, argument, anomaly], S::of(mu), t);
        for (lane, (r, v)) in r.chunks_exact_mut(3).zip(v.chunks_exact_mut(3)).enumerate() {
            r.copy_from_slice(&[position.x.lane(lane), position.y.lane(lane), position.z.lane(lane)]);
            v.copy_from_slice(&[velocity.x.lane(lane), velocity.y.lane(lane), velocity.z.lane(lane)]);
        }
    }
}

/// Returns the only element of `values` in all lanes or, if there are several, the elements from index `from`
/// on, one per lane. Lanes after lane `last` repeat the value of that lane.
#[inline(always)]
fn pick<S: Real>(values: &[f64], from: usize, last: usize) -> S {
    if let [one] = values {
        return S::of(*one);
    }
    let values = &values[from..=from + last];
    if last + 1 == S::LANES {
        return S::from_lanes(
            #[inline(always)]
            |lane| values[lane],
        );
    }
    S::from_lanes(
        #[inline(always)]
        |lane| values[lane.min(last)],
    )
}

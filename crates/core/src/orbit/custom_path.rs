//! A path through given points: any motion, of nature or not.

use crate::number_text::{count, short, unlike};
use nalgebra::{Vector3, Vector4};

use super::error::LARGEST;
use super::{Orbit, OrbitError, OrbitState, PathFrame};
use crate::spatial::{self, Quat, RotationSpline, Spline, SplineError, exp_so3};

/// A path that cannot be built, or that has no state at some time.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
#[allow(missing_docs)] // the fields are what the messages say
pub enum PathError {
    #[error("a path of {got}: at least 2 are needed", got = count(*got, "point"))]
    TooFewPoints { got: usize },
    #[error("{name} has {got}, times has {expected}: one row per time is needed", got = count(*got, "row"))]
    WrongLength { name: &'static str, expected: usize, got: usize },
    #[error(
        "{name}[{index}] holds {value}, finite numbers up to 1e60 (SI units) are needed",
        value = short(*value)
    )]
    NotFinite { name: &'static str, index: usize, value: f64 },
    #[error(
        "times[{index}] is {time} s after {before} s: times must increase, by 1e-9 s at least; sort the rows and \
         leave out those given twice",
        before = short(*before), time = unlike(*time, &[*before])
    )]
    NotIncreasing { index: usize, before: f64, time: f64 },
    #[error("accelerations are given without velocities: give both, or velocities alone, or neither")]
    AccelerationsAlone,
    #[error(
        "attitudes[{index}] has norm {norm}, at most 1e-6 off 1 is accepted; it is x, y, z, w: normalise it first",
        norm = unlike(*norm, &[1.0])
    )]
    QuaternionNorm { index: usize, norm: f64 },
    #[error(
        "the attitude turns by {angle} rad from point {before} to the next, at most 2.0 rad are told apart from \
         a turn the other way: give points closer in time",
        before = index - 1,
        angle = short(*angle)
    )]
    TurnTooFar { index: usize, angle: f64 },
    #[error(
        "the path has no point at t = {time} s, it goes from {start} s to {end} s: give times that cover the run, or let \
         it coast on beyond them with ends=\"coast\"",
        time = unlike(*time, &[*start, *end]), start = short(*start), end = short(*end)
    )]
    TimeOutOfPath { time: f64, start: f64, end: f64 },
    #[error(transparent)]
    Spline(#[from] SplineError),
}

/// What happens before the first point and after the last.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Ends {
    /// There is no state: [`PathError::TimeOutOfPath`].
    #[default]
    Error,
    /// On along a straight line at the last velocity, turning at the last rate: the velocity goes on without
    /// a jump, the acceleration drops to zero.
    Coast,
}

/// What a path goes through, one row per time; axes of `I`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PathPoints {
    /// Increasing, s of simulation.
    pub times: Vec<f64>,
    /// From the planet's centre, m.
    pub positions: Vec<Vector3<f64>>,
    /// m/s.
    pub velocities: Option<Vec<Vector3<f64>>>,
    /// m/s².
    pub accelerations: Option<Vec<Vector3<f64>>>,
    /// Unit quaternions x, y, z, w, which take components of the path's frame to `I`.
    pub attitudes: Option<Vec<Vector4<f64>>>,
}

/// A C² path exactly through the given points.
///
/// Positions alone: cubic spline, of order 4. With velocities: quintic spline whose third derivative goes on
/// across the points too, order 6. With accelerations: quintic pieces, order 6. Attitudes: [`RotationSpline`],
/// of order 4.
#[derive(Clone, Debug, PartialEq)]
pub struct CustomPath {
    mu: Option<f64>,
    ends: Ends,
    position: Spline,
    attitude: Option<RotationSpline>,
}

/// Largest turn between two points, rad.
const LARGEST_TURN: f64 = 2.0;

impl CustomPath {
    /// A path around a planet of parameter `mu`, m³/s², or around none.
    ///
    /// # Errors
    /// [`PathError`] for points that make no path, [`OrbitError::NotPositive`] for `mu`.
    pub fn new(points: PathPoints, mu: Option<f64>, ends: Ends) -> Result<Self, OrbitError> {
        if let Some(mu) = mu {
            super::error::positive("mu", mu)?;
        }
        points.check()?;
        let PathPoints { times, positions, velocities, accelerations, attitudes } = points;
        let attitude = attitudes.map(|given| {
            let given: Vec<_> = given.iter().map(|q| Quat::from_xyzw(q.normalize().as_slice())).collect();
            RotationSpline::passing(&times, &given, spatial::Ends::Free)
        });
        let rows = |of: &[Vector3<f64>]| of.iter().flat_map(|x| [x.x, x.y, x.z]).collect::<Vec<_>>();
        let x = rows(&positions);
        let position = match (velocities, accelerations) {
            (Some(v), Some(a)) => Spline::new(&times, 3, &x, &rows(&v), &rows(&a)),
            (Some(v), None) => Spline::with_slopes(&times, 3, &x, &rows(&v)),
            _ => Spline::passing(&times, 3, &x, spatial::Ends::Free),
        };
        let (position, attitude) =
            (position.map_err(PathError::from)?, attitude.transpose().map_err(PathError::from)?);
        Ok(Self { mu, ends, position, attitude })
    }

    /// First and last time, s.
    pub fn span(&self) -> (f64, f64) {
        let times = self.position.times();
        (times[0], times[times.len() - 1])
    }

    /// What happens outside the span.
    pub fn ends(&self) -> Ends {
        self.ends
    }

    /// Whether attitudes were given.
    pub fn has_attitudes(&self) -> bool {
        self.attitude.is_some()
    }

    /// The nearest time of the path, and how far `t` lies beyond it.
    fn clamped(&self, t: f64) -> Result<(f64, f64), OrbitError> {
        super::error::finite("time", t)?;
        let (start, end) = self.span();
        let inside = t.clamp(start, end);
        let rounding = 8.0 * f64::EPSILON * start.abs().max(end.abs()); // of a run's own instants
        match self.ends {
            Ends::Error if (t - inside).abs() > rounding => {
                Err(PathError::TimeOutOfPath { time: t, start, end }.into())
            }
            Ends::Error => Ok((inside, 0.0)),
            Ends::Coast => Ok((inside, t - inside)),
        }
    }
}

impl Orbit for CustomPath {
    fn mu(&self) -> Option<f64> {
        self.mu
    }

    fn velocity_source(&self) -> &'static str {
        "derivative of the path's spline"
    }

    /// Every point: the acceleration has a kink there, or jumps at the ends where it coasts.
    fn event_times(&self) -> Vec<f64> {
        self.position.times().to_vec()
    }

    fn state(&self, t: f64) -> Result<OrbitState, OrbitError> {
        let (inside, beyond) = self.clamped(t)?;
        let [mut position, mut velocity, mut acceleration] = [Vector3::zeros(); 3];
        self.position.sample(
            inside,
            position.as_mut_slice(),
            velocity.as_mut_slice(),
            acceleration.as_mut_slice(),
        );
        if beyond == 0.0 {
            return Ok(OrbitState { position, velocity, acceleration });
        }
        Ok(OrbitState { position: position + velocity * beyond, velocity, acceleration: Vector3::zeros() })
    }

    fn frame(&self, t: f64) -> Result<PathFrame, OrbitError> {
        let Some(attitude) = &self.attitude else { return self.lvlh(t).map(PathFrame::from) };
        let (inside, beyond) = self.clamped(t)?;
        let (turn, rate, _) = attitude.sample(inside);
        let rot_ip = exp_so3(rate * beyond).product(turn).matrix();
        let rate_p = rot_ip.transpose_mul(rate); // the axis of a steady turn stays where it is
        Ok(PathFrame { rot_ip: rot_ip.to_nalgebra(), rate_p: rate_p.to_nalgebra() })
    }
}

impl PathPoints {
    fn check(&self) -> Result<(), PathError> {
        let n = self.times.len();
        if n < 2 {
            return Err(PathError::TooFewPoints { got: n });
        }
        rows("times", n, Some(&self.times), |t| worst(&[*t]))?;
        rows("positions", n, Some(&self.positions), |x| worst(x.as_slice()))?;
        rows("velocities", n, self.velocities.as_deref(), |x| worst(x.as_slice()))?;
        rows("accelerations", n, self.accelerations.as_deref(), |x| worst(x.as_slice()))?;
        rows("attitudes", n, self.attitudes.as_deref(), |x| worst(x.as_slice()))?;
        if self.accelerations.is_some() && self.velocities.is_none() {
            return Err(PathError::AccelerationsAlone);
        }
        let too_close = |t: &[f64]| t[1] - t[0] < 1e-9;
        if let Some(index) = self.times.windows(2).position(too_close).map(|before| before + 1) {
            let (before, time) = (self.times[index - 1], self.times[index]);
            return Err(PathError::NotIncreasing { index, before, time });
        }
        let attitudes = self.attitudes.as_deref().unwrap_or_default();
        for (index, q) in attitudes.iter().enumerate() {
            let norm = q.norm();
            if (norm - 1.0).abs() > 1e-6 {
                return Err(PathError::QuaternionNorm { index, norm });
            }
        }
        for (before, pair) in attitudes.windows(2).enumerate() {
            let angle = 2.0 * pair[0].dot(&pair[1]).abs().min(1.0).acos();
            if angle > LARGEST_TURN {
                return Err(PathError::TurnTooFar { index: before + 1, angle });
            }
        }
        Ok(())
    }
}

/// The first number of a row that is not finite or too large, else zero.
fn worst(row: &[f64]) -> f64 {
    row.iter().copied().find(|x| !x.is_finite() || x.abs() > LARGEST).unwrap_or(0.0)
}

/// Checks that `column` has `n` rows of numbers that make sense; `worst` returns one that does not, else zero.
fn rows<T>(
    name: &'static str,
    n: usize,
    column: Option<&[T]>,
    worst: fn(&T) -> f64,
) -> Result<(), PathError> {
    let Some(column) = column else { return Ok(()) };
    if column.len() != n {
        return Err(PathError::WrongLength { name, expected: n, got: column.len() });
    }
    match column.iter().map(worst).enumerate().find(|(_, value)| *value != 0.0) {
        Some((index, value)) => Err(PathError::NotFinite { name, index, value }),
        None => Ok(()),
    }
}

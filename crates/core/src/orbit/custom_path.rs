//! Reference path through given points, which may describe any motion, whether in free fall or not.

use nalgebra::{Vector3, Vector4};

use super::error::LARGEST;
use super::{Orbit, OrbitError, OrbitState, PathError, PathFrame};
use crate::spatial::{self, Quat, RotationSpline, Spline, exp_so3};

/// Behaviour of a path before its first point and after its last point.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Ends {
    /// The path has no state before its first and after its last point: [`PathError::TimeOutOfPath`].
    #[default]
    Error,
    /// The path continues along a straight line with the velocity and the angular velocity of the nearest
    /// end. Both velocities are continuous at the end, but the acceleration jumps to zero.
    Coast,
}

/// Points of a path in the inertial axes `I`, with one row per time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PathPoints {
    /// Simulation times in increasing order, s.
    pub times: Vec<f64>,
    /// Positions from the planet's centre, m.
    pub positions: Vec<Vector3<f64>>,
    /// Velocities, m/s; with `None`, they follow from the interpolated positions.
    pub velocities: Option<Vec<Vector3<f64>>>,
    /// Accelerations, m/s², which require velocities; with `None`, they follow from the interpolated
    /// positions and velocities.
    pub accelerations: Option<Vec<Vector3<f64>>>,
    /// Attitudes: unit quaternions (x, y, z, w) of the rotations from the axes of the path's frame to `I`;
    /// with `None`, the path's frame is the LVLH frame.
    pub attitudes: Option<Vec<Vector4<f64>>>,
}

/// Twice continuously differentiable path through given points.
///
/// Positions alone are interpolated by a cubic spline, whose error is of order 4 in the spacing of the
/// points. Positions with velocities are interpolated by a quintic spline with a continuous third derivative,
/// and positions with velocities and accelerations by quintic pieces; the error of both is of order 6.
/// Attitudes are interpolated by a [`RotationSpline`], whose error is of order 4.
#[derive(Clone, Debug, PartialEq)]
pub struct CustomPath {
    mu: Option<f64>,
    ends: Ends,
    position: Spline,
    attitude: Option<RotationSpline>,
}

/// Largest accepted rotation between the attitudes of successive points, rad.
const LARGEST_TURN: f64 = 2.0;

impl CustomPath {
    /// Creates a path through `points` around a planet with gravitational parameter `mu`, m³/s², or without a
    /// planet if `mu` is `None`. `ends` is the behaviour before the first and after the last point.
    ///
    /// # Errors
    /// [`PathError`] for invalid points; [`OrbitError::NotFinite`], [`OrbitError::TooLarge`] and
    /// [`OrbitError::NotPositive`] for `mu`.
    pub fn new(points: PathPoints, mu: Option<f64>, ends: Ends) -> Result<Self, OrbitError> {
        if let Some(mu) = mu {
            super::error::positive("mu", mu)?;
        }
        points.check()?;
        let PathPoints { times, positions, velocities, accelerations, attitudes } = points;
        let attitude = attitudes.map(|given| {
            let given: Vec<_> = given.iter().map(|q| Quat::from_xyzw(q.normalize().as_slice())).collect();
            RotationSpline::interpolating(&times, &given, spatial::Ends::Free)
        });
        let rows = |of: &[Vector3<f64>]| of.iter().flat_map(|x| [x.x, x.y, x.z]).collect::<Vec<_>>();
        let x = rows(&positions);
        let position = match (velocities, accelerations) {
            (Some(v), Some(a)) => Spline::new(&times, 3, &x, &rows(&v), &rows(&a)),
            (Some(v), None) => Spline::with_slopes(&times, 3, &x, &rows(&v)),
            _ => Spline::interpolating(&times, 3, &x, spatial::Ends::Free),
        };
        let (position, attitude) =
            (position.map_err(PathError::from)?, attitude.transpose().map_err(PathError::from)?);
        Ok(Self { mu, ends, position, attitude })
    }

    /// Returns the times of the first and the last point, s.
    pub fn span(&self) -> (f64, f64) {
        let times = self.position.times();
        (times[0], times[times.len() - 1])
    }

    /// Returns the behaviour before the first and after the last point.
    pub fn ends(&self) -> Ends {
        self.ends
    }

    /// Returns true if the path was created with attitudes.
    pub fn has_attitudes(&self) -> bool {
        self.attitude.is_some()
    }

    /// Returns the time within the span of the path that is nearest to `t`, s, and the time, s, by which a
    /// path that coasts is continued to `t`.
    ///
    /// # Errors
    /// [`PathError::TimeOutOfPath`] if the path does not coast and `t` is outside the span by more than
    /// rounding; [`OrbitError::NotFinite`] and [`OrbitError::TooLarge`] for `t`.
    fn clamped(&self, t: f64) -> Result<(f64, f64), OrbitError> {
        super::error::finite("time", t)?;
        let (start, end) = self.span();
        let inside = t.clamp(start, end);
        let rounding = 8.0 * f64::EPSILON * start.abs().max(end.abs()); // rounding error of the times of a run
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

    /// Returns the times of all points, s, where a derivative of the acceleration is discontinuous. At the
    /// first and the last point of a path that coasts, the acceleration itself is discontinuous.
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
        // after the end, the rotation is about the constant angular velocity, so its components in P are
        // constant
        let rate_p = rot_ip.transpose_mul(rate);
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

/// Returns the first number of a row that is too large or not finite, or zero if all numbers are valid.
fn worst(row: &[f64]) -> f64 {
    row.iter().copied().find(|x| !x.is_finite() || x.abs() > LARGEST).unwrap_or(0.0)
}

/// Checks that `column` has `n` valid rows. `worst` returns an invalid number of a row, or zero if the row is
/// valid.
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

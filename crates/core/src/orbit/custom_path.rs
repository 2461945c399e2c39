//! A path through given points: any motion, of nature or not.

use nalgebra::{Matrix3, Quaternion, UnitQuaternion, Vector3, Vector4};

use super::quintic::Quintic;
use super::{Orbit, OrbitError, OrbitState, PathFrame};

/// A path that cannot be built, or that has no state at some time.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
#[allow(missing_docs)] // the fields are what the messages say
pub enum PathError {
    #[error("a path of {got} points: at least 2 are needed")]
    TooFewPoints { got: usize },
    #[error("{name} has {got} rows, times has {expected}: one row per time is needed")]
    WrongLength { name: &'static str, expected: usize, got: usize },
    #[error("{name}[{index}] holds {value}, finite numbers are needed")]
    NotFinite { name: &'static str, index: usize, value: f64 },
    #[error(
        "times[{index}] is {time} s after {before} s: times must increase, by 1e-9 s at least; sort the rows and \
         leave out those given twice"
    )]
    NotIncreasing { index: usize, before: f64, time: f64 },
    #[error("accelerations are given without velocities: give both, or velocities alone, or neither")]
    AccelerationsAlone,
    #[error(
        "attitudes[{index}] has norm {norm}, at most 1e-6 off 1 is accepted; it is x, y, z, w: normalise it first"
    )]
    QuaternionNorm { index: usize, norm: f64 },
    #[error(
        "the attitude turns by {angle} rad from point {before} to the next, at most 2.0 rad are told apart from \
         a turn the other way: give points closer in time",
        before = index - 1
    )]
    TurnTooFar { index: usize, angle: f64 },
    #[error(
        "the path has no point at t = {time} s, it goes from {start} s to {end} s: give times that cover the run, or let \
         it coast on beyond them with ends=\"coast\""
    )]
    TimeOutOfPath { time: f64, start: f64, end: f64 },
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
/// Positions alone: cubic not-a-knot spline, of order 4. With velocities: quintic spline whose third
/// derivative goes on across the points too, order 6. With accelerations: quintic Hermite pieces, order 6.
/// Attitudes: the cubic spline of the quaternions, normalised, which is C² too and of order 4.
#[derive(Clone, Debug, PartialEq)]
pub struct CustomPath {
    mu: Option<f64>,
    ends: Ends,
    position: Quintic<3>,
    attitude: Option<Quintic<4>>,
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
        let attitude = attitudes.map(|given| Quintic::through(times.clone(), &aligned(given)));
        let position = match (velocities, accelerations) {
            (Some(v), Some(a)) => Quintic::hermite(times, &positions, &v, &a),
            (Some(v), None) => Quintic::with_velocities(times, &positions, &v),
            _ => Quintic::through(times, &positions),
        };
        Ok(Self { mu, ends, position, attitude })
    }

    /// First and last time, s.
    pub fn span(&self) -> (f64, f64) {
        (self.position.start(), self.position.end())
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

    fn event_times(&self) -> Vec<f64> {
        match self.ends {
            Ends::Error => Vec::new(),
            Ends::Coast => vec![self.position.start(), self.position.end()],
        }
    }

    fn state(&self, t: f64) -> Result<OrbitState, OrbitError> {
        let (inside, beyond) = self.clamped(t)?;
        let [position, velocity, acceleration] = self.position.at(inside);
        if beyond == 0.0 {
            return Ok(OrbitState { position, velocity, acceleration });
        }
        Ok(OrbitState { position: position + velocity * beyond, velocity, acceleration: Vector3::zeros() })
    }

    fn frame(&self, t: f64) -> Result<PathFrame, OrbitError> {
        let Some(attitude) = &self.attitude else { return self.lvlh(t).map(PathFrame::from) };
        let (inside, beyond) = self.clamped(t)?;
        let [q, q_dot, _] = attitude.at(inside);
        let (u, w, u_dot, w_dot) = (q.xyz(), q.w, q_dot.xyz(), q_dot.w);
        // ω = 2 q̄ ⊗ q̇ / |q|², its vector part, in the frame's own axes
        let rate_p = (u_dot * w - u * w_dot - u.cross(&u_dot)) * (2.0 / q.norm_squared());
        let turn = UnitQuaternion::from_quaternion(Quaternion::from_vector(q))
            * UnitQuaternion::from_scaled_axis(rate_p * beyond);
        Ok(PathFrame { rot_ip: Matrix3::from(turn.to_rotation_matrix()), rate_p })
    }
}

impl PathPoints {
    fn check(&self) -> Result<(), PathError> {
        let n = self.times.len();
        if n < 2 {
            return Err(PathError::TooFewPoints { got: n });
        }
        rows("times", n, Some(&self.times), |t| *t)?;
        rows("positions", n, Some(&self.positions), |x| x.sum())?;
        rows("velocities", n, self.velocities.as_deref(), |x| x.sum())?;
        rows("accelerations", n, self.accelerations.as_deref(), |x| x.sum())?;
        rows("attitudes", n, self.attitudes.as_deref(), |x| x.sum())?;
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

/// Checks that `column` has `n` rows of finite numbers; `total` is finite where all of a row is.
fn rows<T>(
    name: &'static str,
    n: usize,
    column: Option<&[T]>,
    total: fn(&T) -> f64,
) -> Result<(), PathError> {
    let Some(column) = column else { return Ok(()) };
    if column.len() != n {
        return Err(PathError::WrongLength { name, expected: n, got: column.len() });
    }
    match column.iter().map(total).enumerate().find(|(_, value)| !value.is_finite()) {
        Some((index, value)) => Err(PathError::NotFinite { name, index, value }),
        None => Ok(()),
    }
}

/// Each quaternion with the sign that is nearer to the one before.
fn aligned(mut quaternions: Vec<Vector4<f64>>) -> Vec<Vector4<f64>> {
    for i in 1..quaternions.len() {
        if quaternions[i].dot(&quaternions[i - 1]) < 0.0 {
            quaternions[i] = -quaternions[i];
        }
    }
    quaternions
}

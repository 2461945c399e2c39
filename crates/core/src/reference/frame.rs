//! Frames in which references are given.

use super::error::check_numbers;
use super::{Hold, ReferenceError, TaskSample};
use crate::orbit::Orbit;
use crate::spatial::{Mat3, Motion, Vec3, exp_so3};
use nalgebra::{Matrix3, Vector3};
use std::sync::{Arc, Mutex, PoisonError};

/// Frame in which a path is given: it defines the axes and the origin.
#[derive(Clone, Debug, Default)]
pub enum ReferenceFrame {
    /// W: inertial axes, origin on the reference orbit.
    #[default]
    World,
    /// Local orbital frame L (Hill) of an orbit, with its origin at the origin of W.
    Lvlh(Arc<dyn Orbit>),
    /// Base B of the robot: axes and origin of its base link.
    Base,
    /// Body frame of a second spacecraft in free motion.
    Target(Target),
    /// Frame of another system of the same world.
    System(MovingFrame),
}

/// Frame of another system of a world. Before each evaluation of references, the simulation sets the motion
/// of the frame; all copies of this value share it.
#[derive(Clone, Debug)]
pub struct MovingFrame {
    /// Index of the system in the world.
    pub system: usize,
    /// Index of the frame in the model of the system.
    pub frame: usize,
    motion: Arc<Mutex<TaskSample<f64>>>,
}

impl MovingFrame {
    /// Creates the frame of a system; it is at the origin of W until its motion is set.
    pub fn new(system: usize, frame: usize) -> Self {
        let rest = TaskSample::at_rest(Mat3::identity(), Vec3::zero());
        Self { system, frame, motion: Arc::new(Mutex::new(rest)) }
    }

    /// Returns the motion of the frame in W at the present instant.
    pub fn motion(&self) -> TaskSample<f64> {
        *self.motion.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Sets the motion of the frame in W at the present instant.
    pub fn set_motion(&self, motion: TaskSample<f64>) {
        *self.motion.lock().unwrap_or_else(PoisonError::into_inner) = motion;
    }
}

/// Force-free spacecraft with constant velocity and constant angular velocity.
#[derive(Clone, Debug, PartialEq)]
pub struct Target {
    start: Hold,
    velocity: Motion<f64>,
}

impl Target {
    /// Creates a target with the pose in W `(rot_wt, pos_w)`, m, at simulation time zero, and with
    /// `velocity`, m/s, and angular velocity `spin`, rad/s, in W axes.
    ///
    /// # Errors
    /// [`ReferenceError::NotFinite`] for numbers that are not finite or exceed 1e60 in magnitude;
    /// [`ReferenceError::NotARotation`] for `rot_wt`.
    pub fn new(
        rot_wt: Matrix3<f64>,
        pos_w: Vector3<f64>,
        velocity: Vector3<f64>,
        spin: Vector3<f64>,
    ) -> Result<Self, ReferenceError> {
        Self::at(Hold::new(rot_wt, pos_w)?, velocity, spin)
    }

    /// Creates a target with the pose `start` at simulation time zero; other arguments as for
    /// [`Target::new`].
    ///
    /// # Errors
    /// [`ReferenceError::NotFinite`] for numbers that are not finite or exceed 1e60 in magnitude.
    pub fn at(start: Hold, velocity: Vector3<f64>, spin: Vector3<f64>) -> Result<Self, ReferenceError> {
        check_numbers("velocity", &velocity)?;
        check_numbers("spin", &spin)?;
        let velocity = Motion::new(velocity.into(), spin.into());
        Ok(Self { start, velocity })
    }

    /// Returns the motion of the target in W at simulation time `t`, s.
    pub fn sample(&self, t: f64) -> TaskSample<f64> {
        TaskSample {
            rot_wd: exp_so3(self.velocity.angular * t).matrix() * self.start.rot_fd,
            pos_w: self.start.pos_f + self.velocity.linear * t,
            velocity: self.velocity,
            acceleration: Motion::zero(),
        }
    }
}

/// Returns the motion of L in W at simulation time `t`, s.
pub(super) fn lvlh_motion(orbit: &dyn Orbit, t: f64) -> Result<TaskSample<f64>, ReferenceError> {
    let state = orbit.state(t)?;
    let lvlh = orbit.lvlh(t)?;
    let (r, v, rate) = (&state.position, &state.velocity, &lvlh.rate_l);
    let radius = r.norm();
    // rate of the z component of the angular velocity: d/dt (h/r²) = ẑ·(r × a)/r² − 2 (h/r²) ṙ/r
    let z = lvlh.rot_il.column(2);
    let climb = r.dot(v) / radius;
    let along_z = z.dot(&r.cross(&state.acceleration)) / (radius * radius) - 2.0 * rate.z * climb / radius;
    let along_x = turn_of_plane(orbit, t, rate);
    let rot = Mat3::from(lvlh.rot_il);
    let in_w = |x: Vector3<f64>| Motion::new(Vec3::zero(), rot * Vec3::from(x));
    Ok(TaskSample {
        rot_wd: rot,
        pos_w: Vec3::zero(),
        velocity: in_w(*rate),
        acceleration: in_w(Vector3::new(along_x, 0.0, along_z)),
    })
}

/// Returns the time derivative, rad/s², of the x component of L's angular velocity at time `t`, s, when the
/// angular velocity is `rate`, rad/s.
///
/// The derivative depends on the jerk of the orbit. It is therefore computed by finite differences with steps
/// of 1e-3 rad along the orbit, or less near the ends of its time span. The result is 0 if the orbit has no
/// frames near `t`.
///
/// With the component `x_k` at `t + k h`, `ẋ = [8 (x₁ − x₋₁) − (x₂ − x₋₂)]/12h`, and at an end
/// `ẋ = ±(4 x_±1 − x_±2 − 3 x₀)/2h`.
fn turn_of_plane(orbit: &dyn Orbit, t: f64, rate: &Vector3<f64>) -> f64 {
    let x = |dt: f64| orbit.lvlh(t + dt).ok().map(|there| there.rate_l.x);
    let steps = || (0..12).map(|halvings| 1e-3 / rate.norm() * 0.5_f64.powi(halvings));
    let central = |h: f64| Some((8.0 * (x(h)? - x(-h)?) - (x(2.0 * h)? - x(-2.0 * h)?)) / (12.0 * h));
    let one_sided = |h: f64| Some((4.0 * x(h)? - x(2.0 * h)? - 3.0 * rate.x) / (2.0 * h));
    let at_end = || steps().find_map(|h| one_sided(h).or_else(|| one_sided(-h)));
    steps().find_map(central).or_else(at_end).unwrap_or(0.0)
}

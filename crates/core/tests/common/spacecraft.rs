//! Independent integration of one rigid body in the field of a point mass, in absolute coordinates.

use nalgebra::{Matrix3, Quaternion, UnitQuaternion, Vector3};

/// Mass, kg, and inertia about the centre of mass, kg m².
pub struct Craft {
    pub mass: f64,
    pub inertia: Matrix3<f64>,
}

/// Loads besides gravity: a wrench in body axes during `during`, and the gravity-gradient torque.
#[derive(Default)]
pub struct Pull {
    pub force: Vector3<f64>,
    pub torque: Vector3<f64>,
    pub during: (f64, f64),
    pub gradient: bool,
}

/// Position, velocity, body-to-inertial quaternion, rate in body axes.
#[derive(Clone, Copy)]
pub struct State {
    pub position: Vector3<f64>,
    pub velocity: Vector3<f64>,
    pub attitude: Quaternion<f64>,
    pub rate: Vector3<f64>,
}

impl State {
    /// Rotation from body to inertial axes.
    pub fn attitude_matrix(&self) -> Matrix3<f64> {
        UnitQuaternion::from_quaternion(self.attitude).to_rotation_matrix().into_inner()
    }

    fn moved(&self, rate: &Self, h: f64) -> Self {
        Self {
            position: self.position + rate.position * h,
            velocity: self.velocity + rate.velocity * h,
            attitude: self.attitude + rate.attitude * h,
            rate: self.rate + rate.rate * h,
        }
    }
}

pub struct Independent<'a> {
    pub craft: &'a Craft,
    pub mu: f64,
    pub pull: &'a Pull,
}

impl Independent<'_> {
    /// Classical Runge-Kutta with the quaternion as four numbers and steps that end at the switches.
    pub fn run(&self, mut state: State, duration: f64, step: f64) -> State {
        let mut cuts: Vec<f64> = (0..=(duration / step).round() as usize).map(|k| k as f64 * step).collect();
        cuts.extend([self.pull.during.0, self.pull.during.1]);
        cuts.sort_by(f64::total_cmp);
        cuts.dedup();
        for cut in cuts.windows(2) {
            let (h, middle) = (cut[1] - cut[0], 0.5 * (cut[0] + cut[1]));
            let is_on = self.pull.during.0 <= middle && middle < self.pull.during.1;
            let k1 = self.rate(&state, is_on);
            let k2 = self.rate(&state.moved(&k1, h / 2.0), is_on);
            let k3 = self.rate(&state.moved(&k2, h / 2.0), is_on);
            let k4 = self.rate(&state.moved(&k3, h), is_on);
            for (k, weight) in [(k1, 1.0), (k2, 2.0), (k3, 2.0), (k4, 1.0)] {
                state = state.moved(&k, h * weight / 6.0);
            }
        }
        state
    }

    fn rate(&self, state: &State, is_on: bool) -> State {
        let (w, i) = (state.rate, &self.craft.inertia);
        let rot_ib = state.attitude_matrix();
        let r = state.position;
        let r3 = r.norm().powi(3);
        let mut acceleration = r * (-self.mu / r3);
        let mut torque = -w.cross(&(i * w));
        if is_on {
            acceleration += rot_ib * self.pull.force / self.craft.mass;
            torque += self.pull.torque;
        }
        if self.pull.gradient {
            let up = rot_ib.transpose() * r.normalize();
            torque += up.cross(&(i * up)) * (3.0 * self.mu / r3);
        }
        State {
            position: state.velocity,
            velocity: acceleration,
            attitude: state.attitude * Quaternion::from_imag(w) * 0.5,
            rate: i.lu().solve(&torque).expect("an inertia can be inverted"),
        }
    }
}

//! A robot that drifts far from its reference gets one of its own; what it leaves behind stays in W.
//!
//! `W'` has the axes of W and its origin on an orbit that falls freely from where the robot's centre of mass was: what is
//! integrated is robot-sized again. With `s = R' − R` from W's origin to that of `W'`, both of them falling or led,
//! `p = p' + s`, `ṗ = ṗ' + ṡ`, and every body is seen from W to be pulled by `m s̈` more.

use super::error::SimulationError;
use super::plant::Plant;
use super::state::State;
use super::surroundings::Surroundings;
use super::trace::Trace;
use crate::dynamics::{base_rotation, center_of_mass, momentum};
use crate::model::Model;
use crate::orbit::OrbitState;
use crate::spatial::{Scalar, Vec3};
use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};

/// A reference of the robot's own, and what rows in W need to know of the change.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct OwnReference {
    /// Position and velocity of the robot's centre of mass then, axes of I, m and m/s.
    pub(super) position: [f64; 3],
    pub(super) velocity: [f64; 3],
    /// Linear momentum that changes of frame took, kg m/s.
    momentum_taken: [f64; 3],
    /// What the work in W is ahead of that in `W'` beside the energy that goes with the frame, J.
    work_ahead: f64,
    /// When it began, and those before it, s.
    pub(super) times: Vec<f64>,
}

/// The way from `W'` to W at one instant: `s`, its rate and its acceleration, and the robot's mass.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shift {
    position: Vector3<f64>,
    velocity: Vector3<f64>,
    acceleration: Vector3<f64>,
    mass: f64,
    momentum_taken: Vector3<f64>,
    work_ahead: f64,
}

impl Shift {
    /// From the states of the robot's own reference and of W's origin.
    pub(super) fn between(own: &OwnReference, state: &OrbitState, home: &OrbitState, mass: f64) -> Self {
        Self {
            position: state.position - home.position,
            velocity: state.velocity - home.velocity,
            acceleration: state.acceleration - home.acceleration,
            mass,
            momentum_taken: own.momentum_taken.into(),
            work_ahead: own.work_ahead,
        }
    }

    /// Puts the last row of `trace`, which was written in `W'`, in W; all but its acceleration.
    pub(super) fn row(&self, trace: &mut Trace, model: &Model) {
        let (nq, nv) = (model.nq(), model.nv());
        let Self { position, velocity, mass, momentum_taken, work_ahead, .. } = self;
        let rot_bw = last_attitude(trace, nq).transpose();
        let momentum = Vector3::from_column_slice(last(&mut trace.momentum, 6, 3));
        // T = T' + P'·ṡ + m ṡ²/2, and so the work
        let energy = momentum.dot(velocity) + 0.5 * mass * velocity.norm_squared();
        last(&mut trace.kinetic_energy, 1, 1)[0] += energy;
        last(&mut trace.work, 1, 1)[0] += energy + work_ahead;
        // P = P' + m ṡ
        let carried = velocity * *mass;
        add(last(&mut trace.momentum, 6, 3), &carried);
        add(last(&mut trace.impulse, 6, 3), &(carried - momentum_taken));
        add(last(&mut trace.q, nq, 3), position);
        add(last(&mut trace.v, nv, 3), &(rot_bw * velocity));
        add(last(&mut trace.center_of_mass, 3, 3), position);
        if !trace.tool_pose.is_empty() {
            let pose = last(&mut trace.tool_pose, 16, 16);
            (0..3).for_each(|i| pose[4 * i + 3] += position[i]);
        }
    }

    /// Puts the last row's acceleration in W: `a = a' + Rᵀ s̈ − ω × Rᵀ ṡ`.
    pub(super) fn acceleration(&self, trace: &mut Trace, model: &Model) {
        let (nq, nv) = (model.nq(), model.nv());
        let rot_bw = last_attitude(trace, nq).transpose();
        let rate = Vector3::from_column_slice(&last(&mut trace.v, nv, nv)[3..6]);
        let change = rot_bw * self.acceleration - rate.cross(&(rot_bw * self.velocity));
        add(last(&mut trace.acceleration, nv, 3), &change);
    }

    /// What W sees more of the pull on a body of this mass.
    pub(super) fn pull(&self, mass: f64) -> Vector3<f64> {
        self.acceleration * mass
    }
}

/// The first `count` numbers of the last row of a column.
fn last(column: &mut [f64], width: usize, count: usize) -> &mut [f64] {
    let start = column.len() - width;
    &mut column[start..start + count]
}

fn add(to: &mut [f64], v: &Vector3<f64>) {
    to.iter_mut().zip(v.iter()).for_each(|(to, v)| *to += v);
}

/// `R_wb` of the last row.
fn last_attitude(trace: &mut Trace, nq: usize) -> Matrix3<f64> {
    base_rotation::<f64>(last(&mut trace.q, nq, nq)).to_nalgebra()
}

impl<S: Scalar> Plant<'_, S, Surroundings> {
    /// Gives the robot a reference of its own that falls freely from its centre of mass; `state` follows.
    ///
    /// The centre of mass is at rest at the origin of the new frame: `p' = p − c`, `ṗ' = ṗ − P/m`, `P' = 0`, and the
    /// energy there is less by `P²/2m` (König).
    pub(super) fn rereference(&mut self, t: f64, state: &mut State<S>) -> Result<(), SimulationError> {
        let Some(origin) = self.surroundings.origin(t)? else { return Ok(()) };
        self.settle(state);
        let lift = |v: Vector3<f64>| Vec3::new(S::of(v.x), S::of(v.y), S::of(v.z));
        let com = center_of_mass(&self.data, &state.q).to_nalgebra();
        let momentum = momentum(&self.data, &state.q).linear.to_nalgebra();
        let flight = momentum / self.model.mass();

        let mut own = self.surroundings.own().cloned().unwrap_or_default();
        own.momentum_taken = (Vector3::from(own.momentum_taken) + momentum).into();
        own.position = (origin.position + com).into();
        own.velocity = (origin.velocity + flight).into();
        own.work_ahead -= 0.5 * momentum.dot(&flight);
        own.times.push(t);
        self.surroundings.follow(own)?;

        (Vec3::from_slice(&state.q) - lift(com)).write(&mut state.q);
        let slower = base_rotation(&state.q).transpose_mul(lift(flight));
        (Vec3::from_slice(&state.v) - slower).write(&mut state.v);
        state.start.linear -= lift(momentum);
        Ok(())
    }
}

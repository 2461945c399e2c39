//! Local reference orbit of a robot that drifts far from the reference orbit of the run.
//!
//! The axes of the frame `W'` are those of W, and its origin follows an orbit in free fall that starts at the
//! robot's centre of mass, so that the integrated coordinates become small. With the vector `s = R' − R` from
//! the origin of W to the origin of `W'`, `p = p' + s` and `ṗ = ṗ' + ṡ`, and in W an additional force `m s̈`
//! acts on every body. The rows of the trace remain relative to W.

use super::trace::Trace;
use crate::dynamics::base_rotation;
use crate::model::{ANGULAR, Model};
use crate::orbit::OrbitState;
use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};

/// Local reference orbit, with the quantities needed to transform rows from `W'` to W.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct LocalReference {
    /// Position of the robot's centre of mass at the change of reference, axes of I, m.
    pub(super) position: [f64; 3],
    /// Velocity of the robot's centre of mass at the change of reference, axes of I, m/s.
    pub(super) velocity: [f64; 3],
    /// Linear momentum that all changes of reference so far have removed from the integrated motion, W axes,
    /// kg m/s.
    pub(super) momentum_taken: [f64; 3],
    /// Work in W less work in `W'`, J, without the part that results from the present velocity `ṡ` of the
    /// frame `W'`.
    pub(super) work_ahead: f64,
    /// Times of all changes of reference up to this one, s.
    pub(super) times: Vec<f64>,
}

/// Transformation of a row from `W'` to W at one instant. It contains the vector `s`, m, its first and second
/// time derivatives, the mass of the robot, kg, the state of the reference orbit of W, and the corrections of
/// impulse and work in [`LocalReference`].
#[derive(Clone, Copy, Debug)]
pub(super) struct Shift {
    /// State of the reference orbit of W.
    reference: OrbitState,
    position: Vector3<f64>,
    velocity: Vector3<f64>,
    acceleration: Vector3<f64>,
    mass: f64,
    momentum_taken: Vector3<f64>,
    work_ahead: f64,
}

impl Shift {
    /// Computes the transformation for a robot of mass `mass`, kg, from the states `state` of the local
    /// reference orbit and `reference` of the reference orbit of W; `rate` is the time derivative of the
    /// position on the reference orbit of W, m/s.
    pub(super) fn between(
        local: &LocalReference,
        state: &OrbitState,
        reference: &OrbitState,
        rate: Vector3<f64>,
        mass: f64,
    ) -> Self {
        Self {
            reference: *reference,
            position: state.position - reference.position,
            velocity: state.velocity - rate,
            acceleration: state.acceleration - reference.acceleration,
            mass,
            momentum_taken: local.momentum_taken.into(),
            work_ahead: local.work_ahead,
        }
    }

    /// Transforms the last row of `trace` from `W'` to W, except its acceleration.
    pub(super) fn transform_row(&self, trace: &mut Trace, model: &Model) {
        let (nq, nv) = (model.nq(), model.nv());
        let Self { position, velocity, mass, momentum_taken, work_ahead, .. } = self;
        let momentum = Vector3::from_column_slice(last(&mut trace.momentum, 6, 3));
        // T = T' + P'·ṡ + m ṡ²/2; the work changes by the same amount
        let energy = momentum.dot(velocity) + 0.5 * mass * velocity.norm_squared();
        last(&mut trace.kinetic_energy, 1, 1)[0] += energy;
        last(&mut trace.work, 1, 1)[0] += energy + work_ahead;
        // P = P' + m ṡ
        let frame_momentum = velocity * *mass;
        add(last(&mut trace.momentum, 6, 3), &frame_momentum);
        add(last(&mut trace.impulse, 6, 3), &(frame_momentum - momentum_taken));
        self.transform_state(last(&mut trace.q, nq, nq), last(&mut trace.v, nv, nv));
        add(last(&mut trace.center_of_mass, 3, 3), position);
        if !trace.reference_position_eci.is_empty() {
            last(&mut trace.reference_position_eci, 3, 3).copy_from_slice(self.reference.position.as_slice());
            last(&mut trace.reference_velocity_eci, 3, 3).copy_from_slice(self.reference.velocity.as_slice());
        }
        if !trace.tool_pose.is_empty() {
            let pose = last(&mut trace.tool_pose, 16, 16);
            (0..3).for_each(|i| pose[4 * i + 3] += position[i]);
        }
    }

    /// Transforms configuration and velocity from `W'` to W: `p = p' + s`, `ṗ = ṗ' + ṡ`.
    pub(super) fn transform_state(&self, q: &mut [f64], v: &mut [f64]) {
        let rot_bw = base_rotation::<f64>(q).to_nalgebra().transpose();
        add(&mut q[..3], &self.position);
        add(&mut v[..3], &(rot_bw * self.velocity));
    }

    /// Transforms the acceleration of the last row from `W'` to W: `a = a' + Rᵀ s̈ − ω × Rᵀ ṡ` in base axes,
    /// with the angular velocity `ω` and the rotation `R` from base axes to W axes.
    pub(super) fn transform_acceleration(&self, trace: &mut Trace, model: &Model) {
        let (nq, nv) = (model.nq(), model.nv());
        let rot_bw = last_attitude(trace, nq).transpose();
        let rate = Vector3::from_column_slice(&last(&mut trace.v, nv, nv)[ANGULAR]);
        let change = rot_bw * self.acceleration - rate.cross(&(rot_bw * self.velocity));
        add(last(&mut trace.acceleration, nv, 3), &change);
    }

    /// Returns the additional force in W, N, on a body of mass `mass`, kg.
    pub(super) fn inertial_force(&self, mass: f64) -> Vector3<f64> {
        self.acceleration * mass
    }
}

/// Returns the first `count` values of the last row of a column with `width` values per row.
fn last(column: &mut [f64], width: usize, count: usize) -> &mut [f64] {
    let start = column.len() - width;
    &mut column[start..start + count]
}

fn add(to: &mut [f64], v: &Vector3<f64>) {
    to.iter_mut().zip(v.iter()).for_each(|(to, v)| *to += v);
}

/// Returns the rotation `R_wb` from base axes to W axes in the last row.
fn last_attitude(trace: &mut Trace, nq: usize) -> Matrix3<f64> {
    base_rotation::<f64>(last(&mut trace.q, nq, nq)).to_nalgebra()
}

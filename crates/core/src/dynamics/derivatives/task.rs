//! Derivatives of the reduced model of a free-floating manipulator.

use super::terms::{Derivatives, Row, components};
use crate::dynamics::data::Data;
use crate::dynamics::external::{FrameWrench, apply_external};
use crate::dynamics::jacobian::{point_acceleration, unit_axes};
use crate::dynamics::kinematics::{base_rotation, frame_offset, kinematics};
use crate::dynamics::rnea::inverse_dynamics_recursion;
use crate::dynamics::subspace::subspace;
use crate::model::{Frame, Model};
use crate::spatial::{Force, InverseInertia, Mat3, Motion, Real, SpatialInertia, Vec3};

/// Derivatives of the joint torques `M* q̈ + c* − Q*` and of a frame's acceleration `ẍ = Jg q̈ + d` at given joint
/// accelerations, and of the frame's twist `ẋ`, with respect to `q` and `v`.
///
/// `acceleration`: `q̈`, `(n,)`; `frame`: an index. Out, row major: `∂τ/∂q`, `∂τ/∂v` `(n, nv)`, `∂ẍ/∂q`, `∂ẍ/∂v`,
/// `∂ẋ/∂q` `(6, nv)`, rows in W axes, linear first. What is missing is known by other names: `∂τ/∂q̈ = M*`,
/// `∂ẍ/∂q̈ = Jg`, `∂ẋ/∂v = J`. With `q̈ = 0` they are those of `c* − Q*` and `d`.
///
/// Tangent of `q` and what is held constant as said in [`derivatives`](super).
pub fn free_floating_derivatives<S: Real>(
    model: &Model,
    data: &mut Data<S>,
    work: &mut Derivatives<S>,
    q: &[S],
    v: &[S],
    acceleration: &[S],
    frame: usize,
    external: &[FrameWrench<S>],
    out: [&mut [S]; 5],
) {
    kinematics(model, data, q, v);
    apply_external(model, data, external);
    work.acceleration[..6].fill(S::of(0.0));
    work.acceleration[6..].copy_from_slice(acceleration);
    inverse_dynamics_recursion(model, data, v, Some(&work.acceleration), &mut work.force);
    S::enter(
        #[inline(always)]
        || kernel(model, data, work, q, frame, out),
    );
}

#[inline(always)]
fn kernel<S: Real>(
    model: &Model,
    data: &mut Data<S>,
    work: &mut Derivatives<S>,
    q: &[S],
    frame: usize,
    [torque_q, torque_v, acceleration_q, acceleration_v, velocity_q]: [&mut [S]; 5],
) {
    let (nodes, nv, frame) = (model.nodes(), model.nv(), &model.frames()[frame]);
    let inverse = give_way(data, &work.force);
    work.gather(nodes, data);
    for (k, coupling) in work.coupling.iter_mut().enumerate() {
        *coupling = work.bodies[k + 1].reach.from_point(data.bodies[k + 1].pos_b);
    }
    let point = Point::new(base_rotation(q), data, frame);
    let mut lever = frame_offset(data, frame); // from the joint's origin to the frame's
    for out in [&mut *torque_q, torque_v, acceleration_q, acceleration_v, velocity_q] {
        out.fill(S::of(0.0));
    }

    for j in (1..nodes.len()).rev() {
        let rows = work.joint_columns(nodes, &data.bodies, j);
        // ∂a_b = −Mbb⁻¹ ∂τ_b,  ∂τ_m + Mbmᵀ ∂a_b
        let (back_q, back_v) = (recoil(&inverse, rows, 0), recoil(&inverse, rows, 1));
        for row in &rows[6..] {
            torque_q[(row.index - 6) * nv + j + 5] = row.values[0];
            torque_v[(row.index - 6) * nv + j + 5] = row.values[1];
        }
        for (k, coupling) in work.coupling.iter().enumerate() {
            torque_q[k * nv + j + 5] += back_q.dot(*coupling);
            torque_v[k * nv + j + 5] += back_v.dot(*coupling);
        }
        let term = &work.bodies[j];
        let (mut to_q, mut to_v) = (back_q.referred_to(point.position), back_v.referred_to(point.position));
        if (j..nodes[j].end).contains(&frame.body) {
            // carried along: s × ẍ;  what comes through the joint: Ψ̈ + 2 Ψ̇ × ẋ, or 2 Ψ̇ + 2 s × ẋ
            let s = subspace(&nodes[j], data.bodies[j].axis()).angular;
            let (rate, rate2) = (term.rate.referred_to(lever), term.rate2.referred_to(lever));
            to_q += turn(s, point.acceleration) + rate2 + point.coriolis(term.rate.angular);
            to_v += rate * S::of(2.0) + point.coriolis(s);
            point.write(velocity_q, nv, j + 5, turn(s, point.velocity) + rate);
            lever += data.bodies[j].offset;
        }
        point.write(acceleration_q, nv, j + 5, to_q);
        point.write(acceleration_v, nv, j + 5, to_v);
    }

    for m in 0..3 {
        let axis = unit_axes()[m];
        let rows = work.base_columns();
        let back = recoil(&inverse, rows, m);
        for row in &rows[6..] {
            torque_v[(row.index - 6) * nv + m + 3] = row.values[m];
        }
        for (k, coupling) in work.coupling.iter().enumerate() {
            torque_v[k * nv + m + 3] += back.dot(*coupling);
        }
        point.write(acceleration_v, nv, m + 3, back.referred_to(point.position) + point.coriolis(axis));
        point.write(acceleration_q, nv, m + 3, turn(axis, point.acceleration));
        point.write(velocity_q, nv, m + 3, turn(axis, point.velocity));
    }
}

/// Lets the base give way to the force that inverse dynamics found missing; returns `Mbb⁻¹`.
#[inline(always)]
fn give_way<S: Real>(data: &mut Data<S>, force: &[S]) -> InverseInertia<S> {
    let mut inertia = SpatialInertia::zero();
    data.bodies.iter().for_each(|body| inertia += body.inertia_b());
    let inverse = inertia.inverse();
    let acceleration = -inverse.apply(Force::from_slice(force));
    data.bodies.iter_mut().for_each(|body| body.acceleration += acceleration.referred_to(body.pos_b));
    inverse
}

/// `−Mbb⁻¹` times the base's rows of column `c`.
#[inline(always)]
fn recoil<S: Real, const N: usize>(inverse: &InverseInertia<S>, rows: &[Row<S, N>], c: usize) -> Motion<S> {
    let f = |i: usize| rows[i].values[c];
    -inverse.apply(Force::new(Vec3::new(f(0), f(1), f(2)), Vec3::new(f(3), f(4), f(5))))
}

/// Both halves turned: `s × m`.
#[inline(always)]
fn turn<S: Real>(s: Vec3<S>, m: Motion<S>) -> Motion<S> {
    Motion::new(s.cross(m.linear), s.cross(m.angular))
}

/// A frame's origin: twist and acceleration of the point, in B axes.
struct Point<S> {
    rot_wb: Mat3<S>,
    /// From the base's origin.
    position: Vec3<S>,
    velocity: Motion<S>,
    acceleration: Motion<S>,
}

impl<S: Real> Point<S> {
    #[inline(always)]
    fn new(rot_wb: Mat3<S>, data: &Data<S>, frame: &Frame) -> Self {
        let (body, offset) = (&data.bodies[frame.body], frame_offset(data, frame));
        Self {
            rot_wb,
            position: body.pos_b + offset,
            velocity: body.velocity.referred_to(offset),
            acceleration: point_acceleration(body.acceleration, body.velocity, offset),
        }
    }

    /// `(2 ω × ẋ, ω × ω_x)`: what the point's motion adds to a rate of turn under it.
    #[inline(always)]
    fn coriolis(&self, omega: Vec3<S>) -> Motion<S> {
        Motion::new(omega.cross(self.velocity.linear) * S::of(2.0), omega.cross(self.velocity.angular))
    }

    /// Column `j`, turned to W axes.
    #[inline(always)]
    fn write(&self, out: &mut [S], nv: usize, j: usize, m: Motion<S>) {
        let turned = Force::new(self.rot_wb * m.linear, self.rot_wb * m.angular);
        let rows = components(turned);
        for i in 0..6 {
            out[i * nv + j] = rows[i];
        }
    }
}

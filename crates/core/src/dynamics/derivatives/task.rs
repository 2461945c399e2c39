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

/// Computes derivatives of the reduced model at given joint accelerations: those of the joint torques
/// `τ = M* q̈ + c* − Q*` and of the acceleration `ẍ = Jg q̈ + d` of a frame with respect to `q` and `v`, and
/// that of the frame's twist `ẋ` with respect to `q`.
///
/// `acceleration` is `q̈`, `(n,)`, rad/s² (m/s²), and `frame` is an index. `out` receives, row major and in
/// this order, `∂τ/∂q` and `∂τ/∂v`, `(n, nv)`, and `∂ẍ/∂q`, `∂ẍ/∂v` and `∂ẋ/∂q`, `(6, nv)`, with rows in W
/// axes, linear first. The remaining derivatives are matrices of the model itself: `∂τ/∂q̈ = M*`,
/// `∂ẍ/∂q̈ = Jg`, `∂ẋ/∂v = J`. For `q̈ = 0` the results are the derivatives of `c* − Q*` and `d`.
///
/// The tangent space of `q` and the quantities held constant are defined in [`derivatives`](super).
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
    let inverse = add_base_acceleration(data, &work.force);
    work.compute_bodies(nodes, data);
    for (k, coupling) in work.coupling.iter_mut().enumerate() {
        *coupling = work.bodies[k + 1].composite_force.from_point(data.bodies[k + 1].pos_b);
    }
    let point = FramePoint::new(base_rotation(q), data, frame);
    let mut lever = frame_offset(data, frame); // from the joint origin to the frame origin
    for out in [&mut *torque_q, torque_v, acceleration_q, acceleration_v, velocity_q] {
        out.fill(S::of(0.0));
    }

    for j in (1..nodes.len()).rev() {
        let rows = work.joint_columns(nodes, &data.bodies, j);
        // ∂a_b = −Mbb⁻¹ ∂τ_b
        let (base_q, base_v) = (base_response(&inverse, rows, 0), base_response(&inverse, rows, 1));
        for row in &rows[6..] {
            torque_q[(row.index - 6) * nv + j + 5] = row.values[0];
            torque_v[(row.index - 6) * nv + j + 5] = row.values[1];
        }
        for (k, coupling) in work.coupling.iter().enumerate() {
            // ∂τ_m + Mbmᵀ ∂a_b
            torque_q[k * nv + j + 5] += base_q.dot(*coupling);
            torque_v[k * nv + j + 5] += base_v.dot(*coupling);
        }
        let term = &work.bodies[j];
        let mut frame_q = base_q.referred_to(point.position);
        let mut frame_v = base_v.referred_to(point.position);
        if (j..nodes[j].end).contains(&frame.body) {
            let s = subspace(&nodes[j], data.bodies[j].axis()).angular;
            let (rate, subspace_rate2) =
                (term.subspace_rate.referred_to(lever), term.subspace_rate2.referred_to(lever));
            // ∂ẍ/∂q_j += s × ẍ + Ψ̈ + 2 Ψ̇ × ẋ
            frame_q += cross_both(s, point.acceleration)
                + subspace_rate2
                + point.coriolis(term.subspace_rate.angular);
            // ∂ẍ/∂q̇_j += 2 Ψ̇ + 2 s × ẋ
            frame_v += rate * S::of(2.0) + point.coriolis(s);
            // ∂ẋ/∂q_j = s × ẋ + Ψ̇
            point.write(velocity_q, nv, j + 5, cross_both(s, point.velocity) + rate);
            lever += data.bodies[j].offset;
        }
        point.write(acceleration_q, nv, j + 5, frame_q);
        point.write(acceleration_v, nv, j + 5, frame_v);
    }

    for m in 0..3 {
        let axis = unit_axes()[m];
        let rows = work.base_columns();
        let base = base_response(&inverse, rows, m);
        for row in &rows[6..] {
            torque_v[(row.index - 6) * nv + m + 3] = row.values[m];
        }
        for (k, coupling) in work.coupling.iter().enumerate() {
            torque_v[k * nv + m + 3] += base.dot(*coupling);
        }
        point.write(acceleration_v, nv, m + 3, base.referred_to(point.position) + point.coriolis(axis));
        point.write(acceleration_q, nv, m + 3, cross_both(axis, point.acceleration));
        point.write(velocity_q, nv, m + 3, cross_both(axis, point.velocity));
    }
}

/// Adds the acceleration `a_b = −Mbb⁻¹ f_b` of the free base to all bodies, where `f_b` is the base force
/// from inverse dynamics with `a_b = 0`. Returns `Mbb⁻¹`.
#[inline(always)]
fn add_base_acceleration<S: Real>(data: &mut Data<S>, force: &[S]) -> InverseInertia<S> {
    let mut inertia = SpatialInertia::zero();
    data.bodies.iter().for_each(|body| inertia += body.inertia_b());
    let inverse = inertia.inverse();
    let acceleration = -inverse.apply(Force::from_slice(force));
    data.bodies.iter_mut().for_each(|body| body.acceleration += acceleration.referred_to(body.pos_b));
    inverse
}

/// Returns `−Mbb⁻¹ f` for column `c` of a block, where `f` holds the six rows of the base.
#[inline(always)]
fn base_response<S: Real, const N: usize>(
    inverse: &InverseInertia<S>,
    rows: &[Row<S, N>],
    c: usize,
) -> Motion<S> {
    let f = |i: usize| rows[i].values[c];
    -inverse.apply(Force::new(Vec3::new(f(0), f(1), f(2)), Vec3::new(f(3), f(4), f(5))))
}

/// Returns `s × m` for the linear and for the angular half of `m`.
#[inline(always)]
fn cross_both<S: Real>(s: Vec3<S>, m: Motion<S>) -> Motion<S> {
    Motion::new(s.cross(m.linear), s.cross(m.angular))
}

/// Frame origin with its twist and acceleration, in B axes.
struct FramePoint<S> {
    rot_wb: Mat3<S>,
    /// Position relative to the base origin, m.
    position: Vec3<S>,
    velocity: Motion<S>,
    acceleration: Motion<S>,
}

impl<S: Real> FramePoint<S> {
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

    /// Returns `(2 ω × ẋ_lin, ω × ẋ_ang)`, the Coriolis acceleration for an additional angular velocity `ω`.
    #[inline(always)]
    fn coriolis(&self, omega: Vec3<S>) -> Motion<S> {
        Motion::new(omega.cross(self.velocity.linear) * S::of(2.0), omega.cross(self.velocity.angular))
    }

    /// Writes `m`, rotated to W axes, to column `j` of `out`, `(6, nv)`.
    #[inline(always)]
    fn write(&self, out: &mut [S], nv: usize, j: usize, m: Motion<S>) {
        let rotated = Force::new(self.rot_wb * m.linear, self.rot_wb * m.angular);
        let rows = components(rotated);
        for i in 0..6 {
            out[i * nv + j] = rows[i];
        }
    }
}

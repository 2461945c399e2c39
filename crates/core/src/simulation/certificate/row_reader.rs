//! Reader of the rows of a trace, which computes their forces and scales.

use super::trace_row::{BaseMotion, TraceRow};
use crate::dynamics::{
    Data, Momentum, base_rotation, composite_momentum, inverse_dynamics, kinematics,
    locked_dynamics_recursion,
};
use crate::model::{BASE_NV, Model};
use crate::simulation::trace::Trace;
use crate::spatial::Vec3;

/// Reader of the rows of a trace, with the buffers to compute their forces and scales.
pub(super) struct RowReader<'a> {
    model: &'a Model,
    trace: &'a Trace,
    data: Data<f64>,
    forces: Vec<f64>,
    jump: Vec<f64>,
    at_rest: Vec<f64>,
    locked: Vec<bool>,
}

impl<'a> RowReader<'a> {
    pub(super) fn new(model: &'a Model, trace: &'a Trace) -> Self {
        let zeros = vec![0.0; model.nv()];
        Self {
            model,
            trace,
            data: Data::new(model),
            forces: zeros.clone(),
            jump: zeros.clone(),
            at_rest: zeros,
            locked: vec![false; model.joint_count()],
        }
    }

    /// Returns the number of rows that include an acceleration.
    pub(super) fn rows(&self) -> usize {
        self.trace.rows().min(self.trace.acceleration.len() / self.model.nv())
    }

    /// Returns row `k` with the forces and scales computed from it.
    pub(super) fn row(&mut self, k: usize) -> TraceRow<'a> {
        let (trace, nq, nv) = (self.trace, self.model.nq(), self.model.nv());
        let q = Trace::row(&trace.q, k, nq);
        let v = Trace::row(&trace.v, k, nv);
        let a = Trace::row(&trace.acceleration, k, nv);
        let change_before = Vec3::from_slice(&a[3..]) + self.angular_jump(k, q);
        inverse_dynamics(self.model, &mut self.data, q, v, a, &[], &mut self.forces);
        let mut now = TraceRow {
            time: trace.time[k],
            base: BaseMotion::new(trace.time[k], q, v, a, change_before),
            q,
            v,
            a,
            momentum: pair(&trace.momentum, k),
            impulse: pair(&trace.impulse, k),
            kinetic_energy: trace.kinetic_energy[k],
            work: trace.work[k],
            center_of_mass: Vec3::from_slice(Trace::row(&trace.center_of_mass, k, 3)),
            force: base_rotation(q) * Vec3::from_slice(&self.forces),
            mass: 0.0,
            relative_momentum: 0.0,
            spin: 0.0,
            angular: 0.0,
            size: 0.0,
        };
        now.base.is_cut = (0..self.model.joint_count()).any(|j| self.starts_or_stops(k, j));
        self.add_scales(&mut now);
        now
    }

    /// Returns the jump of the angular acceleration of the base, rad/s², `ω̇⁻ − ω̇⁺`, for efforts `τ` that
    /// jump at row `k`: the base part of `M⁻¹ (τ⁻ − τ⁺)`. Joints that are at rest before and after the row
    /// are locked. The jump is zero in the first row and without joints.
    fn angular_jump(&mut self, k: usize, q: &[f64]) -> Vec3<f64> {
        let n = self.model.joint_count();
        if k == 0 || n == 0 {
            return Vec3::zero();
        }
        self.forces[..BASE_NV].fill(0.0);
        for j in 0..n {
            self.locked[j] = self.is_held(k, j);
            let jump = self.effort(k - 1, j) - self.effort(k, j);
            self.forces[BASE_NV + j] = if self.locked[j] { 0.0 } else { jump };
        }
        if self.forces[BASE_NV..].iter().all(|jump| *jump == 0.0) {
            return Vec3::zero();
        }
        // at zero velocity the bias forces vanish, so the acceleration is M⁻¹ Δτ
        let Self { model, data, at_rest, forces, locked, jump, .. } = self;
        kinematics(model, data, q, at_rest);
        data.clear_external();
        locked_dynamics_recursion(model, data, at_rest, forces, locked, &[], jump);
        Vec3::from_slice(&jump[3..])
    }

    /// Returns the effort of the motor and of Coulomb friction on joint `j` just after a row, N m or N.
    fn effort(&self, row: usize, j: usize) -> f64 {
        let tau = Trace::row(&self.trace.tau, row, self.model.joint_count())[j];
        tau - self.model.joints()[j].friction * self.direction(row, j)
    }

    /// Returns the direction of the motion of joint `j` just after a row: 1, −1, or 0 at rest.
    fn direction(&self, row: usize, j: usize) -> f64 {
        let of = |column: &[f64]| Trace::row(column, row, self.model.nv())[BASE_NV + j];
        match (of(&self.trace.v), of(&self.trace.acceleration)) {
            (0.0, 0.0) => 0.0,
            (0.0, acceleration) => acceleration.signum(),
            (rate, _) => rate.signum(),
        }
    }

    /// Returns true if joint `j` is at rest either just before or just after a row, but not both.
    fn starts_or_stops(&self, row: usize, j: usize) -> bool {
        row > 0 && (self.direction(row - 1, j) == 0.0) != (self.direction(row, j) == 0.0)
    }

    /// Returns true if joint `j` is at rest in the intervals before and after a row. The acceleration of such
    /// a joint does not jump at the row.
    fn is_held(&self, row: usize, j: usize) -> bool {
        let rate = Trace::row(&self.trace.v, row, self.model.nv())[BASE_NV + j];
        rate == 0.0 && self.direction(row - 1, j) == 0.0 && self.direction(row, j) == 0.0
    }

    /// Computes the mass and the scales of momentum and length from the kinematics in `data`.
    fn add_scales(&self, now: &mut TraceRow<'_>) {
        let (inertia, h) = composite_momentum(&self.data);
        let (c, v_com) = (inertia.com(), h.linear * (1.0 / inertia.mass));
        now.mass = inertia.mass;
        now.size = (trace_of(&inertia.about_com()) / (2.0 * inertia.mass)).sqrt();
        for (node, body) in self.model.nodes().iter().zip(&self.data.bodies) {
            let relative = body.velocity.at(body.inertia.com) - v_com;
            now.relative_momentum += node.mass * relative.norm();
            let moment = trace_of(&node.about_com) / 2.0; // m ρ²
            now.spin += (node.mass * moment).sqrt() * body.velocity.angular.norm();
            // Lₖ = Iₖ ωₖ + (cₖ − c) × m (vₖ − v_com)
            let spin = body.inertia.about_com * body.velocity.angular;
            now.angular += (spin + (body.com_b() - c).cross(relative) * node.mass).norm();
        }
    }
}

fn trace_of(inertia: &crate::spatial::Sym3<f64>) -> f64 {
    inertia.to_nalgebra().trace()
}

fn pair(column: &[f64], k: usize) -> Momentum<f64> {
    let row = Trace::row(column, k, 6);
    Momentum { linear: Vec3::from_slice(row), angular: Vec3::from_slice(&row[3..]) }
}

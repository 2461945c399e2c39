//! One row of a trace, and what the equations of motion say about it.

use crate::dynamics::{
    Data, Momentum, base_rotation, composite_momentum, forward_dynamics, inverse_dynamics,
};
use crate::model::Model;
use crate::simulation::trace::Trace;
use crate::spatial::{Quat, Vec3};

/// A row read back. W axes unless said.
pub(super) struct Instant<'a> {
    pub(super) time: f64,
    pub(super) q: &'a [f64],
    pub(super) v: &'a [f64],
    pub(super) a: &'a [f64],
    pub(super) momentum: Momentum<f64>,
    pub(super) impulse: Momentum<f64>,
    pub(super) kinetic_energy: f64,
    pub(super) work: f64,
    pub(super) center_of_mass: Vec3<f64>,
    pub(super) attitude: Quat<f64>,
    /// Angular acceleration of the base just before this row, base axes.
    pub(super) turn_before: Vec3<f64>,
    /// External force just after this row, from the base rows of inverse dynamics.
    pub(super) force: Vec3<f64>,
    pub(super) mass: f64,
    /// `Σ mₖ |vₖ − v_com|`, kg m/s.
    pub(super) relative_momentum: f64,
    /// `Σ mₖ ρₖ |ωₖ|` with each body's radius of gyration, kg m/s.
    pub(super) spin: f64,
    /// `Σ |Lₖ|` about the system's centre of mass, kg m²/s.
    pub(super) angular: f64,
    /// Radius of gyration of the whole robot, m.
    pub(super) size: f64,
}

impl Instant<'_> {
    /// Angular velocity of the base, base axes.
    pub(super) fn rate(&self) -> Vec3<f64> {
        Vec3::from_slice(&self.v[3..])
    }

    /// Its change just after this row.
    pub(super) fn turn_after(&self) -> Vec3<f64> {
        Vec3::from_slice(&self.a[3..])
    }
}

/// Reads rows one after the other.
pub(super) struct Reader<'a> {
    model: &'a Model,
    trace: &'a Trace,
    data: Data<f64>,
    forces: Vec<f64>,
    jump: Vec<f64>,
    at_rest: Vec<f64>,
}

impl<'a> Reader<'a> {
    pub(super) fn new(model: &'a Model, trace: &'a Trace) -> Self {
        let zeros = vec![0.0; model.nv()];
        Self {
            model,
            trace,
            data: Data::new(model),
            forces: zeros.clone(),
            jump: zeros.clone(),
            at_rest: zeros,
        }
    }

    /// Rows that are complete.
    pub(super) fn rows(&self) -> usize {
        self.trace.rows().min(self.trace.acceleration.len() / self.model.nv())
    }

    pub(super) fn instant(&mut self, k: usize) -> Instant<'a> {
        let (trace, nq, nv) = (self.trace, self.model.nq(), self.model.nv());
        let q = Trace::row(&trace.q, k, nq);
        let v = Trace::row(&trace.v, k, nv);
        let a = Trace::row(&trace.acceleration, k, nv);
        let turn_before = Vec3::from_slice(&a[3..]) + self.turn_jump(k, q);
        inverse_dynamics(self.model, &mut self.data, q, v, a, &[], &mut self.forces);
        let mut now = Instant {
            time: trace.time[k],
            q,
            v,
            a,
            momentum: pair(&trace.momentum, k),
            impulse: pair(&trace.impulse, k),
            kinetic_energy: trace.kinetic_energy[k],
            work: trace.work[k],
            center_of_mass: Vec3::from_slice(Trace::row(&trace.center_of_mass, k, 3)),
            attitude: Quat::from_xyzw(&q[3..]),
            turn_before,
            force: base_rotation(q) * Vec3::from_slice(&self.forces),
            mass: 0.0,
            relative_momentum: 0.0,
            spin: 0.0,
            angular: 0.0,
            size: 0.0,
        };
        self.measure(&mut now);
        now
    }

    /// `ω̇⁻ − ω̇⁺`: a torque that jumps at the row moves the base by `M⁻¹ (τ⁻ − τ⁺)` less.
    fn turn_jump(&mut self, k: usize, q: &[f64]) -> Vec3<f64> {
        let n = self.model.joint_count();
        if k == 0 || n == 0 {
            return Vec3::zero();
        }
        let (before, after) = (Trace::row(&self.trace.tau, k - 1, n), Trace::row(&self.trace.tau, k, n));
        if before == after {
            return Vec3::zero();
        }
        self.forces[..6].fill(0.0);
        for (force, (before, after)) in self.forces[6..].iter_mut().zip(before.iter().zip(after)) {
            *force = before - after;
        }
        // at zero velocity there is no bias: the answer is M⁻¹ Δτ alone
        forward_dynamics(self.model, &mut self.data, q, &self.at_rest, &self.forces, &[], &mut self.jump);
        Vec3::from_slice(&self.jump[3..])
    }

    /// The scales of momentum and of length. Needs the kinematics in `data`.
    fn measure(&self, now: &mut Instant<'_>) {
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

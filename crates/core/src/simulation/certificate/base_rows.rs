//! The base rows of inverse dynamics, on velocities differenced from the trace, against the wrenches.

use super::instant::Instant;
use super::{relative, worst};
use crate::dynamics::{Data, base_rotation, center_of_mass_b, inverse_dynamics};
use crate::model::{Model, difference, integrate};
use crate::spatial::{Force, Vec3};

/// Running residuals; each pair is linear, angular.
pub(super) struct BaseRows {
    data: Data<f64>,
    step: Vec<f64>,
    middle: [Vec<f64>; 3],
    forces: Vec<f64>,
    residual: [f64; 2],
    scale: [f64; 2],
    /// `Σ |m v|` by the step, N.
    momentum: f64,
    truncation: f64,
}

impl BaseRows {
    pub(super) fn new(model: &Model) -> Self {
        let zeros = vec![0.0; model.nv()];
        Self {
            data: Data::new(model),
            step: zeros.clone(),
            middle: [vec![0.0; model.nq()], zeros.clone(), zeros.clone()],
            forces: zeros,
            residual: [0.0; 2],
            scale: [0.0; 2],
            momentum: 0.0,
            truncation: 0.0,
        }
    }

    /// `f = ID(q_m, (v₀ + v₁)/2, (v₁ − v₀)/h)` at the middle; its base rows, turned to W and about
    /// the centre of mass, are the mean wrench `ΔJ/h` up to `O(h²)`.
    pub(super) fn add(&mut self, model: &Model, before: &Instant<'_>, now: &Instant<'_>) {
        let h = now.time - before.time;
        let [q, v, a] = &mut self.middle;
        difference(before.q, now.q, &mut self.step);
        self.step.iter_mut().for_each(|x| *x *= 0.5);
        integrate(before.q, &self.step, q);
        for i in 0..v.len() {
            v[i] = 0.5 * (before.v[i] + now.v[i]);
            a[i] = (now.v[i] - before.v[i]) / h;
        }
        inverse_dynamics(model, &mut self.data, q, v, a, &[], &mut self.forces);
        let found = Force::from_slice(&self.forces);
        let about_com = found.angular - center_of_mass_b(&self.data).cross(found.linear);
        let rot_wb = base_rotation(q);
        let (j, j0) = (&now.impulse, &before.impulse);
        let mean = |j: Vec3<f64>, j0: Vec3<f64>| (j - j0) * (1.0 / h);
        let open = [
            (rot_wb * found.linear - mean(j.linear, j0.linear)).norm(),
            (rot_wb * about_com - mean(j.angular, j0.angular)).norm(),
        ];
        let scale = self.inertial(h);
        for i in 0..2 {
            self.residual[i] = worst(self.residual[i], open[i]);
            self.scale[i] = self.scale[i].max(scale[i]);
        }
        let momenta = self.data.bodies.iter().map(|body| body.inertia.momentum(body.velocity).linear.norm());
        self.momentum = self.momentum.max(momenta.sum::<f64>() / h);
        self.truncation = self.truncation.max(truncation(h, before.v, before.a));
    }

    /// `Σ |I a| + |v ×* I v|` over the bodies, and the force that would change their momenta by
    /// 1e-9 in a step: below that a difference of velocities is rounding.
    fn inertial(&self, h: f64) -> [f64; 2] {
        let mut sum = [0.0; 2];
        for body in &self.data.bodies {
            let (r, velocity) = (body.pos_b, body.velocity.referred_to(-body.pos_b));
            let momentum = body.inertia.momentum(body.velocity).from_point(r);
            let terms = [
                body.inertia.momentum(body.acceleration).from_point(r),
                velocity.cross_force(momentum),
                momentum * (1e-9 / h),
            ];
            // v × m v is nothing but rounding: moments below a billionth of |v| |m v| are
            sum[1] += 1e-9 * velocity.linear.norm() * momentum.linear.norm();
            for term in terms {
                sum[0] += term.linear.norm();
                sum[1] += term.angular.norm();
            }
        }
        sum
    }

    /// `size`, m, is the robot's: moments below a billionth of its forces at that arm, or of those that would stop its
    /// bodies in a step, are rounding.
    pub(super) fn residual(&self, size: f64) -> f64 {
        let [linear, angular] = self.scale;
        let angular = angular.max(1e-9 * size * linear.max(self.momentum));
        worst(relative(self.residual[0], linear), relative(self.residual[1], angular))
    }

    /// Truncation of the differences at the fastest rates of the run; never so wide that a wrench
    /// as large as the inertial forces could pass.
    pub(super) fn gate(&self) -> f64 {
        (1e-6 + self.truncation).min(0.1)
    }
}

/// `h² (w² + ẇ)` with `w` the fastest that the last body can turn: the sum of all rates.
fn truncation(h: f64, v: &[f64], a: &[f64]) -> f64 {
    let fastest = |x: &[f64]| Vec3::from_slice(&x[3..]).norm() + x[6..].iter().map(|x| x.abs()).sum::<f64>();
    let w = fastest(v);
    h * h * (w * w + fastest(a))
}

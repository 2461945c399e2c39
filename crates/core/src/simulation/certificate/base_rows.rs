//! The base rows of inverse dynamics, on velocities differenced from the trace, against the wrenches.

use super::instant::Instant;
use super::numbers::{Numbers, Restore};
use super::{relative, worst};
use crate::dynamics::{BodyData, Data, base_rotation, center_of_mass_b, inverse_dynamics};
use crate::model::{Model, difference, integrate};
use crate::spatial::{Force, Motion, Vec3};

/// What rounding leaves of a momentum at most, in units of ε: of each row, in the sums over the bodies, the rotation
/// to W and the twist that goes with it.
const ROUNDING: f64 = 40.0;

/// Running residuals beyond rounding; each pair is linear, angular.
pub(super) struct BaseRows {
    data: Data<f64>,
    step: Vec<f64>,
    middle: [Vec<f64>; 3],
    forces: Vec<f64>,
    residual: [f64; 2],
    scale: [f64; 2],
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
        let scale = self.inertial();
        let rounding = self.rounding(model, h, [before, now]);
        for i in 0..2 {
            let beyond = if open[i] <= rounding[i] { 0.0 } else { open[i] - rounding[i] };
            self.residual[i] = worst(self.residual[i], beyond);
            self.scale[i] = self.scale[i].max(scale[i]);
        }
        self.truncation = self.truncation.max(truncation(h, before.v, before.a));
    }

    /// `Σ |I a| + |v ×* I v|` over the bodies.
    fn inertial(&self) -> [f64; 2] {
        let mut sum = [0.0; 2];
        for body in &self.data.bodies {
            let (velocity, momentum) = about_base(body);
            let change = body.inertia.momentum(body.acceleration).from_point(body.pos_b);
            let terms = [change, velocity.cross_force(momentum)];
            for term in terms {
                sum[0] += term.linear.norm();
                sum[1] += term.angular.norm();
            }
        }
        sum
    }

    /// Bound of what rounding leaves of the two residuals of one step: momenta and impulses, each rounded at its own size and
    /// differenced over `h`, and moments `v × m v`, which are nothing but rounding.
    fn rounding(&self, model: &Model, h: f64, rows: [&Instant<'_>; 2]) -> [f64; 2] {
        let (mut linear, mut angular, mut passing) = (0.0, 0.0, 0.0);
        for body in &self.data.bodies {
            let (velocity, momentum) = about_base(body);
            linear += momentum.linear.norm();
            angular += momentum.angular.norm();
            passing += velocity.linear.norm() * momentum.linear.norm();
        }
        for row in rows {
            linear += row.impulse.linear.norm();
            angular += row.impulse.angular.norm() + row.size * row.impulse.linear.norm();
        }
        angular += rows[1].size * linear;
        let unit = (ROUNDING + 10.0 * model.nodes().len() as f64) * f64::EPSILON;
        [unit * linear / h, unit * (angular / h + passing)]
    }

    /// Residual beyond the rounding of its step, over the inertial forces.
    /// `size`, m, is the robot's: moments below a billionth of its forces at that arm are rounding.
    pub(super) fn residual(&self, size: f64) -> f64 {
        let [linear, angular] = self.scale;
        let angular = angular.max(1e-9 * size * linear);
        worst(relative(self.residual[0], linear), relative(self.residual[1], angular))
    }

    /// Truncation of the differences at the fastest rates of the run; never so wide that a wrench
    /// as large as the inertial forces could pass.
    pub(super) fn gate(&self) -> f64 {
        (1e-6 + self.truncation).min(0.1)
    }
}

impl Numbers for BaseRows {
    fn save(&self, to: &mut Vec<f64>) {
        to.extend(self.residual.iter().chain(&self.scale).chain([&self.truncation]));
    }

    fn restore(&mut self, from: &mut Restore<'_>) {
        for pair in [&mut self.residual, &mut self.scale] {
            *pair = [from.next(), from.next()];
        }
        self.truncation = from.next();
    }
}

/// Twist and momentum of a body, both about the base's origin.
fn about_base(body: &BodyData<f64>) -> (Motion<f64>, Force<f64>) {
    let momentum = body.inertia.momentum(body.velocity).from_point(body.pos_b);
    (body.velocity.referred_to(-body.pos_b), momentum)
}

/// `h² (w² + ẇ)` with `w` the fastest that the last body can turn: the sum of all rates.
fn truncation(h: f64, v: &[f64], a: &[f64]) -> f64 {
    let fastest = |x: &[f64]| Vec3::from_slice(&x[3..]).norm() + x[6..].iter().map(|x| x.abs()).sum::<f64>();
    let w = fastest(v);
    h * h * (w * w + fastest(a))
}

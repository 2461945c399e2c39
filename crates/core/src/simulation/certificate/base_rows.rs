//! Check of the base rows of inverse dynamics, with accelerations from differences of the recorded
//! velocities, against the external wrenches.

use super::error_measures::{relative, worst};
use super::trace_row::TraceRow;
use crate::dynamics::{BodyData, Data, base_rotation, center_of_mass_b, inverse_dynamics};
use crate::model::{BASE_NV, Model, difference, integrate};
use crate::spatial::{Force, Motion, Vec3};
use serde::{Deserialize, Serialize};

/// Bound on the relative rounding error of the momentum in a row, in units of the machine epsilon. It covers
/// the sums over the bodies, the rotation to W and the twist.
const ROUNDING: f64 = 40.0;

/// Largest residuals so far after subtraction of the rounding bounds, and the scales of the residuals. Each
/// pair has a linear entry (N) and an angular entry (N m).
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Residuals {
    residual: [f64; 2],
    scale: [f64; 2],
    /// Largest relative truncation error due to rates and accelerations.
    truncation: f64,
    /// Largest truncation errors due to the jerk, N and N m.
    jerk: [f64; 2],
}

/// Residuals of the base rows, and the workspace to compute them.
pub(super) struct BaseRows {
    data: Data<f64>,
    step: Vec<f64>,
    middle: [Vec<f64>; 3],
    forces: Vec<f64>,
    pub(super) largest: Residuals,
}

impl BaseRows {
    pub(super) fn new(model: &Model) -> Self {
        let zeros = vec![0.0; model.nv()];
        Self {
            data: Data::new(model),
            step: zeros.clone(),
            middle: [vec![0.0; model.nq()], zeros.clone(), zeros.clone()],
            forces: zeros,
            largest: Residuals::default(),
        }
    }

    /// Adds an interval of length `h`, s. `f = ID(q_m, (v₀ + v₁)/2, (v₁ − v₀)/h)` is the inverse dynamics at
    /// the configuration `q_m` in the middle of the interval, with the velocities `v₀` and `v₁` at its ends.
    /// Its base rows, in W axes and about the centre of mass, equal the mean wrench `ΔJ/h` up to `O(h²)`,
    /// where `ΔJ` is the change of the recorded impulse.
    pub(super) fn add(&mut self, model: &Model, before: &TraceRow<'_>, now: &TraceRow<'_>) {
        let h = now.time - before.time;
        let [q, v, a] = &mut self.middle;
        difference(before.q, now.q, &mut self.step);
        self.step.iter_mut().for_each(|x| *x *= 0.5);
        integrate(before.q, &self.step, q);
        for i in 0..v.len() {
            v[i] = 0.5 * (before.v[i] + now.v[i]);
            a[i] = (now.v[i] - before.v[i]) / h;
        }
        let found = base_wrench(model, &mut self.data, [&q[..], &v[..], &a[..]], &mut self.forces);
        let rot_wb = base_rotation(q);
        let (j, j0) = (&now.impulse, &before.impulse);
        let mean = |j: Vec3<f64>, j0: Vec3<f64>| (j - j0) * (1.0 / h);
        let open = [
            (rot_wb * found.linear - mean(j.linear, j0.linear)).norm(),
            (rot_wb * found.angular - mean(j.angular, j0.angular)).norm(),
        ];
        let scale = self.inertial();
        let rounding = self.rounding(model, h, [before, now]);
        let jerk = self.jerk(model, h, before, found);
        let largest = &mut self.largest;
        for i in 0..2 {
            let beyond = if open[i] <= rounding[i] { 0.0 } else { open[i] - rounding[i] };
            largest.residual[i] = worst(largest.residual[i], beyond);
            largest.scale[i] = largest.scale[i].max(scale[i]);
            largest.jerk[i] = largest.jerk[i].max(jerk[i]);
        }
        largest.truncation = largest.truncation.max(truncation(h, before.v, before.a));
    }

    /// Returns the truncation errors of the force, N, and of the moment, N m, that are due to the jerk `ȧ` in
    /// an interval of length `h`, s. They are the changes of the base rows `found` when the mean of the
    /// velocities at the ends of the interval is replaced by the velocity in its middle,
    /// `(v₀ + v₁)/2 − h²/8 ȧ`. The mean of the inertial forces over the interval differs from `found` by a
    /// third of this change. Without joints, both errors are zero.
    ///
    /// The jerk of the interval is `ȧ = 2/h ((v₁ − v₀)/h − a₀)`. It includes changes of the acceleration
    /// under constant torques, which can be fast for light links even while a heavy load moves slowly.
    fn jerk(&mut self, model: &Model, h: f64, before: &TraceRow<'_>, found: Force<f64>) -> [f64; 2] {
        if model.joints().is_empty() {
            return [0.0; 2];
        }
        let [q, v, a] = &mut self.middle;
        for i in 0..v.len() {
            v[i] -= 0.25 * h * (a[i] - before.a[i]);
        }
        let moved = base_wrench(model, &mut self.data, [&q[..], &v[..], &a[..]], &mut self.forces);
        [(moved.linear - found.linear).norm(), (moved.angular - found.angular).norm()]
    }

    /// Returns the scale of the inertial forces, `Σ |I a| + |v ×* I v|` over the bodies with their inertias
    /// `I`, accelerations `a` and twists `v`: the linear part, N, and the angular part, N m.
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

    /// Returns bounds on the rounding errors of the linear residual, N, and of the angular residual, N m, of
    /// one step of length `h`, s. They comprise the rounding errors of momenta and impulses, relative to
    /// their magnitudes and divided by `h`, and the rounding errors of the moments `v × m v`, whose exact
    /// value is zero.
    fn rounding(&self, model: &Model, h: f64, rows: [&TraceRow<'_>; 2]) -> [f64; 2] {
        let (mut linear, mut angular, mut moments) = (0.0, 0.0, 0.0);
        for body in &self.data.bodies {
            let (velocity, momentum) = about_base(body);
            linear += momentum.linear.norm();
            angular += momentum.angular.norm();
            moments += velocity.linear.norm() * momentum.linear.norm();
        }
        for row in rows {
            linear += row.impulse.linear.norm();
            angular += row.impulse.angular.norm() + row.size * row.impulse.linear.norm();
        }
        angular += rows[1].size * linear;
        let unit = (ROUNDING + 10.0 * model.nodes().len() as f64) * f64::EPSILON;
        [unit * linear / h, unit * (angular / h + moments)]
    }
}

impl Residuals {
    /// Returns the largest residual in excess of its rounding bound, relative to the inertial forces.
    ///
    /// Moments are treated as rounding errors if they are below a billionth of the moment of the forces about
    /// a lever arm of `size`, the radius of gyration of the robot, m.
    pub(super) fn residual(&self, size: f64) -> f64 {
        let [linear, angular] = self.scale_with(size);
        worst(relative(self.residual[0], linear), relative(self.residual[1], angular))
    }

    /// Returns the largest relative residual that passes the check: 1e-6 plus the truncation errors of the
    /// finite differences at the largest rates and the largest jerk of the run, but at most 0.1, so that the
    /// check fails if a wrench as large as the inertial forces is missing. `size` is that of
    /// [`Residuals::residual`].
    pub(super) fn gate(&self, size: f64) -> f64 {
        let [linear, angular] = self.scale_with(size);
        let jerk = relative(self.jerk[0], linear).max(relative(self.jerk[1], angular));
        (1e-6 + self.truncation + jerk).min(0.1)
    }

    /// Returns the scales of the forces, N, and of the moments, N m, to which residuals are compared, for a
    /// robot with the radius of gyration `size`, m.
    fn scale_with(&self, size: f64) -> [f64; 2] {
        let [linear, angular] = self.scale;
        [linear, angular.max(1e-9 * size * linear)]
    }
}

/// Returns the force, N, and the moment about the centre of mass, N m, in base axes, that inverse dynamics
/// requires at the base for the configuration, velocity and acceleration `[q, v, a]`. `forces` is a buffer,
/// `(nv,)`.
fn base_wrench(
    model: &Model,
    data: &mut Data<f64>,
    [q, v, a]: [&[f64]; 3],
    forces: &mut [f64],
) -> Force<f64> {
    inverse_dynamics(model, data, q, v, a, &[], forces);
    let found = Force::from_slice(forces);
    Force::new(found.linear, found.angular - center_of_mass_b(data).cross(found.linear))
}

/// Returns the twist and the momentum of a body, both about the base's origin and in base axes.
fn about_base(body: &BodyData<f64>) -> (Motion<f64>, Force<f64>) {
    let momentum = body.inertia.momentum(body.velocity).from_point(body.pos_b);
    (body.velocity.referred_to(-body.pos_b), momentum)
}

/// Returns `h² (w² + ẇ)`, the relative truncation error of a central difference over a step of length `h`, s.
/// `w` is the sum of the magnitudes of all rates and bounds the angular velocity of every body; `ẇ` is the
/// sum of the magnitudes of all angular and joint accelerations.
fn truncation(h: f64, v: &[f64], a: &[f64]) -> f64 {
    let fastest =
        |x: &[f64]| Vec3::from_slice(&x[3..]).norm() + x[BASE_NV..].iter().map(|x| x.abs()).sum::<f64>();
    let w = fastest(v);
    h * h * (w * w + fastest(a))
}

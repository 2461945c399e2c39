//! Momentum and energy of one system, computed from the model of this system alone, for the audit of an
//! event.

use crate::dynamics::{Data, base_rotation, kinematics, kinetic_energy};
use crate::model::Model;
use crate::spatial::{Force, Motion, Scalar, Vec3};

/// Lower bound of the speed from which the linear scale of a body is computed, m/s; it keeps the scale of a
/// body at rest from being zero.
const REST: f64 = 1e-9;
/// Smallest angular scale of a body, relative to `|r| |p| + |H|`, because `r × p` and `H` may cancel; `r` is
/// the arm from the reference point to the body's origin, `p` the linear momentum, and `H` the angular
/// momentum about that origin.
const LEAST: f64 = 1e-3;

/// Momentum of a system, and the scales by which its errors are divided.
#[derive(Clone, Copy, Debug, Default)]
pub struct Balance {
    /// Linear momentum, N s, and angular momentum about a point, N m s, in W axes.
    pub momentum: Force<f64>,
    /// Sums over the bodies of the magnitudes of the linear momenta, N s, and of the angular momenta about
    /// the same point, N m s, with a lower bound for each body.
    pub scales: [f64; 2],
}

impl Balance {
    /// Computes the momentum and scales of a system with configuration `q` and velocity `v` about `point` in
    /// W, m.
    pub fn of(model: &Model, q: &[f64], v: &[f64], point: Vec3<f64>) -> Self {
        let mut data = Data::<f64>::new(model);
        kinematics(model, &mut data, q, v);
        let (rot_wb, origin) = (base_rotation(q), Vec3::from_slice(q));
        let mut all = Self::default();
        for body in &data.bodies {
            let h = body.inertia.momentum(body.velocity);
            let lever = rot_wb * body.pos_b + origin - point;
            let about_point = Force::at(rot_wb * h.linear, rot_wb * h.angular, lever);
            all.momentum += about_point;
            add_scales(&mut all.scales, h, about_point.angular, lever, body.inertia.mass);
        }
        all
    }

    /// Returns the scales of the momentum about `point` in W, m, relative to a frame that moves with
    /// `velocity` in W, m/s. Requires the kinematics of the system at `q` in `data`.
    pub(crate) fn scales_in_frame<S: Scalar>(
        velocity: Vec3<f64>,
        data: &Data<S>,
        q: &[S],
        point: Vec3<f64>,
    ) -> [f64; 2] {
        S::enter(
            #[inline(always)]
            || {
                let rot_wb = base_rotation(q);
                let frame = Motion::new(rot_wb.transpose_mul(Vec3::of(&velocity)), Vec3::zero());
                let offset = Vec3::from_slice(q) - Vec3::of(&point);
                let mut scales = [0.0; 2];
                for body in &data.bodies {
                    let h = body.inertia.momentum(body.velocity - frame);
                    let lever = rot_wb * body.pos_b + offset;
                    let about_point = Force::at(rot_wb * h.linear, rot_wb * h.angular, lever).angular;
                    let [linear, angular, about_point, lever] =
                        [h.linear, h.angular, about_point, lever].map(|v| v.map(|x| x.value()));
                    let mass = body.inertia.mass.value();
                    add_scales(&mut scales, Force::new(linear, angular), about_point, lever, mass);
                }
                scales
            },
        )
    }

    /// Adds the momentum about the same point, and the scales, of another system.
    pub fn add(&mut self, other: &Self) {
        self.momentum += other.momentum;
        self.scales = [0, 1].map(|i| self.scales[i] + other.scales[i]);
    }

    /// Returns the magnitudes of the changes of linear and angular momentum since `before`, each divided by
    /// the larger of its scales before and after the change.
    pub fn error_since(&self, before: &Self) -> [f64; 2] {
        let change = self.momentum - before.momentum;
        let sizes = [change.linear.norm(), change.angular.norm()];
        let scales = [0, 1].map(|i| self.scales[i].max(before.scales[i]));
        [0, 1].map(|i| if sizes[i] == 0.0 { 0.0 } else { sizes[i] / scales[i] })
    }
}

/// Adds the scales of a body of mass `mass`, kg: those of its momentum `h` about its origin and of its
/// angular momentum about a point, N m s, from which the origin is at `lever`, m.
#[inline(always)]
fn add_scales(scales: &mut [f64; 2], h: Force<f64>, about_point: Vec3<f64>, lever: Vec3<f64>, mass: f64) {
    let linear = h.linear.norm().max(REST * mass);
    scales[0] += linear;
    scales[1] += about_point.norm().max(LEAST * (lever.norm() * linear + h.angular.norm()));
}

/// Returns the kinetic energy, J, of the change of a system's velocity from `before` to `after`, `(nv,)`, at
/// the configuration `q`.
///
/// If an impulse stops only the motions that a connection forbids, the energy lost is the energy of the
/// velocity change: `T⁻ − T⁺ = ½ (v⁻ − v⁺)ᵀ M (v⁻ − v⁺)`, summed over the systems, with the kinetic energy
/// `T`, the mass matrix `M` and the velocities `v⁻` before and `v⁺` after the impulse.
pub fn energy_of_change(model: &Model, q: &[f64], before: &[f64], after: &[f64]) -> f64 {
    let change: Vec<f64> = after.iter().zip(before).map(|(after, before)| after - before).collect();
    energy(model, q, &change)
}

/// Returns the kinetic energy of a system at the configuration `q` and velocity `v`, J.
pub fn energy(model: &Model, q: &[f64], v: &[f64]) -> f64 {
    let mut data = Data::<f64>::new(model);
    kinematics(model, &mut data, q, v);
    kinetic_energy(model, &data, v)
}

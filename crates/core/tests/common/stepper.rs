//! A second integrator, written with the public kernels only: Runge-Kutta with correct attitude or, as a
//! negative control, with attitude from averaged rates.

use onorbit_core::dynamics::{
    Data, center_of_mass, forward_dynamics, kinematics, kinetic_energy, momentum, projected_base_twist,
};
use onorbit_core::model::Model;
use onorbit_core::simulation::Trace;
use onorbit_core::spatial::{Quat, Vec3, dexp_inv, exp_so3};

/// Method of integrating the attitude.
#[derive(Clone, Copy, PartialEq)]
pub enum Turning {
    /// `R exp(h Σ b ω)`: averages the rates as if rotations commuted.
    Averaged,
    /// The same, with each rate transformed by the inverse differential of the exponential.
    OnTheGroup,
}

/// Returns every step of a free motion in W; momentum is projected at each step, as in the engine.
pub fn free_motion(model: &Model, q: &[f64], v: &[f64], h: f64, steps: usize, turning: Turning) -> Trace {
    let mut data = Data::new(model);
    let (mut q, mut v) = (q.to_vec(), v.to_vec());
    let zeros = vec![0.0; model.nv()];
    kinematics(model, &mut data, &q, &v);
    let start = momentum(&data, &q);
    let mut trace = Trace { rows_suffice: true, ..Trace::default() };
    for k in 0..=steps {
        kinematics(model, &mut data, &q, &v);
        projected_base_twist(&data, &q, &v, start).write(&mut v);
        let mut a = zeros.clone();
        forward_dynamics(model, &mut data, &q, &v, &zeros, &[], &mut a);
        let h_now = momentum(&data, &q);
        trace.time.push(k as f64 * h);
        trace.q.extend(&q);
        trace.v.extend(&v);
        trace.tau.extend(&zeros[6..]);
        trace.acceleration.extend(&a);
        let (p, l, c) = (h_now.linear, h_now.angular, center_of_mass(&data, &q));
        trace.momentum.extend([p.x, p.y, p.z, l.x, l.y, l.z]);
        trace.impulse.extend([0.0; 6]);
        trace.kinetic_energy.push(kinetic_energy(model, &data, &v));
        trace.work.push(0.0);
        trace.center_of_mass.extend([c.x, c.y, c.z]);
        if k < steps {
            step(model, &mut data, &mut q, &mut v, h, turning);
        }
    }
    trace
}

/// Classical Runge-Kutta on positions, joints and velocities; the attitude as in `turning`.
fn step(model: &Model, data: &mut Data<f64>, q: &mut [f64], v: &mut [f64], h: f64, turning: Turning) {
    let (q0, v0) = (q.to_vec(), v.to_vec());
    let zeros = vec![0.0; v.len()];
    let mut sum: (Vec<f64>, Vec<f64>) = (zeros.clone(), zeros.clone());
    let mut rate = (zeros.clone(), zeros.clone()); // (ṗ, θ̇, q̇) and a
    for (reach, weight) in [(0.0, 1.0), (0.5, 2.0), (0.5, 2.0), (1.0, 1.0)] {
        let theta = Vec3::from_slice(&rate.0[3..]) * (reach * h);
        place(q, v, (&q0, &v0), &rate, reach * h);
        let omega = Vec3::from_slice(&v[3..]);
        let mut a = zeros.clone();
        forward_dynamics(model, data, q, v, &zeros, &[], &mut a);
        let mut moved = v.to_vec();
        (Quat::from_xyzw(&q[3..]).matrix() * Vec3::from_slice(v)).write(&mut moved);
        let turned = if turning == Turning::Averaged { omega } else { dexp_inv(theta, omega) };
        turned.write(&mut moved[3..]);
        for i in 0..v.len() {
            sum.0[i] += moved[i] * weight / 6.0;
            sum.1[i] += a[i] * weight / 6.0;
        }
        rate = (moved, a);
    }
    place(q, v, (&q0, &v0), &sum, h);
}

/// Returns `(q, v)`: `start` moved by `h` at `rate`.
fn place(q: &mut [f64], v: &mut [f64], from: (&[f64], &[f64]), rate: &(Vec<f64>, Vec<f64>), h: f64) {
    let (q0, v0) = from;
    for i in 0..3 {
        q[i] = q0[i] + h * rate.0[i];
    }
    let turn = exp_so3(Vec3::from_slice(&rate.0[3..]) * h);
    Quat::from_xyzw(&q0[3..]).product(turn).normalized().write_xyzw(&mut q[3..]);
    for j in 7..q.len() {
        q[j] = q0[j] + h * rate.0[j - 1];
    }
    for i in 0..v.len() {
        v[i] = v0[i] + h * rate.1[i];
    }
}

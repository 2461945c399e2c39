//! Checks derivatives against dual numbers, which are exact, on random trees with every joint type and
//! wrenches on every frame.

#![allow(clippy::unwrap_used)] // a failed unwrap is a failed test

mod common;

use common::dual::{Dual, seeded};
use common::{Random, difference, random_model, random_state};
use onorbit_core::dynamics::derivatives::{
    Derivatives, forward_dynamics_derivatives, free_floating_derivatives, inverse_dynamics_derivatives,
};
use onorbit_core::dynamics::{
    Data, FrameWrench, FreeFloating, forward_dynamics, frame_jacobian, frame_velocity, free_floating,
    inverse_dynamics,
};
use onorbit_core::model::{Model, integrate};
use onorbit_core::spatial::{Force, Real, Vec3};

/// Rounding error of two ways to compute a number, relative to the largest entry.
const ROUNDING: f64 = 1e-12;

fn robots() -> impl Iterator<Item = (u64, Model, Random)> {
    let one = (0, Model::rigid_body(2.0, nalgebra::Matrix3::identity()).unwrap(), Random::new(900));
    let trees =
        (1..=24).map(|seed| (seed, random_model(seed, 2 + seed as usize % 12), Random::new(seed + 1000)));
    std::iter::once(one).chain(trees)
}

/// Variable of differentiation.
#[derive(Clone, Copy)]
enum By {
    Q,
    V,
    Third,
}

/// A state with a third input (accelerations or forces), wrenches and a frame.
struct Case {
    model: Model,
    q: Vec<f64>,
    v: Vec<f64>,
    third: Vec<f64>,
    external: Vec<FrameWrench<f64>>,
    tool: usize,
}

impl Case {
    fn new(model: Model, random: &mut Random, width: impl Fn(&Model) -> usize) -> Self {
        let (q, v) = random_state(&model, random);
        let third = random.numbers(width(&model));
        let external = (0..model.frames().len())
            .map(|frame| FrameWrench { frame, wrench: Force::from_slice(&random.numbers(6)) })
            .collect();
        let tool = model.frames().len() - 1;
        Self { model, q, v, third, external, tool }
    }

    fn wrenches<S: Real>(&self) -> Vec<FrameWrench<S>> {
        let of = |f: &Vec3<f64>| Vec3::of(f);
        let one = |w: &FrameWrench<f64>| FrameWrench {
            frame: w.frame,
            wrench: Force::new(of(&w.wrench.linear), of(&w.wrench.angular)),
        };
        self.external.iter().map(one).collect()
    }

    /// Derivative of `f(q, v, third)`, row major, column by column with dual numbers.
    fn exactly(
        &self,
        by: By,
        f: impl Fn(&[Dual<f64>], &[Dual<f64>], &[Dual<f64>]) -> Vec<Dual<f64>>,
    ) -> Vec<f64> {
        let width = if let By::Third = by { self.third.len() } else { self.v.len() };
        let columns: Vec<Vec<f64>> = (0..width)
            .map(|j| {
                let seed = |x: &[f64], is_here: bool| seeded(x, is_here.then_some(j));
                let mut q = seeded(&self.q, None);
                let step = seed(&vec![0.0; self.v.len()], matches!(by, By::Q));
                let from = q.clone();
                integrate(&from, &step, &mut q);
                let out =
                    f(&q, &seed(&self.v, matches!(by, By::V)), &seed(&self.third, matches!(by, By::Third)));
                out.iter().map(|x| x.rate).collect()
            })
            .collect();
        let rows = columns.first().map_or(0, Vec::len);
        (0..rows).flat_map(|i| columns.iter().map(move |column| column[i])).collect()
    }
}

fn forward<S: Real>(case: &Case, q: &[S], v: &[S], tau: &[S]) -> Vec<S> {
    let mut a = vec![S::of(0.0); v.len()];
    forward_dynamics(&case.model, &mut Data::new(&case.model), q, v, tau, &case.wrenches(), &mut a);
    a
}

fn inverse<S: Real>(case: &Case, q: &[S], v: &[S], a: &[S]) -> Vec<S> {
    let mut tau = vec![S::of(0.0); v.len()];
    inverse_dynamics(&case.model, &mut Data::new(&case.model), q, v, a, &case.wrenches(), &mut tau);
    tau
}

/// `M* q̈ + c* − Q*`, `Jg q̈ + d` and the frame's twist, one after the other.
fn reduced<S: Real>(case: &Case, q: &[S], v: &[S], joints: &[S]) -> Vec<S> {
    let (model, n) = (&case.model, joints.len());
    let (mut data, mut ff) = (Data::new(model), FreeFloating::new(model));
    free_floating(model, &mut data, q, v, case.tool, &case.wrenches(), &mut ff);
    let times = |m: &[S], i: usize| (0..n).fold(S::of(0.0), |sum, j| sum + m[i * n + j] * joints[j]);
    let mut drift = [S::of(0.0); 6];
    ff.drift.write(&mut drift);
    let mut out: Vec<S> = (0..n).map(|i| times(&ff.inertia, i) + ff.bias[i] - ff.external[i]).collect();
    out.extend((0..6).map(|i| times(&ff.jacobian, i) + drift[i]));
    let mut twist = [S::of(0.0); 6];
    frame_velocity(model, &data, q, case.tool).write(&mut twist);
    out.extend(twist);
    out
}

fn three(model: &Model) -> [Vec<f64>; 3] {
    [0; 3].map(|_| vec![f64::NAN; model.nv() * model.nv()])
}

fn assert_same(what: &str, seed: u64, ours: &[f64], exact: &[f64]) {
    let off = difference(ours, exact);
    assert!(off < ROUNDING, "{what}, seed {seed}: {off:.2e}");
}

#[test]
fn inverse_dynamics_agrees_with_dual_numbers() {
    for (seed, model, mut random) in robots() {
        let case = Case::new(model, &mut random, Model::nv);
        let (model, [mut dq, mut dv, mut da]) = (&case.model, three(&case.model));
        inverse_dynamics_derivatives(
            model,
            &mut Data::new(model),
            &mut Derivatives::new(model),
            &case.q,
            &case.v,
            &case.third,
            &case.external,
            [&mut dq, &mut dv, &mut da],
        );
        for (what, by, ours) in [("dq", By::Q, dq), ("dv", By::V, dv), ("da", By::Third, da)] {
            assert_same(what, seed, &ours, &case.exactly(by, |q, v, a| inverse(&case, q, v, a)));
        }
    }
}

#[test]
fn forward_dynamics_agrees_with_dual_numbers() {
    for (seed, model, mut random) in robots() {
        let case = Case::new(model, &mut random, Model::nv);
        let (model, [mut dq, mut dv, mut dtau]) = (&case.model, three(&case.model));
        forward_dynamics_derivatives(
            model,
            &mut Data::new(model),
            &mut Derivatives::new(model),
            &case.q,
            &case.v,
            &case.third,
            &case.external,
            [&mut dq, &mut dv, &mut dtau],
        );
        for (what, by, ours) in [("dq", By::Q, dq), ("dv", By::V, dv), ("dtau", By::Third, dtau)] {
            assert_same(what, seed, &ours, &case.exactly(by, |q, v, tau| forward(&case, q, v, tau)));
        }
    }
}

#[test]
fn the_reduced_model_agrees_with_dual_numbers() {
    for (seed, model, mut random) in robots() {
        let case = Case::new(model, &mut random, Model::joint_count);
        let (model, n, nv) = (&case.model, case.model.joint_count(), case.model.nv());
        let mut out = [n, n, 6, 6, 6].map(|rows| vec![f64::NAN; rows * nv]);
        let [tau_q, tau_v, acc_q, acc_v, vel_q] = &mut out;
        free_floating_derivatives(
            model,
            &mut Data::new(model),
            &mut Derivatives::new(model),
            &case.q,
            &case.v,
            &case.third,
            case.tool,
            &case.external,
            [tau_q, tau_v, acc_q, acc_v, vel_q],
        );
        let by_q = case.exactly(By::Q, |q, v, a| reduced(&case, q, v, a));
        let by_v = case.exactly(By::V, |q, v, a| reduced(&case, q, v, a));
        let rows = |m: &[f64], from: usize, count: usize| m[from * nv..(from + count) * nv].to_vec();
        assert_same("∂τ/∂q", seed, tau_q, &rows(&by_q, 0, n));
        assert_same("∂τ/∂v", seed, tau_v, &rows(&by_v, 0, n));
        assert_same("∂ẍ/∂q", seed, acc_q, &rows(&by_q, n, 6));
        assert_same("∂ẍ/∂v", seed, acc_v, &rows(&by_v, n, 6));
        assert_same("∂ẋ/∂q", seed, vel_q, &rows(&by_q, n + 6, 6));
        // derivatives that equal other quantities
        let (mut data, mut ff) = (Data::new(model), FreeFloating::new(model));
        free_floating(model, &mut data, &case.q, &case.v, case.tool, &case.external, &mut ff);
        let by_a = case.exactly(By::Third, |q, v, a| reduced(&case, q, v, a));
        assert_same("M*", seed, &ff.inertia, &by_a[..n * n]);
        assert_same("Jg", seed, &ff.jacobian, &by_a[n * n..(n + 6) * n]);
        let mut jacobian = vec![0.0; 6 * nv];
        frame_jacobian(model, &data, &case.q, case.tool, &mut jacobian);
        assert_same("J", seed, &jacobian, &rows(&by_v, n + 6, 6));
    }
}

//! Prints the time of a call of every kernel for one state, and of a step of whole runs, as lines of
//! `name<tab>nanoseconds`.
//!
//! Usage: `cargo bench --bench one_state -- [robot.urdf [rounds [kernels | steps | name of a step]]]`. The
//! times are medians over the rounds, and the state varies from call to call. The program can be run
//! alternately with a program that times the same kernels of another engine on the same robot.
#![allow(missing_docs, clippy::print_stdout)] // a program that prints

mod common;

use common::torso;
use onorbit_core::control::{ComputedTorque, Control, Law};
use onorbit_core::dynamics::{
    Data, FreeFloating, bias_forces, forward_dynamics, frame_drift, frame_jacobian, frame_pose,
    free_floating, inverse_dynamics, kinematics, mass_matrix, positions,
};
use onorbit_core::environment::GravityGradient;
use onorbit_core::model::{Model, neutral, urdf::from_file};
use onorbit_core::orbit::{Kepler, MU_EARTH};
use onorbit_core::reference::LineParabola;
use onorbit_core::simulation::Simulation;
use onorbit_core::spatial::{Fused, Real};
use std::error::Error;
use std::hint::black_box;
use std::sync::Arc;
use std::time::Instant;

const STATES: usize = 256;
const LOOPS: usize = 6;
const STEPS: usize = 500;

type Job<'a> = (&'static str, Box<dyn FnMut() -> f64 + 'a>);

/// Returns the mean time of a call of `f`, ns, over all states. The argument of `f` is the index of a state.
fn timed(mut f: impl FnMut(usize)) -> f64 {
    (0..STATES).for_each(&mut f);
    let started = Instant::now();
    for _ in 0..LOOPS {
        (0..STATES).for_each(&mut f);
    }
    started.elapsed().as_secs_f64() * 1e9 / (LOOPS * STATES) as f64
}

/// Returns `n` numbers from -1 to 1, which differ from seed to seed.
fn numbers<S: Real>(n: usize, seed: usize) -> Vec<S> {
    (0..n).map(|i| S::of((12.9898 * i as f64 + 78.233 * seed as f64 + 0.1).sin())).collect()
}

struct States<S> {
    q: Vec<Vec<S>>,
    v: Vec<Vec<S>>,
    tau: Vec<Vec<S>>,
}

impl<S: Real> States<S> {
    fn new(model: &Model) -> Self {
        let unit = [0.0, 0.0, 0.6, 0.8].map(S::of);
        let mut q: Vec<Vec<S>> = (0..STATES).map(|k| numbers(model.nq(), k)).collect();
        q.iter_mut().for_each(|q| q[3..7].copy_from_slice(&unit));
        let rates = |offset| (0..STATES).map(|k| numbers(model.nv(), k + offset)).collect();
        Self { q, v: rates(STATES), tau: rates(2 * STATES) }
    }
}

fn kernels<S: Real>(model: &Model, rounds: usize) {
    let (nv, tool) = (model.nv(), model.frames().len() - 1);
    let States { q, v, tau } = &States::<S>::new(model);
    let space = || (Data::<S>::new(model), vec![S::of(0.0); nv * nv]);
    let jobs: Vec<Job<'_>> = vec![
        ("kinematics", {
            let (mut data, _) = space();
            Box::new(move || timed(|k| kinematics(model, &mut data, black_box(&q[k]), &v[k])))
        }),
        ("aba", {
            let (mut data, mut a) = space();
            let mut call = move |k: usize| {
                forward_dynamics(model, &mut data, black_box(&q[k]), &v[k], &tau[k], &[], &mut a);
            };
            Box::new(move || timed(&mut call))
        }),
        ("rnea", {
            let (mut data, mut out) = space();
            let mut call = move |k: usize| {
                inverse_dynamics(model, &mut data, black_box(&q[k]), &v[k], &tau[k], &[], &mut out);
            };
            Box::new(move || timed(&mut call))
        }),
        ("bias", {
            let (mut data, mut out) = space();
            Box::new(move || timed(|k| bias_forces(model, &mut data, black_box(&q[k]), &v[k], &[], &mut out)))
        }),
        ("crba", {
            let (mut data, mut out) = space();
            Box::new(move || timed(|k| mass_matrix(model, &mut data, black_box(&q[k]), &mut out)))
        }),
        ("J+drift", {
            let (mut data, mut out) = space();
            let mut call = move |k: usize| {
                kinematics(model, &mut data, black_box(&q[k]), &v[k]);
                frame_jacobian(model, &data, &q[k], tool, &mut out[..6 * nv]);
                black_box(frame_drift(model, &data, &q[k], &v[k], tool));
            };
            Box::new(move || timed(&mut call))
        }),
        ("reduced", {
            let (mut data, mut out) = (Data::<S>::new(model), FreeFloating::new(model));
            let mut call = move |k: usize| {
                free_floating(model, &mut data, black_box(&q[k]), &v[k], tool, &[], black_box(&mut out));
            };
            Box::new(move || timed(&mut call))
        }),
    ];
    print(jobs, rounds);
}

fn print(mut jobs: Vec<Job<'_>>, rounds: usize) {
    let mut seen = vec![Vec::new(); jobs.len()];
    for _ in 0..rounds {
        jobs.iter_mut().zip(&mut seen).for_each(|((_, job), seen)| seen.push(job()));
    }
    for ((name, _), mut seen) in jobs.into_iter().zip(seen) {
        seen.sort_by(f64::total_cmp);
        println!("{name}\t{:.1}", seen[rounds / 2]);
    }
}

/// Returns the simulation of the robot without controllers, with initial joint rates.
fn passive(model: &Arc<Model>, record_every: usize) -> Simulation {
    let mut q = neutral(model);
    let v = numbers(model.nv(), 7);
    q[7..].copy_from_slice(&numbers(model.joint_count(), 5));
    Simulation { record_every, ..Simulation::new(Arc::clone(model), q, v) }
}

/// Returns a simulation similar to the scenario `humanoid_reach`: computed torque along a line and, if
/// `in_orbit` is true, an orbit with the gravity gradient.
fn reach(model: &Arc<Model>, in_orbit: bool) -> Result<Simulation, Box<dyn Error>> {
    const START: [f64; 7] = [0.3, 0.6, -0.4, 1.3, 0.2, 1.0, -0.3];
    let mut q = neutral(model);
    q[7..].iter_mut().zip(START.iter().cycle()).for_each(|(q, start)| *q = *start);
    let tool = model.frames().len() - 1;
    let mut data = Data::<f64>::new(model);
    positions(model, &mut data, &q);
    let pose = frame_pose(model, &data, &q, tool);
    let (x, z) = ([0.05, 0.0, 0.0].into(), [0.0, 0.0, 0.04].into());
    let line = LineParabola::new(pose.rot_wf.to_nalgebra(), pose.pos_w.to_nalgebra(), x, z, 2.0)?;
    let mut simulation = Simulation::new(Arc::clone(model), q, vec![0.0; model.nv()]);
    if in_orbit {
        let (r, v) = ([6_778e3, 0.0, 0.0].into(), [0.0, 4_700.0, 6_100.0].into());
        simulation.orbit = Some(Arc::new(Kepler::from_state(r, v, MU_EARTH)?));
        simulation.effects.push(Arc::new(GravityGradient));
    }
    simulation.systems[0].tool = Some(tool);
    let law = ComputedTorque { null_space_damping: 2.0, ..ComputedTorque::new(tool, 100.0, 20.0) };
    let law = Law::TaskComputedTorque(Box::new(law), line.into());
    simulation.systems[0].controls = vec![Control::on_all_joints(model, law)];
    Ok(simulation)
}

/// Returns a job that runs `simulation` and returns the time of a step, ns.
fn stepped(mut simulation: Simulation) -> Box<dyn FnMut() -> f64> {
    Box::new(move || {
        let started = Instant::now();
        let trace = simulation.run(STEPS as f64 * 1e-3);
        let time = started.elapsed().as_secs_f64() * 1e9 / STEPS as f64;
        black_box(trace).map_or(f64::NAN, |_| time)
    })
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).filter(|a| !a.starts_with("--")).collect();
    let robot =
        arguments.first().map_or_else(|| Ok(torso(1)), |path| from_file(path.as_ref(), &Default::default()));
    let model = Arc::new(robot?);
    let rounds = arguments.get(1).map_or(Ok(5), |n| n.parse())?;
    let only = arguments.get(2).map(String::as_str);
    if only.is_none_or(|only| only == "kernels") {
        match Fused::is_available() {
            true => kernels::<Fused>(&model, rounds),
            false => kernels::<f64>(&model, rounds),
        }
    }
    if only != Some("kernels") {
        let mut jobs: Vec<Job<'_>> = vec![
            ("passive step", stepped(passive(&model, 1))),
            ("passive step, 1 row in 100", stepped(passive(&model, 100))),
            ("reach, no orbit", stepped(reach(&model, false)?)),
            ("reach in orbit", stepped(reach(&model, true)?)),
        ];
        jobs.retain(|(name, _)| only.is_none_or(|only| only == "steps" || *name == only));
        print(jobs, rounds);
    }
    Ok(())
}

//! Benches of a simulated step of 1 ms of a torso with a seven-joint arm.
//!
//! Fixed: the robot and its initial state. Varied: integrator, environment and control. Each run has 1000
//! steps. The time is that of one step, including the start of the run and the recording of every 100th step.
#![allow(missing_docs, clippy::unwrap_used)] // criterion's macros write undocumented items

mod common;

use common::torso;
use criterion::{BenchmarkGroup, Criterion, Throughput, criterion_group, criterion_main};
use nalgebra::Vector3;
use onorbit_core::control::{ComputedTorque, Control, Law};
use onorbit_core::dynamics::{Data, frame_pose, positions};
use onorbit_core::earth::{Earth, EarthParameters, Epoch};
use onorbit_core::environment::atmosphere::{MagneticActivity, Nrlmsise00, SpaceIndices, SpaceWeather};
use onorbit_core::environment::surfaces::{Optics, Surfaces};
use onorbit_core::environment::{Drag, GravityGradient, RadiationPressure};
use onorbit_core::gravity::{Gravity, GravityField, Luminary};
use onorbit_core::model::neutral;
use onorbit_core::model::urdf::from_file;
use onorbit_core::orbit::{Kepler, MU_EARTH, Numerical};
use onorbit_core::reference::LineParabola;
use onorbit_core::simulation::{Integrator, Simulation};
use onorbit_core::spatial::InstructionSet;
use std::hint::black_box;
use std::sync::Arc;
use std::time::Instant;

const STEPS: usize = 1000;
const STEP: f64 = 1e-3;
const START: [f64; 7] = [0.3, 0.6, -0.4, 1.3, 0.2, 1.0, -0.3];

/// Returns the simulation of the robot without controllers, with initial joint rates.
fn passive() -> Simulation {
    let model = torso(1);
    let mut q = neutral(&model);
    q[7..].copy_from_slice(&START);
    let v = (0..model.nv()).map(|i| 0.3 * (1.3 * i as f64).sin()).collect();
    Simulation { record_every: 100, time_step: STEP, ..Simulation::new(Arc::new(model), q, v) }
}

/// Returns `simulation` on a low orbit, with the gravity gradient.
fn in_orbit(mut simulation: Simulation) -> Simulation {
    let (r, v) = (Vector3::new(6_778e3, 0.0, 0.0), Vector3::new(0.0, 4_700.0, 6_100.0));
    simulation.orbit = Some(Arc::new(Kepler::from_state(r, v, MU_EARTH).unwrap()));
    simulation.effects.push(Arc::new(GravityGradient));
    simulation
}

/// Returns `simulation` from rest, with computed torque along a line.
fn controlled(mut simulation: Simulation) -> Simulation {
    simulation.systems[0].v.fill(0.0);
    let tool = simulation.systems[0].model.frame("arm0_link6").unwrap();
    let mut data = Data::new(&simulation.systems[0].model);
    positions(&simulation.systems[0].model, &mut data, &simulation.systems[0].q);
    let pose = frame_pose(&simulation.systems[0].model, &data, &simulation.systems[0].q, tool);
    let (rot, pos) = (pose.rot_wf.to_nalgebra(), pose.pos_w.to_nalgebra());
    let line = LineParabola::new(rot, pos, Vector3::x() * 0.1, Vector3::zeros(), 10.0).unwrap();
    simulation.systems[0].tool = Some(tool);
    let law = ComputedTorque { null_space_damping: 5.0, ..ComputedTorque::new(tool, 100.0, 20.0) };
    let law = Law::TaskComputedTorque(Box::new(law), line.into());
    simulation.systems[0].controls = vec![Control::on_all_joints(&simulation.systems[0].model, law)];
    simulation
}

/// Returns a simulation of the bundled torso with all effects: gravity of EGM2008 36 × 36, Sun and Moon,
/// gravity gradient, drag in NRLMSISE-00 and radiation pressure on the faces of the robot. The reference
/// orbit is integrated in the same field.
fn with_all_effects() -> Simulation {
    let urdf = concat!(env!("CARGO_MANIFEST_DIR"), "/../../python/onorbit_rs/robots/humanoid_torso.urdf");
    let model = Arc::new(from_file(urdf.as_ref(), &Default::default()).unwrap());
    let mut q = neutral(&model);
    q[7..].copy_from_slice(&[0.5342, -2.341, -2.0077, -2.2249, -2.2693, -0.1342, -0.1974]);
    let v = vec![0.0; model.nv()];
    let mut simulation = Simulation { record_every: 100, ..Simulation::new(Arc::clone(&model), q, v) };
    let epoch = Epoch::parse("2026-03-20T12:00:00 UTC").unwrap();
    let earth = Arc::new(Earth::new(epoch, &EarthParameters::default()).unwrap());
    let field = Arc::new(GravityField::bundled("egm2008", 36, 36).unwrap());
    let gravity = Gravity::of_field(field, Some(Arc::clone(&earth))).unwrap();
    let gravity = gravity.with(Luminary::Sun, &earth).unwrap().with(Luminary::Moon, &earth).unwrap();
    let gravity = Arc::new(gravity);
    let (r, v) = (Vector3::new(6_778e3, 0.0, 0.0), Vector3::new(0.0, 4_700.0, 6_100.0));
    simulation.orbit = Some(Arc::new(Numerical::new(r, v, 0.0, Arc::clone(&gravity)).unwrap()));
    (simulation.gravity, simulation.earth) = (Some(gravity), Some(earth));
    let indices = SpaceIndices { f107: 150.0, f107a: 150.0, activity: MagneticActivity::Daily(15.0) };
    let air = Arc::new(Nrlmsise00::new(SpaceWeather::Constant(indices)));
    let faces = || Surfaces::from_shapes(&model, 2.2, Optics::new(0.2, 0.3).unwrap()).unwrap();
    simulation.effects = vec![
        Arc::new(GravityGradient),
        Arc::new(Drag::new(air, faces())),
        Arc::new(RadiationPressure::new(faces())),
    ];
    simulation
}

type Group<'a> = BenchmarkGroup<'a, criterion::measurement::WallTime>;

/// Times one step of `simulation`: criterion's iterations are steps, of which each run has a thousand.
fn step(group: &mut Group<'_>, name: &str, mut simulation: Simulation) {
    group.bench_function(name, |b| {
        b.iter_custom(|iterations| {
            let runs = iterations.div_ceil(STEPS as u64);
            let started = Instant::now();
            for _ in 0..runs {
                let duration = black_box(STEPS as f64 * STEP);
                black_box(simulation.run(duration).unwrap().only());
            }
            started.elapsed().mul_f64(iterations as f64 / (runs * STEPS as u64) as f64)
        });
    });
}

fn benches(c: &mut Criterion) {
    let mut group = c.benchmark_group(format!("step/{}", InstructionSet::current().name()));
    group.throughput(Throughput::Elements(1));
    step(&mut group, "passive rk4", passive());
    step(&mut group, "passive semi-implicit euler", {
        Simulation { integrator: Integrator::SemiImplicitEuler, ..passive() }
    });
    step(&mut group, "in orbit rk4", in_orbit(passive()));
    step(&mut group, "controlled rk4", controlled(passive()));
    step(&mut group, "controlled in orbit rk4", in_orbit(controlled(passive())));
    step(&mut group, "in everything rk4", with_all_effects());
    group.finish();
}

criterion_group! {
    name = simulation;
    config = Criterion::default().sample_size(20).warm_up_time(std::time::Duration::from_millis(300))
        .measurement_time(std::time::Duration::from_secs(1)).without_plots();
    targets = benches
}
criterion_main!(simulation);

//! Captures that close loops: two arms of one craft on one load, against Gauss's principle.

#![allow(missing_docs, clippy::unwrap_used)]

mod common;

use common::Random;
use nalgebra::{DMatrix, DVector, Isometry3, Matrix3, Vector3};
use onorbit_core::dynamics::{Data, frame_jacobian, frame_pose, mass_matrix, positions};
use onorbit_core::model::{Inertial, Joint, JointKind, Link, Model, ModelBuilder, neutral};
use onorbit_core::simulation::{Recording, Simulation, Trace, world_rows};
use onorbit_core::world::{Action, Event, FrameIndex, System, When};
use std::sync::Arc;

/// Number of joints of each arm.
const JOINTS: usize = 7;

fn link(name: &str, mass: f64, size: f64) -> Link {
    let inertia = Matrix3::from_diagonal(&(Vector3::new(1.0, 1.2, 0.9) * (mass * size * size / 6.0)));
    Link::new(name, Some(Inertial { mass, com: Vector3::new(0.0, 0.0, size / 2.0), inertia }))
}

/// Returns a craft with two arms, whose last links have the frames `left_hand` and `right_hand`.
fn servicer() -> Model {
    let mut builder = ModelBuilder::new("servicer", link("bus", 150.0, 1.0)).unwrap();
    for (arm, y) in [("left", 0.6), ("right", -0.6)] {
        let mut parent = "bus".to_owned();
        for j in 0..JOINTS {
            let axis = if j % 2 == 0 { Vector3::z() } else { Vector3::y() };
            let origin = match j {
                0 => Isometry3::translation(0.5, y, 0.2),
                _ => Isometry3::translation(0.0, 0.0, 0.3),
            };
            let (joint, child) = (format!("{arm}_{j}"), format!("{arm}_link_{j}"));
            builder
                .add(&parent, Joint::new(&joint, JointKind::Revolute(axis), origin), link(&child, 3.0, 0.3))
                .unwrap();
            parent = child;
        }
        builder.add_frame(&format!("{arm}_hand"), &parent, Isometry3::translation(0.0, 0.0, 0.3)).unwrap();
    }
    builder.build().unwrap()
}

/// Returns a module with two handles.
fn module() -> Model {
    let mut builder = ModelBuilder::new("module", link("module", 40.0, 0.8)).unwrap();
    for (name, y) in [("left_handle", 0.4), ("right_handle", -0.4)] {
        builder.add_frame(name, "module", Isometry3::translation(-0.4, y, 0.1)).unwrap();
    }
    builder.build().unwrap()
}

fn event(name: &str, at: f64, action: Action) -> Event {
    Event { name: name.into(), when: When::At(at), action }
}

fn capture(models: [&Model; 2], hand: &str, handle: &str) -> Action {
    let by = FrameIndex { system: 0, frame: models[0].frame(hand).unwrap() };
    let of = FrameIndex { system: 1, frame: models[1].frame(handle).unwrap() };
    Action::Capture { by, of, seat: None }
}

/// Returns a run in which both hands capture the module one after the other; then the hands release it.
fn berthing() -> Simulation {
    let (servicer, module) = (Arc::new(servicer()), Arc::new(module()));
    let mut random = Random::new(11);
    let mut q = neutral(&servicer);
    q[7..].iter_mut().for_each(|angle| *angle = 0.9 * random.unit());
    let v: Vec<f64> = random.numbers(servicer.nv()).iter().map(|v| 0.1 * v).collect();
    let mut other = neutral(&module);
    other[..3].copy_from_slice(&[1.4, 0.1, 1.5]);
    let tumbling: Vec<f64> = random.numbers(6).iter().map(|v| 0.1 * v).collect();
    let models = [&*servicer, &*module];
    let events = vec![
        event("left", 0.2, capture(models, "left_hand", "left_handle")),
        event("right", 0.5, capture(models, "right_hand", "right_handle")),
        event("let_go_left", 1.5, Action::Release { capture: 0, impulse: [0.0; 6] }),
        event("let_go_right", 2.0, Action::Release { capture: 1, impulse: [0.0; 6] }),
    ];
    let mut simulation = Simulation::of(vec![
        System::new("servicer", servicer, q, v),
        System::new("module", module, other, tumbling),
    ]);
    simulation.events = events;
    simulation.time_step = 2e-3;
    simulation
}

/// Returns the rows before and after the event at `t`.
fn rows_at(trace: &Trace, t: f64) -> [usize; 2] {
    let before = trace.time.iter().position(|time| (time - t).abs() < 1e-12).unwrap();
    [before, before + 1]
}

/// Returns the mass matrix and the Jacobian of the twist of a frame at its origin, at the state of a row.
fn matrices(model: &Model, q: &[f64], frame: &str) -> (DMatrix<f64>, DMatrix<f64>, Vector3<f64>) {
    let (mut data, nv) = (Data::<f64>::new(model), model.nv());
    let (mut mass, mut jacobian) = (vec![0.0; nv * nv], vec![0.0; 6 * nv]);
    mass_matrix(model, &mut data, q, &mut mass);
    positions(model, &mut data, q);
    let frame = model.frame(frame).unwrap();
    frame_jacobian(model, &data, q, frame, &mut jacobian);
    let position = frame_pose(model, &data, q, frame).pos_w.to_nalgebra();
    (DMatrix::from_row_slice(nv, nv, &mass), DMatrix::from_row_slice(6, nv, &jacobian), position)
}

/// Returns the Jacobian of the twist of `module/handle` relative to `servicer/hand` at the origin of the handle.
fn relative(models: [&Model; 2], q: [&[f64]; 2], [hand, handle]: [&str; 2]) -> DMatrix<f64> {
    let (_, mut by, from) = matrices(models[0], q[0], hand);
    let (_, of, to) = matrices(models[1], q[1], handle);
    let lever = to - from;
    for mut column in by.column_iter_mut() {
        let angular = Vector3::new(column[3], column[4], column[5]);
        let shift = angular.cross(&lever);
        (0..3).for_each(|i| column[i] += shift[i]);
    }
    let mut all = DMatrix::zeros(6, by.ncols() + of.ncols());
    all.view_mut((0, 0), (6, by.ncols())).copy_from(&-&by);
    all.view_mut((0, by.ncols()), (6, of.ncols())).copy_from(&of);
    all
}

fn row<'t>(trace: &'t Trace, model: &Model, k: usize) -> (&'t [f64], &'t [f64]) {
    let (nq, nv) = (model.nq(), model.nv());
    (&trace.q[k * nq..(k + 1) * nq], &trace.v[k * nv..(k + 1) * nv])
}

/// Velocities of both systems, one after the other.
fn velocity(models: [&Model; 2], recording: &Recording, k: usize) -> DVector<f64> {
    let parts = [0, 1].map(|i| row(&recording.systems[i], models[i], k).1);
    DVector::from_vec(parts.concat())
}

#[test]
fn a_second_capture_closes_the_loop_by_gauss_principle() {
    let mut simulation = berthing();
    let recording = simulation.run(2.2).unwrap();
    let models = [0, 1].map(|i| &*simulation.systems[i].model);
    let [before, after] = rows_at(&recording.systems[0], 0.5);
    let q = [0, 1].map(|i| row(&recording.systems[i], models[i], before).0);
    let mut mass = DMatrix::zeros(models[0].nv() + 6, models[0].nv() + 6);
    mass.view_mut((0, 0), (models[0].nv(), models[0].nv())).copy_from(&matrices(models[0], q[0], "bus").0);
    mass.view_mut((models[0].nv(), models[0].nv()), (6, 6)).copy_from(&matrices(models[1], q[1], "module").0);
    let hands = [["left_hand", "left_handle"], ["right_hand", "right_handle"]];
    let gauss = |pairs: &[[&str; 2]], v: &DVector<f64>| {
        let rows: Vec<_> = pairs.iter().map(|pair| relative(models, q, *pair)).collect();
        let mut j = DMatrix::zeros(6 * rows.len(), v.len());
        rows.iter().enumerate().for_each(|(i, rows)| j.view_mut((6 * i, 0), (6, v.len())).copy_from(rows));
        let response = mass.clone().cholesky().unwrap().solve(&j.transpose());
        let impulse = (&j * &response).lu().solve(&-(&j * v)).unwrap();
        (v + response * &impulse, impulse)
    };
    let v = velocity(models, &recording, before);
    let (expected, impulse) = gauss(&hands, &v);
    let found = velocity(models, &recording, after);
    let error = (&found - &expected).amax() / expected.amax();
    assert!(error < 1e-12, "{error:.1e}");
    // the control: without the rows of the first capture the result differs
    let (without, _) = gauss(&hands[1..], &v);
    assert!((&found - without).amax() > 1e-3);
    let event = &recording.events[1];
    println!("{event:?}");
    assert!(event.passed() && event.name == "right");
    let recorded = DVector::from_column_slice(&event.impulse);
    assert!((recorded - impulse.rows(6, 6)).amax() < 1e-12 * impulse.amax());
    let lost = 0.5 * (v.dot(&(&mass * &v)) - found.dot(&(&mass * &found)));
    assert!((event.energy_lost - lost).abs() < 1e-12 * lost);
}

/// Position and attitude of the handle in the hand, from the recorded rows.
fn pose(
    models: [&Model; 2],
    recording: &Recording,
    k: usize,
    [hand, handle]: [&str; 2],
) -> (Vector3<f64>, Matrix3<f64>) {
    let poses = [hand, handle].into_iter().enumerate().map(|(i, frame)| {
        let (q, mut data) = (row(&recording.systems[i], models[i], k).0, Data::<f64>::new(models[i]));
        positions(models[i], &mut data, q);
        let pose = frame_pose(models[i], &data, q, models[i].frame(frame).unwrap());
        (pose.pos_w.to_nalgebra(), pose.rot_wf.to_nalgebra())
    });
    let [(p, r), (s, t)] = poses.collect::<Vec<_>>()[..] else { panic!("two poses") };
    (r.transpose() * (s - p), r.transpose() * t)
}

#[test]
fn both_hands_hold_the_module_and_momentum_is_kept() {
    let mut simulation = berthing();
    let recording = simulation.run(2.2).unwrap();
    let models = [0, 1].map(|i| &*simulation.systems[i].model);
    let time = &recording.systems[0].time;
    for (hands, from, to) in
        [(["left_hand", "left_handle"], 0.2, 1.5), (["right_hand", "right_handle"], 0.5, 2.0)]
    {
        let held = (0..time.len()).filter(|&k| time[k] > from + 1e-9 && time[k] < to - 1e-9);
        let poses: Vec<_> = held.map(|k| pose(models, &recording, k, hands)).collect();
        let drift = poses
            .iter()
            .map(|(p, r)| (p - poses[0].0).norm().max((r - poses[0].1).norm()))
            .fold(0.0, f64::max);
        assert!(poses.len() > 600 && drift < 1e-13, "{hands:?} {drift:.1e}");
    }
    assert_eq!(recording.events.len(), 4);
    assert!(recording.events.iter().all(|event| event.passed()), "{:?}", recording.events);
    let systems: Vec<_> = recording.systems.iter().zip(models).collect();
    let rows = world_rows(&systems);
    let scale = rows.momentum[..6].iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    for h in rows.momentum.chunks_exact(6) {
        let error =
            h.iter().zip(&rows.momentum).fold(0.0_f64, |most, (a, b)| most.max((a - b).abs())) / scale;
        assert!(error < 1e-12, "{error:.1e}");
    }
    for check in recording.groups[0].checks() {
        assert!(check.passed() && check.value < 1e-8, "{check:?}");
    }
    // the loop force is recorded while the loop is closed, and is zero before and after
    let [left, column] = &recording.systems[0].loops[..] else { panic!("either capture may close the loop") };
    assert_eq!([left, column].map(|column| &*column.name), ["left", "right"]);
    assert!(left.values.iter().all(|x| *x == 0.0), "the first capture joins the systems");
    for (row, t) in column.values.chunks_exact(11).zip(time) {
        let (force, opening) = (Vector3::from_column_slice(row), row[9].max(row[10]));
        assert!(opening < 1e-13, "{opening:.1e}");
        if *t < 0.5 - 1e-9 || *t > 1.5 + 1e-9 {
            assert_eq!(force.norm(), 0.0, "{t}");
        } else if *t > 0.5 + 1e-9 && *t < 1.5 - 1e-9 {
            assert!(force.norm() > 1e-4, "{t}");
        }
    }
}

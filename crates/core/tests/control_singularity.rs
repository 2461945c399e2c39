//! Checks computed torque with an unreachable target, and with joint friction.
#![allow(clippy::unwrap_used)] // a failed unwrap is a failed test

mod common;

use common::humanoid::{START, humanoid};
use nalgebra::Vector3;
use onorbit_core::control::{ComputedTorque, Control, Law};
use onorbit_core::dynamics::{Data, frame_pose, positions};
use onorbit_core::model::neutral;
use onorbit_core::reference::LineParabola;
use onorbit_core::simulation::{Recording, Simulation, Trace};
use std::sync::Arc;

/// Returns a reach of the humanoid by `displacement` in 10 s, then held for 10 s.
fn reach(displacement: [f64; 3], adjust: impl Fn(&mut ComputedTorque)) -> Result<Trace, String> {
    let model = humanoid();
    let mut q = neutral(&model);
    q[7..].copy_from_slice(&START);
    let tool = model.frame("tool").unwrap();
    let mut data = Data::<f64>::new(&model);
    positions(&model, &mut data, &q);
    let pose = frame_pose(&model, &data, &q, tool);
    let (rot, pos) = (pose.rot_wf.to_nalgebra(), pose.pos_w.to_nalgebra());
    let line = LineParabola::new(rot, pos, displacement.into(), Vector3::zeros(), 10.0).unwrap();
    let v = vec![0.0; model.nv()];
    let mut simulation = Simulation::new(Arc::new(model), q, v);
    let mut law = ComputedTorque::new(tool, 100.0, 20.0);
    adjust(&mut law);
    let law = Law::TaskComputedTorque(Box::new(law), line.into());
    simulation.systems[0].controls = vec![Control::on_all_joints(&simulation.systems[0].model, law)];
    simulation.systems[0].tool = Some(tool);
    simulation.run(20.0).map(Recording::only).map_err(|failure| failure.to_string())
}

#[test]
fn an_arm_with_an_unreachable_target_stretches_and_comes_to_rest() {
    for displacement in [[0.0, 0.0, 3.0], [-1.0, 0.0, 0.0], [3.0, 0.0, 0.0], [0.0, -3.0, 0.0]] {
        let trace = reach(displacement, |_| {}).unwrap();
        let torque = trace.tau.iter().fold(0.0_f64, |most, tau| most.max(tau.abs()));
        let rate = trace.v[trace.v.len() - 7..].iter().fold(0.0_f64, |most, v| most.max(v.abs()));
        // 100 1/s² times metres of error would command hundreds of N m without damping
        assert!(torque < 50.0 && rate < 0.1, "{displacement:?}: {torque} N m, {rate} rad/s");
        // negative control: without damping the run diverges
        assert!(reach(displacement, |law| law.damping = 0.0).is_err(), "{displacement:?}");
    }
}

#[test]
fn damping_does_not_affect_a_well_conditioned_reach() {
    let with = reach([0.2, 0.0, 0.0], |_| {}).unwrap();
    let without = reach([0.2, 0.0, 0.0], |law| law.damping = 0.0).unwrap();
    assert_eq!(with.q, without.q);
}

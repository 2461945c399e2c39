//! Checks a reaching motion of the humanoid torso against numbers from an independent engine.
#![allow(clippy::unwrap_used, clippy::print_stdout)] // set-up that fails should stop; --nocapture shows the numbers

mod common;

use common::humanoid::{humanoid, start};
use nalgebra::{Matrix3, Quaternion, UnitQuaternion, Vector3};
use onorbit_core::control::{ComputedTorque, Control, Law};
use onorbit_core::reference::LineParabola;
use onorbit_core::simulation::{Simulation, Trace, certify};
use std::sync::Arc;

/// The reach over `duration`, gains 100 and 20, without orbit, plain pseudo-inverse, no null-space term, RK4
/// at 1 ms, torque held over each step.
fn reach(duration: f64) -> Trace {
    let model = Arc::new(humanoid());
    let (q, v) = (start(&model), vec![0.0; model.nv()]);
    let tool = model.frame("tool").unwrap();
    let mut data = onorbit_core::dynamics::Data::new(&model);
    onorbit_core::dynamics::positions(&model, &mut data, &q);
    let pose = onorbit_core::dynamics::frame_pose(&model, &data, &q, tool);
    let from = Vector3::new(-0.12678, -0.22187, 0.55367);
    assert!((pose.pos_w.to_nalgebra() - from).norm() < 1e-5); // printed with five digits
    let line = LineParabola::new(
        pose.rot_wf.to_nalgebra(),
        pose.pos_w.to_nalgebra(),
        Vector3::x() * 0.5,
        Vector3::z() * 0.4,
        duration,
    );
    let mut simulation = Simulation::new(Arc::clone(&model), q, v);
    let law = ComputedTorque { damping: 0.0, ..ComputedTorque::new(tool, 100.0, 20.0) };
    let law = Law::TaskComputedTorque(Box::new(law), line.unwrap().into());
    simulation.systems[0].controls = vec![Control::on_all_joints(&simulation.systems[0].model, law)];
    simulation.systems[0].tool = Some(tool);
    let trace = simulation.run(duration).unwrap().only();
    let certificate = certify(&model, &trace);
    assert!(certificate.passed(), "{certificate:#?}");
    trace
}

fn peak_torques(trace: &Trace) -> Vec<f64> {
    (0..7).map(|j| trace.tau.iter().skip(j).step_by(7).fold(0.0_f64, |peak, x| peak.max(x.abs()))).collect()
}

fn largest(column: &[f64]) -> f64 {
    column.iter().fold(0.0, |m, x| x.abs().max(m))
}

fn assert_digits(name: &str, found: &[f64], printed: &[f64], half_digit: f64) {
    println!("{name}: asked {printed:?}, found {found:?}");
    for (found, printed) in found.iter().zip(printed) {
        assert!((found - printed).abs() <= half_digit, "{name}: asked {printed}, found {found}");
    }
}

/// Source: issue 2, part 11. Roll, pitch, yaw: `R = Rz(yaw) Ry(pitch) Rx(roll)`, degrees.
#[test]
fn ten_seconds_agree_with_an_independent_engine() {
    let trace = reach(10.0);
    let end = &trace.q[trace.q.len() - 14..];
    let attitude = UnitQuaternion::from_quaternion(Quaternion::new(end[6], end[3], end[4], end[5]));
    let r: Matrix3<f64> = attitude.to_rotation_matrix().into_inner();
    let roll_pitch_yaw = [
        r[(2, 1)].atan2(r[(2, 2)]).to_degrees(),
        (-r[(2, 0)]).asin().to_degrees(),
        r[(1, 0)].atan2(r[(0, 0)]).to_degrees(),
    ];
    assert_digits("roll, pitch, yaw, deg", &roll_pitch_yaw, &[0.6312, -4.0289, -10.2165], 0.6e-4);
    assert_digits("base position, m", &end[..3], &[-0.01768, -0.00886, 0.00788], 0.6e-5);
    let joints = [1.39262, -1.44492, -1.26576, -1.25090, -1.20085, 1.61279, -0.24949];
    assert_digits("joints, rad", &end[7..], &joints, 0.6e-5);
    let peaks = [0.03208, 0.03935, 0.01229, 0.01378, 0.00016, 0.00020, 0.00007];
    assert_digits("peak torques, N m", &peak_torques(&trace), &peaks, 0.6e-5);
}

#[test]
fn a_reach_in_two_seconds_needs_twenty_five_times_the_torque() {
    let trace = reach(2.0);
    assert_digits("peak torques, N m", &peak_torques(&trace)[..4], &[0.8014, 0.9838, 0.3073, 0.3446], 0.6e-4);
    // the published number is that of the largest component; the norm is 1.34e-5
    assert_digits("position error, m", &[largest(&trace.position_error)], &[1.2e-5], 0.6e-6);
    assert!(largest(&trace.attitude_error) < 1e-4); // 100 times the position error over the arm's length of one metre
}

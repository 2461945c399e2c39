use onorbit_core::{
    control::*, dynamics::*, environment::*, model::*, orbit::*, reference::*, simulation::*,
};
use std::{ops::ControlFlow, path::Path, sync::Arc};
fn main() {
    let model = urdf::from_file(Path::new("python/onorbit_rs/robots/humanoid_torso.urdf"), &[]).unwrap();
    let mut q = neutral(&model);
    q[7..].copy_from_slice(&[0.5342, -2.341, -2.0077, -2.2249, -2.2693, -0.1342, -0.1974]);
    let tool = model.frame("tool").unwrap();
    let mut data = Data::<f64>::new(&model);
    positions(&model, &mut data, &q);
    let p = frame_pose(&model, &data, &q, tool);
    let v = vec![0.0; model.nv()];
    let mut sim = Simulation::new(Arc::new(model), q, v);
    let mut law = ComputedTorque::new(tool, 100.0, 20.0);
    law.null_space_damping = 2.0;
    sim.control = ControlLaw::ComputedTorque(Box::new(law));
    sim.tool = Some(tool);
    sim.reference = Some(TaskReference::LineParabola(
        LineParabola::new(
            p.rot_wf.to_nalgebra(),
            p.pos_w.to_nalgebra(),
            [0.5, 0.0, 0.0].into(),
            [0.0, 0.0, 0.4].into(),
            2.0,
        )
        .unwrap(),
    ));
    sim.orbit = Some(Arc::new(
        Kepler::new(&Elements { inclination: 0.9, ..Elements::new(Size::SemiMajorAxis(6778e3), 5e-4) })
            .unwrap(),
    ));
    sim.effects = vec![Arc::new(GravityGradient)];
    let mut best = f64::MAX;
    for _ in 0..60 {
        let t = std::time::Instant::now();
        let trace = sim.run(6.0, &mut |_| ControlFlow::Continue(())).unwrap();
        best = best.min(t.elapsed().as_secs_f64() / 6000.0 * 1e6);
        std::hint::black_box(trace);
    }
    println!("{best:.2} us/step");
}

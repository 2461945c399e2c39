//! Negative controls of the conservation of angular momentum through contacts: the same forces as effects of
//! the environment, whose moments are integrated about the centres of mass of the single systems, or with the
//! two forces at different points.
#![allow(clippy::unwrap_used)]

mod common;

use common::touch::{body, contact, side};
use nalgebra::Vector3;
use onorbit_core::contact::{ContactLaw, NormalLaw};
use onorbit_core::environment::{BodyState, Effect, EnvironmentError, Scene, Wrench, Wrenches};
use onorbit_core::geometry::Shape;
use onorbit_core::simulation::{Recording, Simulation};
use onorbit_core::spatial::Vec3;
use onorbit_core::world::{Action, Event, FrameIndex, When};

const RADIUS: f64 = 0.1;
const STIFFNESS: f64 = 1e4;
/// Centre of the sphere in the axes of each body, m.
const OFFSET: [f64; 3] = [0.0, 0.3, 0.1];
/// Friction per sliding velocity, N s/m, of the control with two points.
const VISCOUS: f64 = 20.0;

/// Returns two bodies, with spheres beside their centres of mass, that collide.
fn bodies() -> Simulation {
    let mut systems =
        vec![body("a", 2.0, 0.05, [0.0; 3], 0.5), body("b", 3.0, 0.1, [2.2 * RADIUS, 0.05, 0.0], 0.0)];
    systems[1].v[3..].copy_from_slice(&[0.1, -0.2, 0.3]);
    let mut simulation = Simulation::of(systems);
    simulation.time_step = 1e-3;
    simulation
}

/// Returns the change of the angular momentum about the origin of W during a run, N m s.
fn change(recording: &Recording) -> f64 {
    let total = |k: usize| {
        let mut sum = Vector3::zeros();
        for trace in &recording.systems {
            let h = &trace.momentum[6 * k..6 * k + 6];
            let center = Vector3::from_column_slice(&trace.center_of_mass[3 * k..3 * k + 3]);
            sum += Vector3::new(h[3], h[4], h[5]) + center.cross(&Vector3::new(h[0], h[1], h[2]));
        }
        sum
    };
    let trace = &recording.systems[0];
    let last = trace.rows() - 1;
    assert!((trace.v[6 * last] - trace.v[0]).abs() > 0.1, "the bodies do not touch");
    (total(last) - total(0)).norm()
}

/// Spring between the two spheres as an effect of the environment.
#[derive(Debug)]
struct Spring {
    /// True if friction acts on each body at its own surface instead of at a common point.
    at_surfaces: bool,
}

impl Effect for Spring {
    fn name(&self) -> &str {
        "spring"
    }

    fn reads_velocities(&self) -> bool {
        true
    }

    fn add_wrenches(&self, scene: &Scene<'_>, out: &mut Wrenches) -> Result<(), EnvironmentError> {
        let bodies: Vec<_> = scene.bodies.iter().collect();
        let center = |body: &BodyState| body.origin + body.rot_wk * Vector3::from(OFFSET);
        let [(index_a, a), (index_b, b)] = [&bodies[0], &bodies[1]];
        let apart = center(b) - center(a);
        let (normal, depth) = (apart.normalize(), 2.0 * RADIUS - apart.norm());
        if depth <= 0.0 {
            return Ok(());
        }
        let middle = center(a) + normal * (RADIUS - 0.5 * depth);
        let velocity =
            |body: &BodyState| body.velocity + body.angular_velocity.cross(&(middle - body.origin));
        let relative = velocity(b) - velocity(a);
        let sliding = relative - normal * normal.dot(&relative);
        let friction = if self.at_surfaces { sliding * -VISCOUS } else { Vector3::zeros() };
        let force = normal * (STIFFNESS * depth) + friction;
        let shift = if self.at_surfaces { normal * (0.5 * depth) } else { Vector3::zeros() };
        for (index, body, force, point) in
            [(*index_a, a, -force, middle + shift), (*index_b, b, force, middle - shift)]
        {
            let com = body.origin + body.rot_wk * body.com;
            out.add(index, Wrench { force, torque: (point - com).cross(&force) })?;
        }
        Ok(())
    }
}

#[test]
fn angular_momentum_is_exact_only_about_a_common_centre_and_at_a_common_point() {
    let mut native = bodies();
    let normal = NormalLaw::HuntCrossley { stiffness: STIFFNESS, exponent: 1.0, dissipation: 0.0 };
    let mut sides = [0, 1].map(|system| side(system, 0, Shape::Sphere { radius: RADIUS }));
    sides.iter_mut().for_each(|side| side.pose.pos = Vec3::new(OFFSET[0], OFFSET[1], OFFSET[2]));
    native.contacts = vec![contact("spheres", sides, ContactLaw { normal, friction: None })];
    let exact = change(&native.run(0.5).unwrap());
    let lost = [false, true].map(|at_surfaces| {
        let mut simulation = bodies();
        // an event that never happens lets the effect act on both systems at once
        let [by, of] = [0, 1].map(|system| FrameIndex { system, frame: 0 });
        let (name, when) = ("grasp".to_owned(), When::OnCommand);
        simulation.events = vec![Event { name, when, action: Action::Capture { by, of, seat: None } }];
        simulation.effects = vec![std::sync::Arc::new(Spring { at_surfaces })];
        change(&simulation.run(0.5).unwrap())
    });
    assert!(exact < 1e-14, "{exact:e}");
    assert!(lost[0] > 1e3 * exact && lost[0] > 1e-11, "{:e}", lost[0]);
    assert!(lost[1] > 1e-4, "{:e}", lost[1]);
}

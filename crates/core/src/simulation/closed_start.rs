//! Initial state of a system with closed loops and mimic joints.

use super::error::SimulationError;
use crate::dynamics::{
    ClosedLoops, Data, close_loops, closure_errors, kinematics, project_configuration, project_velocity,
};
use crate::model::{BASE_NQ, BASE_NV, Constraint, Model};
use crate::world::System;

/// Largest initial opening of a loop or deviation of a mimic joint, m or rad, and largest rate of this error,
/// m/s or rad/s, that are corrected even if `project` is false for the loop or mimic joint.
const ACCEPTED: f64 = 1e-6;

impl System {
    /// Returns the initial configuration and velocity with all loops closed; see [`closed_start`]. The
    /// correction of the velocity does not change the rates of joints that are held by engaged brakes with an
    /// infinite slip torque.
    ///
    /// # Errors
    /// The same errors as [`closed_start`].
    pub(super) fn closed_start(&self) -> Result<[Vec<f64>; 2], SimulationError> {
        let mut held = vec![false; self.model.joint_count()];
        let rigid = self.brakes.iter().filter(|brake| brake.is_engaged && brake.slip_torque.is_infinite());
        rigid.for_each(|brake| held[brake.joint] = true);
        closed_start(&self.model, [self.q.clone(), self.v.clone()], &held)
    }
}

/// Returns a configuration and a velocity with all loops closed: those nearest to the given ones in the
/// metric of the kinetic energy. Mimic joints that start at zero follow their leaders. Joints for which
/// `held`, `(n,)`, is true may move while the loops are closed, but are locked while the remaining errors of
/// the configuration and those of the velocity are corrected.
///
/// # Errors
/// [`SimulationError::OpenLoop`] for a loop without `project` whose opening exceeds 1e-6 m or rad, or
/// changes faster than 1e-6 m/s or rad/s; [`SimulationError::OpenMimic`] for a mimic joint without `project`
/// whose position or rate differs by more than these limits from the value that its leader prescribes;
/// [`SimulationError::CannotClose`] for loops that cannot be closed together.
pub(crate) fn closed_start(
    model: &Model,
    [mut q, mut v]: [Vec<f64>; 2],
    held: &[bool],
) -> Result<[Vec<f64>; 2], SimulationError> {
    if model.closures().is_empty() {
        return Ok([q, v]);
    }
    follow_leaders(model, &mut q, &mut v);
    let (mut data, mut loops) = (Data::new(model), ClosedLoops::new(model, model.closures()));
    closure_errors(model, &mut data, &mut loops, &q);
    check_open(model, &loops, loops.errors(), ["m", "rad"])?;
    close_loops(model, &mut data, &mut loops, &mut q);
    loops.check_closed(model)?;
    kinematics(model, &mut data, &q, &v);
    let rates = loops.rates(&data, &v).to_vec();
    check_open(model, &loops, &rates, ["m/s", "rad/s"])?;
    let locked = held.contains(&true).then_some((held, &[][..]));
    project_configuration(model, &mut data, &mut loops, &mut q, locked);
    kinematics(model, &mut data, &q, &v);
    project_velocity(model, &mut data, &mut loops, (&q, &mut v), locked);
    Ok([q, v])
}

/// Replaces each zero position and each zero rate of a mimic joint by the value that its leader prescribes.
/// The function repeats this, so that the values reach the end of a chain of mimic joints.
fn follow_leaders(model: &Model, q: &mut [f64], v: &mut [f64]) {
    let [given_q, given_v] = [q.to_vec(), v.to_vec()];
    for _ in model.closures() {
        for closure in model.closures() {
            let Constraint::Mimic { joint, leader, ratio, offset } = closure.constraint else { continue };
            if given_q[BASE_NQ + joint] == 0.0 {
                q[BASE_NQ + joint] = ratio * q[BASE_NQ + leader] + offset;
            }
            if given_v[BASE_NV + joint] == 0.0 {
                v[BASE_NV + joint] = ratio * v[BASE_NV + leader];
            }
        }
    }
}

/// Checks that no loop or mimic joint without `project` has an error, or a rate of its error, above
/// [`ACCEPTED`]. `x` contains the errors of all scalar constraints, or the rates of these errors; `units`
/// contains the units of distances and of angles in `x`.
fn check_open(
    model: &Model,
    loops: &ClosedLoops<f64>,
    x: &[f64],
    units: [&str; 2],
) -> Result<(), SimulationError> {
    for (i, closure) in loops.closures().iter().enumerate().filter(|(_, closure)| !closure.project) {
        if loops.magnitudes(i, x).iter().any(|size| *size > ACCEPTED) {
            let (name, by) = (closure.name.clone(), loops.opening(model, i, x, units));
            let is_moving = units[0] != "m";
            return Err(match closure.constraint {
                Constraint::Frames { .. } => SimulationError::OpenLoop { name, by, is_moving },
                Constraint::Mimic { .. } => SimulationError::OpenMimic { joint: name, by, is_moving },
            });
        }
    }
    Ok(())
}

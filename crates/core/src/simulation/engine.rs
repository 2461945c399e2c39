//! Interface of external physics engines, which replace the native engine.

use super::error::SimulationError;
use crate::environment::BodyIndex;
use crate::model::Model;
use crate::spatial::{Mat3, Vec3};

/// External physics engine that computes the motion of the systems. Controllers, schedule, events, trace and
/// certificate work as with the native engine.
pub trait Engine: Send {
    /// Advances all systems by one step. Writes to `output` the state at the end of the step, the
    /// acceleration at its start, and the impulse and work during the step. The output must depend only on
    /// the input, so that a run can resume from a checkpoint.
    ///
    /// A step of zero length is a request for the acceleration only.
    ///
    /// # Errors
    /// Any error ends the run and is reported unchanged.
    fn step(&mut self, input: &StepInput<'_>, output: &mut StepOutput) -> Result<(), SimulationError>;

    /// Returns the names of the contacts whose forces the engine computes, in the order of
    /// [`StepOutput::contacts`]. The default is an empty list.
    fn contacts(&self) -> Vec<String> {
        Vec::new()
    }

    /// Returns the names of the closed loops and of the mimic joints whose constraints the engine satisfies,
    /// as `SYSTEM/NAME`, or `NAME` for a single system. The default is an empty list.
    fn loops(&self) -> Vec<String> {
        Vec::new()
    }

    /// Returns true if the engine holds the joints of engaged brakes; see [`StepInput::brakes`]. The default
    /// is false.
    fn supports_brakes(&self) -> bool {
        false
    }
}

/// Input of a step: interval, initial states, torques and connections. States and torques are those of all
/// systems, one system after another.
#[derive(Clone, Copy, Debug)]
pub struct StepInput<'a> {
    /// Start and end of the step, s.
    pub interval: (f64, f64),
    /// Configurations at the start of the step, `(nq,)` of each system, m and rad.
    pub q: &'a [f64],
    /// Velocities at the start of the step, `(nv,)` of each system, m/s and rad/s.
    pub v: &'a [f64],
    /// Joint torques, constant during the step, `(n,)` of each system, N m or N.
    pub tau: &'a [f64],
    /// Rigid connections that hold during the step.
    pub welds: &'a [BodyWeld],
    /// Brakes that are engaged during the step.
    pub brakes: &'a [EngagedBrake],
}

/// Engaged brake of a joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EngagedBrake {
    /// Index of the system in the world.
    pub system: usize,
    /// Index of the joint among those of the system.
    pub joint: usize,
    /// Largest torque that the brake can hold, N m (N for a prismatic joint); may be infinite.
    pub slip_torque: f64,
}

/// Rigid connection of two bodies of different systems. Points and rotation are in the axes of the links, as
/// the models declare them.
#[derive(Clone, Debug, PartialEq)]
pub struct BodyWeld {
    /// The two bodies, beginning with the body of the capturing frame.
    pub bodies: [BodyIndex; 2],
    /// Origin of the captured frame relative to the origin of each body's link, in axes of that link, m.
    pub points: [Vec3<f64>; 2],
    /// Rotation from axes of the second body's link to axes of the first body's link.
    pub rotation: Mat3<f64>,
}

/// Output of a step: states at its end, accelerations at its start, and impulses and work during the step.
#[derive(Clone, Debug)]
pub struct StepOutput {
    /// Configurations at the end of the step, `(nq,)` of each system, m and rad.
    pub q: Vec<f64>,
    /// Velocities at the end of the step, `(nv,)` of each system, m/s and rad/s.
    pub v: Vec<f64>,
    /// Accelerations at the start of the step, `(nv,)` of each system, m/s² and rad/s².
    pub acceleration: Vec<f64>,
    /// Impulse and work that each system receives during the step, in the order of the systems.
    pub systems: Vec<Exchange>,
    /// Time integral over the step of the moments of the external forces about the common centre of mass,
    /// with each force acting at the centre of mass of its system, W axes, N m s; zero for a single system.
    pub orbital: [f64; 3],
    /// Force, impulse and work of each contact that the engine computes, in the order of
    /// [`Engine::contacts`].
    pub contacts: Vec<ContactOutput>,
}

/// Force of a contact at the start of a step, and its impulse and work during the step.
#[derive(Clone, Copy, Debug, Default)]
pub struct ContactOutput {
    /// Force on the second side at the start of the step, W axes, N.
    pub force: [f64; 3],
    /// Power that the contact removes from the motion at the start of the step, W.
    pub power: f64,
    /// Time integrals over the step of the force and of its moment about the origin of W, on the second side,
    /// N s and N m s.
    pub impulse: [f64; 6],
    /// Energy that the contact removes from the motion during the step, J.
    pub work: f64,
}

/// Impulse and work that a system receives during a step.
#[derive(Clone, Copy, Debug, Default)]
pub struct Exchange {
    /// Time integral over the step of the external forces and of their moments about the centre of mass of
    /// the system, W axes, N s and N m s.
    pub impulse: [f64; 6],
    /// Work done by motors, springs and external wrenches during the step, less the energy that the joints
    /// dissipate, J.
    pub work: f64,
    /// Energy that the joints dissipate during the step, J.
    pub dissipated: f64,
    /// Impulse that connections and contacts with other systems exert on the system, N s and N m s;
    /// components as in `impulse`.
    pub weld_impulse: [f64; 6],
    /// Work that connections and contacts do on the system during the step, J.
    pub weld_work: f64,
}

impl StepOutput {
    pub(super) fn new(models: &[&Model], contacts: usize) -> Self {
        let sum = |size: fn(&Model) -> usize| models.iter().map(|model| size(model)).sum();
        let (q, v) = (vec![0.0; sum(Model::nq)], vec![0.0; sum(Model::nv)]);
        let systems = vec![Exchange::default(); models.len()];
        let contacts = vec![ContactOutput::default(); contacts];
        Self { q, acceleration: v.clone(), v, systems, orbital: [0.0; 3], contacts }
    }

    pub(super) fn is_finite(&self) -> bool {
        let finite = |x: &[f64]| x.iter().all(|x| x.is_finite());
        [&self.q, &self.v, &self.acceleration].iter().all(|x| finite(x))
            && finite(&self.orbital)
            && self
                .contacts
                .iter()
                .all(|one| finite(&one.force) && finite(&one.impulse) && finite(&[one.power, one.work]))
            && self.systems.iter().all(|done| {
                finite(&done.impulse)
                    && finite(&done.weld_impulse)
                    && finite(&[done.work, done.dissipated, done.weld_work])
            })
    }
}

//! Integrators that a run can use, and their settings.

/// Integration method of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Integrator {
    /// Classical fourth-order Runge-Kutta method with the attitude integrated on SO(3)
    /// (Runge-Kutta-Munthe-Kaas).
    #[default]
    Rk4,
    /// Semi-implicit Euler method, of first order: updates the velocities, then the positions with the new
    /// velocities.
    SemiImplicitEuler,
    /// Embedded pair 5(4) of Dormand and Prince with the attitude integrated on SO(3). The tolerance
    /// determines the length of each step. Rows within a step are computed by dense output of fourth order.
    DormandPrince,
}

/// Settings of an integrator.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StepSettings {
    pub(crate) integrator: Integrator,
    /// Largest permitted error of a step of the adaptive integrator, relative to the scales of the motion.
    pub(crate) tolerance: f64,
    /// Length of a regular step, s.
    pub(crate) time_step: f64,
    /// Time between two updates of the controllers, s; zero without controllers.
    pub(crate) control_period: f64,
    /// Planned duration of the run, or, for an open-ended run, the longest interval between two instants at
    /// which a step must end, s.
    pub(crate) duration: f64,
}

//! Choice of the integrator.

/// Integration method of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Integrator {
    /// Classical fourth-order Runge-Kutta, the attitude on its group (Runge-Kutta-Munthe-Kaas).
    #[default]
    Rk4,
    /// Semi-implicit Euler, first order: velocities first, then positions with the new ones.
    SemiImplicitEuler,
    /// Dormand and Prince's embedded pair 5(4), the attitude on its group. The tolerance determines the length of
    /// each step; rows within a step come from dense output of fourth order.
    DormandPrince,
}

/// Settings of an integrator.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StepSettings {
    pub(crate) integrator: Integrator,
    /// Error tolerance of the adaptive integrator.
    pub(crate) tolerance: f64,
    /// Regular step, s.
    pub(crate) time_step: f64,
    /// Duration of the run, s.
    pub(crate) duration: f64,
}

//! Compliant normal forces.

use super::error::{ContactError, at_least, positive};

/// Law of the normal force, N, as a function of the depth `x`, m, and its rate `ẋ`, m/s, which is positive
/// while the bodies approach each other. Bodies that can separate exert no force where the law gives a
/// negative value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NormalLaw {
    /// Law of Hunt and Crossley, `F = k xⁿ (1 + d ẋ)`.
    ///
    /// Source: Hunt and Crossley, Coefficient of Restitution Interpreted as Damping in Vibroimpact, Journal
    /// of Applied Mechanics 42, 1975.
    HuntCrossley {
        /// Stiffness `k`, N/mⁿ.
        stiffness: f64,
        /// Exponent `n`: 1.5 for spheres (Hertz), 1 for a linear spring.
        exponent: f64,
        /// Dissipation `d`, s/m.
        dissipation: f64,
    },
    /// Linear spring and damper, `F = k x + c ẋ`. In contrast to the law of Hunt and Crossley, the force
    /// is discontinuous at touch-down.
    SpringDashpot {
        /// Stiffness `k`, N/m.
        stiffness: f64,
        /// Damping `c`, N s/m.
        damping: f64,
    },
}

impl NormalLaw {
    /// Returns the value of the law, N, at the depth `x`, m, and the rate `rate`, m/s. Bodies that can
    /// separate exert no force where the value is negative.
    #[inline]
    pub fn force(&self, x: f64, rate: f64) -> f64 {
        match *self {
            // F = k xⁿ (1 + d ẋ)
            Self::HuntCrossley { dissipation, .. } => self.elastic_force(x) * (1.0 + dissipation * rate),
            // F = k x + c ẋ
            Self::SpringDashpot { damping, .. } => self.elastic_force(x) + damping * rate,
        }
    }

    /// Returns a number that has the sign of [`NormalLaw::force`] at the depth `x > 0`, m, and the rate
    /// `rate`, m/s. It is zero where the force changes from compression to tension.
    #[inline]
    pub fn pressing(&self, x: f64, rate: f64) -> f64 {
        match *self {
            Self::HuntCrossley { dissipation, .. } => 1.0 + dissipation * rate,
            Self::SpringDashpot { .. } => self.force(x, rate),
        }
    }

    /// Returns the elastic part of the force, `k xⁿ`, N. At negative depths, a linear law gives a negative
    /// force, so that the force is smooth where the bodies separate; for other exponents the force is 0.
    #[inline]
    pub fn elastic_force(&self, x: f64) -> f64 {
        let (stiffness, exponent) = (self.stiffness(), self.exponent());
        if exponent == 1.0 {
            stiffness * x
        } else if exponent == 1.5 {
            stiffness * x.max(0.0) * x.max(0.0).sqrt()
        } else {
            stiffness * x.max(0.0).powf(exponent)
        }
    }

    /// Returns the elastic energy, J, stored at the depth `x`, m; 0 at negative depths.
    pub fn elastic_energy(&self, x: f64) -> f64 {
        // U = k xⁿ⁺¹/(n + 1)
        if x > 0.0 { self.elastic_force(x) * x / (self.exponent() + 1.0) } else { 0.0 }
    }

    /// Returns the derivative of the elastic force at the depth `x`, m: `n k xⁿ⁻¹`, N/m. At negative depths
    /// it is 0, or `k` if the law is linear.
    pub fn tangent_stiffness(&self, x: f64) -> f64 {
        if self.exponent() == 1.0 {
            return self.stiffness();
        }
        self.exponent() * self.stiffness() * x.max(0.0).powf(self.exponent() - 1.0)
    }

    /// Returns the derivative of the force with respect to the rate of the depth, N s/m, at the depth `x`, m.
    pub fn tangent_damping(&self, x: f64) -> f64 {
        match *self {
            Self::HuntCrossley { dissipation, .. } => self.elastic_force(x).max(0.0) * dissipation,
            Self::SpringDashpot { damping, .. } => damping,
        }
    }

    /// Returns the tangential stiffness `σ`, N/m, of elastic bodies with Poisson's ratio 0.3: 0.82 times the
    /// tangent stiffness of the normal force, which is evaluated at a depth of 0.1 mm if it varies.
    ///
    /// Source: Mindlin, Compliance of Elastic Bodies in Contact, Journal of Applied Mechanics 16, 1949:
    /// `k_t/k_n = 2 (1 − ν)/(2 − ν)`.
    pub fn tangential_stiffness(&self) -> f64 {
        0.82 * self.tangent_stiffness(1e-4)
    }

    /// Returns the stiffness `k`, N/mⁿ.
    pub fn stiffness(&self) -> f64 {
        match *self {
            Self::HuntCrossley { stiffness, .. } | Self::SpringDashpot { stiffness, .. } => stiffness,
        }
    }

    /// Returns the exponent `n` of the elastic force.
    pub fn exponent(&self) -> f64 {
        match *self {
            Self::HuntCrossley { exponent, .. } => exponent,
            Self::SpringDashpot { .. } => 1.0,
        }
    }

    /// Returns the depth `x_max`, m, at which two bodies come to rest if no energy is dissipated:
    /// `½ m ẋ² + U(x) = U(x_max)`, with the elastic energy `U`. `mass` is their effective mass `m`, kg, `x`
    /// their present depth, m, and `rate` the speed `ẋ` of their approach, m/s.
    pub fn largest_depth(&self, mass: f64, x: f64, rate: f64) -> f64 {
        let energy = 0.5 * mass * rate * rate + self.elastic_energy(x);
        let n = self.exponent();
        ((n + 1.0) * energy / self.stiffness()).powf(1.0 / (n + 1.0))
    }

    /// Checks the parameters.
    ///
    /// # Errors
    /// [`ContactError::Parameter`] for a stiffness that is not positive, an exponent below 1, negative
    /// dissipation or damping, or a parameter that is not finite.
    pub fn check(&self) -> Result<(), ContactError> {
        match *self {
            Self::HuntCrossley { stiffness, exponent, dissipation } => {
                positive("stiffness", stiffness, "N/m^n")?;
                at_least("exponent", exponent, 1.0, "")?;
                at_least("dissipation", dissipation, 0.0, "s/m")
            }
            Self::SpringDashpot { stiffness, damping } => {
                positive("stiffness", stiffness, "N/m")?;
                at_least("damping", damping, 0.0, "N s/m")
            }
        }
    }
}

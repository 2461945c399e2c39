//! Inertial axes.

/// Inertial axes in which an orbit is given.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Axes {
    /// Geocentric celestial reference frame; for other planets any axes that do not rotate.
    #[default]
    Gcrf,
    /// True equator, mean equinox of date (TEME), used by SGP4; rotated from GCRF by 0.3° in 2024, and further every
    /// year.
    Teme,
}

impl Axes {
    /// Returns `GCRF` or `TEME`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Gcrf => "GCRF",
            Self::Teme => "TEME",
        }
    }
}

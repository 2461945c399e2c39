//! Inertial axes.

/// Inertial axes in which an orbit is given.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Axes {
    /// Geocentric celestial reference frame; for planets other than the Earth, any axes that do not rotate.
    #[default]
    Gcrf,
    /// True equator, mean equinox of date (TEME), the axes of SGP4. In 2024 they are rotated from GCRF by
    /// 0.3°, an angle that grows every year.
    Teme,
}

impl Axes {
    /// Returns the name of the axes, `GCRF` or `TEME`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Gcrf => "GCRF",
            Self::Teme => "TEME",
        }
    }
}

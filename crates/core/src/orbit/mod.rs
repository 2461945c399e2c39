//! Reference orbits.

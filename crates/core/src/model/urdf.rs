//! URDF files.

//! Layout of configurations and velocities:
//! `q = [p(3), quat_xyzw(4), joints]`, `v = [v_body(3), w_body(3), joint rates]`.
//!
//! Joint `j` has the position `q[BASE_NQ + j]` and the rate `v[BASE_NV + j]`.

use std::ops::Range;

/// Number of coordinates of the base in `q`: its position and its quaternion.
pub const BASE_NQ: usize = 7;

/// Number of velocity components of the base in `v`: linear, then angular.
pub const BASE_NV: usize = 6;

/// Indices of the base quaternion (x, y, z, w) in `q`.
pub const QUATERNION: Range<usize> = 3..7;

/// Indices of the angular velocity of the base in `v`.
pub const ANGULAR: Range<usize> = 3..6;

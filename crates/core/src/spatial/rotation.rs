//! Rotations: unit quaternions, exponential, logarithm and the differential of the exponential.

use super::mat3::Mat3;
use super::scalar::Real;
use super::vec3::Vec3;
use serde::{Deserialize, Serialize};

/// Unit quaternion, stored in the order x, y, z, w.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Quat<S> {
    /// Vector part.
    pub v: Vec3<S>,
    /// Scalar part.
    pub w: S,
}

impl<S: Real> Quat<S> {
    /// Creates the quaternion from a slice `[x, y, z, w]`.
    #[inline(always)]
    pub fn from_xyzw(s: &[S]) -> Self {
        Self { v: Vec3::from_slice(s), w: s[3] }
    }

    /// Writes the components to `out` in the order `[x, y, z, w]`.
    #[inline(always)]
    pub fn write_xyzw(self, out: &mut [S]) {
        self.v.write(out);
        out[3] = self.w;
    }

    /// Returns the Hamilton product, which rotates by `o` first and by `self` second.
    #[inline(always)]
    #[must_use]
    pub fn product(self, o: Self) -> Self {
        Self {
            v: self.v.scale_add(o.w, o.v.scale_add(self.w, self.v.cross(o.v))),
            w: self.w.mul_add(o.w, -self.v.dot(o.v)),
        }
    }

    /// Returns the conjugate, which is the inverse rotation.
    #[inline(always)]
    #[must_use]
    pub fn conjugate(self) -> Self {
        Self { v: -self.v, w: self.w }
    }

    /// Returns the quaternion scaled to unit length.
    #[inline(always)]
    #[must_use]
    pub fn normalized(self) -> Self {
        let s = S::of(1.0) / (self.v.dot(self.v) + self.w * self.w).sqrt();
        Self { v: self.v * s, w: self.w * s }
    }

    /// Returns a quaternion whose norm differs from one only by rounding, scaled to unit length by one Newton
    /// step for `1/|q|`.
    #[inline(always)]
    #[must_use]
    pub fn renormalized(self) -> Self {
        let squared = self.v.dot(self.v) + self.w * self.w;
        let s = squared.mul_add(S::of(-0.5), S::of(1.5));
        Self { v: self.v * s, w: self.w * s }
    }

    /// Returns the quaternion of a rotation matrix; of its two signs, either may be returned.
    ///
    /// The component of largest magnitude is computed first, which avoids cancellation.
    ///
    /// Source: Shepperd, J. Guidance and Control 1(3), 1978.
    #[inline(always)]
    pub fn from_matrix(r: &Mat3<S>) -> Self {
        let one = S::of(1.0);
        let (xx, yy, zz) = (r.x.x, r.y.y, r.z.z);
        let squares = [one + xx + yy + zz, one + xx - yy - zz, one - xx + yy - zz, one - xx - yy + zz]; // 4 w², …
        let (wx, wy, wz) = (r.y.z - r.z.y, r.z.x - r.x.z, r.x.y - r.y.x); // 4 w x, …
        let (xy, xz, yz) = (r.y.x + r.x.y, r.z.x + r.x.z, r.z.y + r.y.z); // 4 x y, …
        let mut best = squares[0];
        let mut q = Self { v: Vec3::new(wx, wy, wz), w: best };
        let others = [
            (squares[1], Self { v: Vec3::new(squares[1], xy, xz), w: wx }),
            (squares[2], Self { v: Vec3::new(xy, squares[2], yz), w: wy }),
            (squares[3], Self { v: Vec3::new(xz, yz, squares[3]), w: wz }),
        ];
        for (square, other) in others {
            let is_larger = S::less(best, square);
            let pick = |a, b| S::select(is_larger, a, b);
            q = Self {
                v: Vec3::new(pick(other.v.x, q.v.x), pick(other.v.y, q.v.y), pick(other.v.z, q.v.z)),
                w: pick(other.w, q.w),
            };
            best = pick(square, best);
        }
        q.normalized()
    }

    /// Returns the rotation matrix.
    #[inline(always)]
    pub fn matrix(self) -> Mat3<S> {
        let (v, w, one) = (self.v, self.w, S::of(1.0));
        let d = v + v;
        let (xx, yy, zz) = (v.x * d.x, v.y * d.y, v.z * d.z);
        let (xy, xz, yz) = (v.x * d.y, v.x * d.z, v.y * d.z);
        let (wx, wy, wz) = (w * d.x, w * d.y, w * d.z);
        Mat3::from_columns(
            Vec3::new(one - (yy + zz), xy + wz, xz - wy),
            Vec3::new(xy - wz, one - (xx + zz), yz + wx),
            Vec3::new(xz + wy, yz - wx, one - (xx + yy)),
        )
    }
}

/// Returns `exp(θ)` as a unit quaternion: the rotation by the angle `|θ|`, rad, about `θ`.
#[inline(always)]
pub fn exp_so3<S: Real>(theta: Vec3<S>) -> Quat<S> {
    // q = (sin(φ/2)/φ θ, cos(φ/2)); below 0.25 rad, which covers every step of a simulation, use the series
    // in z = (φ/2)², exact to 3e-17
    let of = S::of;
    let z = theta.dot(theta) * of(0.25);
    let s = z.mul_add(
        z.mul_add(
            z.mul_add(z.mul_add(of(1.0 / 362_880.0), of(-1.0 / 5_040.0)), of(1.0 / 120.0)),
            of(-1.0 / 6.0),
        ),
        of(1.0),
    );
    let c = z.mul_add(
        z.mul_add(
            z.mul_add(
                z.mul_add(z.mul_add(of(-1.0 / 3_628_800.0), of(1.0 / 40_320.0)), of(-1.0 / 720.0)),
                of(1.0 / 24.0),
            ),
            of(-0.5),
        ),
        of(1.0),
    );
    let (mut s, mut c) = (s * of(0.5), c);
    let is_large = S::less(of(1.0 / 64.0), z);
    if S::any(is_large) {
        let half = S::select(is_large, z, of(1.0)).sqrt();
        let (sin, cos) = half.sin_cos();
        (s, c) = (S::select(is_large, sin / (half + half), s), S::select(is_large, cos, c));
    }
    Quat { v: theta * s, w: c }
}

/// Returns `log(q)`: the rotation vector, rad, with an angle of at most π.
#[inline(always)]
pub fn log_so3<S: Real>(q: Quat<S>) -> Vec3<S> {
    // θ = 2 atan2(|v|, w) v/|v|, with the sign of q chosen such that w ≥ 0
    let of = S::of;
    let sign = S::select(S::less(q.w, of(0.0)), of(-1.0), of(1.0));
    let (v, w) = (q.v * sign, q.w * sign);
    let squared = v.dot(v);
    let is_large = S::less(of(1e-4), squared);
    // series of atan(x)/x with x = |v|/w below 0.01, where the omitted term x¹⁰/11 is below rounding
    let inverse_w = of(1.0) / S::select(is_large, of(1.0), w);
    let y = squared * inverse_w * inverse_w;
    let series = y.mul_add(
        y.mul_add(y.mul_add(y.mul_add(of(1.0 / 9.0), of(-1.0 / 7.0)), of(0.2)), of(-1.0 / 3.0)),
        of(1.0),
    );
    let mut scale = of(2.0) * series * inverse_w;
    if S::any(is_large) {
        let length = S::select(is_large, squared, of(1.0)).sqrt();
        scale = S::select(is_large, of(2.0) * length.atan2(w) / length, scale);
    }
    v * scale
}

/// Returns `log(R)`: the rotation vector, rad, with an angle of at most π. It is accurate up to half a turn.
#[inline(always)]
pub fn log_rotation<S: Real>(r: &Mat3<S>) -> Vec3<S> {
    log_so3(Quat::from_matrix(r))
}

/// Returns the time derivative, rad/s, of the rotation vector `θ`, rad, in `R = R₀ exp(θ)` for the angular
/// velocity `ω`, rad/s in body axes: `θ̇ = ω + ½ θ×ω + b θ×(θ×ω)`.
///
/// `b = 1/12 + |θ|²/720` truncates the series of the inverse differential of the exponential. The error is of
/// sixth order in `θ`, below the error of the integrators, for which `θ` is the rotation of one step. Because
/// `ω` is in body axes, the result is `dexp⁻¹` of `−θ` in the convention of Hairer, Lubich and Wanner
/// (section III.4.1).
///
/// Source: Munthe-Kaas, BIT 38, 1998.
#[inline(always)]
pub fn dexp_inv<S: Real>(theta: Vec3<S>, omega: Vec3<S>) -> Vec3<S> {
    let b = theta.dot(theta).mul_add(S::of(1.0 / 720.0), S::of(1.0 / 12.0));
    let first = theta.cross(omega);
    theta.cross(first).scale_add(b, first.scale_add(S::of(0.5), omega))
}

/// Computes [`dexp_inv`] in closed form, for rotations of less than one turn: `b = (1 − φ/2 cot φ/2)/φ²` with
/// `φ = |θ|`.
#[inline(always)]
pub fn dexp_inv_exact<S: Real>(theta: Vec3<S>, omega: Vec3<S>) -> Vec3<S> {
    let squared = theta.dot(theta);
    let is_small = S::less(squared, S::of(1e-2));
    let angle = S::select(is_small, S::of(1.0), squared).sqrt();
    let half = angle * S::of(0.5);
    let (s, c) = half.sin_cos();
    let closed = (S::of(1.0) - half * c / s) / (angle * angle);
    // 1/12 + φ²/720 + φ⁴/30240 + φ⁶/1209600: exact to 1e-16 below 0.1 rad, where the closed form loses digits
    let tail = squared.mul_add(S::of(1.0 / 1_209_600.0), S::of(1.0 / 30_240.0));
    let series = squared.mul_add(squared.mul_add(tail, S::of(1.0 / 720.0)), S::of(1.0 / 12.0));
    let first = theta.cross(omega);
    theta.cross(first).scale_add(S::select(is_small, series, closed), first.scale_add(S::of(0.5), omega))
}

//! Double-double arithmetic, for constants that are computed once per orbit.
//!
//! If the period had only the accuracy of `f64`, its rounding error would shift the orbit by 1e-7 m along
//! track per day.
//!
//! Source: Dekker, Numerische Mathematik 18, 1971; Hida, Li and Bailey, ARITH-15, 2001.

use nalgebra::Vector3;

/// Double-double number: the sum `hi + lo` of two numbers with `|lo| ≤ ulp(hi)/2`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Double {
    pub(super) hi: f64,
    pub(super) lo: f64,
}

/// `2π` as a double-double number, to 32 digits.
pub(super) const TAU: Double = Double { hi: std::f64::consts::TAU, lo: 2.449_293_598_294_706_4e-16 };

impl From<f64> for Double {
    fn from(hi: f64) -> Self {
        Self { hi, lo: 0.0 }
    }
}

impl Double {
    /// Returns `a + b` exactly, for `|a| ≥ |b|`.
    fn quick(a: f64, b: f64) -> Self {
        let hi = a + b;
        Self { hi, lo: b - (hi - a) }
    }

    /// Returns `a + b` exactly.
    fn sum(a: f64, b: f64) -> Self {
        let hi = a + b;
        let bb = hi - a;
        Self { hi, lo: (a - (hi - bb)) + (b - bb) }
    }

    /// Returns `a b` exactly.
    fn product(a: f64, b: f64) -> Self {
        let hi = a * b;
        Self { hi, lo: a.mul_add(b, -hi) }
    }

    pub(super) fn dot(a: &Vector3<f64>, b: &Vector3<f64>) -> Self {
        Self::product(a.x, b.x) + Self::product(a.y, b.y) + Self::product(a.z, b.z)
    }

    pub(super) fn sqrt(self) -> Self {
        let root = self.hi.sqrt();
        if root == 0.0 {
            return Self::from(0.0);
        }
        // √x = s + (x - s²)/(2 s)
        let rest = self - Self::product(root, root);
        Self::quick(root, rest.hi / (2.0 * root))
    }
}

impl std::ops::Add for Double {
    type Output = Self;
    fn add(self, b: Self) -> Self {
        let (s, t) = (Self::sum(self.hi, b.hi), Self::sum(self.lo, b.lo));
        let u = Self::quick(s.hi, s.lo + t.hi);
        Self::quick(u.hi, u.lo + t.lo)
    }
}

impl std::ops::Neg for Double {
    type Output = Self;
    fn neg(self) -> Self {
        Self { hi: -self.hi, lo: -self.lo }
    }
}

impl std::ops::Sub for Double {
    type Output = Self;
    fn sub(self, b: Self) -> Self {
        self + (-b)
    }
}

impl std::ops::Mul for Double {
    type Output = Self;
    fn mul(self, b: Self) -> Self {
        let p = Self::product(self.hi, b.hi);
        Self::quick(p.hi, p.lo + (self.hi * b.lo + self.lo * b.hi))
    }
}

impl std::ops::Div for Double {
    type Output = Self;
    fn div(self, b: Self) -> Self {
        let q1 = self.hi / b.hi;
        let rest = self - b * Self::from(q1);
        let q2 = rest.hi / b.hi;
        let rest = rest - b * Self::from(q2);
        Self::quick(q1, q2) + Self::from(rest.hi / b.hi)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thirds_and_roots_keep_thirty_digits() {
        let three = Double::from(3.0);
        let back = Double::from(1.0) / three * three - Double::from(1.0);
        assert!(back.hi.abs() < 1e-31, "{back:?}");
        let back = three.sqrt() * three.sqrt() - three;
        assert!(back.hi.abs() < 1e-30, "{back:?}");
    }
}

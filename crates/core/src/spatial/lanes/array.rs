//! Lanes as arrays, which the compiler may keep in vector registers.

/// Array of `N` lanes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Array<const N: usize>([f64; N]);

pub(super) type F64x4 = Array<4>;
pub(super) type F64x8 = Array<8>;
pub(super) type Mask4 = [bool; 4];
pub(super) type Mask8 = [bool; 8];

impl<const N: usize> Array<N> {
    #[inline(always)]
    pub(super) fn from_array(x: [f64; N]) -> Self {
        Self(x)
    }
    #[inline(always)]
    pub(super) fn to_array(self) -> [f64; N] {
        self.0
    }
    #[inline(always)]
    fn each(f: impl Fn(usize) -> f64) -> Self {
        Self(std::array::from_fn(f))
    }
    #[inline(always)]
    pub(super) fn add(self, b: Self) -> Self {
        Self::each(|i| self.0[i] + b.0[i])
    }
    #[inline(always)]
    pub(super) fn sub(self, b: Self) -> Self {
        Self::each(|i| self.0[i] - b.0[i])
    }
    #[inline(always)]
    pub(super) fn mul(self, b: Self) -> Self {
        Self::each(|i| self.0[i] * b.0[i])
    }
    #[inline(always)]
    pub(super) fn div(self, b: Self) -> Self {
        Self::each(|i| self.0[i] / b.0[i])
    }
    #[inline(always)]
    pub(super) fn mul_add(self, b: Self, c: Self) -> Self {
        Self::each(|i| f64::mul_add(self.0[i], b.0[i], c.0[i]))
    }
    #[inline(always)]
    pub(super) fn sqrt(self) -> Self {
        Self::each(|i| self.0[i].sqrt())
    }
    #[inline(always)]
    pub(super) fn abs(self) -> Self {
        Self::each(|i| self.0[i].abs())
    }
    #[inline(always)]
    pub(super) fn less(self, b: Self) -> [bool; N] {
        std::array::from_fn(|i| self.0[i] < b.0[i])
    }
    #[inline(always)]
    pub(super) fn select(held: [bool; N], a: Self, b: Self) -> Self {
        Self::each(|i| if held[i] { a.0[i] } else { b.0[i] })
    }
    #[inline(always)]
    pub(super) fn any(held: [bool; N]) -> bool {
        held.contains(&true)
    }
    #[inline(always)]
    pub(super) fn all(held: [bool; N]) -> bool {
        !held.contains(&false)
    }
    /// Returns the transpose: element `j` of array `i` becomes element `i` of array `j`.
    #[inline(always)]
    pub(super) fn transpose(rows: [Self; N]) -> [Self; N] {
        std::array::from_fn(|j| Self::each(|i| rows[i].0[j]))
    }
}

//! Secular perturbations of the mean elements by zonal harmonics and drag.
//!
//! Source: Spacetrack Report #3, section 6, with its symbols. Sums and products are evaluated in the order of
//! the reference code, because after thousands of revolutions the last digit of a rate amounts to
//! centimetres.

use super::constants::{Earth, Mean};
use super::elements::MeanElements;
use crate::spatial::Real;

/// Perigee height, km, below which the higher-order drag terms are omitted.
const FINE_PERIGEE: f64 = 220.0;
/// Eccentricity up to which `C₃` and the periodic drag term of the mean anomaly are set to zero.
const NEARLY_CIRCULAR: f64 = 1e-4;

/// Mean elements at the epoch, their secular rates, and the coefficients of drag in the report's symbols.
#[derive(Clone, Debug)]
pub(super) struct NearEarth {
    pub(super) epoch: Mean,
    /// Rate `Ṁ` of the mean anomaly, rad/min.
    pub(super) anomaly_rate: f64,
    /// Rate `ω̇` of the argument of perigee, rad/min.
    pub(super) perigee_rate: f64,
    /// Rate `Ω̇` of the node, rad/min.
    pub(super) node_rate: f64,
    node_drag: f64,
    b_star: f64,
    c1: f64,
    c4: f64,
    fine: Option<Fine>,
}

/// Higher-order and periodic drag terms, which are omitted for low perigees and in deep space.
#[derive(Clone, Debug)]
struct Fine {
    eta: f64,
    c5: f64,
    d: [f64; 3],
    t: [f64; 3],
    perigee: f64,
    anomaly: f64,
    /// `(1 + η cos M₀)³` with the mean anomaly `M₀` at the epoch.
    cube0: f64,
    /// `sin M₀` with the mean anomaly `M₀` at the epoch.
    sin0: f64,
}

/// Mean elements with secular perturbations at one instant, and drag terms that are applied later.
pub(super) struct SecularElements<S = f64> {
    pub(super) mean: Mean<S>,
    /// Factor by which drag changes `√a`.
    pub(super) axis_factor: S,
    /// Decrease of the eccentricity by drag.
    pub(super) eccentricity_loss: S,
    /// Increase of the mean longitude caused by drag, divided by `n″₀`, min.
    pub(super) longitude_gain: S,
}

/// Converts the published mean elements to Brouwer's mean elements.
///
/// `n″₀ = n₀/(1 + δ₀)`, `δ₀ = d/a₀²`, `a₀ = a₁ (1 - δ₁² - δ₁ (1/3 + 134 δ₁²/81))`, `δ₁ = d/a₁²`, `a₁ =
/// (kₑ/n₀)^{2/3}`, `d = ¾ J₂ (3 cos²i - 1)/(1 - e²)^{3/2}`, with the published mean motion `n₀`, rad/min,
/// inclination `i` and eccentricity `e`; `a₀` and `a₁` are in Earth radii.
pub(super) fn brouwer(set: &MeanElements, earth: &Earth) -> Mean {
    let MeanElements { inclination: i, eccentricity: e, mean_motion: n, .. } = *set;
    let (cos, p) = (i.cos(), 1.0 - e * e);
    let a1 = (earth.ke / n).powf(2.0 / 3.0);
    let d = 0.75 * earth.j2 * (3.0 * (cos * cos) - 1.0) / (p.sqrt() * p);
    let d1 = d / (a1 * a1);
    let a0 = a1 * (1.0 - d1 * d1 - d1 * (1.0 / 3.0 + 134.0 * d1 * d1 / 81.0));
    Mean {
        n: n / (1.0 + d / (a0 * a0)),
        e,
        i,
        node: set.raan,
        perigee: set.argument_of_perigee,
        anomaly: set.mean_anomaly,
    }
}

impl NearEarth {
    pub(super) fn new(epoch: Mean, b_star: f64, earth: &Earth, is_deep: bool) -> Self {
        let Mean { n, e, i, perigee, anomaly, .. } = epoch;
        let (sin, cos) = i.sin_cos();
        let c2 = cos * cos; // θ²
        let c4 = c2 * c2; // θ⁴
        let (e2, a) = (e * e, (earth.ke / n).powf(2.0 / 3.0));
        let beta2 = 1.0 - e2;
        let (p, rp) = (a * beta2, a * (1.0 - e));
        let pinv2 = 1.0 / (p * p);
        let (x3, x1) = (3.0 * c2 - 1.0, 1.0 - c2);

        // density ~ ((q₀ - s)/(r - s))⁴, where s is smaller for low perigees
        let height = (rp - 1.0) * earth.radius_km;
        let s_km = if height < 98.0 { 20.0 } else { (height - 78.0).min(78.0) };
        let s = s_km / earth.radius_km + 1.0;
        let q4 = ((120.0 - s_km) / earth.radius_km).powi(4);
        let xi = 1.0 / (a - s); // ξ
        let eta = a * e * xi;
        let (eta2, e_eta) = (eta * eta, e * eta);
        let psi2 = (1.0 - eta2).abs();
        let k = q4 * xi.powi(4); // (q₀ - s)⁴ ξ⁴
        let k1 = k / psi2.powf(3.5);
        // C₂, C₁ = B* C₂, C₃, C₄, C₅
        let cc2 = k1
            * n
            * (a * (1.0 + 1.5 * eta2 + e_eta * (4.0 + eta2))
                + 0.375 * earth.j2 * xi / psi2 * x3 * (8.0 + 3.0 * eta2 * (8.0 + eta2)));
        let c1 = b_star * cc2;
        let c3 = if e > NEARLY_CIRCULAR { -2.0 * k * xi * earth.j3_j2 * n * sin / e } else { 0.0 };
        let about_perigee = -3.0 * x3 * (1.0 - 2.0 * e_eta + eta2 * (1.5 - 0.5 * e_eta))
            + 0.75 * x1 * (2.0 * eta2 - e_eta * (1.0 + eta2)) * (2.0 * perigee).cos();
        let cc4 = 2.0
            * n
            * k1
            * a
            * beta2
            * (eta * (2.0 + 0.5 * eta2) + e * (0.5 + 2.0 * eta2)
                - earth.j2 * xi / (a * psi2) * about_perigee);
        let c5 = 2.0 * k1 * a * beta2 * (1.0 + 2.75 * (eta2 + e_eta) + e_eta * eta2);

        // rates by J₂, J₂², J₄
        let k2 = 1.5 * earth.j2 * pinv2 * n;
        let k22 = 0.5 * k2 * earth.j2 * pinv2;
        let k4 = -0.46875 * earth.j4 * pinv2 * pinv2 * n;
        let beta = beta2.sqrt();
        let anomaly_rate = n + 0.5 * k2 * beta * x3 + 0.0625 * k22 * beta * (13.0 - 78.0 * c2 + 137.0 * c4);
        let perigee_rate = -0.5 * k2 * (1.0 - 5.0 * c2)
            + 0.0625 * k22 * (7.0 - 114.0 * c2 + 395.0 * c4)
            + k4 * (3.0 - 36.0 * c2 + 49.0 * c4);
        let node_first = -k2 * cos;
        let node_rate = node_first + (0.5 * k22 * (4.0 - 19.0 * c2) + 2.0 * k4 * (3.0 - 7.0 * c2)) * cos;

        let is_fine = !is_deep && rp >= FINE_PERIGEE / earth.radius_km + 1.0;
        let fine = is_fine.then(|| {
            let c1_2 = c1 * c1;
            let d2 = 4.0 * a * xi * c1_2;
            let third = d2 * xi * c1 / 3.0;
            let d3 = (17.0 * a + s) * third;
            let d4 = 0.5 * third * a * xi * (221.0 * a + 31.0 * s) * c1;
            let t3 = d2 + 2.0 * c1_2;
            let t4 = 0.25 * (3.0 * d3 + c1 * (12.0 * d2 + 10.0 * c1_2));
            let t5 = 0.2 * (3.0 * d4 + 12.0 * c1 * d3 + 6.0 * d2 * d2 + 15.0 * c1_2 * (2.0 * d2 + c1_2));
            Fine {
                eta,
                c5,
                d: [d2, d3, d4],
                t: [t3, t4, t5],
                perigee: b_star * c3 * perigee.cos(),
                anomaly: if e > NEARLY_CIRCULAR { -2.0 / 3.0 * k * b_star / e_eta } else { 0.0 },
                cube0: cube(1.0 + eta * anomaly.cos()),
                sin0: anomaly.sin(),
            }
        });
        let node_drag = 3.5 * beta2 * node_first * c1;
        Self { epoch, anomaly_rate, perigee_rate, node_rate, node_drag, b_star, c1, c4: cc4, fine }
    }

    /// Returns the mean elements with secular perturbations, `t` minutes after the epoch, together with the
    /// drag terms of the semi-major axis, the eccentricity and the mean longitude, which are applied later.
    #[inline(always)]
    pub(super) fn at<S: Real>(&self, t: S) -> SecularElements<S> {
        let (of, t2, epoch) = (S::of, t * t, &self.epoch);
        let mut mean = Mean {
            n: of(epoch.n),
            e: of(epoch.e),
            i: of(epoch.i),
            node: of(epoch.node) + of(self.node_rate) * t + of(self.node_drag) * t2,
            perigee: of(epoch.perigee) + of(self.perigee_rate) * t,
            anomaly: of(epoch.anomaly) + of(self.anomaly_rate) * t,
        };
        let mut axis_factor = of(1.0) - of(self.c1) * t;
        let mut eccentricity_loss = of(self.b_star * self.c4) * t;
        let mut longitude_gain = of(1.5 * self.c1) * t2;
        if let Some(fine) = &self.fine {
            // δω = B* C₃ cos ω₀ t,  δM = -⅔ (q₀ - s)⁴ B* ξ⁴/(e η) [(1 + η cos M)³ - (1 + η cos M₀)³]
            let here = of(1.0) + of(fine.eta) * mean.anomaly.sin_cos().1;
            let swing = of(fine.perigee) * t + of(fine.anomaly) * (here * here * here - of(fine.cube0));
            mean.anomaly += swing;
            mean.perigee -= swing;
            let (t3, [d2, d3, d4], [l3, l4, l5]) = (t2 * t, fine.d, fine.t);
            let t4 = t3 * t;
            axis_factor = axis_factor - of(d2) * t2 - of(d3) * t3 - of(d4) * t4;
            eccentricity_loss += of(self.b_star * fine.c5) * (mean.anomaly.sin_cos().0 - of(fine.sin0));
            longitude_gain = longitude_gain + of(l3) * t3 + t4 * (of(l4) + t * of(l5));
        }
        SecularElements { mean, axis_factor, eccentricity_loss, longitude_gain }
    }
}

fn cube(x: f64) -> f64 {
    x * x * x
}

//! Perturbations by Sun and Moon, averaged over a revolution of the satellite.
//!
//! Source: Hoots, Schumacher and Glover, J. Guidance, Control and Dynamics 27(2), 2004; coefficients as in
//! Spacetrack Report #3, section 7, with its names `aₖ`, `xₖ`, `zₖⱼ`, `sₖ`.

use super::constants::Mean;
use std::f64::consts::TAU;

/// One value for each of `e`, `i`, `l` (mean longitude), `g + h` (perigee plus node) and `h` (node,
/// multiplied by `sin i`).
pub(super) type Five = [f64; 5];

/// Perturbing body on its apparent elliptic orbit around the Earth.
#[derive(Clone, Debug)]
pub(super) struct ThirdBody {
    /// Secular rates of the five quantities of [`Five`], per minute.
    pub(super) rates: Five,
    /// Amplitudes of `F₂`, `F₃` and `sin f` ([`ThirdBody::waves()`]) for each of the five quantities.
    waves: [[f64; 3]; 5],
    eccentricity: f64,
    /// Mean motion of the body, rad/min.
    motion: f64,
    /// Mean anomaly at the epoch, rad.
    anomaly: f64,
}

/// Orbit of a third body around the Earth: cosine and sine of its argument of perigee `g`, inclination `i`
/// and node `h`, eccentricity, mean motion (rad/min) and mean anomaly at the epoch (rad).
struct Ellipse {
    g: (f64, f64),
    i: (f64, f64),
    h: (f64, f64),
    eccentricity: f64,
    motion: f64,
    anomaly: f64,
    /// Strength of the perturbation, rad/min.
    c: f64,
}

const COS_OBLIQUITY: f64 = 0.917_448_67;
const SIN_OBLIQUITY: f64 = 0.397_854_16;

/// Returns the perturbations of the orbit `mean` by Sun and Moon; `day` is the epoch in days since 1900-01-00
/// 12:00.
pub(super) fn sun_and_moon(day: f64, mean: &Mean) -> [ThirdBody; 2] {
    let sun = Ellipse {
        g: (0.194_590_5, -0.980_884_58),
        i: (COS_OBLIQUITY, SIN_OBLIQUITY),
        h: (1.0, 0.0),
        eccentricity: 0.01675,
        motion: 1.194_59e-5,
        anomaly: (6.256_583_7 + 0.017_201_977 * day) % TAU,
        c: 2.986_479_7e-6,
    };
    // orbit of the Moon, which is inclined to the ecliptic, in equatorial axes
    let node = (4.523_602_0 - 9.242_202_9e-4 * day) % TAU;
    let (sin_node, cos_node) = node.sin_cos();
    let cos_i = 0.913_751_64 - 0.035_680_96 * cos_node;
    let sin_i = (1.0 - cos_i * cos_i).sqrt();
    let sin_h = 0.089_683_511 * sin_node / sin_i;
    let cos_h = (1.0 - sin_h * sin_h).sqrt();
    let longitude = 5.835_151_4 + 0.001_944_368_0 * day; // longitude of the perigee
    let along = (SIN_OBLIQUITY * sin_node / sin_i).atan2(cos_h * cos_node + COS_OBLIQUITY * sin_h * sin_node);
    let (sin_g, cos_g) = (longitude + along - node).sin_cos();
    let moon = Ellipse {
        g: (cos_g, sin_g),
        i: (cos_i, sin_i),
        h: (cos_h, sin_h),
        eccentricity: 0.05490,
        motion: 1.583_521_8e-4,
        anomaly: (4.719_967_2 + 0.229_971_50 * day - longitude) % TAU,
        c: 4.796_806_5e-7,
    };
    [sun, moon].map(|body| ThirdBody::new(&body, mean))
}

impl ThirdBody {
    fn new(body: &Ellipse, mean: &Mean) -> Self {
        let ((cg, sg), (ci, si)) = (body.g, body.i);
        let (sin_node, cos_node) = mean.node.sin_cos();
        // node of the satellite's orbit relative to the node of the third body's orbit
        let ch = body.h.0 * cos_node + body.h.1 * sin_node;
        let sh = sin_node * body.h.0 - cos_node * body.h.1;
        let ((sin_w, cos_w), (sin_i, cos_i)) = (mean.perigee.sin_cos(), mean.i.sin_cos());
        let (e, e2) = (mean.e, mean.e * mean.e);
        let beta2 = 1.0 - e2;
        let beta = beta2.sqrt();

        let (a1, a3) = (cg * ch + sg * ci * sh, -sg * ch + cg * ci * sh);
        let (a7, a8) = (-cg * sh + sg * ci * ch, sg * si);
        let (a9, a10) = (sg * sh + cg * ci * ch, cg * si);
        let (a2, a4) = (cos_i * a7 + sin_i * a8, cos_i * a9 + sin_i * a10);
        let (a5, a6) = (-sin_i * a7 + cos_i * a8, -sin_i * a9 + cos_i * a10);

        let (x1, x2) = (a1 * cos_w + a2 * sin_w, a3 * cos_w + a4 * sin_w);
        let (x3, x4) = (-a1 * sin_w + a2 * cos_w, -a3 * sin_w + a4 * cos_w);
        let (x5, x6, x7, x8) = (a5 * sin_w, a6 * sin_w, a5 * cos_w, a6 * cos_w);

        let z31 = 12.0 * x1 * x1 - 3.0 * x3 * x3;
        let z32 = 24.0 * x1 * x2 - 6.0 * x3 * x4;
        let z33 = 12.0 * x2 * x2 - 3.0 * x4 * x4;
        let twice = |z: f64| z + z;
        let z1 = twice(3.0 * (a1 * a1 + a2 * a2) + z31 * e2) + beta2 * z31;
        let z2 = twice(6.0 * (a1 * a3 + a2 * a4) + z32 * e2) + beta2 * z32;
        let z3 = twice(3.0 * (a3 * a3 + a4 * a4) + z33 * e2) + beta2 * z33;
        let z11 = -6.0 * a1 * a5 + e2 * (-24.0 * x1 * x7 - 6.0 * x3 * x5);
        let z12 = -6.0 * (a1 * a6 + a3 * a5) + e2 * (-24.0 * (x2 * x7 + x1 * x8) - 6.0 * (x3 * x6 + x4 * x5));
        let z13 = -6.0 * a3 * a6 + e2 * (-24.0 * x2 * x8 - 6.0 * x4 * x6);
        let z21 = 6.0 * a2 * a5 + e2 * (24.0 * x1 * x5 - 6.0 * x3 * x7);
        let z22 = 6.0 * (a4 * a5 + a2 * a6) + e2 * (24.0 * (x2 * x5 + x1 * x6) - 6.0 * (x4 * x7 + x3 * x8));
        let z23 = 6.0 * a4 * a6 + e2 * (24.0 * x2 * x6 - 6.0 * x4 * x8);

        let s3 = body.c * (1.0 / mean.n);
        let s2 = -0.5 * s3 / beta;
        let s4 = s3 * beta;
        let s1 = -15.0 * e * s4;
        let (s5, s6, s7) = (x1 * x3 + x2 * x4, x2 * x3 + x1 * x4, x2 * x4 - x1 * x3);

        let (n, eb) = (body.motion, body.eccentricity);
        let rates = [
            s1 * n * s5,
            s2 * n * (z11 + z13),
            -n * s3 * (z1 + z3 - 14.0 - 6.0 * e2),
            s4 * n * (z31 + z33 - 6.0),
            -n * s2 * (z21 + z23),
        ];
        let waves = [
            [2.0 * s1 * s6, 2.0 * s1 * s7, 0.0],
            [2.0 * s2 * z12, 2.0 * s2 * (z13 - z11), 0.0],
            [-2.0 * s3 * z2, -2.0 * s3 * (z3 - z1), -2.0 * s3 * (-21.0 - 9.0 * e2) * eb],
            [2.0 * s4 * z32, 2.0 * s4 * (z33 - z31), -18.0 * s4 * eb],
            [-2.0 * s2 * z22, -2.0 * s2 * (z23 - z21), 0.0],
        ];
        Self { rates, waves, eccentricity: eb, motion: n, anomaly: body.anomaly }
    }

    /// Returns the periodic perturbations of the five quantities of [`Five`], `t` minutes after the epoch.
    ///
    /// They are weighted sums of `F₂ = ½ sin²f - ¼`, `F₃ = -½ sin f cos f` and `sin f` with the true anomaly
    /// `f` of the body.
    pub(super) fn waves(&self, t: f64) -> Five {
        // f = M + 2 e sin M,  F₂ = ½ sin²f - ¼,  F₃ = -½ sin f cos f
        let anomaly = self.anomaly + self.motion * t;
        let (sin, cos) = (anomaly + 2.0 * self.eccentricity * anomaly.sin()).sin_cos();
        let (f2, f3) = (0.5 * sin * sin - 0.25, -0.5 * sin * cos);
        self.waves.map(|[a2, a3, a]| a2 * f2 + a3 * f3 + a * sin)
    }
}

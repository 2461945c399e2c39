//! Checks the gravity field of a planet against closed forms, and its consistency.
#![allow(missing_docs, clippy::unwrap_used)]

use nalgebra::{Matrix3, Vector3};
use onorbit_core::gravity::{Coefficients, Gravity, GravityField};

const MU: f64 = 3.986004415e14;
const R: f64 = 6_378_136.3;

/// Fully normalised `P̄nm(u)` by rows, `c[n (degree + 1) + m]`; for moderate degrees.
fn legendre(degree: usize, u: f64) -> Vec<f64> {
    let w = degree + 1;
    let c = (1.0 - u * u).sqrt();
    let mut p = vec![0.0; w * w];
    p[0] = 1.0;
    for n in 1..=degree {
        let k = n as f64;
        let first = if n == 1 { 3.0_f64.sqrt() } else { ((2.0 * k + 1.0) / (2.0 * k)).sqrt() };
        p[n * w + n] = first * c * p[(n - 1) * w + n - 1];
        for m in 0..n {
            let j = m as f64;
            let a = ((2.0 * k + 1.0) / ((k - j) * (k + j))).sqrt();
            let b = (2.0 * k - 1.0).sqrt() * u * p[(n - 1) * w + m];
            let d = if n > m + 1 {
                ((k - 1.0 - j) * (k - 1.0 + j) / (2.0 * k - 3.0)).sqrt() * p[(n - 2) * w + m]
            } else {
                0.0
            };
            p[n * w + m] = a * (b - d);
        }
    }
    p
}

/// Returns the coefficients of a unit mass at `d` (units of `R`) instead of the centre.
///
/// `C̄nm + i S̄nm = dⁿ P̄nm(sin φ) exp(i m λ)/(2n + 1)`: the addition theorem.
fn mass_off_centre(degree: usize, d: Vector3<f64>) -> (Vec<f64>, Vec<f64>) {
    let (p, w) = (legendre(degree, d.z / d.norm()), degree + 1);
    let (mut c, mut s) = (vec![0.0; w * w], vec![0.0; w * w]);
    for n in 0..=degree {
        for m in 0..=n {
            let size = d.norm().powi(n as i32) * p[n * w + m] / (2 * n + 1) as f64;
            let (sin, cos) = (m as f64 * d.y.atan2(d.x)).sin_cos();
            (c[n * w + m], s[n * w + m]) = (size * cos, size * sin);
        }
    }
    (c, s)
}

fn point_mass(r: Vector3<f64>) -> (Vector3<f64>, Matrix3<f64>) {
    let (r2, i) = (r.norm_squared(), Matrix3::identity());
    let k = MU / (r2 * r2.sqrt());
    (r * -k, (r * r.transpose() * (3.0 / r2) - i) * k)
}

#[test]
fn harmonics_of_an_offset_point_mass_give_its_attraction() {
    // degree 360, two thirds of the radius out: the truncation error is (d R/r)³⁶⁰
    for (degree, d, tolerance) in [
        (20, Vector3::new(0.05, -0.1, 0.07), 1e-13),
        (360, Vector3::new(0.3, -0.4, 0.75), 1e-12),
        (360, Vector3::new(-0.2, 0.1, -0.88), 1e-12),
        (360, Vector3::new(0.0, 0.9, 0.0), 1e-12),
    ] {
        // scaled by a power of two, so that the coefficients are as small as those of planets, without
        // rounding
        let share = 2f64.powi(-14);
        let (c, s) = mass_off_centre(degree, d);
        let [c, s] = [c, s].map(|x| x.into_iter().map(|x| x * share).collect::<Vec<_>>());
        let model = Coefficients::new("off centre", MU, R, degree, &c, &s).unwrap();
        let field = GravityField::new(&model, degree, degree).unwrap();
        let mut worst = (0.0_f64, 0.0_f64);
        for r in [
            Vector3::new(4e6, -3e6, 5e6),
            Vector3::new(0.0, 0.0, 6.8e6),
            Vector3::new(0.0, 0.0, -6.8e6),
            Vector3::new(1e-3, 0.0, 6.7e6),
            Vector3::new(-7e6, 0.0, 0.0),
            Vector3::new(0.0, 6.7e6, 1e5),
        ] {
            let (g, tensor) = field.gradient(&r).unwrap();
            let (g, tensor) = (g / share, tensor / share);
            let (off, centre) = (point_mass(r - d * R), point_mass(r));
            let (eg, et) = (off.0 - centre.0, off.1 - centre.1);
            worst.0 = worst.0.max((g - eg).norm() / off.0.norm());
            worst.1 = worst.1.max((tensor - et).norm() / off.1.norm());
            let alone = field.acceleration(&r).unwrap() / share;
            assert!((alone - g).norm() <= 1e-14 * off.0.norm());
            assert_eq!(tensor, tensor.transpose());
            assert!(tensor.trace().abs() <= 4.0 * f64::EPSILON * tensor.norm());
        }
        println!("{degree}: {:.1e} {:.1e}", worst.0, worst.1);
        assert!(worst.0 < tolerance && worst.1 < 10.0 * tolerance, "{worst:?}");
    }
}

#[test]
fn zonals_in_closed_form_are_the_harmonics_of_order_zero() {
    for degree in 2..=6 {
        let zonal = GravityField::bundled("egm2008", degree, 0).unwrap();
        let named = GravityField::zonal(degree).unwrap();
        // the recursion, which a term of order 1 that vanishes asks for
        let w = degree + 1;
        let (mut c, mut s) = (vec![0.0; w * w], vec![0.0; w * w]);
        let unnormalised = [1.082626173852223e-3, -2.532410518567722e-6, -1.619897599916973e-6];
        let others = [-2.277535907308361e-7, 5.406665762838132e-7];
        for (n, j) in (2..=degree).zip(unnormalised.into_iter().chain(others)) {
            c[n * w] = -j / ((2 * n + 1) as f64).sqrt();
        }
        s[w + 1] = 1e-30;
        let model = Coefficients::new("zonals", MU, R, degree, &c, &s).unwrap();
        let harmonics = GravityField::new(&model, degree, 1).unwrap();
        for r in [
            Vector3::new(4e6, -3e6, 5e6),
            Vector3::new(0.0, 0.0, -6.8e6),
            Vector3::new(6.5e6, 2e6, 0.0),
            Vector3::new(3e7, 1e7, -2e7),
        ] {
            let (g, tensor) = harmonics.gradient(&r).unwrap();
            for field in [&zonal, &named] {
                assert_eq!((field.order(), field.degree()), (0, degree));
                let (gz, tz) = field.gradient(&r).unwrap();
                assert!((g - gz).norm() < 1e-14 * g.norm(), "{degree} {r}: {g} {gz}");
                assert!((tensor - tz).norm() < 1e-14 * tensor.norm(), "{degree} {r}: {tensor} {tz}");
                assert!((field.acceleration(&r).unwrap() - g).norm() < 1e-14 * g.norm());
                assert!(tz.trace().abs() < 8.0 * f64::EPSILON * tz.norm());
            }
        }
    }
}

#[test]
fn the_gradient_is_that_of_the_acceleration() {
    let fields = [
        GravityField::zonal(6).unwrap(),
        GravityField::bundled("egm2008", 36, 36).unwrap(),
        GravityField::bundled("egm2008", 70, 70).unwrap(),
        GravityField::bundled("jgm3", 12, 12).unwrap(),
    ];
    for field in fields {
        for r in [Vector3::new(4e6, -3e6, 5e6), Vector3::new(10.0, 0.0, 6.9e6), Vector3::new(0.0, -7e6, 1e5)]
        {
            let (_, tensor) = field.gradient(&r).unwrap();
            let step = 50.0;
            for axis in 0..3 {
                let e = Vector3::ith(axis, step);
                let at = |k: f64| field.acceleration(&(r + e * k)).unwrap();
                // fourth order: rounding 1e-17/50, truncation (50 n/r)⁴/30
                let slope = ((at(1.0) - at(-1.0)) * 8.0 - (at(2.0) - at(-2.0))) / (12.0 * step);
                let error = (slope - tensor.column(axis)).norm() / tensor.norm();
                assert!(error < 1e-9, "{} {axis} {r}: {error:e}", field.name());
            }
        }
    }
}

#[test]
fn gravity_transforms_the_field_to_inertial_axes() {
    use onorbit_core::earth::Earth;
    use std::sync::Arc;
    let field = Arc::new(GravityField::bundled("egm2008", 8, 8).unwrap());
    let earth = Arc::new(Earth::about_z(0.7, 1e-3));
    let gravity = Gravity::of_field(Arc::clone(&field), Some(Arc::clone(&earth))).unwrap();
    let (t, r) = (100.0, Vector3::new(4e6, -3e6, 5e6));
    let rot = nalgebra::Rotation3::from_axis_angle(&Vector3::z_axis(), -0.8).into_inner();
    let (g, tensor) = field.gradient(&(rot * r)).unwrap();
    let pm = point_mass(r);
    let error = (gravity.acceleration(t, &r).unwrap() - pm.0 - rot.transpose() * g).norm();
    assert!(error < 4e-15, "{error:e}");
    let error = (gravity.gradient(t, &r).unwrap() - pm.1 - rot.transpose() * tensor * rot).norm();
    assert!(error < 1e-21, "{error:e}");
}

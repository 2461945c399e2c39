//! Checks the Earth's shadow against ray tracing and against the cones of umbra and penumbra.

use nalgebra::Vector3;
use onorbit_core::environment::sunlit;

const AU: f64 = 149_597_870_700.0;
const SUN: f64 = 6.957e8;
const EARTH: f64 = 6_378_137.0;

/// Fraction of the Sun's disc that is visible, by tracing rays from rings of points.
fn traced(r: &Vector3<f64>, sun: &Vector3<f64>, radius: f64) -> f64 {
    const RINGS: usize = 400;
    let toward = (sun - r).normalize();
    let side = toward.cross(&Vector3::new(0.3, 0.5, 0.8)).normalize();
    let other = toward.cross(&side);
    // seen from r, the disc has the angular radius a: its edge is where rays touch the Sun
    let a = (SUN / (sun - r).norm()).asin();
    let (mut seen, mut all) = (0.0, 0.0);
    for i in 0..RINGS {
        let angle = a * (i as f64 + 0.5) / RINGS as f64;
        let weight = angle / RINGS as f64;
        for k in 0..RINGS {
            let (s, c) = ((k as f64 + 0.5) / RINGS as f64 * std::f64::consts::TAU).sin_cos();
            let ray = toward * angle.cos() + (side * c + other * s) * angle.sin();
            let along = -r.dot(&ray);
            let is_hidden = along > 0.0 && (r + ray * along).norm() < radius;
            all += weight;
            seen += if is_hidden { 0.0 } else { weight };
        }
    }
    seen / all
}

/// Returns a position `behind` the Earth as seen from the Sun on x, `aside` of the axis, m.
fn place(behind: f64, aside: f64) -> (Vector3<f64>, Vector3<f64>) {
    (Vector3::new(-behind, 0.6 * aside, 0.8 * aside), Vector3::new(AU, 0.0, 0.0))
}

#[test]
fn the_penumbra_agrees_with_traced_rays() {
    let mut partial = 0;
    for behind in [2.5e6, 6.0e6, 42.0e6, 380e6] {
        let (inner, outer) = (EARTH - behind * (SUN - EARTH) / AU, EARTH + behind * (SUN + EARTH) / AU);
        for k in 0..=20 {
            let aside = inner + (outer - inner) * (f64::from(k) / 20.0 * 1.2 - 0.1);
            let (r, sun) = place(behind, aside);
            let (got, expected) = (sunlit(&r, &sun, EARTH), traced(&r, &sun, EARTH));
            // at low altitude the Earth's limb is curved by a fraction b/a = 300: discs on the sphere are not
            // plane discs
            assert!((got - expected).abs() < 2e-3, "{behind} {aside}: {got} is not {expected}");
            partial += i32::from(got > 0.01 && got < 0.99);
        }
    }
    assert!(partial > 40, "{partial} places in the penumbra");
}

#[test]
fn the_umbra_ends_at_the_tip_of_its_cone() {
    // r = R sun/(R☉ - R): the tip of the umbra, 1.38 million km away
    let tip = EARTH * AU / (SUN - EARTH);
    for (behind, aside, expected) in [
        (7.0e6, 0.0, 0.0),
        (0.999 * tip, 0.0, 0.0),
        (7.0e6, 6.3e6, 0.0),
        (7.0e6, 6.45e6, 1.0),
        (-7.0e6, 0.0, 1.0),
        (-2.0e5, 6.9e6, 1.0),
        (1.0, 6.9e6, 1.0),
    ] {
        let (r, sun) = place(behind, aside);
        assert_eq!(sunlit(&r, &sun, EARTH), expected, "{behind} {aside}");
    }
    // beyond the tip a ring of the disc is visible: 1 - (b/a)²
    let (r, sun) = place(1.5 * tip, 0.0);
    let ratio = (EARTH / (1.5 * tip)).asin() / (SUN / (AU + 1.5 * tip)).asin();
    assert!((sunlit(&r, &sun, EARTH) - (1.0 - ratio * ratio)).abs() < 1e-12);
    // inside the Earth the Sun is invisible, and an Earth of radius zero has no shadow
    assert_eq!(sunlit(&Vector3::new(6.0e6, 0.0, 0.0), &sun, EARTH), 0.0);
    assert_eq!(sunlit(&Vector3::new(-7.0e6, 0.0, 0.0), &sun, 0.0), 1.0);
}

#[test]
fn the_penumbra_is_continuous() {
    let behind = 2.5e6;
    let width = behind * 2.0 * SUN / AU; // 23 km
    let at = |aside: f64| {
        let (r, sun) = place(behind, aside);
        sunlit(&r, &sun, EARTH)
    };
    let (from, steps) = (EARTH - width, 20_000);
    let mut before = at(from);
    assert_eq!(before, 0.0);
    for k in 1..=steps {
        let now = at(from + 2.0 * width * f64::from(k) / f64::from(steps));
        // the largest slope is at the middle of the disc: 4/π of the mean
        assert!(
            (-1e-9..=1.5 * 2.0 / f64::from(steps)).contains(&(now - before)),
            "step {k}: {before} to {now}"
        );
        before = now;
    }
    assert_eq!(before, 1.0);
}

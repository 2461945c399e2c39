//! Reader of `.gfc` files, in the format of the International Centre for Global Earth Models (ICGEM).

use super::coefficients::{Coefficients, check_degree};
use super::error::GravityError;
use super::series::Series;

/// Reads the coefficients from the text of a `.gfc` file; `file` is the name used in error messages.
///
/// Coefficients above `degree` are skipped. If `degree` is `None` or exceeds the degree of the file, all
/// coefficients are read.
///
/// # Errors
/// [`GravityError`] for a degree outside its range, an invalid header or row, a last row that may be
/// truncated, missing or repeated coefficients, a field that varies with time, a `mu` or radius that cannot
/// be that of a planet, and coefficients that are not normalised or implausible. The error of a row states
/// its line.
///
/// Source: Barthelmes and Förste, The ICGEM-format, GFZ Potsdam 2011.
pub(super) fn read(file: &str, text: &str, degree: Option<usize>) -> Result<Coefficients, GravityError> {
    let header = Header::read(file, text)?;
    let degree = check_degree(degree.unwrap_or(header.degree).min(header.degree))?;
    let mut series = Series::zeros(degree);
    let mut is_given = vec![false; (degree + 1) * (degree + 2) / 2];
    let mut central = 1.0;
    let (last, is_cut) = (text.lines().count(), !text.ends_with(['\n', '\r']));
    let rows = text.lines().enumerate().skip(header.lines).filter(|(_, line)| !line.trim().is_empty());
    for (index, text) in rows {
        let line = index + 1;
        let invalid = || GravityError::Row {
            file: file.to_owned(),
            line,
            got: text.trim().to_owned(),
            max_degree: header.degree,
        };
        let words: Vec<&str> = text.split_whitespace().collect();
        let (n, m) =
            (index_of(words.get(1)).ok_or_else(invalid)?, index_of(words.get(2)).ok_or_else(invalid)?);
        if m > n || n > header.degree {
            return Err(invalid());
        }
        match words[0] {
            "gfc" => {}
            _ if n > degree => continue,
            "gfct" | "trnd" | "dot" | "acos" | "asin" => {
                let key = words[0].to_owned();
                return Err(GravityError::VariesWithTime { file: file.to_owned(), line, key, degree: n });
            }
            _ => return Err(invalid()),
        }
        if words.len() != 5 && words.len() != header.words {
            return Err(invalid());
        }
        let (c, s) = (number(words[3]).ok_or_else(invalid)?, number(words[4]).ok_or_else(invalid)?);
        if n > degree {
            continue;
        }
        // if the file ends with S, without an error column or a line end, the digits of S may be truncated; a
        // truncated exponent is detected by the size of the number
        let may_be_cut = m > 0 && !words[4].contains(['e', 'E', 'd', 'D']);
        if is_cut && line == last && words.len() == 5 && may_be_cut {
            return Err(GravityError::CutRow { file: file.to_owned(), line, got: text.trim().to_owned() });
        }
        if std::mem::replace(&mut is_given[n * (n + 1) / 2 + m], true) {
            return Err(GravityError::Twice { file: file.to_owned(), line, degree: n, order: m });
        }
        if n == 0 {
            central = c;
        }
        *series.at(n, m) = [c, s];
    }
    for n in 2..=degree {
        if let Some(order) = (0..=n).find(|m| !is_given[n * (n + 1) / 2 + m]) {
            return Err(GravityError::Truncated { file: file.to_owned(), degree: n, order });
        }
    }
    // U = (μ/r) [C00 + …]: C00 is included in μ, and the other coefficients are divided by C00
    Coefficients::checked(header.model, header.mu * central, header.radius, series.divided_by(central))
}

/// Contents of the header of a `.gfc` file.
struct Header {
    model: String,
    mu: f64,
    radius: f64,
    degree: usize,
    /// Number of words in a row of coefficients, including error columns.
    words: usize,
    /// Number of lines before the coefficients.
    lines: usize,
}

impl Header {
    fn read(file: &str, text: &str) -> Result<Self, GravityError> {
        let end = text.lines().position(|line| line.starts_with("end_of_head"));
        let invalid = |key: &'static str, got: Option<&str>, expected: &'static str| GravityError::Header {
            file: file.to_owned(),
            key,
            got: got.map_or_else(|| "missing".to_owned(), |got| format!("'{got}'")),
            expected,
        };
        let end = end.ok_or_else(|| invalid("end_of_head", None, "the line that ends the header"))?;
        let value = |key: &str| {
            let mut lines = text.lines().take(end).map(str::split_whitespace);
            lines.find_map(|mut words| words.next().filter(|word| *word == key).and_then(|_| words.next()))
        };
        let kind = value("product_type");
        if kind != Some("gravity_field") {
            return Err(invalid("product_type", kind, "gravity_field"));
        }
        let model = value("modelname").unwrap_or(file).to_owned();
        if let Some(norm) = value("norm").filter(|norm| *norm != "fully_normalized") {
            return Err(GravityError::NotNormalised {
                model,
                found: format!("the norm in the header is {norm}"),
            });
        }
        let real = |key: &'static str, got: Option<&str>| {
            let good = got.and_then(number).filter(|x| *x > 0.0);
            good.ok_or_else(|| invalid(key, got, "a positive number"))
        };
        let degree = value("max_degree");
        let errors = value("errors").unwrap_or("no");
        Ok(Self {
            model,
            mu: real(
                "earth_gravity_constant",
                value("earth_gravity_constant").or(value("gravity_constant")),
            )?,
            radius: real("radius", value("radius"))?,
            degree: index_of(degree.as_ref())
                .ok_or_else(|| invalid("max_degree", degree, "a non-negative whole number"))?,
            words: match errors {
                "no" => 5,
                "calibrated_and_formal" => 9,
                _ => 7,
            },
            lines: end + 1,
        })
    }
}

/// Parses a degree or an order; returns `None` if it is missing or not a non-negative whole number.
fn index_of(word: Option<&&str>) -> Option<usize> {
    word?.parse().ok()
}

/// Parses a number with a C or Fortran exponent; returns `None` for any other text and for numbers that are
/// not finite.
fn number(word: &str) -> Option<f64> {
    word.replace(['d', 'D'], "e").parse().ok().filter(|x: &f64| x.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gravity::GravityField;

    const GOOD: &str = "a comment\nproduct_type gravity_field\nmodelname tiny\nearth_gravity_constant 0.3986004415D+15\n\
        radius 0.63781363E+07\nmax_degree 3\nerrors formal\nnorm fully_normalized\n\nkey L M C S sigma sigma\nend_of_head ==\n\
        gfc 0 0 1.0d0 0 0 0\ngfc 2 0 -0.4841D-03 0.0 1e-10 0\ngfc 2 1 -2D-10 1.4d-9 0 0\ngfc 2 2 2.4e-6 -1.4e-6 0 0\n\
        gfc 3 0 9.57e-7 0 0 0\ngfc 3 1 2e-6 2e-7 0 0\ngfc 3 2 9e-7 -6e-7 0 0\ngfc 3 3 7e-7 1.4e-6 0 0\n";

    fn refused(text: &str, degree: Option<usize>) -> GravityError {
        let error = read("tiny.gfc", text, degree).expect_err("something is wrong");
        assert!(!error.to_string().is_empty());
        error
    }

    #[test]
    fn exponents_of_fortran_and_comments_are_read() {
        let read = read("tiny.gfc", GOOD, None).expect("a good file");
        assert_eq!((read.mu, read.radius, read.degree()), (3.986_004_415e14, 6_378_136.3, 3));
        assert_eq!(read.series.get(2, 0), [-0.4841e-3, 0.0]);
        assert_eq!(read.series.get(3, 3), [7e-7, 1.4e-6]);
        // coefficients of degree 0 belong to the point mass
        let doubled = GOOD.replace("gfc 0 0 1.0d0", "gfc 0 0 2.0d0");
        let doubled = super::read("tiny.gfc", &doubled, Some(2)).expect("a good file");
        assert_eq!((doubled.mu, doubled.series.get(2, 0)[0]), (2.0 * read.mu, -0.24205e-3));
    }

    #[test]
    fn broken_files_are_refused_with_the_line() {
        let cut = |count: usize| GOOD.lines().take(count).map(|line| format!("{line}\n")).collect::<String>();
        // files in which rows are missing or the last row is truncated
        assert!(matches!(refused(&cut(18), None), GravityError::Truncated { degree: 3, order: 3, .. }));
        assert!(matches!(refused(&cut(11), None), GravityError::Truncated { degree: 2, order: 0, .. }));
        assert!(read("tiny.gfc", &cut(16), Some(2)).is_ok());
        let broken = GOOD.replace("7e-7 1.4e-6 0 0\n", "7e-7");
        assert!(matches!(refused(&broken, None), GravityError::Row { line: 19, .. }));
        // files truncated within the last number, which then has a different value
        for cut in ["7e-7 0.0000014", "7e-7 0.00", "7e-7 1.4"] {
            let cut = refused(&GOOD.replace("7e-7 1.4e-6 0 0\n", cut), None);
            assert!(matches!(cut, GravityError::CutRow { line: 19, .. }), "{cut}");
        }
        assert!(read("tiny.gfc", GOOD.trim_end(), None).is_ok());
        for whole in ["7e-7 0.0000014\n", "7e-7 1.4e-6", "7e-7 0.0000014 0 0"] {
            assert!(read("tiny.gfc", &GOOD.replace("7e-7 1.4e-6 0 0\n", whole), None).is_ok(), "{whole}");
        }
        assert!(read("tiny.gfc", &GOOD.replace("7e-7 1.4e-6 0 0\n", "7e-7 1.4"), Some(2)).is_ok());
        for (from, to) in
            [("2D-10", "2DD10"), ("gfc 2 1", "gfc 2 5"), ("2.4e-6", "nan"), ("gfc 3 0", "foo 3 0")]
        {
            assert!(matches!(refused(&GOOD.replace(from, to), None), GravityError::Row { .. }), "{to}");
        }
        let beyond_header = refused(&GOOD.replace("gfc 3 3", "gfc 4 3"), None);
        assert!(
            matches!(beyond_header, GravityError::Row { line: 19, max_degree: 3, .. }),
            "{beyond_header}"
        );
        assert!(beyond_header.to_string().contains("order ≤ degree ≤ 3"), "{beyond_header}");
        let twice = GOOD.replace("gfc 2 2", "gfc 2 1");
        assert!(matches!(refused(&twice, None), GravityError::Twice { line: 15, degree: 2, order: 1, .. }));
        let varies = GOOD.replace("gfc 3 1", "gfct 3 1");
        assert!(matches!(refused(&varies, None), GravityError::VariesWithTime { line: 17, .. }));
        assert!(read("tiny.gfc", &varies, Some(2)).is_ok());
    }

    #[test]
    fn headers_that_cannot_be_are_refused() {
        for (from, to, key) in [
            ("0.3986004415D+15", "-1", "earth_gravity_constant"),
            ("0.63781363E+07", "0", "radius"),
            ("max_degree 3", "max_degree x", "max_degree"),
            ("end_of_head", "body", "end_of_head"),
            ("gravity_field", "topography", "product_type"),
        ] {
            let error = refused(&GOOD.replace(from, to), None);
            assert!(matches!(&error, GravityError::Header { key: got, .. } if *got == key), "{error}");
        }
        let error = refused(&GOOD.replace("fully_normalized", "unnormalized"), None);
        assert!(matches!(error, GravityError::NotNormalised { .. }));
    }

    #[test]
    fn coefficients_that_are_not_normalised_show() {
        let degree = 20;
        let model = read("egm2008", include_str!("models/egm2008.gfc"), Some(degree)).expect("ours");
        let (mut c, mut s) = (vec![0.0; 441], vec![0.0; 441]);
        for n in 2..=degree {
            for m in 0..=n {
                let factorial: f64 = (n - m + 1..=n + m).map(|k| k as f64).product();
                let norm = (f64::from(1 + u8::from(m > 0)) * (2 * n + 1) as f64 / factorial).sqrt();
                let [a, b] = model.series.get(n, m);
                (c[n * 21 + m], s[n * 21 + m]) = (a * norm, b * norm);
            }
        }
        let error =
            Coefficients::new("raw", model.mu, model.radius, degree, &c, &s).expect_err("not normalised");
        assert!(matches!(error, GravityError::NotNormalised { .. }), "{error}");
    }

    #[test]
    fn more_than_a_model_has_is_refused() {
        let ask = |degree, order| GravityField::bundled("egm2008", degree, order).expect_err("too much");
        assert!(matches!(ask(71, 71), GravityError::BeyondModel { highest: 70, .. }));
        assert!(matches!(ask(8, 9), GravityError::OrderAboveDegree { degree: 8, order: 9 }));
        assert!(matches!(ask(1, 0), GravityError::Degree { degree: 1 }));
        let unknown = GravityField::bundled("egm08", 8, 8).expect_err("no such model");
        assert!(unknown.to_string().contains("egm2008, jgm3, zonal"), "{unknown}");
        assert!(matches!(GravityField::zonal(7), Err(GravityError::ZonalDegree { degree: 7 })));
        for (mu, radius, j) in [(-1.0, 1.0, 1e-3), (1.0, f64::NAN, 1e-3), (1.0, 1.0, f64::INFINITY)] {
            assert!(GravityField::zonals(mu, radius, &[j]).is_err());
        }
        let field = GravityField::zonal(2).expect("J2");
        let below = field.acceleration(&nalgebra::Vector3::x().scale(6.3e6));
        assert!(matches!(below, Err(GravityError::BelowSurface { .. })));
        for x in [f64::NAN, f64::INFINITY] {
            let nowhere = field.acceleration(&nalgebra::Vector3::new(7e6, x, 0.0));
            assert!(matches!(nowhere, Err(GravityError::NotFinite { .. })));
        }
    }
}

//! Reading `.gfc`, the format of the International Centre for Global Earth Models.

use super::GravityError;
use super::coefficients::{Coefficients, check_degree};
use super::series::Series;

/// Reads the text of a `.gfc` file, up to `degree` where one is given; `file` is its name, for messages.
///
/// # Errors
/// [`GravityError`] with file and line.
///
/// Source: Barthelmes and Förste, The ICGEM-format, GFZ Potsdam 2011.
pub(super) fn read(file: &str, text: &str, degree: Option<usize>) -> Result<Coefficients, GravityError> {
    let header = Header::read(file, text)?;
    let degree = check_degree(degree.unwrap_or(header.degree).min(header.degree))?;
    let mut series = Series::zeros(degree);
    let mut is_given = vec![false; (degree + 1) * (degree + 2) / 2];
    let mut central = 1.0;
    let rows = text.lines().enumerate().skip(header.lines).filter(|(_, line)| !line.trim().is_empty());
    for (index, text) in rows {
        let line = index + 1;
        let refuse = || GravityError::Row { file: file.to_owned(), line, got: text.trim().to_owned() };
        let words: Vec<&str> = text.split_whitespace().collect();
        let (n, m) = (index_of(words.get(1)).ok_or_else(refuse)?, index_of(words.get(2)).ok_or_else(refuse)?);
        if m > n || n > header.degree {
            return Err(refuse());
        }
        match words[0] {
            "gfc" => {}
            _ if n > degree => continue,
            "gfct" | "trnd" | "dot" | "acos" | "asin" => {
                let key = words[0].to_owned();
                return Err(GravityError::VariesWithTime { file: file.to_owned(), line, key });
            }
            _ => return Err(refuse()),
        }
        if words.len() != 5 && words.len() != header.words {
            return Err(refuse());
        }
        let (c, s) = (number(words[3]).ok_or_else(refuse)?, number(words[4]).ok_or_else(refuse)?);
        if n > degree {
            continue;
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
    // U = (μ/r) [C00 + …]: what stands before all terms is μ, the rest is relative to it
    Coefficients::checked(header.model, header.mu * central, header.radius, series.over(central))
}

/// What the lines before the coefficients say.
struct Header {
    model: String,
    mu: f64,
    radius: f64,
    degree: usize,
    /// Words in a row of coefficients with its errors.
    words: usize,
    /// Lines until the coefficients.
    lines: usize,
}

impl Header {
    fn read(file: &str, text: &str) -> Result<Self, GravityError> {
        let end = text.lines().position(|line| line.starts_with("end_of_head"));
        let refuse = |key: &'static str, got: Option<&str>, expected: &'static str| GravityError::Header {
            file: file.to_owned(),
            key,
            got: got.map_or_else(|| "missing".to_owned(), |got| format!("'{got}'")),
            expected,
        };
        let end = end.ok_or_else(|| refuse("end_of_head", None, "the line that ends the header"))?;
        let value = |key: &str| {
            let mut lines = text.lines().take(end).map(str::split_whitespace);
            lines.find_map(|mut words| words.next().filter(|word| *word == key).and_then(|_| words.next()))
        };
        let kind = value("product_type");
        if kind != Some("gravity_field") {
            return Err(refuse("product_type", kind, "gravity_field"));
        }
        let model = value("modelname").unwrap_or(file).to_owned();
        if let Some(norm) = value("norm").filter(|norm| *norm != "fully_normalized") {
            return Err(GravityError::NotNormalised { model, found: format!("its header says norm {norm}") });
        }
        let real = |key: &'static str, got: Option<&str>| {
            let good = got.and_then(number).filter(|x| *x > 0.0);
            good.ok_or_else(|| refuse(key, got, "a positive number"))
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
                .ok_or_else(|| refuse("max_degree", degree, "a whole number"))?,
            words: match errors {
                "no" => 5,
                "calibrated_and_formal" => 9,
                _ => 7,
            },
            lines: end + 1,
        })
    }
}

fn index_of(word: Option<&&str>) -> Option<usize> {
    word?.parse().ok()
}

/// A finite number, its exponent marked as in C or as in Fortran.
fn number(word: &str) -> Option<f64> {
    word.replace(['d', 'D'], "e").parse().ok().filter(|x: &f64| x.is_finite())
}

//! Typical coefficients of friction of pairs of materials.

use crate::model::closest;

/// Coefficients of friction between two materials with clean and dry surfaces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MaterialPair {
    /// Names of both materials.
    pub materials: [&'static str; 2],
    /// Coefficient of static friction.
    pub static_coefficient: f64,
    /// Coefficient of kinetic friction.
    pub kinetic_coefficient: f64,
}

/// Typical coefficients of friction between clean, dry surfaces in air. Coatings, oxide films and vacuum may
/// change the coefficients severalfold; clean metals may seize in vacuum.
///
/// The source gives 1.4 for sliding aluminium, which exceeds its static coefficient; because the friction
/// model requires a kinetic coefficient of at most the static one, the table repeats the static coefficient.
///
/// Source: Marks' Standard Handbook for Mechanical Engineers, 10th edition, 1996, table 3.2.1.
pub const MATERIAL_PAIRS: [MaterialPair; 10] = [
    pair("aluminium", "aluminium", 1.05, 1.05),
    pair("aluminium", "mild steel", 0.61, 0.47),
    pair("brass", "mild steel", 0.51, 0.44),
    pair("copper", "mild steel", 0.53, 0.36),
    pair("glass", "glass", 0.94, 0.40),
    pair("hard steel", "hard steel", 0.78, 0.42),
    pair("mild steel", "mild steel", 0.74, 0.57),
    pair("nickel", "nickel", 1.10, 0.53),
    pair("steel", "teflon", 0.04, 0.04),
    pair("teflon", "teflon", 0.04, 0.04),
];

const fn pair(
    a: &'static str,
    b: &'static str,
    static_coefficient: f64,
    kinetic_coefficient: f64,
) -> MaterialPair {
    MaterialPair { materials: [a, b], static_coefficient, kinetic_coefficient }
}

/// Returns the typical coefficients of friction of two materials, which may be given in either order. The
/// spelling `aluminum` is accepted as well.
///
/// # Errors
/// A message with the known pairs and, if there is one, a similar pair, if the table does not contain the
/// pair.
pub fn material_pair(a: &str, b: &str) -> Result<MaterialPair, String> {
    let [a, b] = [a, b].map(|name| if name == "aluminum" { "aluminium" } else { name });
    let is_pair = |pair: &&MaterialPair| pair.materials == [a, b] || pair.materials == [b, a];
    MATERIAL_PAIRS.iter().find(is_pair).copied().ok_or_else(|| {
        let names: Vec<String> = MATERIAL_PAIRS.iter().map(|pair| pair.materials.join("-")).collect();
        let similar = closest(&names, &format!("{a}-{b}"));
        let similar = similar.map_or_else(String::new, |pair| format!(" (did you mean '{pair}'?)"));
        format!(
            "no coefficients of friction are known for '{a}' on '{b}'{similar}; give the coefficients, or use \
             one of the known pairs: {}",
            names.join(", ")
        )
    })
}

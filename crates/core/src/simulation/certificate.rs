//! placeholder
use super::trace::Trace;
use crate::model::Model;
/// x
#[derive(Debug)]
pub struct Certificate;
impl Certificate {
    /// rows
    pub fn rows(&self) -> Vec<(&'static str, Option<f64>, f64, bool)> {
        Vec::new()
    }
}
/// x
pub fn certify(_m: &Model, _t: &Trace) -> Certificate {
    Certificate
}

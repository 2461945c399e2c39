//! placeholder
use super::trace::Trace;
/// x
#[derive(Debug)]
pub struct Certificate;
/// x
pub fn certify(_t: &Trace) -> Certificate {
    Certificate
}

//! Propagation by PyPI's `sgp4`, the reference implementation of SGP4.

use onorbit_core::orbit::sgp4::ExternalSgp4;
use pyo3::prelude::*;

/// Object of the class `Satrec` of `sgp4.api`. It is called in Python for each state.
#[derive(Debug)]
pub(super) struct Satrec {
    tsince: Py<PyAny>,
}

impl Satrec {
    /// Creates a `Satrec` by calling `function` of the Python module `onorbit_rs.ephemeris.satrec`.
    pub(super) fn new<'py>(
        py: Python<'py>,
        function: &str,
        arguments: impl pyo3::call::PyCallArgs<'py>,
    ) -> PyResult<Self> {
        let satrec = py.import("onorbit_rs.ephemeris.satrec")?.getattr(function)?.call1(arguments)?;
        Ok(Self { tsince: satrec.getattr("sgp4_tsince")?.unbind() })
    }
}

impl ExternalSgp4 for Satrec {
    fn at(&self, minutes: f64) -> Result<[[f64; 3]; 2], u8> {
        const NO_ANSWER: u8 = 255;
        const DECAYED: u8 = 6;
        Python::attach(|py| {
            let answer = self.tsince.bind(py).call1((minutes,));
            match answer.and_then(|answer| answer.extract::<(u8, [f64; 3], [f64; 3])>()) {
                Ok((0 | DECAYED, r, v)) => Ok([r, v]),
                Ok((code, ..)) => Err(code),
                Err(error) => {
                    error.write_unraisable(py, None);
                    Err(NO_ANSWER)
                }
            }
        })
    }
}

//! Assignment of a world's closed loops to its systems.

use super::system::PySystem;
use crate::errors::{fields, raise};
use onorbit_core::model::Loop;
use onorbit_core::number_text;
use pyo3::prelude::*;

/// Returns the systems after each loop has been added to the robot of its system. The frames of the loops are
/// given as `SYSTEM/FRAME`; a loop whose frames are not both on one of the systems is an error.
pub(super) fn close_systems(
    py: Python<'_>,
    systems: &[Bound<'_, PySystem>],
    loops: &[Loop],
) -> PyResult<Vec<Py<PySystem>>> {
    let names: Vec<&str> = systems.iter().map(|system| system.get().name.as_str()).collect();
    let mut closing: Vec<Vec<Loop>> = vec![Vec::new(); systems.len()];
    for given in loops {
        let (system, own) = of_one_system(py, given, &names)?;
        closing[system].push(own);
    }
    let close = |(system, loops): (&Bound<'_, PySystem>, Vec<Loop>)| match loops.is_empty() {
        true => Ok(system.clone().unbind()),
        false => system.get().with_loops(py, loops),
    };
    systems.iter().zip(closing).map(close).collect()
}

/// Returns the index of the system to which both frames of a loop belong, and the loop with frame names that
/// do not include the name of the system.
fn of_one_system(py: Python<'_>, given: &Loop, names: &[&str]) -> PyResult<(usize, Loop)> {
    let refuse = |problem: &str| {
        let message = format!("loop '{}' {problem}", given.name);
        raise(py, "WorldError", &message, &fields!(py, "name": &given.name))
    };
    let place = |path: &String| {
        let example = names.first().copied().unwrap_or("chaser");
        let Some((system, frame)) = path.split_once('/') else {
            return Err(refuse(&format!(
                "refers to the frame '{path}' without a system; it must be written SYSTEM/FRAME, as in \
                 '{example}/FRAME'"
            )));
        };
        let number = names.iter().position(|known| *known == system).ok_or_else(|| {
            let known = number_text::names(names, "system");
            refuse(&format!("refers to the frame '{path}', but there is no system '{system}'; {known}"))
        })?;
        Ok((number, frame.to_owned()))
    };
    let [a, b] = [place(&given.frames[0])?, place(&given.frames[1])?];
    if a.0 != b.0 {
        let Loop { name, frames: [first, second], .. } = given;
        return Err(refuse(&format!(
            "connects frames of two systems, '{}' and '{}'; give frames of one system, or connect the \
             systems with a capture at t = 0 s: oo.Capture('{name}', '{first}', '{second}', at=0.0)",
            names[a.0], names[b.0]
        )));
    }
    Ok((a.0, Loop { frames: [a.1, b.1], ..given.clone() }))
}

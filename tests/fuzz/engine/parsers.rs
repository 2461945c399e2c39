//! The engine's parsers: each takes bytes and either reads them or refuses them with a typed error.
//!
//! A panic is a finding, and so is a number that is not finite in what was read.

use nalgebra::{Matrix3, Vector3};
use onorbit_core::dynamics::{Data, mass_matrix};
use onorbit_core::earth::{Earth, EarthParameters, Epoch, SpiceKernel, SpiceSegment};
use onorbit_core::environment::atmosphere::SpaceWeatherTable;
use onorbit_core::gravity::GravityField;
use onorbit_core::model::{Model, neutral, urdf};
use onorbit_core::orbit::{
    CustomPath, EarthModel, Elements, Ends, Kepler, MeanElements, Orbit, PathPoints, Phase, Sgp4, Size,
};
use onorbit_core::reference::{Hold, PoseSpline};
use onorbit_core::simulation::{Checkpoint, Simulation, Trace};
use std::path::PathBuf;
use std::sync::Arc;

/// What became of an input: the text of the error, where it was refused.
type Outcome = Result<(), String>;

/// A parser by name, with the pieces of text that mean something to it.
pub(crate) struct Parser {
    pub(crate) name: &'static str,
    pub(crate) words: &'static [&'static str],
    pub(crate) read: fn(&[u8]) -> Outcome,
}

/// All of them.
pub(crate) const PARSERS: &[Parser] = &[
    Parser { name: "urdf", words: URDF, read: read_urdf },
    Parser { name: "tle", words: &["1 ", "2 ", "00000-0", "+0", "-11606-4", "U"], read: read_tle },
    Parser { name: "omm_keywords", words: OMM, read: read_omm },
    Parser { name: "gfc", words: GFC, read: read_gfc },
    Parser { name: "earth_parameters", words: EARTH, read: read_earth_parameters },
    Parser { name: "space_weather", words: WEATHER, read: read_space_weather },
    Parser {
        name: "epoch",
        words: &["UTC", "TAI", "TT", "TDB", "GPST", "T", "Z", "+02:00", "60"],
        read: read_epoch,
    },
    Parser { name: "engine_checkpoint", words: CHECKPOINT, read: read_checkpoint },
    Parser {
        name: "orbit_elements",
        words: &["0", "1", "6778000", "3.141592653589793"],
        read: read_elements,
    },
    Parser { name: "path_points", words: &["0", "1", "2", "6778000", "7500"], read: read_path },
    Parser { name: "pose_samples", words: &["0", "1", "-1", "0.5"], read: read_poses },
    Parser { name: "kernel_segments", words: &["0", "1", "86400", "150000000"], read: read_segments },
];

const URDF: &[&str] = &[
    "&a;",
    "&",
    "<?xml?>",
    " xmlns=\"u\"",
    "p:",
    " quat_xyzw=\"0 0 0 1\"",
    " version=\"1.1\"",
    "<link name=\"c\"/>",
    "<joint name=\"k\" type=\"prismatic\">",
    "</joint>",
    "<parent link=\"a\"/>",
    "<child link=\"b\"/>",
    "<axis xyz=\"0 1 0\"/>",
    "<origin xyz=\"1 2 3\" rpy=\"0 0 1\"/>",
    "<mimic joint=\"j\"/>",
    "<inertial>",
    "<mass value=\"1e-300\"/>",
    "type=\"planar\"",
    "type=\"ball\"",
    "type=\"floating\"",
    "<box size=\"1 1 1\"/>",
    "<mesh filename=\"package://p/x.stl\"/>",
    "<!--",
    "-->",
    "<![CDATA[",
    "]]>",
    "&lt;",
    "<!DOCTYPE r [",
    "<!ENTITY a \"b\">",
    "xacro:",
    "${x}",
    "world",
    "/>",
    "</",
];
const OMM: &[&str] = &[
    "EPOCH = ",
    "NORAD_CAT_ID = ",
    "MEAN_MOTION = ",
    "ECCENTRICITY = ",
    "BSTAR = ",
    "TEME",
    "2020-064T10:34:41",
];
const GFC: &[&str] = &[
    "gfc ",
    "gfct ",
    "dot ",
    "end_of_head",
    "max_degree ",
    "norm fully_normalized",
    "D-06",
    "radius ",
    "errors no",
];
const EARTH: &[&str] = &["mjd,x_arcsec,y_arcsec,ut1_minus_utc_s", "I", "P", "60000", "0.1"];
const WEATHER: &[&str] =
    &["DATE", "F10.7_OBS", "F10.7_OBS_CENTER81", "AP_AVG", "AP1", "AP8", "2024-02-29", ",,", "9999-12-31"];
const CHECKPOINT: &[&str] =
    &["null", "true", "[]", "{}", "\"rows\":", "\"steps\":", "1e999", "18446744073709551615"];

fn text(bytes: &[u8]) -> std::borrow::Cow<'_, str> {
    String::from_utf8_lossy(bytes)
}

/// Numbers between blanks; what is no number is NaN.
fn numbers(bytes: &[u8]) -> Vec<f64> {
    text(bytes).split_whitespace().map(|word| word.parse().unwrap_or(f64::NAN)).collect()
}

fn message(error: impl std::fmt::Display) -> String {
    error.to_string()
}

/// Fails where a number that came out of accepted input is not finite.
#[track_caller]
fn all_finite<'a>(of: &str, numbers: impl IntoIterator<Item = &'a f64>) {
    for x in numbers {
        assert!(x.is_finite(), "{of} were accepted and give {x}");
    }
}

/// The state at `t`, which is finite or refused.
#[track_caller]
fn state(orbit: &dyn Orbit, t: f64, of: &str) -> Outcome {
    let state = orbit.state(t).map_err(message)?;
    all_finite(of, state.position.iter().chain(&state.velocity));
    Ok(())
}

fn read_urdf(bytes: &[u8]) -> Outcome {
    let model = urdf::from_str(&text(bytes), None, &Default::default()).map_err(message)?;
    if model.nv() < 40 {
        let mut matrix = vec![0.0; model.nv() * model.nv()];
        mass_matrix(&model, &mut Data::<f64>::new(&model), &neutral(&model), &mut matrix);
        all_finite("the robot's links", &matrix);
    }
    Ok(())
}

fn read_tle(bytes: &[u8]) -> Outcome {
    let text = text(bytes);
    let (line1, line2) = text.split_once('\n').unwrap_or((&text, ""));
    let elements = [true, false].map(|check| MeanElements::from_tle(line1, line2, check));
    let [_, elements] = elements;
    state(&Sgp4::new(elements.map_err(message)?, EarthModel::Wgs72), 60.0, "the lines")
}

fn read_omm(bytes: &[u8]) -> Outcome {
    let text = text(bytes);
    let entry = |key: &str| {
        let pairs = text.lines().filter_map(|line| line.split_once('='));
        pairs.into_iter().find(|(name, _)| name.trim() == key).map(|(_, value)| value.trim().to_owned())
    };
    let elements = MeanElements::from_omm(entry).map_err(message)?;
    state(&Sgp4::new(elements, EarthModel::Wgs72), 60.0, "the entries")
}

/// A file of this process's own that holds the bytes.
fn file(name: &str, bytes: &[u8]) -> Result<PathBuf, String> {
    let path = std::env::temp_dir().join(format!("onorbit-fuzz-{}-{name}", std::process::id()));
    std::fs::write(&path, bytes).map_err(message).map(|()| path)
}

fn read_gfc(bytes: &[u8]) -> Outcome {
    let path = file("field.gfc", bytes)?;
    let field = GravityField::from_gfc(&path, None, None).map_err(message);
    std::fs::remove_file(path).map_err(message)?;
    field.map(drop)
}

fn read_earth_parameters(bytes: &[u8]) -> Outcome {
    let parameters = EarthParameters::read(&text(bytes)).map_err(message)?;
    let epoch = Epoch::parse("2024-03-01T00:00:00 UTC").map_err(message)?;
    let earth = Earth::new(epoch, &parameters).map_err(message)?;
    earth.covers(60.0).map_err(message)?;
    all_finite("the rows", earth.rot_fi(60.0).iter());
    Ok(())
}

fn read_space_weather(bytes: &[u8]) -> Outcome {
    SpaceWeatherTable::from_csv(&text(bytes)).map_err(message).map(drop)
}

fn read_epoch(bytes: &[u8]) -> Outcome {
    let epoch = Epoch::parse(&text(bytes)).map_err(message)?;
    all_finite("the epoch", &[epoch.utc_minus_tai()]);
    let earth = Earth::new(epoch, &EarthParameters::default()).map_err(message)?;
    all_finite("the epoch", earth.rot_fi(0.0).iter());
    Ok(())
}

/// Duration of its run, s.
const DURATION: f64 = 0.1;

/// A body that turns.
fn turning() -> Result<Simulation, String> {
    let inertia = Matrix3::from_diagonal(&Vector3::new(1.0, 2.0, 3.0));
    let model = Model::rigid_body(1.0, inertia).map_err(message)?;
    let (q, mut v) = (neutral(&model), vec![0.0; 6]);
    v[3] = 0.1;
    Ok(Simulation::new(Arc::new(model), q, v))
}

/// Returns the checkpoint and the rows of a run that was stopped half-way.
fn stopped() -> Result<(Checkpoint, Trace), String> {
    let mut simulation = turning()?;
    let mut stepper = simulation.start(Some(DURATION)).map_err(message)?;
    stepper.advance(DURATION / 2.0).map_err(message)?;
    Ok((stepper.checkpoint().map_err(message)?, stepper.rows(0).clone()))
}

/// Inputs that depend on the version of the engine, beside those in the corpus.
pub(crate) fn seeds(name: &str) -> Vec<Vec<u8>> {
    let made = (name == "engine_checkpoint").then(stopped).and_then(Result::ok);
    made.map(|(checkpoint, _)| checkpoint.to_json().into_bytes()).into_iter().collect()
}

fn read_checkpoint(bytes: &[u8]) -> Outcome {
    let checkpoint = Checkpoint::from_json(&text(bytes)).map_err(message)?;
    let (_, rows) = stopped()?;
    let mut simulation = turning()?;
    let mut stepper = simulation.resume(Some(DURATION), checkpoint, vec![rows]).map_err(message)?;
    stepper.advance_to(DURATION).map_err(message)?;
    stepper.finish().map_err(|failure| message(failure.error)).map(drop)
}

fn read_elements(bytes: &[u8]) -> Outcome {
    let given = numbers(bytes);
    let [size, e, inclination, raan, argument, phase, kind, ..] = given[..] else {
        return Err("too few numbers".to_owned());
    };
    let elements = Elements {
        inclination,
        raan,
        argument_of_periapsis: argument,
        phase: match kind as i64 % 3 {
            0 => Phase::MeanAnomaly(phase),
            1 => Phase::TrueAnomaly(phase),
            _ => Phase::PeriapsisTime(phase),
        },
        ..Elements::new(if kind > 3.0 { Size::SemiLatusRectum(size) } else { Size::SemiMajorAxis(size) }, e)
    };
    state(&Kepler::new(&elements).map_err(message)?, 60.0, "the elements")
}

fn read_path(bytes: &[u8]) -> Outcome {
    let given = numbers(bytes);
    let vectors = |from: usize| {
        given.chunks_exact(10).map(move |row| Vector3::from_column_slice(&row[from..from + 3])).collect()
    };
    let points = PathPoints {
        times: given.chunks_exact(10).map(|row| row[0]).collect(),
        positions: vectors(1),
        velocities: (given.len().is_multiple_of(2)).then(|| vectors(4)),
        accelerations: (given.len().is_multiple_of(4)).then(|| vectors(7)),
        attitudes: None,
    };
    let path = CustomPath::new(points, None, Ends::Coast).map_err(message)?;
    let (start, end) = path.span();
    state(&path, 0.5 * start + 0.5 * end, "the points")
}

fn read_poses(bytes: &[u8]) -> Outcome {
    let given = numbers(bytes);
    let rows: Vec<[f64; 16]> =
        given.as_chunks::<17>().0.iter().map(|row| *row.last_chunk().unwrap_or(&[0.0; 16])).collect();
    let times: Vec<f64> = given.as_chunks::<17>().0.iter().map(|row| row[0]).collect();
    let poses = Hold::from_rows(&rows).map_err(message)?;
    PoseSpline::sampled(&times, &poses, None).map_err(message).map(drop)
}

fn read_segments(bytes: &[u8]) -> Outcome {
    let given = numbers(bytes);
    let [start, length, count, ref coefficients @ ..] = given[..] else {
        return Err("too few numbers".to_owned());
    };
    let segment = || SpiceSegment {
        sign: 1.0,
        start,
        length,
        count: count as usize,
        coefficients: coefficients.to_vec(),
    };
    let kernel = SpiceKernel::new(vec![segment()], vec![segment()]).map_err(message)?;
    let epoch = Epoch::parse("2000-01-01T12:00:00 TDB").map_err(message)?;
    let earth = Earth::new(epoch, &EarthParameters::default()).map_err(message)?;
    let earth = earth.with_kernel(kernel).map_err(message)?;
    earth.covers(60.0).map_err(message)?;
    all_finite("the segments", earth.sun(60.0).map_err(message)?.iter());
    Ok(())
}

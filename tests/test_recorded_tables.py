"""Tables and ephemerides of a run: names, units, bits, and errors."""

from __future__ import annotations

import csv
from datetime import datetime
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from commands import onorbit

import onorbit_rs as oo
from onorbit_rs.common.rotations import matrix_from_quaternion
from onorbit_rs.exceptions import InputError, NotFoundError
from onorbit_rs.tables import ccsds
from onorbit_rs.tables.files import write_csv, write_parquet
from onorbit_rs.tables.labels import Names, labels

SHORT = {"simulation.duration": "20 ms"}
EPOCH = "2024-03-01T12:00:00 UTC"


@pytest.fixture(scope="module")
def reach(tmp_path_factory: pytest.TempPathFactory) -> oo.Run:
    out = tmp_path_factory.mktemp("tables") / "out"
    changes = SHORT | {"epoch": EPOCH, "simulation.record_wrenches": True}
    return oo.run("humanoid_reach", out, quiet=True, figures=False, recording=False, changes=changes)


def numbers(table: tuple[list[Any], Any], name: str) -> tuple[Any, str]:
    """Returns the column and the unit of a name."""
    labels, rows = table
    (number,) = [number for number, label in enumerate(labels) if label.name == name]
    return rows[:, number], labels[number].unit


def test_every_number_has_a_name_and_a_unit(reach: oo.Run) -> None:
    assert reach.out is not None
    table = oo.read_run(reach.out).table()
    labels, rows = table
    assert len({label.name for label in labels}) == len(labels) == rows.shape[1]
    assert all(label.unit and " or " not in label.unit for label in labels)
    trace, joint = reach.trace, reach.model.joint_names[2]
    for name, values, unit in (
        ("time", trace.time, "s"),
        ("q/position/y", trace.q[:, 1], "m"),
        ("q/quaternion/w", trace.q[:, 6], "1"),
        (f"q/joints/{joint}", trace.q[:, 9], "rad"),
        (f"v/joints/{joint}", trace.v[:, 8], "rad/s"),
        (f"tau/{joint}", trace.tau[:, 2], "N m"),
        ("momentum/angular/z", trace.momentum[:, 5], "N m s"),
        ("tool_pose/14", trace.tool_pose[:, 0, 3], "m"),
        ("tool_pose/11", trace.tool_pose[:, 0, 0], "1"),
        ("position_eci/x", trace.position_eci[:, 0], "m"),
    ):
        found, own = numbers(table, name)
        np.testing.assert_array_equal(found, values, err_msg=name)
        assert own == unit, name
    effect, body = next(iter(trace.wrenches)), reach.model.body_names[1]
    found, unit = numbers(table, f"wrench_{effect}/{body}/torque/z")
    np.testing.assert_array_equal(found, trace.wrenches[effect][:, 1, 5])
    assert unit == "N m"


def test_a_run_of_a_single_robot_has_no_names_of_systems(reach: oo.Run) -> None:
    assert reach.out is not None
    with pytest.raises(InputError, match="single robot, so there is no system 'x'; omit system"):
        oo.read_run(reach.out).columns(system="x")


def test_csv_has_all_digits(reach: oo.Run, tmp_path: Path) -> None:
    assert reach.out is not None
    done = onorbit("export", reach.out, "--csv", "a.csv", cwd=tmp_path)
    assert done.returncode == 0 and "csv: a.csv" in done.stdout
    with (tmp_path / "a.csv").open(newline="") as stream:
        header, *lines = csv.reader(stream)
    labels, rows = oo.read_run(reach.out).table()
    assert header[1] == "q/position/x [m]" and len(header) == len(labels)
    np.testing.assert_array_equal(np.array(lines, dtype=np.float64), rows)
    assert onorbit("export", reach.out, "--csv", "a.csv", cwd=tmp_path).returncode == 2, "keeps the file"


def test_parquet_has_the_bits_and_units(reach: oo.Run, tmp_path: Path) -> None:
    parquet = pytest.importorskip("pyarrow.parquet")
    assert reach.out is not None
    run = oo.read_run(reach.out)
    write_parquet(run, tmp_path / "a.parquet")
    table = parquet.read_table(tmp_path / "a.parquet")
    labels, rows = run.table()
    assert table.column_names == [label.name for label in labels]
    np.testing.assert_array_equal(np.column_stack([table[name] for name in table.column_names]), rows)
    assert table.schema.field("time").metadata[b"unit"] == b"s"


def test_pandas_and_xarray_have_names_and_units(reach: oo.Run) -> None:
    pytest.importorskip("pandas")
    pytest.importorskip("xarray")
    assert reach.out is not None
    run = oo.read_run(reach.out)
    frame, data = run.to_pandas(), run.to_xarray()
    name = f"tau/{reach.model.joint_names[0]}"
    np.testing.assert_array_equal(frame[name], reach.trace.tau[:, 0])
    np.testing.assert_array_equal(data[name], reach.trace.tau[:, 0])
    assert frame.attrs["units"][name] == data[name].attrs["units"] == "N m"
    np.testing.assert_array_equal(frame.index, reach.trace.time)
    np.testing.assert_array_equal(data["time"], reach.trace.time)


def test_a_missing_package_is_an_error_with_the_command_that_installs_it(
    reach: oo.Run, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    assert reach.out is not None
    run = oo.read_run(reach.out)
    monkeypatch.setattr("onorbit_rs.tables.extra.find_spec", lambda name: None)
    for call in (run.to_pandas, run.to_xarray, lambda: write_parquet(run, tmp_path / "a.parquet")):
        with pytest.raises(NotFoundError, match=r"pip install 'onorbit-rs\[tables\]'"):
            call()
    assert not (tmp_path / "a.parquet").exists()


def messages(file: Path) -> tuple[dict[str, str], list[list[str]]]:
    """Returns the keywords and the data lines of a CCSDS message."""
    lines = [line for line in file.read_text().splitlines() if line]
    keys = {
        key.strip(): value.strip() for key, _, value in (line.partition("=") for line in lines if "=" in line)
    }
    return keys, [line.split() for line in lines if line.startswith("20")]


def test_the_orbit_ephemeris_has_the_states_of_the_base(reach: oo.Run, tmp_path: Path) -> None:
    assert reach.out is not None
    ccsds.write_oem(oo.read_run(reach.out), tmp_path / "a.oem")
    keys, lines = messages(tmp_path / "a.oem")
    assert keys["CENTER_NAME"] == "EARTH" and keys["REF_FRAME"] == "GCRF" and keys["TIME_SYSTEM"] == "UTC"
    assert keys["START_TIME"] == "2024-03-01T12:00:00.000000000"
    assert lines[-1][0] == keys["STOP_TIME"] == "2024-03-01T12:00:00.020000000"
    states = np.array([line[1:] for line in lines], dtype=np.float64)
    np.testing.assert_array_equal(states[:, :3], reach.trace.position_eci / 1e3)
    np.testing.assert_array_equal(states[:, 3:], reach.trace.velocity_eci / 1e3)


def test_the_attitude_ephemeris_turns_inertial_to_base_components(reach: oo.Run, tmp_path: Path) -> None:
    """Checked by the matrix of CCSDS 504.0, A_ba = I + ..., against the rotation of the base."""
    assert reach.out is not None
    ccsds.write_aem(oo.read_run(reach.out), tmp_path / "a.aem")
    keys, lines = messages(tmp_path / "a.aem")
    assert keys["ATTITUDE_DIR"] == "A2B" and keys["REF_FRAME_A"] == "GCRF"
    q1, q2, q3, qc = np.array(lines[-1][1:], dtype=np.float64)
    own = np.array([
        [q1**2 - q2**2 - q3**2 + qc**2, 2 * (q1 * q2 + q3 * qc), 2 * (q1 * q3 - q2 * qc)],
        [2 * (q1 * q2 - q3 * qc), -(q1**2) + q2**2 - q3**2 + qc**2, 2 * (q2 * q3 + q1 * qc)],
        [2 * (q1 * q3 + q2 * qc), 2 * (q2 * q3 - q1 * qc), -(q1**2) - q2**2 + q3**2 + qc**2],
    ])  # fmt: skip
    rot_wb = matrix_from_quaternion(np.asarray(reach.trace.q)[-1, 3:7])
    np.testing.assert_allclose(own, rot_wb.T, atol=1e-15)


def test_an_ephemeris_requires_an_epoch_and_an_orbit(tmp_path: Path) -> None:
    def run(name: str, changes: dict[str, Any]) -> oo.RecordedRun:
        out = tmp_path / str(len(list(tmp_path.iterdir())))
        oo.run(name, out, quiet=True, figures=False, recording=False, changes=SHORT | changes)
        return oo.read_run(out)

    with pytest.raises(InputError, match="no epoch"):
        ccsds.write_oem(run("humanoid_reach", {"epoch": None}), tmp_path / "a.oem")
    with pytest.raises(InputError, match="no orbit"):
        ccsds.write_aem(run("free_tumble", {"epoch": EPOCH}), tmp_path / "a.aem")
    leap = run("humanoid_reach", {"epoch": "2016-12-31T23:59:59.99 UTC"})
    with pytest.raises(InputError, match="leap second"):
        ccsds.write_oem(leap, tmp_path / "a.oem")
    assert not list(tmp_path.glob("*.?em"))
    assert not ccsds._has_leap_second(datetime(2024, 12, 31), 1e6)


@pytest.mark.filterwarnings("ignore:event .* did not happen")
def test_a_world_requires_the_name_of_a_system(tmp_path: Path) -> None:
    oo.run(
        "capture_tumbling_target",
        tmp_path / "out",
        quiet=True,
        figures=False,
        recording=False,
        changes={"simulation.duration": "20 ms", "simulation.record_every": 1},
    )
    run = oo.read_run(tmp_path / "out")
    name = run.systems[0]
    assert repr(name)[1:-1] in repr(run)
    assert run.table(name)[0][1].name == "q/position/x"
    with pytest.raises(InputError, match="no system is given"):
        run.table()
    with pytest.raises(InputError, match="there is no system 'nobody'"):
        write_csv(run, tmp_path / "a.csv", "nobody")
    with pytest.raises(InputError, match="no output file"):
        from onorbit_rs.cli.export import export

        export(tmp_path / "out")


@pytest.mark.parametrize(
    ("width", "expected"),
    [
        (1, [("tracking_grip/0", "rad, m or N; for rates, rad/s or m/s")]),
        (2, [(f"tracking_grip/{name}", "rad or m; for rates, rad/s or m/s") for name in ("turn", "slide")]),
        (
            6,
            [(f"tracking_grip/position/{axis}", "m") for axis in "xyz"]
            + [(f"tracking_grip/attitude/{axis}", "rad") for axis in "xyz"],
        ),
    ],
)
def test_tracking_errors_have_the_units_that_their_number_shows(
    width: int, expected: list[tuple[str, str]]
) -> None:
    names = Names(["turn", "slide"], ["base", "arm", "rod"], ["rad", "m"])
    assert [(label.name, label.unit) for label in labels("tracking_grip", (width,), names)] == expected

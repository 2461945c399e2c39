"""Invalid scenario files: each error is one line with file, line and place."""

from __future__ import annotations

import pickle
from pathlib import Path

import pytest
import yaml
from commands import onorbit

from onorbit_rs import scenarios
from onorbit_rs.exceptions import NotFoundError, OnOrbitError, ReadError, ScenarioError
from onorbit_rs.scenario import Scenario, WorldScenario, load

ALIAS_BOMB = b"a: &a [1, 1, 1, 1, 1, 1, 1, 1]\n" + b"".join(
    b"%c: &%c [%s]\n" % (n + 1, n + 1, b",".join([b"*%c" % n] * 8)) for n in range(ord("a"), ord("h"))
)
REACH = scenarios.path("humanoid_reach").read_text()


def _refusal(tmp_path: Path, text: str | bytes) -> ScenarioError:
    file = tmp_path / "mine.yaml"
    file.write_bytes(text if isinstance(text, bytes) else text.encode())
    with pytest.raises(ScenarioError) as caught:
        load(file)
    error = caught.value
    assert isinstance(error, OnOrbitError) and isinstance(error, ValueError)
    assert str(error).startswith(str(file))
    assert len(str(error).splitlines()) == max(1, len(error.errors))
    assert error.file == str(file)
    return error


def _line_of(text: str, part: str) -> int:
    return text[: text.index(part)].count("\n") + 1


@pytest.mark.parametrize(
    ("right", "wrong", "path", "says"),
    [
        ("semi_major_axis", "semi_major_axix", "orbit.semi_major_axix", "did you mean 'semi_major_axis'?"),
        ("simulation:", "simulations:", "simulations", "did you mean 'simulation'?"),
        (
            "kind: gravity_gradient",
            "kind: gravity_gradent",
            "environment[0].kind",
            "did you mean 'gravity_gradient'?",
        ),
        ("kind: kepler", "kind: keplr", "orbit.kind", "'kepler'"),
        ("kind: computed_torque", "kind: magic", "controller.kind", "computed_torque"),
        ("51.6 deg", "51.6 km", "orbit.inclination", "is not an angle"),
        ("duration: 6 s", "duration: 0 s", "simulation.duration", "it must be above zero"),
        ("time_step: 1 ms", "time_step: -1 ms", "simulation.time_step", "it must be above zero"),
        ("time_step: 1 ms", "time_step: 0", "simulation.time_step", "it must be above zero"),
        ("kp: 100", "kp: [100, 100]", "controller.kp", "6 x 6"),
        ("kp: 100", "kp: .nan", "controller.kp", "not a finite number"),
        ("kp: 100", "kp: true", "controller.kp", "is not"),
        (
            "displacement: [0.5, 0, 0]",
            "displacement: [0.5, 0]",
            "reference.displacement",
            "has 2 entries; give 3",
        ),
        ("eccentricity: 0.0005", "eccentricity: -0.1", "orbit.eccentricity", "zero or above"),
        ("joints: [0.5342", "joints: ['0.5 s'", "initial.joints", "not an angle or a length"),
    ],
)
def test_a_wrong_entry_is_named_with_its_line(
    tmp_path: Path, right: str, wrong: str, path: str, says: str
) -> None:
    text = REACH.replace(right, wrong)
    error = _refusal(tmp_path, text)
    assert error.path == path
    assert error.line == _line_of(text, wrong)
    assert f":{error.line}: {path}: " in str(error)
    assert says in str(error)


@pytest.mark.parametrize(
    ("right", "wrong", "says"),
    [
        ("6778 km", "-6778 km", "contradicts eccentricity"),
        ("eccentricity: 0.0005", "eccentricity: 1.5", "contradicts eccentricity"),
        ("eccentricity: 0.0005", "eccentricity: 1", "semi_latus_rectum"),
        (
            "  mean_anomaly: 0 deg",
            "  mean_anomaly: 0\n  true_anomaly: 0",
            "give at most one of 'mean_anomaly'",
        ),
        ("  semi_major_axis: 6778 km", "", "exactly one of 'semi_major_axis'"),
        ("  mean_anomaly: 0 deg", "  velocity: [0, 1, 0]", "requires 'position' and 'velocity'"),
        ("orbit:   ", "no: 1\norbit: ", "unknown key"),
        ("tool: tool ", "", "'tool' is missing"),
        ("robot: humanoid_torso", "robot: {}", "exactly one of 'bundled'"),
        (
            "robot: humanoid_torso",
            "robot: {rigid_body: {mass: -1, inertia: [1, 1, 1]}}",
            "it must be above zero",
        ),
        ("robot: humanoid_torso", "robot: {rigid_body: {mass: 1, inertia: [1, 1]}}", "three numbers"),
        ("  duration: 6 s", "  duration: 6 s\n  duration: 7 s", "given twice"),
        ("  time_step: 1 ms", "  time_step: 7 s", "exceeds the duration"),
        ("  time_step: 1 ms", "  time_step: 1e-15", "steps"),
        ("  time_step: 1 ms", "  time_step: 1e-8", "record_every"),
        ("  time_step: 1 ms", "  record_every: 0", "0 is below the minimum, 1"),
        ("initial: ", "initial: {attitude: {quaternion_xyzw: [0, 0, 0, 1.1]}} #", "invalid YAML"),
    ],
)
def test_contradicting_scenarios_are_rejected(tmp_path: Path, right: str, wrong: str, says: str) -> None:
    assert right in REACH
    assert says in str(_refusal(tmp_path, REACH.replace(right, wrong)))


def test_a_quaternion_without_unit_norm_is_rejected() -> None:
    data = load("free_tumble").resolved()
    data["initial"]["attitude"] = {"quaternion_xyzw": [0.0, 0.0, 0.0, 1.0 + 2e-6]}
    with pytest.raises(ScenarioError, match="it must be 1 within 1e-6"):
        load(data)
    data["initial"]["attitude"] = {"quaternion_xyzw": [0.0, 0.0, 0.0, 1.0 + 5e-7]}
    assert load(data).initial.attitude is not None


@pytest.mark.parametrize(
    ("raw", "says"),
    [
        (b"\x89PNG\r\n\x1a\n\xff", "not UTF-8 text"),
        (b"a\0b", "binary"),
        (b"", "the content is empty"),
        (b"- 1\n- 2\n", "the content is a list"),
        (b"42", "the content is a number"),
        (b"orbit: [kepler", "invalid YAML"),
        (b"tab:\n\t- x: 1", "invalid YAML"),
        (b"robot: *nope", "undefined alias"),
        (b"a: !!python/object:os.system x", "invalid YAML"),
        (b"1: 2", "a key must be text"),
        (b"[" * 5000, "nested too deeply"),
        (b"a: &a [*a]", "nested too deeply"),
        (ALIAS_BOMB, "including those of aliases"),
        (b"#" * 4_000_001, "larger than"),
        (b"a: " + b"9" * 5000, "digits"),
    ],
)  # fmt: skip
def test_invalid_yaml_is_rejected(tmp_path: Path, raw: bytes, says: str) -> None:
    assert says in str(_refusal(tmp_path, raw))


def test_all_errors_are_reported_at_once(tmp_path: Path) -> None:
    error = _refusal(tmp_path, REACH.replace("51.6 deg", "51.6 m").replace("kd: 20", "kd: twenty"))
    assert error.path == "orbit.inclination"
    assert [own.path for own in error.errors] == ["orbit.inclination", "controller.kd"]
    first, second = str(error).splitlines()
    assert "orbit.inclination: " in first and "controller.kd: " in second
    done = onorbit("check", str(error.file), cwd=tmp_path)
    assert done.returncode == 2
    paths = [line.split(": ")[2] for line in done.stderr.splitlines()]
    assert paths == ["orbit.inclination", "controller.kd"]


def test_errors_of_several_systems_are_reported_at_once() -> None:
    data = load("capture_tumbling_target").resolved()
    for system in data["systems"].values():
        system["tool"], system["controller"] = None, {"kind": "computed_torque"}
        system.pop("controllers", None)
    with pytest.raises(ScenarioError) as caught:
        load(data)
    whose = {str(error.path).split(".")[1] for error in caught.value.errors}
    assert whose == set(data["systems"])


def test_missing_file_suggests_a_bundled_name(tmp_path: Path) -> None:
    with pytest.raises(NotFoundError, match="did you mean 'humanoid_reach'") as caught:
        load("humanoid_rech")
    assert isinstance(caught.value, FileNotFoundError)
    with pytest.raises(ReadError, match="is a folder"):
        load(tmp_path)


def test_error_fields_survive_pickling(tmp_path: Path) -> None:
    error = _refusal(tmp_path, REACH.replace("51.6 deg", "51.6 km"))
    copy = pickle.loads(pickle.dumps(error))
    assert (type(copy), str(copy), copy.file, copy.path, copy.line) == (
        ScenarioError, str(error), error.file, error.path, error.line,
    )  # fmt: skip


def test_numbers_follow_yaml_1_2(tmp_path: Path) -> None:
    file = tmp_path / "mine.yaml"
    file.write_text(
        REACH.replace("eccentricity: 0.0005", "eccentricity: 1e-3").replace("humanoid_reach\n", "on\n", 1)
    )
    scenario = load(file)
    assert scenario.orbit is not None and scenario.orbit.eccentricity == 1e-3
    assert scenario.name == "on"
    file.write_text(REACH.replace("duration: 6 s", "duration: 12:30"))
    with pytest.raises(ScenarioError, match=r"simulation\.duration"):
        load(file)  # YAML 1.1 would read 750


@pytest.mark.parametrize("name", scenarios.names())
def test_bundled_scenarios_resolve_to_themselves(name: str, tmp_path: Path) -> None:
    resolved = load(name).resolved()
    file = tmp_path / "resolved.yaml"
    file.write_text(yaml.safe_dump(resolved, sort_keys=False))
    again = load(file)
    assert isinstance(again, (Scenario, WorldScenario))
    assert again.resolved() == resolved


def test_a_kind_alone_is_its_mapping() -> None:
    data = load("humanoid_reach").resolved()
    data["environment"] = ["gravity_gradient"]
    assert load(data).resolved()["environment"] == [{"kind": "gravity_gradient"}]


def test_the_former_key_plant_means_engine(tmp_path: Path) -> None:
    file = tmp_path / "former.yaml"
    file.write_text("robot: humanoid_torso\nplant: native\nsimulation: {duration: 1 s}\n")
    former = load(file)
    assert former.engine == "native" and "plant" not in former.resolved()
    assert Scenario(robot="humanoid_torso", simulation={"duration": 1.0}, plant="native").engine == "native"
    file.write_text("robot: humanoid_torso\nplant: bullet\nsimulation: {duration: 1 s}\n")
    with pytest.raises(ScenarioError, match=r"former.yaml:2: engine: 'bullet' is not one of"):
        load(file)
    file.write_text("robot: humanoid_torso\nengine: native\nsimulation: {duration: 1 s}\nplant: native\n")
    with pytest.raises(ScenarioError, match=r"former.yaml:4: plant: .*former name of 'engine'"):
        load(file)

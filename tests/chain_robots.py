"""URDF texts of serial-chain robots."""

from __future__ import annotations

INERTIAL = (
    '<inertial><origin xyz="0 0 0.1"/><mass value="{mass}"/>'
    '<inertia ixx="{i}" iyy="{i}" izz="{i}" ixy="0" ixz="0" iyz="0"/></inertial>'
)


def arm(
    joints: list[tuple[str, str, str]],
    *,
    limits: str = 'lower="-2" upper="2"',
    names: str = "",
    base: tuple[float, float] = (100, 20),
) -> str:
    """Returns the URDF of a chain of (name, type, axis) joints on a base of 100 kg, with links of 0.2 m."""
    parts = [f'<link name="base">{INERTIAL.format(mass=base[0], i=base[1])}</link>']
    parent = "base"
    for index, (name, kind, axis) in enumerate(joints):
        last = index == len(joints) - 1
        link = names if last and names else f"link_{index}"
        limit = f'<limit {limits} effort="100" velocity="1"/>' if kind != "continuous" else ""
        parts += [
            f'<link name="{link}">{INERTIAL.format(mass=3, i=0.05)}</link>',
            f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{link}"/>'
            f'<origin xyz="0 0 0.2"/><axis xyz="{axis}"/>{limit}</joint>',
        ]
        parent = link
    return f'<robot name="r">{"".join(parts)}</robot>'


SEVEN = [(f"j{index}", "revolute", "0 0 1" if index % 2 else "0 1 0") for index in range(7)]

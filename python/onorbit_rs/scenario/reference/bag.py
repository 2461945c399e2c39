"""Joint reference from a ROS bag."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from decimal import Decimal
from typing import TYPE_CHECKING, Literal

import numpy as np

from onorbit_rs import _core
from onorbit_rs.common.suggestions import did_you_mean, nearest
from onorbit_rs.exceptions import FrameError, ReadError
from onorbit_rs.scenario.bag_samples import Sample, read_samples
from onorbit_rs.scenario.fields import FilePath, Time
from onorbit_rs.scenario.part import Part

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs.scenario.reference.start import Start

    Floats = NDArray[np.float64]


class BagReference(Part):
    """Recorded motion from a bag of ROS 1 or ROS 2; joints without a recording are held."""

    kind: Literal["bag"] = "bag"
    file: FilePath
    """MCAP file, SQLite file or folder of rosbag2, or bag of ROS 1, relative to the scenario."""
    topic: str | None = None
    """Topic of JointState messages, or of one JointTrajectory; default: the only one in the bag."""
    joints: dict[str, str] | None = None
    """Mapping from joints in the bag to the joints of the robot that follow them. Default: every joint
    follows the joint of the same name."""
    start: Time = 0.0
    """Time, s, from the start of the reference, at which the first message applies."""

    def build(self, at: Start) -> _core.JointSampled:
        """Return the engine's reference object, for the joints of the group."""
        path = at.folder / self.file
        topic, samples = read_samples(path, self.topic)
        try:
            followed = self._followed(samples, at)
            chosen = _distinct(_with(samples, list(followed)))
        except _BadRecordingError as error:
            message = f"{path}: topic {topic}: {error}"
            raise ReadError(message, path=str(path), kind="bag") from None
        time = self.start + 1e-9 * np.array([sample.time for sample in chosen], dtype=np.float64)
        positions = np.tile(at.of_group(at.joint_positions), (len(chosen), 1))
        rates = np.zeros_like(positions) if all(len(sample.rates) for sample in chosen) else None
        for name, joint in followed.items():
            column, places = at.group.index(joint), [sample.names.index(name) for sample in chosen]
            positions[:, column] = [row.positions[k] for row, k in zip(chosen, places, strict=True)]
            if rates is not None:
                rates[:, column] = [row.rates[k] for row, k in zip(chosen, places, strict=True)]
        return _core.JointSampled(time, positions, rates=rates)

    def _followed(self, samples: Sequence[Sample], at: Start) -> Mapping[str, str]:
        """Return the joints of the group that follow the bag, by the names of the joints in the bag."""
        recorded = list(dict.fromkeys(name for sample in samples for name in sample.names))
        robot = list(at.model.joint_names)
        for name in self.joints or ():
            if name not in recorded:
                raise _BadRecordingError(
                    f"the messages contain no joint {name!r}{did_you_mean(name, recorded)}"
                )
        wanted = self.joints or {name: name for name in recorded}
        for joint in wanted.values():
            if joint not in robot:
                raise FrameError(
                    f"the robot has no joint {joint!r}{did_you_mean(joint, robot)} ('joints' maps the joints "
                    "of the bag to those of the robot)",
                    name=joint, kind="joint", known=robot, suggestion=nearest(joint, robot),
                )  # fmt: skip
        found = {name: joint for name, joint in wanted.items() if joint in at.group}
        if not found:
            group, names = ", ".join(at.group), ", ".join(wanted.values()) or "none"
            raise _BadRecordingError(
                f"the joints that would follow the messages ({names}) are not among the controlled joints "
                f"({group}); use 'joints' to map joints of the bag to controlled joints"
            )
        return found


class _BadRecordingError(ValueError):
    """Raised for a recording that cannot be used as a reference."""


def _with(samples: Sequence[Sample], names: list[str]) -> list[Sample]:
    """Return the samples that contain all named joints; raise an error if a sample contains only some."""
    found = []
    for sample in samples:
        missing = [name for name in names if name not in sample.names]
        if not missing:
            _check_lengths(sample)
            found.append(sample)
        elif len(missing) < len(names):
            raise _BadRecordingError(
                f"{sample.origin} lacks {', '.join(missing)}; each message must contain all followed joints "
                "or none; list in 'joints' only joints that are always recorded together"
            )
    return found


def _check_lengths(sample: Sample) -> None:
    """Raise an error if the numbers of names and values in a sample differ, or a name occurs twice."""
    joints = len(sample.names)
    if doubled := [name for name, times in Counter(sample.names).items() if times > 1]:
        raise _BadRecordingError(
            f"{sample.origin} names {', '.join(doubled)} more than once; name each joint once"
        )
    if len(sample.positions) != joints or len(sample.rates) not in (0, joints):
        raise _BadRecordingError(
            f"the numbers of names, positions and velocities in {sample.origin} are {joints}, "
            f"{len(sample.positions)} and {len(sample.rates)}; give one position per name, and one velocity "
            "per name or none"
        )


def _distinct(samples: list[Sample]) -> list[Sample]:
    """Return samples with increasing times; of samples with the same time and positions, the last is kept.

    Raises a _BadRecordingError if times decrease or fewer than two samples remain.
    """
    found: list[Sample] = []
    for sample in samples:
        if found and sample.time <= found[-1].time:
            is_same = sample.time == found[-1].time and np.array_equal(sample.positions, found[-1].positions)
            if not is_same:
                raise _BadRecordingError(
                    f"times must increase, but {sample.origin} is at {_seconds(sample.time)} s, after "
                    f"{_seconds(found[-1].time)} s; sort the recording by time, or record it again"
                )
            found.pop()
        found.append(sample)
    if len(found) < 2:
        raise _BadRecordingError(
            "a motion requires at least two messages, or points of a trajectory, that contain the followed "
            f"joints and have different times; found: {len(found)}"
        )
    return found


def _seconds(time: int) -> str:
    """Return a time, ns, in seconds without rounding."""
    return f"{Decimal(time).scaleb(-9).normalize():f}"

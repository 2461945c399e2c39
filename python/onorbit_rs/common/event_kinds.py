"""Kinds of the events of a run."""

from __future__ import annotations

OF_CONTACT = frozenset({"touch_down", "lift_off"})
"""Kinds of contact events. Contact forces change velocities gradually, unlike captures and releases."""

OF_BRAKE = frozenset({"engage", "disengage"})
"""Kinds of brake events, each of which concerns one system."""

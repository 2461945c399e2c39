"""Converts files of other simulators to scenarios."""

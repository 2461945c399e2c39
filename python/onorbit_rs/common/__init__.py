"""Helpers shared by the other packages.

Among them are helpers for files, numbers, units, text, rotations, the layout of q and v, and
progress display.
"""

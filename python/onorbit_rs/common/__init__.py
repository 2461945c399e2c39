"""Helpers without knowledge of robots or simulations: files, numbers, text and rotations."""

"""Runs a scenario: progress, live view, checkpoints, and the results written at the end."""

"""A simulator for free-floating robots in orbit."""

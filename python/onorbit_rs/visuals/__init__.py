"""Geometry that the viewer and the figures draw: the robot's shapes and meshes, the Earth's ellipsoid."""

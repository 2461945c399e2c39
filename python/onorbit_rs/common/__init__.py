"""Functions shared by the other packages: files, numbers, units, text, rotations, indices, progress."""

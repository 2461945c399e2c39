"""Readers of orbit and ephemeris data: OMM files, ``Satrec`` objects, SPICE kernels."""

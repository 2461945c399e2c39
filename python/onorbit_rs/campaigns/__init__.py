"""Campaigns: many runs of one scenario with dispersed values, on threads, processes or a Dask cluster.

``document`` reads a campaign from YAML, ``expand`` finds the entries that its paths name, ``draws`` draws the
values of a case, ``plan`` combines them, ``cases`` runs a case, an engine runs many, ``storage`` keeps the
results, and ``run`` is the entry point.
"""

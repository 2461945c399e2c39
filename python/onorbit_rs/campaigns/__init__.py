"""Campaigns: many runs of one scenario with dispersed values, on threads, processes or a Dask cluster.

``document`` reads a campaign from YAML, ``expand`` finds the entries that its paths name, ``draws`` draws the
values of a case, ``plan`` combines them, ``cases`` runs one case, ``on_threads``, ``on_processes`` and
``on_dask`` run many, ``storage`` keeps the results, and ``run`` is the entry point.
"""

"""Deliberately changed output folders of runs."""

from __future__ import annotations

from pathlib import Path

from onorbit_rs.output.manifest import FIGURES, MANIFEST, RESULTS, Entry, Manifest


def listed(folder: Path) -> Path:
    """Writes a manifest of the folder's current files, as if a run had written them; returns the folder."""
    names = [name for name in RESULTS if (folder / name).is_file()]
    names += [f"{FIGURES}/{file.name}" for file in folder.glob(f"{FIGURES}/*.p[nd][gf]")]
    manifest = Manifest({name: Entry.of(folder / name) for name in names})
    (folder / MANIFEST).write_bytes(manifest.as_bytes())
    return folder

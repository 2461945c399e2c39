"""Division of closed meshes into convex pieces, with a cache on disk."""

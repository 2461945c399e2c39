"""Tools around the simulator: new scenarios, conversion, comparison and validation."""

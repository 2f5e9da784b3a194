"""What the world looks like: scenarios, sets of them in YAML, simulated draws, recorded plots."""

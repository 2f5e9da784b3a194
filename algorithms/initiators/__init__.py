"""The initiators: one module each, found by themselves; see `registry`."""

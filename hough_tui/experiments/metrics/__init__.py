"""Metrics: each measured quantity as one object, and the one list of them."""

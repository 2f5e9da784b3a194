"""Experiments: plan, chunks of trials, tallies, store."""

"""Scoring: the tracks of a chunk of trials against the truth."""

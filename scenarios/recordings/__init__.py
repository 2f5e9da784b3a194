"""Recorded plots: one file a format."""

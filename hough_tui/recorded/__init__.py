"""Recorded plots and points: initiation and clustering of them."""

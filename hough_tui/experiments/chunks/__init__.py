"""Chunks: consecutive trials of a cell, drawn, worked on and scored together."""

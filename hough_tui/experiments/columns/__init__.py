"""Columns: what each trial of a cell gave, by a declared schema."""

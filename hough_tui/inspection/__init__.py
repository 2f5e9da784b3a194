"""Inspection: one trial looked at closely."""

"""Engines: what runs the chunks of a plan."""

"""Kinematics in two and three dimensions: noise of plots, states fitted to plots, filters."""

"""Initiation in space: pairs of plots within reach, votes in planes, tracks of constant velocity."""

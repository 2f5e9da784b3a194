"""Quantisation: advice, what it is designed for, its forecast, and putting it into a set."""

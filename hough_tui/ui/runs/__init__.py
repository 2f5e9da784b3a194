"""Runs as the application knows them: under way, shown, kept."""

"""The terminal application; nothing outside this package imports textual."""

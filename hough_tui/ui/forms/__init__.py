"""Forms worked out from declared models: nothing about a field is said here a second time."""

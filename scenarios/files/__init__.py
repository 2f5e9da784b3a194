"""Files: sets as YAML, tables as CSV, atomic replacement; errors name file, line and field."""

"""What results look like: tables, charts and progress for a terminal, texts for files."""

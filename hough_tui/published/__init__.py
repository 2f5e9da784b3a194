"""Published tables, and how they compare with what is measured here."""

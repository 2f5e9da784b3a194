"""Track initiation as numerics: arrays in, arrays out; no files, no screens."""

"""Drawing in characters: arrays in, segments of text out; no widgets."""

"""Machine code of the kernels, kept on disk from one process to the next."""

"""The Hough transform of lines: geometry, grid, votes, peaks."""

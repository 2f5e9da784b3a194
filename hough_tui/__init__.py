"""hough-tui: design and judge track initiation in a terminal."""

from importlib.metadata import PackageNotFoundError, version

try:
    __version__ = version("hough-tui")
except PackageNotFoundError:  # run from a source tree that was never installed
    __version__ = "0+unknown"

"""Entry point; the end of the process is watched over before anything else is loaded."""

from __future__ import annotations

from hough_tui.ending import watched


def main() -> None:
    """Run the command line."""
    with watched():
        from hough_tui.cli import main as command_line

        command_line()


if __name__ == "__main__":
    main()

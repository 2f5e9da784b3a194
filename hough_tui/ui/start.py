"""Start of the application in its terminal, and its end."""

from __future__ import annotations

from hough_tui import ending
from hough_tui.ui import interpreter
from hough_tui.ui.app import HoughApp
from hough_tui.ui.config import read_config
from hough_tui.ui.terminal import Terminal, draw_in_any_encoding


def run(set_name: str | None) -> int:
    """Open the application and return its exit status.

    Raises
    ------
    RequestError
        Where the settings are wrong.
    """
    interpreter.prepare()
    draw_in_any_encoding()
    app = HoughApp(set_name, read_config())
    terminal = Terminal()
    ending.hand_over(app.end, terminal.restore, terminal.descriptor)
    app.run()
    if app.wrong_setting is not None:
        raise app.wrong_setting
    if not app.is_leaving:
        # It broke down, maybe since its terminal has gone.
        app.keep_aside()
    return ending.requested_status() or app.return_code or 0

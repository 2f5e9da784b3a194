"""The interpreter as the application sets it; in a process of its own, which it ends."""

import subprocess
import sys

PROGRAM = """
import atexit, gc, sys, threading, time
from hough_tui.ui import interpreter

interpreter.prepare()
assert not gc.isenabled() and gc.get_freeze_count() == 0
assert sys.getswitchinterval() == interpreter.SWITCH_INTERVAL
interpreter.settle()
assert gc.isenabled() and gc.get_freeze_count() > 0
atexit.register(print, "taken apart")
threading.Thread(target=time.sleep, args=(3600,)).start()
print("said", end="")
interpreter.leave(7)
"""


def test_the_process_ends_with_what_was_said_and_waits_for_nothing() -> None:
    ended = subprocess.run(
        [sys.executable, "-c", PROGRAM], capture_output=True, text=True, timeout=120, check=False
    )
    assert (ended.returncode, ended.stdout, ended.stderr) == (7, "said", "")

"""The worker: runs commands of hough-tui one after the other in one process, each with its own output files.

It says that it is ready, reads lines of JSON, the arguments, from standard input, and answers each on
standard output with a line of JSON: exit status, seconds, and the peak of memory in bytes. The output of a
command is in the files `out` and `err` of the working directory, which outlive a crash.
"""

from __future__ import annotations

import contextlib
import faulthandler
import importlib
import json
import os
import resource
import shutil
import signal
import sys
import threading
import time
import traceback
import warnings
from pathlib import Path
from typing import Any

MOST_ADDRESSES = 12 * 2**30
"""What a worker may map at all, so that no case exhausts the machine; the limit of a case is much lower."""


def main() -> None:
    """Serve commands until standard input ends."""
    requests, answers = os.dup(0), os.dup(1)
    os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
    resource.setrlimit(resource.RLIMIT_AS, (MOST_ADDRESSES, MOST_ADDRESSES))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    threading.Thread(target=end_with, args=(os.getppid(),), daemon=True).start()
    module, _, function = sys.argv[1].partition(":")
    command_line = getattr(importlib.import_module(module), function)
    # As `python -W always` does: else the command line keeps warnings of libraries from its user.
    sys.warnoptions.append("always")
    # The default shows a warning once a place, that is to the first case alone.
    for category in (RuntimeWarning, UserWarning, SyntaxWarning, FutureWarning):
        warnings.simplefilter("always", category)
    os.write(answers, b"ready\n")
    with os.fdopen(requests) as lines:
        for line in lines:
            answer = run(command_line, json.loads(line))
            os.write(answers, json.dumps(answer).encode() + b"\n")


def end_with(parent: int) -> None:
    """End this process once its parent has ended."""
    while os.getppid() == parent:
        time.sleep(0.5)
    os._exit(1)


def run(command_line: Any, arguments: list[str]) -> dict[str, Any]:
    """Run a command and return how it went."""
    for number, name in ((1, "out"), (2, "err")):
        file = os.open(name, os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
        os.dup2(file, number)
        os.close(file)
    sys.stdout = open(1, "w", encoding="utf-8", closefd=False)  # noqa: SIM115
    sys.stderr = open(2, "w", encoding="utf-8", errors="backslashreplace", buffering=1, closefd=False)  # noqa: SIM115
    faulthandler.enable(2)
    sys.argv = ["hough-tui", *arguments]
    shutil.rmtree(os.environ["XDG_DATA_HOME"], ignore_errors=True)
    reset_peak()
    began, used = time.monotonic(), time.process_time()
    status = 0
    try:
        command_line()
        sys.stdout.flush()
    except SystemExit as ending:
        status = ending.code if isinstance(ending.code, int) else int(ending.code is not None)
    except BaseException:
        # As the interpreter itself would end.
        traceback.print_exc()
        status = 1
    finally:
        signal.signal(signal.SIGINT, signal.default_int_handler)
    seconds, processor = time.monotonic() - began, time.process_time() - used
    with contextlib.suppress(OSError):
        sys.stdout.flush()
    return {"status": status, "seconds": seconds, "processor": processor, "peak": peak()}


def reset_peak() -> None:
    """Begin to measure the peak of memory anew, where the system can."""
    with contextlib.suppress(OSError):
        Path("/proc/self/clear_refs").write_text("5")


def peak() -> int:
    """Return the peak of memory since `reset_peak`, in bytes."""
    try:
        text = Path("/proc/self/status").read_text()
    except OSError:
        return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024
    return int(text.partition("VmHWM:")[2].split()[0]) * 1024


if __name__ == "__main__":
    main()

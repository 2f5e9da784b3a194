"""What a batch leaves behind when it is ended from outside."""

import os
import signal
import subprocess
import sys
import time

import pytest

from hough_tui.experiments.stores.folder import FolderStore

BATCH = [sys.executable, "-c", "from hough_tui.cli import main; main()", "batch", "course-report"]


@pytest.mark.parametrize(
    ("number", "status"), [(signal.SIGTERM, 143), (signal.SIGHUP, 129), (signal.SIGINT, 130)]
)
def test_finished_trials_survive_an_ending_signal(number, status, tmp_path):
    given = {**os.environ, "XDG_DATA_HOME": str(tmp_path)}
    process = subprocess.Popen(
        [*BATCH, "--experiment", "modified", "--trials", "3000000"],
        env=given,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        # What runs in the background may have been started deaf to it.
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler),
    )
    # Each thread's time stands in the process's own: it is at work once that goes on.
    deadline = time.monotonic() + 60
    while _processor_seconds(process.pid) < 3.0 and time.monotonic() < deadline:
        time.sleep(0.1)
    process.send_signal(number)
    try:
        out, err = process.communicate(timeout=60)
    finally:
        process.kill()
    assert process.returncode == status
    assert "Traceback" not in err
    assert "finished trials only" in err
    assert out == ""
    store = FolderStore(tmp_path / "hough-tui" / "runs")
    (name,) = store.names()
    document = store.document(name)
    assert document["complete"] is False
    assert 0 < document["rows"][0]["trials"] < 3_000_000


def _processor_seconds(process: int) -> float:
    with open(f"/proc/{process}/stat") as file:
        fields = file.read().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

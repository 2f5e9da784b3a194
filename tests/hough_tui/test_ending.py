"""How a command ends when it is asked to from outside, whatever it is at, and what it leaves behind."""

import contextlib
import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from hough_tui.experiments.stores.folder import FolderStore

PATIENCE = 20.0
"""Seconds until an end is given up; what these commands are at takes longer, and some of it for ever."""

COMMAND = "from hough_tui.__main__ import main; main()"

# The command, with a thread that writes a file as soon as a trial is done.
SIGNALLING = f"""
import pathlib, threading, time
from hough_tui.experiments.engines import threads as engine

class Signalling(engine.Job):
    def __init__(self, *arguments):
        super().__init__(*arguments)
        def watch():
            while not self.progress.done.any():
                time.sleep(0.01)
            pathlib.Path("done").touch()
        threading.Thread(target=watch, daemon=True).start()

engine.Job = Signalling
{COMMAND}
"""


@pytest.fixture
def start(tmp_path, long_set):
    """Start a Python program on a command line; it is killed in the end."""
    with contextlib.ExitStack() as stack:

        def run(
            program: str, *arguments: str, stderr: int = subprocess.PIPE, before=hear_interrupts, **variables
        ) -> subprocess.Popen:
            process = subprocess.Popen(
                [sys.executable, "-c", program, *arguments],
                stdout=subprocess.PIPE,
                stderr=stderr,
                text=True,
                cwd=tmp_path,
                env={**os.environ, "XDG_DATA_HOME": str(tmp_path / "data"), **variables},
                preexec_fn=before,
            )
            stack.enter_context(process)
            stack.callback(process.kill)
            return process

        yield run


def hear_interrupts() -> None:
    # What runs in the background may have been started deaf to them.
    signal.signal(signal.SIGINT, signal.default_int_handler)


def until(condition, process: subprocess.Popen) -> None:
    deadline = time.monotonic() + 120
    while not condition():
        assert process.poll() is None, process.communicate()
        assert time.monotonic() < deadline
        time.sleep(0.02)


@pytest.mark.parametrize(
    ("number", "status", "words"),
    [
        (signal.SIGINT, 130, "interrupted"),
        (signal.SIGTERM, 143, "terminated"),
        (signal.SIGHUP, 129, "hung up"),
    ],
)
def test_finished_trials_outlive_an_end_in_a_kernel(number, status, words, start, tmp_path):
    process = start(SIGNALLING, "batch", "long.yaml")
    until((tmp_path / "done").exists, process)
    process.send_signal(number)
    out, err = process.communicate(timeout=PATIENCE)
    assert process.returncode == status
    assert out == ""
    lines = [line for line in err.splitlines() if "compiling" not in line]
    assert lines[0].endswith("(the finished trials only)")
    assert lines[1:] == [f"hough-tui: {words}"]
    store = FolderStore(tmp_path / "data" / "hough-tui" / "runs")
    (name,) = store.names()
    document = store.document(name)
    assert document["complete"] is False
    assert [row["trials"] for row in document["rows"]] == [1]


def test_a_reader_that_stalls_does_not_hold_the_end_up(start, tmp_path):
    reading, writing = os.pipe()
    os.set_blocking(writing, False)
    with contextlib.suppress(BlockingIOError):
        while os.write(writing, b" " * 4096):
            continue
    os.set_blocking(writing, True)
    process = start(SIGNALLING, "batch", "long.yaml", stderr=writing)
    os.close(writing)
    until((tmp_path / "done").exists, process)
    process.send_signal(signal.SIGTERM)
    assert process.wait(PATIENCE) == 143
    os.close(reading)


def test_an_interrupt_reaches_a_kernel_of_the_main_thread(start, long_set, tmp_path):
    rows = "\n".join(f"{plot % 3},{plot * 7 % 100},{plot * 13 % 100}" for plot in range(600))
    (tmp_path / "plots.csv").write_text(f"scan,x,y\n{rows}\n")
    parameters = re.search("initiator: sequential, (.*)", long_set.read_text()).group(1)
    (tmp_path / "endless.yaml").write_text(f"{{{parameters}")
    process = start(
        COMMAND, "initiate", "plots.csv", "-i", "sequential", "--config", "endless.yaml", "--json"
    )
    until(lambda: processor_seconds(process.pid) > 3.0, process)
    process.send_signal(signal.SIGINT)
    out, err = process.communicate(timeout=PATIENCE)
    assert (process.returncode, out) == (130, "")
    assert err.splitlines()[-1] == "hough-tui: interrupted"
    assert "Traceback" not in err


def test_a_termination_reaches_a_run_that_compiles(start, tmp_path):
    process = start(COMMAND, "batch", "long.yaml", XDG_CACHE_HOME=str(tmp_path / "cold"))
    until(lambda: any((tmp_path / "cold").rglob("*.nbc")), process)
    process.send_signal(signal.SIGTERM)
    _, err = process.communicate(timeout=PATIENCE)
    assert process.returncode == 143
    assert err.splitlines()[1:] == ["hough-tui: terminated"]


def test_a_hangup_that_nohup_ignores_stays_ignored(start, long_set, tmp_path):
    short = long_set.read_text().replace("trials: 20", "initiators: [standard], trials: 300")
    (tmp_path / "short.yaml").write_text(short)
    process = start(
        SIGNALLING,
        *("batch", "short.yaml"),
        before=lambda: signal.signal(signal.SIGHUP, signal.SIG_IGN),
    )
    until((tmp_path / "done").exists, process)
    process.send_signal(signal.SIGHUP)
    assert process.wait(120) == 0


PLUG_IN = """
import os, pathlib, time
from hough_tui import plugin

class Endless(plugin.Initiator):
    name = "endless"
    summary = "never comes back"
    parameters = plugin.Parameters

    def initiate(self, plots, context, parameters):
        (pathlib.Path("workers") / str(os.getpid())).touch()
        while True:
            time.sleep(0.1)
"""


def test_worker_processes_end_with_the_command(start, long_set, tmp_path):
    site = tmp_path / "site"
    (site / "endless-1.0.dist-info").mkdir(parents=True)
    (site / "endless.py").write_text(PLUG_IN)
    (site / "endless-1.0.dist-info" / "METADATA").write_text(
        "Metadata-Version: 2.1\nName: endless\nVersion: 1.0\n"
    )
    (site / "endless-1.0.dist-info" / "entry_points.txt").write_text(
        "[hough_tui.initiators]\nendless = endless:Endless\n"
    )
    plain = re.sub("{name: endless.*", "{name: endless}", long_set.read_text())
    (tmp_path / "plain.yaml").write_text(plain)
    workers = tmp_path / "workers"
    workers.mkdir()
    path = os.pathsep.join([str(site), str(Path(__file__).parents[2])])
    process = start(COMMAND, "batch", "plain.yaml", "--no-keep", PYTHONPATH=path)
    until(lambda: any(workers.iterdir()), process)
    process.send_signal(signal.SIGTERM)
    _, err = process.communicate(timeout=PATIENCE)
    assert process.returncode == 143, err
    assert all(is_gone(int(worker.name)) for worker in workers.iterdir())


def is_gone(process: int) -> bool:
    """Whether a process has ended, maybe with nobody to take its status."""
    deadline = time.monotonic() + PATIENCE
    while time.monotonic() < deadline:
        try:
            if Path(f"/proc/{process}/stat").read_text().rsplit(")", 1)[1].split()[0] == "Z":
                return True
        except FileNotFoundError:
            return True
        time.sleep(0.02)
    return False


def processor_seconds(process: int) -> float:
    """Return the time of all threads of a process: it is at work once that goes on."""
    fields = Path(f"/proc/{process}/stat").read_text().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

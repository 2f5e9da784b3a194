"""Settings that all tests share."""

import os
import subprocess
import sys
import tempfile
from pathlib import Path

import pytest
from hypothesis import settings

# The first call of a kernel compiles it, which no deadline allows for.
settings.register_profile("kernels", deadline=None)
settings.load_profile("kernels")

# No test may write among the user's own runs, in whatever process it works.
os.environ["XDG_DATA_HOME"] = tempfile.mkdtemp(prefix="hough-tui-data-")


PARTS = ("warm_plane()", "warm_space(); warming.warm_clustering()")
"""What has the kernels compiled, in two parts that take about as long."""


def pytest_sessionstart(session: pytest.Session) -> None:
    """Have two processes compile the kernels, one half each, before each worker would compile them all."""
    from algorithms.kernel_cache.folder import is_cold

    is_worker = hasattr(session.config, "workerinput")
    if not is_worker and session.config.getoption("numprocesses", None) and is_cold():
        program = "from hough_tui.ui import warming; warming."
        # What fails here fails again in the tests, which tell why.
        for process in [subprocess.Popen([sys.executable, "-c", program + part]) for part in PARTS]:
            process.wait()


@pytest.fixture
def data_home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A data directory that holds no runs yet."""
    home = tmp_path / "data"
    monkeypatch.setenv("XDG_DATA_HOME", str(home))
    return home

"""Settings that all tests share."""

import os
import tempfile
from pathlib import Path

import pytest
from hypothesis import settings

# The first call of a kernel compiles it, which no deadline allows for.
settings.register_profile("kernels", deadline=None)
settings.load_profile("kernels")

# No test may write among the user's own runs, in whatever process it works.
os.environ["XDG_DATA_HOME"] = tempfile.mkdtemp(prefix="hough-tui-data-")


@pytest.fixture
def data_home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A data directory that holds no runs yet."""
    home = tmp_path / "data"
    monkeypatch.setenv("XDG_DATA_HOME", str(home))
    return home

"""Commands where compiled kernels cannot be kept: it is said once, and the work is done."""

import os

import pytest

from algorithms import notices
from algorithms.kernel_cache.folder import kernel_folder

PLOTS = "scan,time,x,y\n" + "".join(f"{scan},{4 * scan},{scan},{5 + 0.5 * scan}\n" for scan in range(5))


@pytest.fixture
def cache(tmp_path, monkeypatch):
    cache = tmp_path / "cache"
    cache.mkdir()
    monkeypatch.setenv("XDG_CACHE_HOME", str(cache))
    monkeypatch.setattr(notices, "_notices", [])
    kernel_folder.cache_clear()
    yield cache
    kernel_folder.cache_clear()


@pytest.mark.parametrize("is_open", [True, False])
def test_a_cache_of_no_use_is_said_once(cli, cache, tmp_path, is_open):
    if is_open:
        cache.chmod(0o777)
    else:
        cache.rmdir()
        cache.touch()
    (tmp_path / "plots.csv").write_text(PLOTS)
    status, out, err = cli("initiate", tmp_path / "plots.csv", "-i", "modified")
    assert status == 0
    assert "3 tracks" in out
    told = [line for line in err.splitlines() if "kernels" in line]
    assert len(told) == 1
    assert told[0].startswith("hough-tui: the compiled kernels ")
    assert ("others can write" if is_open else "Not a directory") in told[0]
    assert not cache.is_dir() or os.listdir(cache) == []

"""Files of compiled kernels: nothing that is damaged or a stranger's is used, and no disk stops the work."""

import os
import stat
import time

import pytest

from algorithms import notices
from algorithms.kernel_cache import folder as kernel_folders
from algorithms.kernel_cache.folder import KernelFolder, kernel_folder
from algorithms.kernel_cache.trust import objection

BODY = bytes(range(256)) * 40


@pytest.fixture
def said(monkeypatch):
    """Return the notices of this test alone."""
    messages = []
    monkeypatch.setattr(notices, "_notices", [])
    monkeypatch.setattr(notices, "_listeners", [messages.append])
    return messages


@pytest.fixture
def place(tmp_path):
    return tmp_path / "cache" / "hough-tui" / "kernels-algorithms-0123456789abcdef"


@pytest.fixture
def kept(place):
    KernelFolder(place).write("a", BODY)
    return place / "a.nbc"


def flip(file, position):
    body = bytearray(file.read_bytes())
    body[position] ^= 1
    file.write_bytes(body)


def into_folder(file):
    file.unlink()
    (file / "inside").mkdir(parents=True)


def into_link(file):
    file.rename(file.with_suffix(".elsewhere"))
    file.symlink_to(file.with_suffix(".elsewhere"))


def into_pipe(file):
    file.unlink()
    os.mkfifo(file)


DAMAGES = {
    "empty": lambda file: file.write_bytes(b""),
    "cut": lambda file: os.truncate(file, file.stat().st_size // 2),
    "longer": lambda file: file.write_bytes(file.read_bytes() + b"\0"),
    "zeros": lambda file: file.write_bytes(bytes(file.stat().st_size)),
    "flipped head": lambda file: flip(file, 3),
    "flipped checksum": lambda file: flip(file, 25),
    "flipped body": lambda file: flip(file, -7),
    "folder": into_folder,
    "link": into_link,
    "pipe": into_pipe,
    "others can write": lambda file: file.chmod(0o666),
}


def test_what_is_kept_is_read_in_another_process(place, kept, said):
    assert KernelFolder(place).read("a") == BODY
    assert KernelFolder(place).read("b") is None
    assert said == []
    assert [path.name for path in place.iterdir()] == ["a.nbc"]


@pytest.mark.parametrize("damage", DAMAGES.values(), ids=DAMAGES)
def test_a_damaged_file_is_reported_and_replaced(place, kept, said, damage):
    damage(kept)
    folder = KernelFolder(place)
    assert folder.read("a") is None
    assert len(said) == 1
    assert "are damaged (a.nbc: " in said[0]
    assert str(place) in said[0]
    folder.write("a", BODY)
    assert KernelFolder(place).read("a") == BODY
    assert len(said) == 1


def test_damage_and_a_folder_of_no_use_are_said_once(place, kept, said):
    KernelFolder(place).write("b", BODY)
    for name in "ab":
        (place / f"{name}.nbc").write_bytes(b"")
    folder = KernelFolder(place)
    assert [folder.read(name) for name in "ab"] == [None, None]
    assert len(said) == 1
    place.parent.chmod(0o777)
    for further in (place, place.with_name("kernels-scenarios-0123456789abcdef")):
        assert KernelFolder(further).read("a") is None
    assert len(said) == 2


@pytest.mark.parametrize("position", range(0, len(BODY), 997))
def test_any_flipped_bit_is_noticed(place, kept, said, position):
    flip(kept, 51 + position)
    assert KernelFolder(place).read("a") is None


def test_folders_are_made_for_their_user_alone(place):
    before = os.umask(0)
    try:
        KernelFolder(place).write("a", BODY)
    finally:
        os.umask(before)
    for folder in (place, place.parent, place.parent.parent):
        assert stat.S_IMODE(folder.stat().st_mode) == 0o700
    assert stat.S_IMODE((place / "a.nbc").stat().st_mode) == 0o600


@pytest.mark.parametrize("level", range(3))
@pytest.mark.parametrize("mode", [0o777, 0o702])
def test_a_folder_that_others_can_write_is_not_used(place, kept, said, level, mode):
    open_one = [place, *place.parents][level]
    open_one.chmod(mode)
    folder = KernelFolder(place)
    assert folder.is_empty
    assert folder.read("a") is None
    folder.write("b", BODY)
    assert not folder.can_keep
    assert not (place / "b.nbc").exists()
    assert len(said) == 1
    assert f"others can write {open_one} " in said[0]
    assert "chmod go-w it, or set XDG_CACHE_HOME to a folder of your own" in said[0]
    open_one.chmod(0o755)
    assert KernelFolder(place).read("a") == BODY


def test_a_cache_where_others_can_only_add_is_used(place, kept, said):
    place.parents[1].chmod(0o1777)
    assert KernelFolder(place).read("a") == BODY
    place.parents[0].chmod(0o1777)
    assert KernelFolder(place).read("a") is None


def test_a_folder_of_another_user_is_not_used(place, kept, said, monkeypatch):
    stranger = os.geteuid() + 4321
    if os.geteuid() == 0:
        os.chown(place.parent, stranger, -1)
    else:
        monkeypatch.setattr(os, "geteuid", lambda: stranger)
    assert KernelFolder(place).read("a") is None
    assert len(said) == 1
    assert "belongs to user " in said[0]


def test_a_link_to_a_folder_that_others_can_write_is_not_used(place, kept, tmp_path):
    elsewhere = tmp_path / "open" / "hough-tui"
    elsewhere.parent.mkdir()
    place.parent.rename(elsewhere)
    place.parent.symlink_to(elsewhere)
    assert objection(place) is None
    elsewhere.parent.chmod(0o777)
    assert f"others can write {elsewhere.parent} " in objection(place)


@pytest.mark.parametrize("above", [0, 1, 2])
def test_where_nothing_can_be_kept_it_is_said_once(place, said, above):
    in_the_way = [place, *place.parents][above]
    in_the_way.parent.mkdir(parents=True, exist_ok=True)
    in_the_way.write_text("no folder")
    folder = KernelFolder(place)
    assert folder.read("a") is None
    folder.write("a", BODY)
    folder.write("b", BODY)
    assert not folder.can_keep
    assert folder.is_empty
    assert len(said) == 1
    assert f"cannot be kept in {place.parent}: " in said[0]
    assert in_the_way.read_text() == "no folder"


def test_a_full_disk_leaves_nothing_and_is_said_once(place, kept, said, monkeypatch):
    folder = KernelFolder(place)

    class FullDisk:
        def __init__(self, handle, _):
            os.close(handle)

        def __enter__(self):
            raise OSError(28, "No space left on device")

        def __exit__(self, *_):
            raise AssertionError

    with monkeypatch.context() as patched:
        patched.setattr(kernel_folders, "open", FullDisk, raising=False)
        folder.write("b", BODY)
        folder.write("c", BODY)
    assert [path.name for path in place.iterdir()] == ["a.nbc"]
    assert len(said) == 1
    assert "No space left on device" in said[0]
    assert folder.read("a") == BODY


def aged(path, days):
    then = time.time() - days * 86_400
    os.utime(path, (then, then))
    return path


def test_folders_of_older_versions_go_after_a_month(place, kept, said):
    cache = place.parent
    gone = [
        "kernels-0123456789abcdef",
        "kernels-scenarios-0123456789abcdef",
        "kernels-no_plug_in-0123456789abcdef",
    ]
    stays = ["kernels-fedcba9876543210", "kernels-algorithms-fedcba9876543210"]
    others = [
        "kernels",
        "kernels-0123",
        "runs",
        "kernels-0123456789abcdef-old",
        "kernels-a-b-0123456789abcdef",
    ]
    for name in gone + others:
        (cache / name / "below").mkdir(parents=True)
        (cache / name / "below" / "file").touch()
        aged(cache / name, 32)
    for name in stays:
        aged_folder = cache / name
        aged_folder.mkdir()
        aged(aged_folder, 27)
    link = cache / "kernels-00000000000000aa"
    link.symlink_to(cache / "runs")
    unfinished, recent = place / "a.killed.tmp", place / "a.writing.tmp"
    for file in (unfinished, recent):
        file.touch()
    aged(unfinished, 2)
    aged(place, 100)
    assert KernelFolder(place).read("a") == BODY
    left = {path.name for path in cache.iterdir()}
    assert left == {*stays, *others, link.name, place.name}
    assert {path.name for path in place.iterdir()} == {"a.nbc", "a.writing.tmp"}
    assert time.time() - place.stat().st_mtime < 3600
    assert said == []


@pytest.fixture
def own_cache(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    kernel_folder.cache_clear()
    yield tmp_path / "cache"
    kernel_folder.cache_clear()


def test_current_folders_of_other_packages_stay(own_cache):
    numerics, world = kernel_folder("algorithms"), kernel_folder("scenarios")
    numerics.write("a", BODY)
    world.write("a", BODY)
    aged(world.path, 100)
    assert kernel_folder("algorithms").read("a") == BODY
    assert world.read("a") == BODY


def test_all_that_makes_the_code_names_the_folder(own_cache, tmp_path, monkeypatch):
    monkeypatch.syspath_prepend(tmp_path)
    module = tmp_path / "a_plug_in.py"

    def folder(source="pass", package="a_plug_in"):
        module.write_text(source)
        kernel_folder.cache_clear()
        return kernel_folder(package).path

    first = folder()
    assert first.parent == own_cache / "hough-tui"
    assert first == folder()
    others = [folder("1"), folder(package="algorithms"), folder(package="of_no_such_name")]
    monkeypatch.setenv("NUMBA_BOUNDSCHECK", "1")
    others.append(folder())
    monkeypatch.setattr(kernel_folders, "version", lambda name: "99")
    others.append(folder())
    assert len({first, *others}) == 6


def test_kernels_are_cold_until_some_are_kept(own_cache, said, monkeypatch):
    assert kernel_folders.is_cold()
    assert kernel_folders.can_keep()
    assert kernel_folders.is_cold()
    kernel_folder().write("a", BODY)
    assert not kernel_folders.is_cold()
    (own_cache / "hough-tui").chmod(0o777)
    kernel_folder.cache_clear()
    assert kernel_folders.is_cold()
    assert not kernel_folders.can_keep()
    monkeypatch.delenv("XDG_CACHE_HOME")
    monkeypatch.setenv("HOME", "")
    monkeypatch.setattr("os.getuid", lambda: 2**31 - 5)
    kernel_folder.cache_clear()
    assert kernel_folders.is_cold()
    assert len(said) == 2
    assert "this user has no home folder" in said[1]

"""Standard streams of every kind: plain words on the one that is left, the right status, no traceback."""

import io
import os
import subprocess
import sys
import warnings

import pytest

from hough_tui.cli import run as run_command

PLOTS = "scan,x,y,λ\n" + "".join(f"{scan},{10 + scan},{20 + 2 * scan},×\n" for scan in range(4))
COMMAND = [sys.executable, "-m", "hough_tui"]
CLOSED = "hough-tui: standard output: it is closed\n"
FULL = "hough-tui: standard output: No space left on device\n"


def ended(redirections: str, *arguments: str) -> tuple[int, str]:
    """Run a command under a shell's redirections; return its status and all that it could still say."""
    shell = ["bash", "-c", f'exec 3>&1; "$@" {redirections}', "bash", *COMMAND, *arguments]
    environment = {name: value for name, value in os.environ.items() if not name.startswith("PYTHON")}
    process = subprocess.run(shell, capture_output=True, text=True, stdin=subprocess.DEVNULL, env=environment)
    return process.returncode, process.stdout + process.stderr


@pytest.mark.parametrize("arguments", [["sets"], ["--help"], ["--version"]])
@pytest.mark.parametrize(("redirection", "said"), [(">&-", CLOSED), (">/dev/full", FULL)])
def test_lost_output_is_one_sentence_and_a_failure(arguments, redirection, said):
    assert ended(redirection, *arguments) == (1, said)


@pytest.mark.parametrize("redirections", [">/dev/full 2>/dev/full", "<&- >&- 2>&-"])
def test_no_stream_left_is_silence_and_a_failure(redirections):
    assert ended(redirections, "--version") == (1, "")


@pytest.mark.parametrize("redirections", ["2>&-", "2>/dev/full", "<&-"])
def test_output_that_is_there_is_enough(redirections):
    said = "course-report: valid: 2 scenarios, 3 initiators, 3 experiments\n"
    assert ended(redirections, "validate", "course-report") == (0, said)


@pytest.mark.parametrize("arguments", [["batch", "--nothing"], ["initiators", "nowhere"]])
def test_a_wrong_request_that_nobody_hears_of_is_wrong(arguments):
    assert ended("2>/dev/full", *arguments) == (2, "")


@pytest.mark.parametrize("arguments", [["sets"], ["--version"]])
def test_a_reader_that_left_is_no_news(arguments):
    reader, writer = os.pipe()
    os.close(reader)
    process = subprocess.run([*COMMAND, *arguments], stdout=writer, stderr=subprocess.PIPE)
    os.close(writer)
    assert (process.returncode, process.stderr) == (1, b"")


def test_a_file_is_written_without_standard_output(tmp_path):
    path = tmp_path / "plots.csv"
    assert ended(">&-", "simulate", "course-report", "--scenario", "two-crossing", "-o", str(path)) == (0, "")
    assert path.read_text().startswith("scan,time,x,y")


def test_a_run_whose_table_is_lost_is_kept(cli, data_home, tmp_path, monkeypatch):
    with open("/dev/full", "w") as full:
        monkeypatch.setattr(sys, "stdout", full)
        path = tmp_path / "rows.csv"
        status, _, said = cli("batch", "course-report", "--experiment=tables", "--trials=2", "--csv", path)
    assert status == 1
    assert said.endswith(FULL)
    assert path.read_text().startswith("set,")
    assert len([*(data_home / "hough-tui" / "runs").glob("*/result.json")]) == 1


@pytest.fixture
def encoded(data_home, tmp_path, monkeypatch):
    """Run a command on streams of an encoding; return its status and what it printed, as bytes."""
    monkeypatch.chdir(tmp_path)

    def run(encoding: str, *arguments: str) -> tuple[int, bytes]:
        out, err = (io.TextIOWrapper(io.BytesIO(), encoding) for _ in range(2))
        monkeypatch.setattr(sys, "stdout", out)
        monkeypatch.setattr(sys, "stderr", err)
        with pytest.raises(SystemExit) as ending:
            run_command([*arguments])
        assert b"Traceback" not in err.buffer.getvalue()
        return ending.value.code or 0, out.buffer.getvalue()

    return run


@pytest.mark.parametrize("encoding", ["ascii", "latin-1", "cp1252", "gbk"])
def test_every_command_prints_in_any_encoding(encoded, tmp_path, encoding):
    (tmp_path / "λ.csv").write_text(PLOTS)
    (tmp_path / "points.csv").write_text("range,doppler,amplitude\n1,2,3\n")
    for status, *arguments in (
        (0, "--help"),
        (0, "batch", "--help"),
        (2, "batch", "--λ"),
        (0, "sets"),
        (0, "initiators", "weighted"),
        (2, "validate", "λ.yaml"),
        (2, "open", "λ"),
        (0, "initiate", "λ.csv", "--plot"),
        (0, "advise", "course-report:two-crossing"),
        (0, "cluster", "points.csv", "--range-extent=9", "--doppler-extent=9", "--plot"),
        (0, "batch", "course-report", "--experiment=tables", "--trials=2", "--plot"),
        (0, "reproduce", "course-2-1", "--trials=2"),
    ):
        assert encoded(encoding, *arguments)[0] == status, arguments


@pytest.mark.parametrize(
    "arguments",
    [
        ["sets", "course-report"],
        ["sets", "--json"],
        ["initiators", "--json"],
        ["simulate", "course-report", "--scenario", "two-crossing"],
    ],
    ids=" ".join,
)
def test_documents_are_the_same_bytes_in_any_encoding(encoded, arguments):
    assert encoded("ascii", *arguments) == encoded("utf-8", *arguments)


def test_tables_keep_their_columns_in_any_encoding(encoded):
    _, printed = encoded("ascii", "advise", "course-report:two-crossing", "--map")
    lines = printed.decode("ascii").split("\n")
    table = lines[lines.index("P_D over dtheta and drho") + 1 :]
    rows = [line for line in table[: table.index("")] if "|" in line]
    assert len(rows) > 3
    assert len({tuple(place for place, sign in enumerate(row) if sign == "|") for row in rows}) == 1


def test_a_document_on_a_terminal_is_made_safe(cli, tmp_path, monkeypatch, capsys):
    text = "name: small # \u202e\x85\n"
    (tmp_path / "small.yaml").write_text(text)
    assert cli("sets", tmp_path / "small.yaml")[1] == text
    monkeypatch.setattr(sys.stdout, "isatty", lambda: True)
    assert cli("sets", tmp_path / "small.yaml")[1] == "name: small # \\u202e\\x85\n"


def test_warnings_of_libraries_never_reach_the_user(cli, monkeypatch):
    def warn(name: str) -> None:
        warnings.warn("overflow encountered in multiply", RuntimeWarning, stacklevel=1)

    monkeypatch.setattr("scenarios.files.set_files.locate", warn)
    monkeypatch.setattr("scenarios.files.set_files.read_text", lambda path: "read\n")
    with warnings.catch_warnings(record=True) as shown:
        warnings.simplefilter("always")
        assert cli("sets", "course-report") == (0, "read\n", "")
    assert not shown

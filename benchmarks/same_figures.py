"""The figures of every bundled set, byte for byte, beside those of another state of the code.

Run it with `python benchmarks/same_figures.py --against REVISION`, or with a folder in place of the revision;
sets may be named after that. It ends with status 1 where figures differ.

Both states run the same bundled sets with one seed and few trials, and the rows of their JSON documents are
compared key by key, numbers as they are written. Timings and what is new on either side of a set (keys, rows,
whole sets that the other state does not have) are left aside; a key or a row that is gone is a difference.
"""

from __future__ import annotations

import argparse
import contextlib
import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

HERE = Path(__file__).resolve().parent.parent

LEFT_ASIDE = {"seconds_per_trial"}
"""Keys of a row that are no figures of its trials."""

RENAMED = {"success_ci95": "success_rate_ci95", "count_exact_ci95": "count_exact_rate_ci95"}
"""Keys that have had another name: the old one, then that of today."""

IDENTITY = ("experiment", "scenario", "scene", "initiator", "clustering", "swept")
"""Keys that say which row of a set it is."""

MOST_SHOWN = 12
"""The most differences of a set that are printed."""

Row = dict[str, Any]


def documents(folder: Path, arguments: list[str]) -> Any:
    """Return the JSON document that a command of the code in a folder prints, its numbers as text."""
    own = folder / ".venv" / "bin" / "python"
    command = [str(own) if own.exists() else sys.executable, "-c", "from hough_tui.cli import main; main()"]
    done = subprocess.run(
        [*command, *arguments],
        cwd=folder,
        env={**os.environ, "PYTHONPATH": str(folder)},
        capture_output=True,
        text=True,
    )
    if done.returncode:
        raise SystemExit(f"{folder}: hough-tui {' '.join(arguments)} failed\n{done.stderr}")
    return json.loads(done.stdout, parse_float=str, parse_int=str)


def sets_of(document: Any) -> list[Row]:
    """Return the sets of a listing, which was a bare list once."""
    return document["sets"] if isinstance(document, dict) else document


@contextlib.contextmanager
def checkout(against: str) -> Iterator[Path]:
    """Provide the folder of another state of the code: itself, or a worktree of a revision for the time."""
    if Path(against).is_dir():
        yield Path(against).resolve()
        return
    with tempfile.TemporaryDirectory(prefix="same-figures-") as temporary:
        folder = Path(temporary) / "tree"
        git = ["git", "-C", str(HERE), "worktree"]
        subprocess.run([*git, "add", "--quiet", "--detach", str(folder), against], check=True)
        try:
            yield folder
        finally:
            subprocess.run([*git, "remove", "--force", str(folder)], check=True)


def by_identity(rows: list[Row]) -> dict[str, Row]:
    """Return rows by what tells them apart, in words."""
    return {
        ", ".join(f"{key} {json.dumps(row[key])}" for key in IDENTITY if row.get(key) not in (None, {})): row
        for row in rows
    }


def differences(ours: list[Row], theirs: list[Row]) -> Iterator[str]:
    """Yield what differs between the rows of a set here and in the other state."""
    mine = by_identity(ours)
    for name, row in by_identity(theirs).items():
        if name not in mine:
            yield f"{name}: the row is gone"
            continue
        for line in different_keys(mine[name], row):
            yield f"{name}: {line}"


def different_keys(ours: Row, theirs: Row) -> Iterator[str]:
    """Yield the keys of the other state that are gone here or have another value, in words."""
    for key, value in theirs.items():
        present = key if key in ours else RENAMED.get(key, key)
        if key in LEFT_ASIDE:
            continue
        if present not in ours:
            yield f"{key} is gone"
        elif isinstance(value, dict) and isinstance(ours[present], dict):
            yield from (f"{present}.{line}" for line in different_keys(ours[present], value))
        elif json.dumps(ours[present]) != json.dumps(value):
            yield f"{present} is {json.dumps(ours[present])}, was {json.dumps(value)}"


def compare(folder: Path, name: str, trials: int, seed: int) -> int:
    """Print what differs in a set, and return how many differences there are."""
    arguments = ["batch", name, "--json", "--no-keep", "--trials", str(trials), "--seed", str(seed)]
    ours, theirs = (documents(tree, arguments)["rows"] for tree in (HERE, folder))
    found = list(differences(ours, theirs))
    new = len(by_identity(ours).keys() - by_identity(theirs).keys())
    beside = f", {new} new rows left aside" if new else ""
    print(f"{name}: {len(theirs)} rows, {len(found) or 'no'} differences{beside}", flush=True)
    for line in found[:MOST_SHOWN]:
        print(f"  {line}")
    if len(found) > MOST_SHOWN:
        print(f"  … and {len(found) - MOST_SHOWN} more")
    return len(found)


def main() -> int:
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    options.add_argument("sets", nargs="*", help="bundled sets; none: all that both states have")
    options.add_argument("--against", default="HEAD", help="a revision, or the folder of a checkout")
    options.add_argument("--trials", type=int, default=10)
    options.add_argument("--seed", type=int, default=7)
    asked = options.parse_args()
    with checkout(asked.against) as folder:
        ours, theirs = (
            [listed["name"] for listed in sets_of(documents(tree, ["sets", "--json"]))]
            for tree in (HERE, folder)
        )
        for name in theirs:
            if name not in ours:
                print(f"{name}: the set is gone")
        common = [name for name in asked.sets or theirs if name in ours]
        different = sum(compare(folder, name, asked.trials, asked.seed) for name in common)
        different += sum(name not in ours for name in theirs)
    return 1 if different else 0


if __name__ == "__main__":
    raise SystemExit(main())

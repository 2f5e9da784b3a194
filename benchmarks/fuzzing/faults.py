"""What is a fault of a command: judged from its status, its output, its time and its memory."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from typing import NoReturn

from benchmarks.fuzzing.watch import LONGEST, LONGEST_ENDING, MOST_MEMORY, Outcome

WARNING = re.compile(r"^.*?\b\w*Warning: .*$", re.MULTILINE)
LIBRARY_WORDS = re.compile(
    r"errors\.pydantic\.dev|Input should be|Value error,|validation error|\b(pydantic|numba|numpy|scipy)\b"
    r"|\bLinAlg|<class '|object at 0x|<[\w.]+ object|not supported between|argument must be|has no attribute"
    r"|cannot convert|could not convert|out of range for|Exception ignored|Fatal Python error"
)
CONTROL = re.compile("[\x00-\x09\x0b-\x1f\x7f-\x9f\u202a-\u202e\u2066-\u2069]")
LONG = re.compile(r"(?i)takes? (about|long|up to|at least)|\bwill take\b|estimated|compiling the kernels")
"""What a command says beforehand that will take long."""

INTERRUPTED = 130
SHOWN = 160
LONGEST_LINE, MOST_LINES = 2_000, 60


def faults(outcome: Outcome) -> Iterator[str]:
    """Yield what is wrong with an outcome: a kind of fault, a colon, and what tells it from others."""
    said = outcome.err.decode("utf-8", "backslashreplace")
    printed = outcome.out.decode("utf-8", "backslashreplace")
    is_interrupted = outcome.ending is not None
    if outcome.status is None:
        yield "hang: " + ("an interrupt does not end it" if is_interrupted else "memory without bound")
        return
    if outcome.status < 0:
        yield f"crash: signal {-outcome.status} {innermost(said)}"
        return
    if is_interrupted:
        if outcome.ending is not None and outcome.ending > LONGEST_ENDING:
            yield "deaf: goes on for more than a second after an interrupt"
        if outcome.seconds > LONGEST and not LONG.search(said):
            yield "slow: without a word beforehand"
    if "Traceback (most recent call last)" in said + printed:
        yield f"traceback: {innermost(said)} {last_line(said)}"
        return
    if warning := WARNING.search(said):
        yield f"warning: {warning[0].strip()[:SHOWN]}"
    if words := LIBRARY_WORDS.search(said):
        yield f"words: {words[0]} in: {last_line(said)}"
    if outcome.peak > MOST_MEMORY:
        yield "memory: more than 1 GiB"
    for stream, text in (("standard error", said), ("standard output", printed)):
        if stray := CONTROL.search(text):
            yield f"control: {stray[0]!r} on {stream}"
    if outcome.status == 0:
        yield from _faults_of_success(outcome, printed)
    elif outcome.status == 2:
        yield from _faults_of_refusal(outcome, said, printed)
    elif not (is_interrupted and outcome.status == INTERRUPTED):
        yield f"status: {outcome.status} with: {last_line(said)}"


def _faults_of_success(outcome: Outcome, printed: str) -> Iterator[str]:
    if "--json" in outcome.arguments:
        try:
            json.loads(printed, parse_constant=_refuse)
        except ValueError as error:
            yield f"json: {str(error)[:SHOWN]}"


def _refuse(name: str) -> NoReturn:
    raise ValueError(f"{name} is no JSON")


def _faults_of_refusal(outcome: Outcome, said: str, printed: str) -> Iterator[str]:
    if printed and outcome.arguments[0] != "validate":
        yield f"output: a refused command prints {printed[:40]!r}"
    messages = [line for line in said.split("\n") if line and "compiling the kernels" not in line]
    if not any(line.startswith("hough-tui: ") for line in messages):
        yield f"silent: {last_line(said)}"
    elif not any(part in said for part in (outcome.arguments[1], "--", "give ")):
        yield f"placeless: {last_line(said)}"
    if max(map(len, messages), default=0) > LONGEST_LINE:
        yield f"long: a line of more than {LONGEST_LINE:,} characters"
    if len(messages) > MOST_LINES:
        yield f"many: {len(messages)} lines"


def last_line(text: str) -> str:
    """Return the last line that is not blank, shortened."""
    lines = [line for line in text.split("\n") if line.strip()]
    return lines[-1].strip()[:SHOWN] if lines else ""


def innermost(said: str) -> str:
    """Return the innermost place in the product that a traceback, or the report of a crash, names."""
    # Of a crash the thread counts in which it happened.
    said = said.partition("Current thread")[2] or said
    frames = re.findall(
        r'File "[^"]*?/((?:algorithms|scenarios|hough_tui)/[^"]+)", line (\d+)(?: in (\w+))?', said
    )
    if not frames:
        return ""
    # faulthandler begins with the innermost frame, a traceback ends with it.
    path, line, _ = frames[0] if "most recent call first" in said else frames[-1]
    return f"{path}:{line}"


def signature(fault: str) -> str:
    """Return what faults of one kind have in common: digits, names and bytes left out."""
    return (
        re.sub(r"(?<!signal )(?<![:\d])\d[\d.,e+-]*(?!\d*\.py)", "N", fault) if ".py:" not in fault else fault
    )

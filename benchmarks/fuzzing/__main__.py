"""Run cases, count outcomes, and print each kind of fault with the cases that show it."""

from __future__ import annotations

import argparse
import itertools
import json
import random
import sys
import threading
import time
from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path

from benchmarks.fuzzing.cases import Case, make_case, warm_cases
from benchmarks.fuzzing.faults import faults, last_line, signature
from benchmarks.fuzzing.watch import Outcome, Watch

Judge = Callable[[Watch, Case, tuple[str, ...]], tuple[Outcome, list[str]]]


class Tally:
    """Counts, worst time and worst memory by command, and the cases of each kind of fault."""

    def __init__(self) -> None:
        self.statuses: dict[str, Counter[str]] = {}
        self.slowest: dict[str, tuple[float, str]] = {}
        self.largest: dict[str, tuple[int, str]] = {}
        self.faults: dict[str, list[str]] = {}
        self.cases = 0

    def add(self, case: Case, outcome: Outcome, kinds: list[str]) -> None:
        """Count an outcome."""
        key = command_key(outcome.arguments)
        status = "killed" if outcome.status is None else str(outcome.status)
        self.statuses.setdefault(key, Counter())[status] += 1
        self.slowest[key] = max(self.slowest.get(key, (0.0, "")), (outcome.seconds, case.name))
        self.largest[key] = max(self.largest.get(key, (0, "")), (outcome.peak, case.name))
        for kind in kinds:
            self.faults.setdefault(f"{key}: {signature(kind)}", []).append(case.name)

    def print(self) -> None:
        """Print the counts, then the faults."""
        print(f"\n{'command':28} {'commands':>8}  {'slowest':>8}  {'most memory':>11}  exit statuses")
        for key, statuses in sorted(self.statuses.items()):
            (seconds, slow), (peak, large) = self.slowest[key], self.largest[key]
            counted = ", ".join(f"{status}: {count:,}" for status, count in sorted(statuses.items()))
            figures = f"{statuses.total():8,}  {seconds:6.2f} s  {peak / 2**20:7,.0f} MiB"
            print(f"{key:28} {figures}  {counted}  ({slow}, {large})")
        print(f"\n{len(self.faults)} kinds of faults")
        for kind, names in sorted(self.faults.items(), key=lambda item: -len(item[1])):
            print(f"{len(names):6,}  {kind}  ({', '.join(names[:3])})")


def command_key(arguments: tuple[str, ...]) -> str:
    """Return what outcomes are counted by: the command, with the initiator or the mode."""
    options = dict(itertools.pairwise(arguments))
    which = options.get("-i") or options.get("--mode")
    return f"{arguments[0]} {which}" if which else arguments[0]


def judged(watch: Watch, case: Case, arguments: tuple[str, ...]) -> tuple[Outcome, list[str]]:
    """Return the outcome of a command and its faults; a fault of the process is tried again alone."""
    watch.write(case.file, case.content)
    outcome = watch.run(arguments)
    kinds = list(faults(outcome))
    if not any(kind.startswith(("slow", "deaf", "hang", "memory", "crash", "traceback")) for kind in kinds):
        return outcome, kinds
    # Kernels may have been compiled, libraries keep memory, and a command before may have written where it
    # must not: a fresh worker has none of it.
    watch.end()
    alone = watch.run(arguments)
    if outcome.status is not None and outcome.status < 0 and not list(faults(alone)):
        return outcome, [f"{kind}, not alone: a command before it is to blame" for kind in kinds]
    return alone, list(faults(alone))


def interrupted(watch: Watch, case: Case, arguments: tuple[str, ...]) -> tuple[Outcome, list[str]]:
    """Return the outcome of a command that is interrupted at a random moment, with a process of its own."""
    watch.end()
    watch.write(case.file, case.content)
    trials = {"2": "100000"} if arguments[0] == "batch" else {}
    moment = random.Random(f"{case.name} {arguments}").uniform(0.0, 3.0)
    outcome = watch.run(tuple(trials.get(argument, argument) for argument in arguments), longest=moment)
    return outcome, list(faults(outcome))


def warm() -> None:
    """Have the kernels compiled, which is charged to no case."""
    with Watch() as watch:
        for case in warm_cases():
            watch.write(case.file, case.content)
            for arguments in case.commands:
                outcome = watch.run(arguments, longest=900.0)
                if outcome.status != 0:
                    sys.exit(
                        f"{case.name}: {arguments}: {outcome.status}: {outcome.err.decode(errors='replace')}"
                    )


def run_cases(
    names: list[str], workers: int, report: Path | None, only: str = "", judge: Judge = judged
) -> Tally:
    """Run cases on several workers: all commands, or only those that have a word.

    A report gets a line of JSON for each fault.
    """
    tally, lock, pending = Tally(), threading.Lock(), iter(names)
    began = time.monotonic()

    def work() -> None:
        with Watch() as watch:
            while True:
                with lock:
                    name = next(pending, None)
                if name is None:
                    return
                case = make_case(name)
                for arguments in case.commands:
                    if only and only not in arguments:
                        continue
                    outcome, kinds = judge(watch, case, arguments)
                    with lock:
                        tally.add(case, outcome, kinds)
                        if report is not None and kinds:
                            with report.open("a") as file:
                                file.write(json.dumps(record(case, outcome, kinds)) + "\n")
                with lock:
                    tally.cases += 1
                    if tally.cases % 200 == 0:
                        took = time.monotonic() - began
                        print(f"{tally.cases:,} of {len(names):,} cases, {took:,.0f} s", file=sys.stderr)

    threads = [threading.Thread(target=work) for _ in range(workers)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    return tally


def record(case: Case, outcome: Outcome, kinds: list[str]) -> dict[str, object]:
    """Return what a report says of an outcome with faults."""
    return {
        "case": case.name,
        "arguments": outcome.arguments,
        "faults": kinds,
        "status": outcome.status,
        "seconds": round(outcome.seconds, 3),
        "peak": outcome.peak,
        "ending": outcome.ending,
        # A crash is reported at the beginning, everything else at the end.
        "said": (outcome.err[:2_000] + b"..." + outcome.err[2_000:][-2_000:]).decode(
            "utf-8", "backslashreplace"
        ),
    }


def show_case(name: str, folder: Path) -> bool:
    """Run one case, print how each command went, keep its file in a folder; return whether all is well."""
    case = make_case(name)
    folder.mkdir(parents=True, exist_ok=True)
    (folder / case.file).write_bytes(case.content)
    print(f"{name}: {len(case.content):,} bytes, kept as {folder / case.file}")
    is_well = True
    with Watch() as watch:
        for arguments in case.commands:
            outcome, kinds = judged(watch, case, arguments)
            is_well &= not kinds
            print(f"\nhough-tui {' '.join(arguments)}")
            memory = f"{outcome.peak / 2**20:,.0f} MiB"
            print(
                f"  status {outcome.status}, {outcome.seconds:.2f} s, {memory}: {'; '.join(kinds) or 'well'}"
            )
            print("  " + ascii(last_line(outcome.err.decode("utf-8", "backslashreplace"))))
    return is_well


def case_names(kind: str, first: int, count: int) -> Iterator[str]:
    """Yield the names of so many cases of a kind."""
    return (f"{kind}:{seed}" for seed in range(first, first + count))


def main() -> None:
    """Run what the arguments ask for; end with 1 where there is a fault."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.fuzzing", description=__doc__)
    parser.add_argument("--sets", type=int, default=0, metavar="N", help="so many mutated scenario sets")
    parser.add_argument("--tables", type=int, default=0, metavar="N", help="so many mutated CSV files")
    parser.add_argument("--first", type=int, default=0, metavar="SEED", help="the first seed of each kind")
    parser.add_argument("--workers", type=int, default=2, help="processes")
    parser.add_argument(
        "--only", default="", metavar="WORD", help="only the commands with it: batch, standard, …"
    )
    parser.add_argument("--interrupt", action="store_true", help="interrupt each command at a random moment")
    parser.add_argument("--report", type=Path, metavar="FILE", help="append each fault as a line of JSON")
    parser.add_argument("--case", metavar="KIND:SEED", help="run this case alone and keep its file")
    parser.add_argument("--folder", type=Path, default=Path("case"), help="where --case keeps its file")
    options = parser.parse_args()
    if options.case:
        sys.exit(not show_case(options.case, options.folder))
    names = [
        *case_names("sets", options.first, options.sets),
        *case_names("tables", options.first, options.tables),
    ]
    print(f"sets {options.first} to {options.first + options.sets - 1}, " if options.sets else "", end="")
    print(f"tables {options.first} to {options.first + options.tables - 1}" if options.tables else "")
    if options.only != "validate":
        warm()
    judge = interrupted if options.interrupt else judged
    tally = run_cases(names, options.workers, options.report, options.only, judge)
    tally.print()
    sys.exit(bool(tally.faults))


if __name__ == "__main__":
    main()

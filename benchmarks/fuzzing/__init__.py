"""Fuzzing: mutated scenario sets and CSV files through the command line.

Every command must exit with 0 or 2, without a traceback, a library's warning, a crash, a control character
on its output, more than 5 s (unless it says so beforehand) or more than 1 GiB; an interrupt must end it
within a second. A case is named by its kind and seed, and one version of the product makes the same case
of the same name:

    python -m benchmarks.fuzzing --sets 6000 --tables 6000
    python -m benchmarks.fuzzing --case sets:1234
"""

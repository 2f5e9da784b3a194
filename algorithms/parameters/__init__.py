"""The one declaration of a parameter, and the words for what is wrong with a value.

A parameter's name, type, unit, bounds, default and help line are declared once, as a field
of a validated model. Forms, command line, YAML, JSON Schema, error texts and documentation
are derived from that field.
"""

from algorithms.parameters.declaration import (
    LARGEST_WHOLE,
    NAME,
    Auto,
    Count,
    Declared,
    Dimension,
    Flag,
    Fraction,
    Integer,
    Name,
    NotNegative,
    Number,
    Parameters,
    Positive,
    Whole,
    parameter,
    with_default,
)
from algorithms.parameters.paths import Path, dotted, field_at, fields_at, numeric_paths
from algorithms.parameters.validation import (
    MISSING_EITHER,
    FieldError,
    Problem,
    join,
    lines,
    missing_either,
    problems,
    replaced,
    validated,
)
from algorithms.parameters.words import listed, nearest, shortened, unknown

__all__ = [
    "LARGEST_WHOLE",
    "MISSING_EITHER",
    "NAME",
    "Auto",
    "Count",
    "Declared",
    "Dimension",
    "FieldError",
    "Flag",
    "Fraction",
    "Integer",
    "Name",
    "NotNegative",
    "Number",
    "Parameters",
    "Path",
    "Positive",
    "Problem",
    "Whole",
    "dotted",
    "field_at",
    "fields_at",
    "join",
    "lines",
    "listed",
    "missing_either",
    "nearest",
    "numeric_paths",
    "parameter",
    "problems",
    "replaced",
    "shortened",
    "unknown",
    "validated",
    "with_default",
]

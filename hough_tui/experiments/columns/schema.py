"""Schema of per-trial columns: each column declares its type, its shape and the value of what is missing."""

from __future__ import annotations

from abc import ABC
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from typing import Annotated, Any, Self, get_args, get_type_hints

import numpy as np
from numpy.typing import DTypeLike, NDArray

from algorithms.errors import RequestError


@dataclass(frozen=True, slots=True)
class Listed:
    """How a list of trials shows a column.

    Attributes
    ----------
    heading : one or two lines; of a column by target one, below the name of the target
    order : what it is called to sort by it, the greatest first
    decimals : of its numbers
    shown : returns what is shown of its values
    is_hidden_at_zero : whether it is left out where all its values are 0
    """

    heading: str
    order: str
    decimals: int = 0
    shown: Callable[[NDArray[Any]], NDArray[Any]] = np.asarray
    is_hidden_at_zero: bool = False


@dataclass(frozen=True, slots=True)
class Column:
    """Declaration of a column, one row a trial.

    Attributes
    ----------
    dtype : of its values
    axis : name of its second axis, such as `targets`; None for one value a trial
    fill : its value where a trial is not finished, and in a file that does not have the column
    is_required : whether a file without the column is of no use
    is_family : whether it is a mapping from names to such columns, which no trial need have
    listed : how a list of trials shows it; None where it does not
    """

    dtype: DTypeLike
    axis: str | None = None
    fill: float = 0
    is_required: bool = False
    is_family: bool = False
    listed: Listed | None = None

    def empty(self, trials: int, sizes: Mapping[str, int]) -> Any:
        """Return the column filled with `fill`; of a family no column yet."""
        if self.is_family:
            return {}
        shape = (trials,) if self.axis is None else (trials, sizes.get(self.axis, 0))
        return np.full(shape, self.fill, self.dtype)

    def bytes_a_trial(self, sizes: Mapping[str, int]) -> int:
        """Return the size of a trial's values; a family counts for one column."""
        return np.dtype(self.dtype).itemsize * (1 if self.axis is None else sizes.get(self.axis, 0))


@dataclass(frozen=True, slots=True)
class Columns(ABC):
    """Columns of some trials of a cell: a dataclass of arrays, each `Annotated` with its `Column`.

    Attributes
    ----------
    trial : int32 (trials,), which trials of the experiment they are, rising
    """

    trial: Annotated[NDArray[np.int32], Column(np.int32)]

    def __len__(self) -> int:
        return len(self.trial)

    @classmethod
    def schema(cls) -> Mapping[str, Column]:
        """Return the declared columns by name."""
        return _schema(cls)

    @classmethod
    def empty(cls, trials: int, **sizes: int) -> Self:
        """Return columns to be filled part by part.

        Parameters
        ----------
        trials : how many, from trial 0 on
        sizes : of each second axis
        """
        columns = {name: column.empty(trials, sizes) for name, column in cls.schema().items()}
        return cls(**{**columns, "trial": np.arange(trials, dtype=np.int32)})

    @classmethod
    def bytes_a_trial(cls, **sizes: int) -> int:
        """Return the size of the columns of one trial."""
        return sum(column.bytes_a_trial(sizes) for column in cls.schema().values())

    @classmethod
    def of(cls, first: int, trials: int, **values: Any) -> Self:
        """Return the columns of consecutive trials from `first` on.

        Parameters
        ----------
        first, trials : which trials
        values : columns by name, cast to their declared types; those that are not there hold their fill
        """
        schema = cls.schema()
        arrays = {
            name: np.asarray(values[name], column.dtype)
            for name, column in schema.items()
            if name in values and not column.is_family
        }
        sizes = {
            column.axis: arrays[name].shape[1]
            for name, column in schema.items()
            if name in arrays and column.axis is not None
        }
        columns = {name: column.empty(trials, sizes) for name, column in schema.items()} | arrays
        for name, column in schema.items():
            if column.is_family:
                named = values.get(name, {})
                columns[name] = {key: np.asarray(one, column.dtype) for key, one in named.items()}
        return cls(**{**columns, "trial": np.arange(first, first + trials, dtype=np.int32)})

    @classmethod
    def read(cls, arrays: Mapping[str, NDArray[Any]], trials: int) -> Self:
        """Return columns from the arrays of a file, which may be of an earlier version.

        Parameters
        ----------
        arrays : as `arrays` gave them; columns without which the others are of use may be missing
        trials : how many rows there must be

        Raises
        ------
        RequestError
            Where a required column is missing, or one has another number of rows.
        """
        schema = cls.schema()
        missing = [name for name, column in schema.items() if column.is_required and name not in arrays]
        if missing:
            raise RequestError(f"the run was kept without the columns {', '.join(missing)}")
        sizes: dict[str, int] = {}
        for name, column in schema.items():
            # Columns that no trial has were kept without rows once.
            if column.axis is not None and name in arrays and len(arrays[name]):
                sizes.setdefault(column.axis, arrays[name].shape[1])
        columns = cls.empty(trials, **sizes)
        for name, values in columns.arrays().items():
            if name in arrays and arrays[name].size:
                if arrays[name].shape != values.shape:
                    raise RequestError(
                        f"the run is damaged: its column {name} is of shape {arrays[name].shape}, "
                        f"not {values.shape}"
                    )
                values[:] = arrays[name]
        for name, column in schema.items():
            if column.is_family:
                members = {key: one for key, one in arrays.items() if key.startswith(f"{name}.")}
                getattr(columns, name).update({key.partition(".")[2]: one for key, one in members.items()})
        return columns

    def arrays(self) -> dict[str, NDArray[Any]]:
        """Return the columns by name, those of a family as `FAMILY.NAME`."""
        return dict(self._named())

    def select(self, rows: slice | NDArray[np.bool_]) -> Self:
        """Return the columns of some of the trials."""
        columns: dict[str, Any] = {}
        for name, column in self.schema().items():
            values = getattr(self, name)
            if column.is_family:
                # A copy first: other threads may be adding members.
                columns[name] = {key: one[rows] for key, one in tuple(values.items())}
            else:
                columns[name] = values[rows]
        return type(self)(**columns)

    def put(self, part: Self) -> None:
        """Put in the columns of consecutive trials, at their places among all trials."""
        if not len(part):
            return
        rows = slice(int(part.trial[0]), int(part.trial[0]) + len(part))
        for name, column in self.schema().items():
            values, new = getattr(self, name), getattr(part, name)
            if column.is_family:
                for key, one in new.items():
                    # One of several threads makes the column, and all write into it.
                    made = values.setdefault(key, np.full(len(self), column.fill, column.dtype))
                    made[rows] = one
            else:
                values[rows] = new

    def _named(self) -> Iterator[tuple[str, NDArray[Any]]]:
        for name, column in self.schema().items():
            values = getattr(self, name)
            if column.is_family:
                yield from ((f"{name}.{key}", one) for key, one in tuple(values.items()))
            else:
                yield name, values


@cache
def _schema(columns: type[Columns]) -> Mapping[str, Column]:
    hints = get_type_hints(columns, include_extras=True)
    return {
        name: declared
        for name, hint in hints.items()
        for declared in get_args(hint)[1:]
        if isinstance(declared, Column)
    }

"""What a published table is: its figures, and the cells of a bundled set that measure them."""

from __future__ import annotations

from dataclasses import dataclass, field


@dataclass(frozen=True, slots=True)
class Entry:
    """One figure of a published table.

    Attributes
    ----------
    case : how the row is called
    experiment, method, swept, world : which cell of the bundled set measures it: the name of an entry
        (initiator or clustering), and of a scenario or scene where the experiment has several
    metric : key of what is compared
    published : the printed figure; None where the source has none
    note : what a reader must know
    is_judged : whether the printed figure is meant to be reproduced
    """

    case: str
    experiment: str
    method: str
    metric: str
    published: float | None = None
    note: str | None = None
    swept: dict[str, int | float] = field(default_factory=dict)
    is_judged: bool = True
    world: str | None = None


@dataclass(frozen=True, slots=True)
class PublishedTable:
    """A published table and the bundled set that measures it.

    Attributes
    ----------
    name, title, source : what it is
    set_name : which bundled set
    trials : number of trials behind each published figure
    rounding : half the last printed digit; 0 where figures have several sizes
    entries : its figures
    """

    name: str
    title: str
    source: str
    set_name: str
    trials: int
    rounding: float
    entries: tuple[Entry, ...]

"""A form for any declared model: its fields in groups, its lists as tables."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import ClassVar

from pydantic import BaseModel
from textual import on
from textual.app import ComposeResult
from textual.binding import Binding
from textual.containers import VerticalScroll
from textual.content import Content
from textual.events import Resize
from textual.widget import AwaitMount, Widget
from textual.widgets import Input, Static

from algorithms.context import Unit
from algorithms.parameters import Path, Problem, join
from hough_tui.ui.forms.edits import value_in
from hough_tui.ui.forms.extended_target_table import ExtendedTargetTable
from hough_tui.ui.forms.fields import FieldDescription, Kind, described, ordered, walk
from hough_tui.ui.forms.list_table import ListTable
from hough_tui.ui.forms.numbers import Unreadable
from hough_tui.ui.forms.pending_edits import Asked, Negotiation
from hough_tui.ui.forms.sensor_table import SensorTable
from hough_tui.ui.forms.target_table import TargetTable
from hough_tui.ui.forms.value_field import ValueField
from hough_tui.ui.messages import ElementAdded, ElementRemoved, FieldEdited, FieldUnreadable
from scenarios.scenes import ExtendedTarget
from scenarios.sensors import CartesianSensor
from scenarios.targets import Target

TWO_COLUMNS = 100
"""The width from which fields stand in two columns."""


class ModelForm(VerticalScroll, can_focus=False, inherit_bindings=False):
    """A form for a model of the set.

    Whoever hears its `FieldEdited`, `ElementAdded` and `ElementRemoved` answers each, in their
    order: with `load` where the set took it, with `problems` where it did not. What was not taken
    stays as it was typed, and is asked for again when the model has changed, or together with
    another edit that was not taken: some edits are allowed only together.
    """

    DEFAULT_CSS = """
    ModelForm {
        height: 1fr;
        padding: 0 1;
        scrollbar-size-vertical: 1;
        & > .form--problem { display: none; dock: top; height: auto; padding: 0 1; }
        & > .form--problem { background: $surface; color: $text-error; }
        & > .form--heading { height: 1; margin-top: 1; color: $text-muted; }
        & > .form--heading { text-wrap: nowrap; text-overflow: ellipsis; }
        & > ListTable { margin-top: 1; }
        & > _Fields { grid-size: 1; }
        &.-wide > _Fields { grid-size: 2; grid-columns: 1fr 1fr; grid-gutter: 0 2; }
    }
    """

    BINDINGS = [
        Binding("down", "app.focus_next", "Next field", show=False, id="form.next_field"),
        Binding("up", "app.focus_previous", "Field before", show=False, id="form.previous_field"),
        Binding("pagedown", "page_down", "Page down", show=False, id="form.page_down"),
        Binding("pageup", "page_up", "Page up", show=False, id="form.page_up"),
    ]

    TABLES: ClassVar[dict[type[BaseModel], type[ListTable]]] = {
        Target: TargetTable,
        ExtendedTarget: ExtendedTargetTable,
        CartesianSensor: SensorTable,
    }
    """The tables that say more of their elements than the declaration does."""

    def __init__(self, *, id: str | None = None, classes: str | None = None) -> None:
        super().__init__(id=id, classes=classes)
        self._model: BaseModel | None = None
        self._path: Path = ()
        self._unit: Unit | None = None
        self._resolved: BaseModel | None = None
        self._shape: object = None
        # By their paths within the model, which stays what it is when the model moves in the set.
        self._fields: dict[Path, ValueField] = {}
        self._tables: dict[Path, ListTable] = {}
        self._negotiation = Negotiation()
        self._mounting: AwaitMount | None = None
        self._top = Static("", classes="form--problem", markup=False)

    @property
    def model(self) -> BaseModel | None:
        """The model that is shown."""
        return self._model

    @property
    def is_sound(self) -> bool:
        """Whether all that is typed is in effect: nothing is unreadable, and nothing was refused."""
        if self._negotiation.refused or not all(table.is_sound for table in self._tables.values()):
            return False
        return not any(isinstance(field.meaning, Unreadable) for field in self._fields.values())

    def compose(self) -> ComposeResult:
        yield self._top

    def on_mount(self) -> None:
        if self._model is not None:
            self._rebuild()

    def on_resize(self, event: Resize) -> None:
        self.set_class(event.size.width >= TWO_COLUMNS, "-wide")

    def field(self, path: Path) -> ValueField | None:
        """Return the field at a path of the set; None where there is none."""
        return self._fields.get(path[len(self._path) :]) if self._has(path) else None

    def table(self, path: Path) -> ListTable | None:
        """Return the table of the list at a path of the set; None where there is none."""
        return self._tables.get(path[len(self._path) :]) if self._has(path) else None

    def load(
        self, model: BaseModel, path: Path, *, unit: Unit | None = None, resolved: BaseModel | None = None
    ) -> None:
        """Show a model; nothing is posted for what it changes.

        Parameters
        ----------
        path : where the model stands in the set
        unit : the unit of lengths, for a model that has none itself
        resolved : the model, or its parameters, with every `auto` worked out
        """
        is_same, is_changed = path == self._path and self._model is not None, model != self._model
        self._model, self._path, self._unit, self._resolved = model, path, unit, resolved
        if not is_same:
            self._negotiation = Negotiation()
        if not self.is_mounted:
            return
        if _shape(self._described()) == self._shape:
            self._refresh(is_same=is_same)
        else:
            self._rebuild()
        self._say(None)
        for typed, value in list(self._negotiation.refused.items()):
            field = self.field(typed)
            if field is None or field.meaning != value:
                # Another value was set outside in the meantime, and took the place of what was typed.
                self._negotiation.forget(typed)
        for asked in self._negotiation.taken(model, path, is_changed=is_changed):
            self._ask(asked)

    def problems(self, found: Sequence[Problem]) -> None:
        """Show what is wrong: beside the field, or at the top where there is none.

        Where something is, the edit that was asked for first was not taken.
        """
        self._say(None)
        if not found or self._model is None:
            return
        asked, instead = self._negotiation.turned_down(self._model, self._path)
        if asked is None or len(asked.typed) < 2:
            # Where several edits were tried together, each says already why it was not taken alone.
            for problem in found:
                self._place(problem, asked)
        if instead is not None:
            self._ask(instead)

    def revert(self) -> None:
        """Show what is in effect in place of what is typed and is not."""
        self._negotiation = Negotiation()
        for field in self._fields.values():
            if field.check_action("revert", ()):
                field.action_revert()
        for table in self._tables.values():
            table.action_cancel()
        self._say(None)

    def focus_field(self, path: Path) -> None:
        """Put the cursor into the field at a path, or into the table that it lies in."""
        for length in range(len(path), len(self._path), -1):
            found = self.field(path[:length]) or self.table(path[:length])
            for inner in found.walk_children(Widget) if found else ():
                if inner.can_focus:
                    inner.focus()
                    return

    def focus_first(self) -> None:
        """Put the cursor into the first field."""
        first = next((child for child in self.walk_children(Widget) if child.focusable), None)
        if first is not None:
            first.focus()

    @on(Input.Submitted)
    def _submitted(self, event: Input.Submitted) -> None:
        event.stop()
        self.screen.focus_next()

    @on(FieldEdited)
    def _edited(self, event: FieldEdited) -> None:
        if self._model is not None and self.field(event.path) is not None:
            event.stop()
            self._ask(self._negotiation.edit(self._model, self._path, event.path, event.value))
        else:
            self._negotiation.note(event.path, event.value)

    @on(ElementAdded)
    @on(ElementRemoved)
    def _counted(self, event: ElementAdded | ElementRemoved) -> None:
        self._negotiation.note(event.path, is_count=True)

    @on(FieldUnreadable)
    def _unreadable(self, event: FieldUnreadable) -> None:
        self._negotiation.forget(event.path)

    def _ask(self, asked: Asked) -> None:
        """Ask for an edit, past this form's own ears."""
        if isinstance(self.parent, Widget):
            self.parent.post_message(FieldEdited(asked.path, asked.value))

    def _has(self, path: Path) -> bool:
        return path[: len(self._path)] == self._path

    def _place(self, problem: Problem, asked: Asked | None) -> None:
        for length in range(len(problem.path), len(self._path), -1):
            field, table = self.field(problem.path[:length]), self.table(problem.path[:length])
            if field is not None:
                return field.show_problem(problem.message)
            if table is not None:
                return table.show_problem(problem)
        edited = self._asking(asked)
        if asked is not None and edited is not None and asked.path[: len(problem.path)] == problem.path:
            # What is wrong with the whole is wrong since this was edited.
            return self._mark(edited, asked.path, problem.message)
        inner = problem.path[len(self._path) :] if self._has(problem.path) else problem.path
        self._say(join(replace(problem, path=inner)))
        if asked is not None and edited is not None:
            self._mark(edited, asked.path, "this is not taken; the top of the form says why")

    def _asking(self, asked: Asked | None) -> ValueField | ListTable | None:
        """Return the field or the table that asked for an edit."""
        if asked is None:
            return None
        tables = (self.table(asked.path[:length]) for length in range(len(self._path) + 1, len(asked.path)))
        typed = next(iter(asked.typed), None)
        return self.field(typed) if typed is not None else next(filter(None, tables), None)

    @staticmethod
    def _mark(edited: ValueField | ListTable, path: Path, words: str) -> None:
        if isinstance(edited, ValueField):
            edited.show_problem(words)
        else:
            edited.show_problem(Problem(path, words))

    def _say(self, words: str | None) -> None:
        self._top.update(Content(f"! {words}" if words else ""))
        self._top.display = bool(words)

    def _described(self) -> list[FieldDescription]:
        assert self._model is not None
        return ordered(described(self._model, self._path, self._unit))

    def _refresh(self, *, is_same: bool) -> None:
        """Show the model in the widgets that there are; for another model they begin anew."""
        for field in walk(self._described()):
            inner = field.path[len(self._path) :]
            value, auto_value = value_in(self._model, inner), value_in(self._resolved, inner)
            if inner in self._tables:
                self._load_table(self._tables[inner], field)
            elif inner in self._fields and is_same:
                self._fields[inner].redescribe(field)
                self._fields[inner].refresh_value(value, auto_value)
            elif inner in self._fields:
                self._fields[inner].begin(field, value, auto_value)

    def _rebuild(self) -> None:
        fields = self._described()
        self._shape = _shape(fields)
        self._fields, self._tables = {}, {}
        old = [child for child in self.children if child is not self._top]
        with self.app.batch_update():
            for child in old:
                child.display = False
            before, self._mounting = self._mounting, self.mount_all(self._built(fields))
        if before is not None:
            self.run_worker(self._take_away(old, before))

    async def _take_away(self, old: Sequence[Widget], mounting: AwaitMount) -> None:
        # A widget that is taken away before it was mounted never finishes either.
        await mounting
        await self.remove_children([child for child in old if child.parent is self])

    def _built(self, fields: Sequence[FieldDescription]) -> Iterator[Widget]:
        singles = [field for field in fields if field.kind not in (Kind.GROUP, Kind.LIST)]
        if singles:
            yield _Fields(*map(self._made, singles))
        for field in fields:
            if field.kind is Kind.GROUP:
                title = Content.assemble((field.label, "bold $foreground"), f"  {field.help}")
                yield Static(title, classes="form--heading")
                yield from self._built(field.fields)
            elif field.kind is Kind.LIST:
                kind = next((self.TABLES[model] for model in field.models if model in self.TABLES), ListTable)
                table = self._tables[field.path[len(self._path) :]] = kind(field)
                self._load_table(table, field)
                yield table

    def _made(self, field: FieldDescription) -> ValueField:
        inner = field.path[len(self._path) :]
        value, auto_value = value_in(self._model, inner), value_in(self._resolved, inner)
        room = self.scrollable_content_region.width
        width = (room // 2 if self.has_class("-wide") else room) if room else None
        widget = ValueField(field, value, auto_value, width=width)
        self._fields[inner] = widget
        return widget

    def _load_table(self, table: ListTable, field: FieldDescription) -> None:
        elements = value_in(self._model, field.path[len(self._path) :]) or ()
        unit = getattr(self._model, "unit", None)
        table.load(field, elements, self._model, unit if isinstance(unit, Unit) else self._unit)


class _Fields(Widget):
    """Fields side by side, in as many columns as there is room for."""

    DEFAULT_CSS = "_Fields { layout: grid; height: auto; grid-rows: auto; }"


def _shape(fields: Sequence[FieldDescription]) -> object:
    """Return all that the widgets of a form rest on: where the model stands, and its unit, may change."""
    return [replace(field, path=field.path[-1:], unit="", fields=()) for field in walk(fields)]

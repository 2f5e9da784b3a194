"""A list of models as a table whose cells are edited in place."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from pydantic import BaseModel
from rich.text import Text
from textual import events, on
from textual.app import ComposeResult
from textual.binding import Binding
from textual.content import Content
from textual.coordinate import Coordinate
from textual.widget import Widget
from textual.widgets import DataTable, Input, Static

from algorithms.context import Unit
from algorithms.parameters import Path, Problem, dotted
from hough_tui.ui.forms.cell_editor import CellEditor
from hough_tui.ui.forms.cell_table import CellTable
from hough_tui.ui.forms.columns import cell, columns_of, has, heading, inherited, is_right
from hough_tui.ui.forms.controls import EXPLAIN, ExplanationWanted
from hough_tui.ui.forms.edits import Edit, duplicate, edit_of, names_of, starter, value_in
from hough_tui.ui.forms.fields import FieldDescription, Kind
from hough_tui.ui.forms.labels import within
from hough_tui.ui.forms.list_bar import ListBar
from hough_tui.ui.forms.numbers import Unreadable
from hough_tui.ui.forms.texts import next_of, text_of
from hough_tui.ui.messages import ElementAdded, ElementRemoved, FieldEdited, FieldUnreadable
from hough_tui.ui.screens.explanation import ExplanationScreen


class ListTable(Widget):
    """The elements of a list of the set: a row for each, a column for each of their fields.

    It posts `FieldEdited`, `FieldUnreadable`, `ElementAdded` and `ElementRemoved`, and shows what
    `load` gives it. A cell whose value is not taken stays open, with what is wrong below the table.

    Parameters
    ----------
    field : the list
    """

    DEFAULT_CSS = """
    ListTable {
        height: auto;
        layers: default editor;
        & > .list--empty { display: none; height: 1; padding-left: 1; color: $text-muted; }
        & > .list--message { display: none; height: auto; padding-left: 2; color: $text-error; }
        &:focus-within { color: $foreground; }
        &:focus-within > ListBar > Static { color: $text-accent; }
    }
    """

    BINDINGS = [
        Binding("a", "add", "Add", id="list.add"),
        Binding("c", "duplicate", "Duplicate", show=False, id="list.duplicate"),
        Binding("d,delete", "remove", "Remove", id="list.remove"),
        Binding("question_mark,ctrl+question_mark", "explain", "Explain", key_display="?", id=EXPLAIN),
        Binding("tab", "finish(1)", "Next cell", show=False, id="list.next_cell"),
        Binding("shift+tab", "finish(-1)", "Cell before", show=False, id="list.previous_cell"),
        Binding("escape", "cancel", "Leave as it was", show=False, id="list.cancel"),
    ]

    def __init__(self, field: FieldDescription) -> None:
        super().__init__()
        self.field = field
        self._elements: Sequence[BaseModel] = ()
        self._holder: BaseModel | None = None
        self._unit: Unit | None = None
        self._columns: tuple[FieldDescription, ...] = ()
        self._editor: CellEditor | None = None
        self._new_row: int | None = None
        self._table = CellTable()
        self._empty = Static(f"no {within(field.label)} yet; a adds one", classes="list--empty", markup=False)
        self._message = Static("", classes="list--message", markup=False)

    @property
    def is_sound(self) -> bool:
        """Whether nothing that is typed here is wrong."""
        return self._editor is None or not self._editor.is_wrong

    @property
    def cursor_path(self) -> Path | None:
        """Where the value under the cursor stands in the set; None where it stands nowhere."""
        place = self._table.cursor_coordinate
        if place.row >= len(self._elements) or place.column >= len(self._columns):
            return None
        return (*self.field.path, place.row, *self._columns[place.column].path)

    def compose(self) -> ComposeResult:
        yield ListBar(self.field)
        yield self._table
        yield self._empty
        yield self._message

    def on_mount(self) -> None:
        self._show()
        self.watch(self._table, "scroll_x", self._put_editor, init=False)
        self.watch(self._table, "scroll_y", self._put_editor, init=False)

    def load(
        self,
        field: FieldDescription,
        elements: Sequence[BaseModel],
        holder: BaseModel | None = None,
        unit: Unit | None = None,
    ) -> None:
        """Show elements; a cell under edit stays open until it has the value that it asked for.

        Parameters
        ----------
        field : the list, and with it its path
        holder : what the list is part of: empty groups of an element are taken from it
        unit : the unit of lengths
        """
        is_same = field.path == self.field.path and len(elements) == len(self._elements)
        self.field, self._elements, self._holder, self._unit = field, elements, holder, unit
        self._columns = tuple(filter(self.is_of_use, columns_of(field.models, unit, elements)))
        if self.is_mounted:
            self._show()
        editor = self._editor
        if editor is None:
            self._say(None)
        elif not is_same:
            # The rows are others now; an edit must not end up in one that it was not meant for.
            self._close()
        elif editor.asked is not None and self._value_at(editor.place) == editor.asked[0]:
            self._close(editor.step)

    def show_problem(self, problem: Problem | None) -> None:
        """Say below the table what is wrong; None takes it away."""
        editor, self._new_row = self._editor, None
        if problem is None:
            return self._say(None)
        where = f"{dotted(problem.path[len(self.field.path) - 1 :])}: "
        if editor is not None:
            editor.refuse()
            where = "" if problem.path == editor.path else where
        self._say(where + problem.message)

    def worked_out(self) -> Sequence[tuple[str, str]]:
        """Return label and unit of the columns that are worked out of the others."""
        return ()

    def worked_out_cells(self, element: BaseModel) -> Sequence[str]:
        """Return the cells of those columns."""
        return ()

    def is_of_use(self, column: FieldDescription) -> bool:
        """Return whether a column is shown: some fields mean nothing in what the list is part of."""
        return True

    def new_element(self) -> dict[str, Any]:
        """Return the data of a new element."""
        return starter(self.field.models[0], names_of(self._elements))

    def action_add(self) -> None:
        """Ask for a new element below the cursor."""
        self._insert(self.new_element())

    def action_duplicate(self) -> None:
        """Ask for another element like the one under the cursor."""
        row = self._table.cursor_row
        if row < len(self._elements):
            self._insert(duplicate(self._elements[row], names_of(self._elements)))

    def action_remove(self) -> None:
        """Ask for the element under the cursor to go."""
        row = self._table.cursor_row
        if row < len(self._elements):
            self.post_message(ElementRemoved((*self.field.path, row)))

    def action_explain(self) -> None:
        """Explain the field under the cursor."""
        place, path = self._table.cursor_coordinate, self.cursor_path
        if path is not None:
            column = self._columns[place.column]
            text = self._editor.text if self._editor else text_of(column, self._value_at(place))
            self.app.push_screen(ExplanationScreen(replace(column, path=path), text))

    def action_finish(self, step: int = 0) -> None:
        """Ask for what is typed, and go on by some cells when it is taken."""
        editor = self._editor
        if editor is None or editor.asked is not None:
            return
        meaning = editor.meaning
        if isinstance(meaning, Unreadable):
            editor.refuse()
            self._say(meaning.message)
            self.post_message(FieldUnreadable(editor.path, meaning.message))
        elif meaning == editor.value and not editor.is_wrong:
            self._close(step)
        else:
            editor.asked, editor.step = (meaning,), step
            self._post(editor.place, meaning)

    def action_cancel(self) -> None:
        """Leave the cell as it was."""
        if self._editor is not None and self._editor.is_wrong:
            # The set's own value again: whoever waits for the cell to be mended is told so.
            self._post(self._editor.place, self._editor.value)
        self._close()

    def check_action(self, action: str, parameters: tuple[object, ...]) -> bool | None:
        return self._editor is not None if action in ("finish", "cancel") else True

    @on(DataTable.CellSelected)
    def _selected(self, event: DataTable.CellSelected) -> None:
        event.stop()
        self._edit(event.coordinate)

    @on(events.DescendantFocus)
    def _entered(self) -> None:
        if not self._elements:
            # An empty table has no height that the form could scroll to.
            self.scroll_visible(animate=False)

    @on(ListBar.Pressed)
    async def _pressed(self, event: ListBar.Pressed) -> None:
        event.stop()
        self._table.focus(scroll_visible=False)
        await self.run_action(event.action)

    @on(Input.Submitted)
    def _submitted(self, event: Input.Submitted) -> None:
        event.stop()
        self.action_finish()

    @on(Input.Blurred)
    def _left(self, event: Input.Blurred) -> None:
        event.stop()
        # A terminal that is left, or a screen over this one, is no end of editing.
        if self._editor is not None and self.app.app_focus and self.screen.focused is not self._editor.line:
            self.action_finish()

    @on(ExplanationWanted)
    def _asked(self, event: ExplanationWanted) -> None:
        event.stop()
        self.action_explain()

    def edit_of(self, element: BaseModel, base: Path, path: Path, value: Any) -> Edit:
        """Return what to ask of the set where a cell of an element gets a value; see `edits.edit_of`."""
        return edit_of(element, base, path, value, holder=self._holder, found=self.field.models)

    def _show(self) -> None:
        extra = self.worked_out()
        headings = [heading(one.label, one.unit, right=is_right(one)) for one in self._columns]
        headings += [heading(label, unit, right=True) for label, unit in extra]
        rows = [
            [cell(column, element, self._holder) for column in self._columns]
            + [Text(text, "dim", justify="right") for text in self.worked_out_cells(element)]
            for element in self._elements
        ]
        self._table.show(headings, rows)
        if self._new_row is not None and self._new_row < len(rows):
            self._table.move_cursor(row=self._new_row, column=0, animate=False)
            # The table has grown, maybe beyond what can be seen of the form.
            self.call_after_refresh(self._table.scroll_visible, animate=False)
        self._new_row = None
        self._empty.display = not rows

    def _value_at(self, place: Coordinate) -> Any:
        return value_in(self._elements[place.row], self._columns[place.column].path)

    def _insert(self, data: dict[str, Any]) -> None:
        self._new_row = min(self._table.cursor_row + 1, len(self._elements))
        self.post_message(ElementAdded((*self.field.path, self._new_row), data))

    def _edit(self, place: Coordinate) -> None:
        if self._editor is not None:
            # What is typed there must be mended or left first.
            self._editor.line.focus()
            return
        if place.column >= len(self._columns):
            return self._say("this is worked out of the other columns; edit those")
        column, path = self._columns[place.column], (*self.field.path, place.row)
        if not has(self._elements[place.row], column):
            return self._say(f"this one has no {within(column.label)}")
        value = self._value_at(place)
        self._say(None)
        if column.kind in (Kind.FLAG, Kind.CHOICE):
            return self._post(place, next_of(column, value))
        hint = text_of(column, inherited(column, self._holder)) or ("none" if column.optional else "")
        self._editor = CellEditor(column, place, (*path, *column.path), value, hint)
        self.mount(self._editor)
        self._put_editor()
        self._editor.line.focus(scroll_visible=False)

    def _put_editor(self) -> None:
        if self._editor is not None:
            self._editor.put(self._table.cell_region(self._editor.place), self._table.virtual_region)

    def _post(self, place: Coordinate, value: Any) -> None:
        base = (*self.field.path, place.row)
        path, element = (*base, *self._columns[place.column].path), self._elements[place.row]
        self.post_message(FieldEdited(*self.edit_of(element, base, path, value)))

    def _close(self, step: int = 0) -> None:
        editor, self._editor = self._editor, None
        if editor is not None:
            if editor.line.has_focus:
                self._table.focus(scroll_visible=False)
                self._table.move_cursor(row=editor.place.row, column=max(0, editor.place.column + step))
            editor.remove()
        self._say(None)

    def _say(self, words: str | None) -> None:
        self._message.update(Content(f"! {words}" if words else ""))
        self._message.display = bool(words)
        if words and self.has_focus_within:
            # The table may stand at the end of what can be seen of the form.
            self.call_after_refresh(self._message.scroll_visible, animate=False)

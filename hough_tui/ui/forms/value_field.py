"""One field of a form: label with unit, control, what `auto` is worked out to, and what is wrong."""

from __future__ import annotations

from typing import Any

from textual import on
from textual.app import ComposeResult
from textual.binding import Binding
from textual.content import Content
from textual.events import Resize
from textual.widget import Widget
from textual.widgets import Input, Select, Static

from algorithms.parameters import Path
from hough_tui.ui.forms.controls import EXPLAIN, ExplanationWanted, Flag, Menu, input_for
from hough_tui.ui.forms.fields import FieldDescription, Kind
from hough_tui.ui.forms.numbers import Unreadable
from hough_tui.ui.forms.texts import shown, text_of, value_of
from hough_tui.ui.messages import FieldEdited, FieldUnreadable
from hough_tui.ui.screens.explanation import ExplanationScreen

CONTROL = "field--control"

ROOMY, STACKED = 56, 40
"""Widths from which what is worked out stands beside, and below which the label stands above."""


class ValueField(Widget):
    """One field, which says what is typed into it and never changes it.

    It posts `FieldEdited` where the meaning of what is typed changes, and `FieldUnreadable` where it
    comes to have none. The value that it was last given from outside is its baseline.

    Parameters
    ----------
    field : what the field is
    value : what it holds
    auto_value : what `auto`, or nothing, is worked out to
    width : how wide it is going to be, if that is known: it need not be styled twice then
    """

    DEFAULT_CSS = """
    ValueField {
        layout: grid;
        height: auto;
        grid-size: 2;
        grid-columns: 22 1fr;
        grid-rows: auto;
        & > .field--label { height: 1; width: 100%; padding-right: 1; }
        & > .field--label, & > .field--note { text-wrap: nowrap; text-overflow: ellipsis; }
        & > .field--note { display: none; height: 1; width: 100%; padding-left: 2; color: $text-muted; }
        & > .field--message { display: none; height: auto; padding-left: 2; color: $text-error; }
        & > .field--note, & > .field--message { column-span: 2; }
        & > .field--constant { height: 1; padding-left: 1; color: $text-muted; }
        & > Flag { padding: 0 1; }
        & > Input.field--control { padding: 0 1; }
        & > Select.field--control > SelectCurrent { padding: 0 1; }
        & > Input.-wrong { background-tint: $error 25%; }
        &:ansi > Input.field--control { text-style: underline; }
        /* Textual looks at what is inside only where the widget itself has such a rule. */
        &:focus-within { color: $foreground; }
        &:focus-within > .field--label { text-style: bold; color: $text-accent; }
        &.-noted > .field--note { display: block; }
        &.-roomy { grid-size: 3; grid-columns: 22 24 1fr; }
        &.-roomy > .field--note { display: block; column-span: 1; }
        &.-roomy > .field--message { column-span: 3; }
        &.-long.-roomy { grid-size: 2; grid-columns: 22 1fr; }
        &.-long.-roomy > .field--message { column-span: 2; }
        &.-stacked { grid-size: 1; grid-columns: 1fr; }
        &.-stacked > .field--note, &.-stacked > .field--message { column-span: 1; }
    }
    """

    BINDINGS = [
        Binding("question_mark,ctrl+question_mark", "explain", "Explain", key_display="?", id=EXPLAIN),
        Binding("escape", "revert", "Put back", show=False, id="field.revert"),
    ]

    def __init__(
        self, field: FieldDescription, value: Any, auto_value: Any = None, *, width: int | None = None
    ) -> None:
        self.field = field
        self._value = value
        self._auto = auto_value
        self._meaning: Any = value
        self._posted: list[Any] = []
        self._problem: str | None = None
        self._said = (self._worked_out(), "")
        self._has_note = field.kind not in (Kind.TEXT, Kind.TEXTS, Kind.MAPPING)
        # A class that is there from the beginning costs nothing; one that is set later styles all anew.
        classes = {"-long": not self._has_note, "-noted": bool(self._said[0])}
        if width is not None:
            classes |= {"-roomy": width >= ROOMY, "-stacked": width < STACKED}
        super().__init__(classes=" ".join(name for name, is_set in classes.items() if is_set))
        self._label = Static(field.title, classes="field--label", markup=False)
        self._control = self._made_control()
        self._note = Static(self._said[0], classes="field--note", markup=False)
        self._message = Static("", classes="field--message", markup=False)

    @property
    def path(self) -> Path:
        """Where the field stands."""
        return self.field.path

    @property
    def text(self) -> str:
        """What is typed or chosen."""
        match self._control:
            case Input():
                return self._control.value
            case Select():
                return "" if self._control.is_blank() else str(self._control.value)
            case Flag():
                return text_of(self.field, self._control.value)
        return text_of(self.field, self._value)

    @property
    def meaning(self) -> Any | Unreadable:
        """The value that the field holds, or why what is typed is none."""
        if isinstance(self._control, Flag):
            return self._control.value
        return self._value if self.field.is_constant else value_of(self.field, self.text)

    @property
    def problem(self) -> str | None:
        """What is said to be wrong; None where nothing is."""
        meaning = self._meaning
        return meaning.message if isinstance(meaning, Unreadable) else self._problem

    @property
    def in_short(self) -> str:
        """What the field is, in one sentence."""
        return f"{self.field.title}: {self.field.help}. ? tells more."

    def compose(self) -> ComposeResult:
        self._label.tooltip = Content(self.field.help)
        yield self._label
        yield self._control
        if self._has_note:
            yield self._note
        yield self._message

    def on_resize(self, event: Resize) -> None:
        self.set_class(event.size.width >= ROOMY, "-roomy")
        self.set_class(event.size.width < STACKED, "-stacked")

    def show_problem(self, message: str | None) -> None:
        """Say beside the field what is wrong with its value; None takes it away."""
        self._problem = message
        self._show()

    def refresh_value(self, value: Any, auto_value: Any = None) -> None:
        """Show a value that was set outside; nothing is posted.

        What is typed stays as it is where it means that value, and where it is newer than the value:
        a value that the field itself posted is no news.
        """
        is_new, self._value, self._auto = value != self._value, value, auto_value
        if value in self._posted:
            # Of what was posted, later values are still on their way.
            del self._posted[: self._posted.index(value) + 1]
        elif is_new:
            self._posted.clear()
            if self.meaning != value:
                self._put(value)
            self._meaning = value
        if self.meaning == value:
            self._meaning, self._problem = value, None
        self._show()

    def redescribe(self, field: FieldDescription) -> None:
        """Show another unit: everything else about the field stays."""
        if field.title != self.field.title:
            self._label.update(Content(field.title))
        self.field = field

    def begin(self, field: FieldDescription, value: Any, auto_value: Any = None) -> None:
        """Be a field of another model, of the same kind; what was typed for the one before is gone."""
        self.redescribe(field)
        self._value, self._auto, self._meaning, self._problem = value, auto_value, value, None
        self._posted.clear()
        if self.text != text_of(field, value):
            self._put(value)
        self._show()

    def action_explain(self) -> None:
        """Explain the field."""
        self.app.push_screen(ExplanationScreen(self.field, self.text, self._worked_out()))

    def action_revert(self) -> None:
        """Put back the value that is in effect."""
        self._put(self._value)
        self._take()

    def check_action(self, action: str, parameters: tuple[object, ...]) -> bool | None:
        # Where there is nothing to put back, Escape is for someone else.
        return self.meaning != self._value if action == "revert" else True

    @on(Input.Changed)
    @on(Select.Changed)
    @on(Flag.Changed)
    def _changed(self, event: Input.Changed | Select.Changed | Flag.Changed) -> None:
        event.stop()
        self._take()

    @on(ExplanationWanted)
    def _asked(self, event: ExplanationWanted) -> None:
        event.stop()
        self.action_explain()

    def _take(self) -> None:
        """Post what the field means now, if that is something new; mounting changes nothing."""
        meaning = self.meaning
        if meaning == self._meaning:
            return
        self._meaning = meaning
        if isinstance(meaning, Unreadable):
            self.post_message(FieldUnreadable(self.path, meaning.message))
        else:
            self._posted.append(meaning)
            self.post_message(FieldEdited(self.path, meaning))
        self._show()

    def _put(self, value: Any) -> None:
        """Show a value in the control without a word."""
        with self.prevent(Input.Changed, Select.Changed, Flag.Changed):
            match self._control:
                case Input():
                    self._control.value = text_of(self.field, value)
                case Select():
                    self._control.value = Select.NULL if value is None else text_of(self.field, value)
                case Flag():
                    self._control.value = bool(value)

    def _made_control(self) -> Widget:
        text = text_of(self.field, self._value)
        match self.field.kind:
            case Kind.FLAG:
                return Flag(bool(self._value), classes=CONTROL)
            case Kind.CHOICE if self.field.is_constant:
                return Static(text, classes=f"field--constant {CONTROL}", markup=False)
            case Kind.CHOICE:
                return Menu(
                    [(Content(choice), choice) for choice in self.field.choices],
                    value=text if text else Select.NULL,
                    allow_blank=self.field.optional,
                    prompt="none",
                    compact=True,
                    classes=CONTROL,
                )
        return input_for(self.field, text, "none" if self.field.optional else "", CONTROL)

    def _worked_out(self) -> str:
        """Return what `auto`, or nothing, comes to; empty where the field says it itself."""
        if self._auto is None or self._auto == self._meaning or self._meaning not in ("auto", None):
            return ""
        unit = f" {self.field.unit}" if self.field.unit else ""
        return f"{self._meaning or 'worked out'}: {shown(self._auto)}{unit}"

    def _show(self) -> None:
        """Show what is worked out and what is wrong, where either has changed."""
        said = self._worked_out(), self.problem or ""
        if said == self._said:
            return
        self._said = (note, problem) = said
        self._note.update(Content(note))
        self.set_class(bool(note), "-noted")
        self._message.update(Content(f"! {problem}" if problem else ""))
        self._message.display = bool(problem)
        self._control.set_class(bool(problem), "-wrong")
        if problem and self.has_focus_within:
            self.call_after_refresh(self._message.scroll_visible, animate=False)

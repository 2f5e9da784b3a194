"""What a field is: its help, unit, bounds, default and how its `auto` is worked out."""

from __future__ import annotations

from rich.text import Text
from textual.app import ComposeResult
from textual.binding import Binding
from textual.containers import VerticalScroll
from textual.screen import ModalScreen
from textual.widgets import Static

from algorithms.parameters import Path, dotted
from hough_tui.ui.forms.fields import FieldDescription, Kind
from hough_tui.ui.forms.texts import text_of

NAMES = {
    Kind.NUMBER: "a number",
    Kind.WHOLE: "a whole number",
    Kind.CHOICE: "a choice",
    Kind.TEXT: "text",
    Kind.FLAG: "yes or no",
    Kind.VECTORS: "vectors, with semicolons between them: 40, 20; 60, 20",
    Kind.TEXTS: "names, with commas between them",
    Kind.MAPPING: "names with their values: scans: 5, 10, 15; rate: 20, 50",
}


def explained(
    field: FieldDescription, text: str = "", auto: str = "", path: Path | None = None
) -> list[tuple[str, str]]:
    """Return what is to be said of a field, each with a heading.

    Parameters
    ----------
    text : what the field holds
    auto : what its `auto` is worked out to, with its unit
    path : where it stands in the set, if other than the field says
    """
    allowed = field.wanted.allowed if field.is_numeric else NAMES.get(field.kind, "")
    if field.kind is Kind.CHOICE:
        allowed = ", ".join(field.choices)
    if not field.is_numeric and field.optional:
        allowed += " or empty"
    default = "none: it must be given" if field.required else text_of(field, field.default) or "empty"
    said = [
        ("Unit", field.unit),
        ("Allowed", f"{allowed}; {field.bounds}" if field.bounds else allowed),
        ("Default", default),
        ("auto", field.auto),
        ("Now", f"{text or 'empty'} ({auto})" if auto else text or "empty"),
        ("Field", dotted(path or field.path)),
    ]
    return [(heading, words) for heading, words in said if words]


class ExplanationScreen(ModalScreen[None]):
    """A field explained, over the form.

    Parameters
    ----------
    field : the field
    text : what it holds
    auto : what its `auto` is worked out to, with its unit
    """

    DEFAULT_CSS = """
    ExplanationScreen {
        align: center middle;
        & > VerticalScroll {
            width: 72;
            max-width: 94%;
            height: auto;
            max-height: 90%;
            padding: 1 2;
            background: $surface;
            border: round $border;
            border-title-color: $text-accent;
        }
        .explanation--help { margin-bottom: 1; }
    }
    """

    BINDINGS = [
        Binding("escape,enter,question_mark,q", "close", "Close", key_display="Esc", id="explanation.close"),
    ]

    def __init__(self, field: FieldDescription, text: str = "", auto: str = "") -> None:
        super().__init__()
        self.field = field
        self._said = explained(field, text, auto)

    def compose(self) -> ComposeResult:
        width = max(len(heading) for heading, _ in self._said) + 2
        with VerticalScroll() as panel:
            yield Static(
                self.field.help[:1].upper() + self.field.help[1:], classes="explanation--help", markup=False
            )
            for heading, words in self._said:
                yield _Line(heading, words, width)
        panel.border_title = Text(self.field.title).markup
        panel.border_subtitle = "Esc closes · F1 tells of the view"

    def action_close(self) -> None:
        """Go back to the form."""
        self.dismiss()


class _Line(Static):
    """A heading and what is said under it, wrapped beside the heading."""

    DEFAULT_CSS = """
    _Line {
        layout: horizontal;
        height: auto;
        & > .line--heading { color: $text-muted; }
        & > .line--words { width: 1fr; }
    }
    """

    def __init__(self, heading: str, words: str, width: int) -> None:
        super().__init__()
        self._heading = Static(heading, classes="line--heading", markup=False)
        self._heading.styles.width = width
        self._words = Static(words, classes="line--words", markup=False)

    def compose(self) -> ComposeResult:
        yield self._heading
        yield self._words

"""YAML 1.2 text to plain data, with the line and column of every value.

What PyYAML makes of scalars is not the core schema of YAML 1.2, so the data is built here, from the events
of its parser.
"""

from __future__ import annotations

import copy
import re
from dataclasses import dataclass, field
from typing import Any

import yaml  # type: ignore[import-untyped,unused-ignore]

from algorithms.errors import RequestError
from algorithms.parameters import shortened
from scenarios.files.marked_yaml.syntax import (
    BLANK_END,
    BREAK,
    BREAKS,
    COMMENT,
    CORE,
    DEEPEST,
    LINE_END,
    MERGE,
    MOST_COPIES,
    MOST_VALUES,
    Path,
    match_end,
    scalar_maker,
)
from scenarios.files.marked_yaml.writing import Layout


@dataclass(frozen=True, slots=True)
class Mark:
    """A place in a text, counted from one, as editors count."""

    line: int
    column: int


@dataclass(slots=True)
class Node:
    """A value, the stretch of text that it stands on and, in a collection, the entry that it makes."""

    value: Any
    mark: Any
    start: int
    end: int
    block: bool = False
    opened: int = 0  # just behind the bracket; 0 where there is none
    children: list[Node] = field(default_factory=list)
    size: int = 1
    height: int = 0
    key: Node | None = None
    first: int = 0  # where the entry begins: at its key, or at the `?` or dash before it
    column: int = 0
    last: int = 0


@dataclass(frozen=True)
class MarkedDocument:
    """The data of a YAML document, and where each part of it stands in the text."""

    data: Any
    source: str
    _root: Node | None = field(default=None, repr=False, compare=False)

    def mark(self, path: Path, *, key: bool = False) -> Mark:
        """Return where the value at `path` stands or, with `key`, the mapping key that leads to it.

        Without such a path its nearest existing ancestor counts, in an empty document 1:1. Never raises.
        """
        node = self._root
        if node is None:
            return Mark(1, 1)
        mark = node.mark
        for position, part in enumerate(path):
            numbered = enumerate(node.children)
            found = [child for at, child in numbered if part == (child.key.value if child.key else at)]
            if not found:
                break
            node = found[0]
            mark = node.key.mark if key and node.key and position == len(path) - 1 else node.mark
        return Mark(mark.line + 1, mark.column + 1)

    def where(self, path: Path, *, key: bool = False) -> str:
        """Return the place of `path` as `FILE:line:column`, to begin a message with."""
        mark = self.mark(path, key=key)
        return f"{self.source}:{mark.line}:{mark.column}"


def read(text: str, source: str) -> MarkedDocument:
    """Read one YAML 1.2 document; `source` names it in messages.

    Mappings become dicts with text keys, sequences lists, scalars what the core schema makes of them; an
    empty document is None. Every use of an alias gets data of its own.

    Raises `RequestError`, with line and column, for text that is not YAML, duplicate keys, keys that are not
    text, merge keys, tags, a second document, recursive or exploding aliases, and nesting that is too deep.
    Only the first of these is named: what else would be wrong, such as missing fields, may follow from it.
    """
    root = Reader(text, source).root
    return MarkedDocument(root.value if root else None, source, root)


class _Loader(yaml.SafeLoader):  # type: ignore[misc,unused-ignore]
    """PyYAML's scanner and parser, which also tell where the present key or list item opened."""

    opening: Any = None

    def get_token(self) -> Any:
        token = super().get_token()  # type: ignore[no-untyped-call,unused-ignore]
        if isinstance(token, yaml.BlockEntryToken | yaml.KeyToken):
            self.opening = token.start_mark
        return token


class Reader:
    """One pass over a text; afterwards `root`, `layout` and `aliases` describe it."""

    def __init__(self, text: str, source: str) -> None:
        self.text = text
        self.source = source
        self.aliases: list[tuple[int, int, Any]] = []
        self.copies = 0
        self.values = 0
        self.anchors: dict[str | None, Node | None] = {}
        self.indents: dict[type, int] = {}
        try:
            self.loader: Any = _Loader(text)
        except yaml.reader.ReaderError as error:
            above = re.split(BREAK, text[: error.position])
            problem = f"YAML does not allow U+{ord(text[error.position]):04X} here; remove it or escape it"
            raise RequestError(f"{source}:{len(above)}:{len(above[-1]) + 1}: {problem}") from None
        self.root = self.document()
        step, newline = self.indents.get(dict, 2), "\r\n" if "\r\n" in text else "\n"
        self.layout = Layout(step, self.indents.get(list, step), newline)

    def failure(self, mark: Any, message: str) -> RequestError:
        """Return what is wrong at a mark, with its place."""
        return RequestError(f"{self.source}:{mark.line + 1}:{mark.column + 1}: {message}")

    def event(self) -> Any:
        """Take the next event of the parser; its complaints become requests."""
        try:
            return self.loader.get_event()
        except (yaml.MarkedYAMLError, ValueError, OverflowError) as error:
            # PyYAML lets pass what int() and chr() say of impossible numbers and escapes.
            mark = getattr(error, "problem_mark", None) or self.loader.get_mark()
            context, begun = getattr(error, "context", None) or "", getattr(error, "context_mark", None)
            if begun and begun.line != mark.line:
                context += f" that began on line {begun.line + 1},"
            said = f"{context} {getattr(error, 'problem', None) or error}"
            remedy = "use spaces instead" if "\\t" in said else "check indentation, brackets and quotes"
            raise self.failure(
                mark, f"not valid YAML: {shortened(' '.join(said.split()), 200)}; {remedy}"
            ) from None

    def document(self) -> Node | None:
        """Read the one document that there may be."""
        self.event()
        if isinstance(self.event(), yaml.StreamEndEvent):
            return None
        root = self.node(self.event(), 0)
        self.event()
        event = self.event()
        if isinstance(event, yaml.StreamEndEvent):
            return root
        raise self.failure(event.start_mark, "a second document begins here; put it into a file of its own")

    def node(self, event: Any, depth: int) -> Node:
        """Read the value that an event begins."""
        mark = event.start_mark
        self.values += 1
        if self.values > MOST_VALUES:
            raise self.failure(mark, f"more than {MOST_VALUES:,} keys and values; make the document smaller")
        if depth > DEEPEST:
            raise self.failure(mark, f"nested more than {DEEPEST} levels deep; make the document flatter")
        if isinstance(event, yaml.AliasEvent):
            return self.alias(event, depth)
        is_scalar, is_map = isinstance(event, yaml.ScalarEvent), isinstance(event, yaml.MappingStartEvent)
        if event.tag not in (None, "!", CORE + ("str" if is_scalar else "map" if is_map else "seq")):
            tag = event.tag.replace(CORE, "!!")
            raise self.failure(mark, f"the tag {shortened(tag)} means nothing here; remove it")
        self.anchors[event.anchor] = None
        if is_scalar:
            value, end, literal = self.scalar(event), event.end_mark.index, event.style in ("|", ">")
            if literal and value.strip("\n") and not value.endswith("\n\n"):
                # Blank lines below a block scalar are not its own, unless it keeps them in its value.
                end = mark.index + len(BLANK_END.sub("", self.text[mark.index : end]))
            node = Node(value, mark, mark.index, end, literal)
        else:
            node = self.collection(event, depth)
        self.anchors[event.anchor] = node
        return node

    def alias(self, event: Any, depth: int) -> Node:
        """Return a copy of what an alias stands for."""
        name, mark, end = event.anchor, event.start_mark, event.end_mark.index
        target = self.anchors.get(name)
        if target is None:
            fault = "stands inside its own anchor" if name in self.anchors else "has no anchor before it"
            raise self.failure(mark, f"the alias *{shortened(name)} {fault}; write the value out")
        self.copies += target.size
        if self.copies > MOST_COPIES or depth + target.height > DEEPEST:
            raise self.failure(mark, "the aliases make the document too large; use fewer of them")
        value = copy.deepcopy(target.value)
        self.aliases.append((mark.index, end, value))
        return Node(value, mark, mark.index, end, False, 0, target.children, target.size, target.height)

    def scalar(self, event: Any) -> Any:
        """Return the value of a scalar."""
        try:
            # JSON writes a character beyond U+FFFF as two escapes, which are one character in the end.
            text = event.value.encode("utf-16-le", "surrogatepass").decode("utf-16-le")
            make = scalar_maker(text) if event.tag is None and not event.style else None
            return make(text) if make else text
        except ValueError as error:
            what = "half a character" if isinstance(error, UnicodeError) else "a number with too many digits"
            raise self.failure(event.start_mark, f"{what} stands here; correct it") from None

    def collection(self, event: Any, depth: int) -> Node:
        """Read a mapping or a list."""
        mark, opened, flow = event.start_mark, event.end_mark.index, event.flow_style
        is_map = isinstance(event, yaml.MappingStartEvent)
        braced = flow and self.text[opened - 1] == ("{" if is_map else "[")  # not so the mapping in `[a: 1]`
        node = Node({} if is_map else [], mark, mark.index, opened, not flow, opened if braced else 0)
        event = self.event()
        while not isinstance(event, yaml.CollectionEndEvent):
            opening: Any = self.loader.opening
            # In `{a, b: 1}` nothing but its text opens `a`, and in flow lists nothing ever does.
            if flow and not (is_map and opening and node.end <= opening.index <= event.start_mark.index):
                opening = event.start_mark
            key = self.key(event, node, depth) if is_map else None
            child = self.node(self.event() if key else event, depth + 1)
            if key and child.start == child.end and self.text[child.start - 1] != ":":
                if ":" in key.value and self.text[key.start : key.end] == key.value:
                    spaced = key.value.replace(":", ": ", 1)
                    raise self.failure(key.mark, f"{key.value} is no field with a value; write {spaced}")
                # PyYAML puts the value of a key without a colon in front of whatever comes next.
                child.start, child.end, child.mark = key.end, key.end, key.mark
            if key:
                node.value[key.value] = child.value
            else:
                node.value.append(child.value)
            if key and child.block and child.children:
                self.indents.setdefault(type(child.value), child.children[0].column - opening.column)
            node.end = child.end if flow else self.tail(child.end, opening.column)
            child.key, child.first, child.column, child.last = key, opening.index, opening.column, node.end
            node.children.append(child)
            node.size += child.size
            node.height = max(node.height, child.height + 1)
            event = self.event()
        if node.opened:
            closing: Any = event.end_mark
            node.end = closing.index
        return node

    def key(self, event: Any, mapping: Node, depth: int) -> Node:
        """Read a key of a mapping; it must be text, and new, and no merge key of YAML 1.1."""
        is_plain = isinstance(event, yaml.ScalarEvent) and not event.style
        if is_plain and event.value == MERGE and event.tag in (None, CORE + "merge"):
            message = f"merge keys ({MERGE}) are not YAML 1.2; write the fields out"
            raise self.failure(event.start_mark, message)
        key = self.node(event, depth + 1)
        if not isinstance(key.value, str):
            shown = " ".join(self.text[key.start : key.end].split())[:40] or "(none)"
            raise self.failure(key.mark, f"the key {shown} is no text; quote it, or choose another one")
        if key.value in mapping.value:
            before = mapping.children[list(mapping.value).index(key.value)].key or key
            twice = f"stands on line {before.mark.line + 1} and again on line {key.mark.line + 1}"
            raise self.failure(key.mark, f"the key {shortened(key.value)!r} {twice}; keep one of them")
        return key

    def tail(self, position: int, column: int) -> int:
        """Return where an entry of a block ends: behind its line and the deeper comments below it."""
        line = "" if self.text[position - 1] in BREAKS else LINE_END.pattern
        below = rf"(?:(?:[ \t]*{BREAK})*[ ]{{{column + 1},}}{COMMENT}(?:{BREAK}|\Z))*"
        return match_end(re.compile(line + below), self.text, position)

"""YAML 1.2 text to plain data and back, with the line and column of every value.

`read` turns a document into dicts, lists and scalars and remembers where each of them stands, so that
whoever checks the data can point at the place. `write` prints data as a fresh document. `rewrite` changes
an existing text as little as the new data asks for, so that comments, order and layout survive.

Scalars follow the core schema of YAML 1.2 (`1e-3` and `0o17` are numbers, `no` and `12:30` are text). What
PyYAML makes of scalars does not, so the data is built here, from the events of its parser.
"""

from __future__ import annotations

import contextlib
import copy
import itertools
import json
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import yaml  # type: ignore[import-untyped,unused-ignore]

from algorithms.errors import RequestError

Path = tuple[str | int, ...]

# Deeper than a person writes, and shallow enough for any recursive function that meets the data later.
_DEEPEST = 100
# Values that aliases may add to a document; without a bound a few lines can stand for billions of values.
_MOST_COPIES = 100_000
# PyYAML takes up to 1024 characters for a key on one line; longer keys need the form `? key`.
_LONGEST_KEY = 1000
_SHORT = 72

_BREAKS = "\r\n\x85\u2028\u2029"
_BREAK = rf"(?:\r\n|[{_BREAKS}])"
_COMMENT = rf"#[^{_BREAKS}]*"
_LINE_END = re.compile(rf"[^{_BREAKS}]*(?:{_BREAK}|\Z)")
# What stands above an item, cut in two: things further up; its own comment lines, and its indentation.
_LEAD = re.compile(rf"(?s)\A(.*?)(?<![^{_BREAKS}])((?:[ \t]*{_COMMENT}{_BREAK})*[ ]*)\Z")
_BLANK_END = re.compile(rf"(?<=[{_BREAKS}])(?<!\r(?=\n))(?:[ \t]*{_BREAK})+\Z")
_COMMA = re.compile(rf"\A((?:\s|{_COMMENT})*),")
# What follows an item in brackets and belongs to it: its comma, and a comment on its line.
_TAIL = re.compile(rf"(?:(?:\s|{_COMMENT})*,)?(?:[ \t]*{_COMMENT})?")

# The first pattern that fits a plain scalar makes its value; str() refuses as many digits as int() does.
_SCALARS: tuple[tuple[re.Pattern[str], Callable[[str], Any]], ...] = (
    (re.compile("(null|Null|NULL|~)?"), lambda _: None),
    (re.compile("true|True|TRUE|false|False|FALSE"), lambda text: text[0] in "tT"),
    (re.compile(r"[-+]?[0-9]+"), int),
    (re.compile(r"0o[0-7]+|0x[0-9a-fA-F]+"), lambda text: int(str(int(text, 0)))),
    (re.compile(r"[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?"), float),
    (re.compile(r"[-+]?\.(inf|Inf|INF)|\.(nan|NaN|NAN)"), lambda text: float(text.replace(".", ""))),
)
_CORE = "tag:yaml.org,2002:"


@dataclass(frozen=True, slots=True)
class Mark:
    """A place in a text, counted from one, as editors count."""

    line: int
    column: int


@dataclass(slots=True)
class _Node:
    """A value, the stretch of text that it stands on and, in a collection, the entry that it makes."""

    value: Any
    mark: Any
    start: int
    end: int
    block: bool = False
    opened: int = 0  # just behind the bracket; 0 where there is none
    children: list[_Node] = field(default_factory=list)
    size: int = 1
    height: int = 0
    key: _Node | None = None
    first: int = 0  # where the entry begins: at its key, or at the `?` or dash before it
    column: int = 0
    last: int = 0


@dataclass(frozen=True)
class MarkedDocument:
    """The data of a YAML document, and where each part of it stands in the text."""

    data: Any
    source: str
    _root: _Node | None = field(default=None, repr=False, compare=False)

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
    text, tags, a second document, recursive or exploding aliases, and nesting that is too deep.
    """
    root = _Reader(text, source).root
    return MarkedDocument(root.value if root else None, source, root)


def write(data: Any) -> str:
    """Print data as a fresh document in block style, which `read` reads as the same data.

    Keys keep their order; short lists and mappings of scalars come in flow style, text of several lines as
    a literal block where that can be. Tuples become lists.

    Raises `TypeError` for data that YAML's core schema has no form for, `RequestError` for data that is
    nested too deeply or within itself, or holds text or numbers that could not be read back.
    """
    return "\n".join((*_Layout().lines(_plain(data), 0), ""))


def rewrite(text: str, data: Any) -> str:
    """Change a document so that reading it gives `data`, and leave the rest of its text as it is.

    Keys stay in the order of the text, new ones follow. List items are recognised by equality, by their
    `name`, by their place, and take their comments along when they move. Comments directly above an item go
    when it goes; those above a first item belong to the list, unless other items have comments too. The
    result is read back before it is returned; where no small change does it, it is `write(data)`.

    Raises `RequestError` where the text cannot be read, and what `write` raises for `data`.
    """
    data = _plain(data)
    spelled_out = text
    for start, end, value in reversed(_Reader(text, "text").aliases):
        spelled_out = spelled_out[:start] + _flow(value) + spelled_out[end:]
    # An alias repeats what its anchor says, so a small change can change too much, or cut off the anchor;
    # with every alias spelled out it does neither.
    for attempt in (text, spelled_out):
        with contextlib.suppress(RequestError):
            changed = _Rewriter(attempt, "text").apply(data)
            if _same(read(changed, "text").data, data):
                return changed
    return write(data)


class _Loader(yaml.SafeLoader):  # type: ignore[misc,unused-ignore]
    """PyYAML's scanner and parser, which also tell where the present key or list item opened."""

    opening: Any = None

    def get_token(self) -> Any:
        token = super().get_token()  # type: ignore[no-untyped-call,unused-ignore]
        if isinstance(token, yaml.BlockEntryToken | yaml.KeyToken):
            self.opening = token.start_mark
        return token


class _Reader:
    """One pass over a text; afterwards `root`, `layout` and `aliases` describe it."""

    def __init__(self, text: str, source: str) -> None:
        self.text = text
        self.source = source
        self.aliases: list[tuple[int, int, Any]] = []
        self.copies = 0
        self.anchors: dict[str | None, _Node | None] = {}
        self.indents: dict[type, int] = {}
        try:
            self.loader: Any = _Loader(text)
        except yaml.reader.ReaderError as error:
            above = re.split(_BREAK, text[: error.position])
            problem = f"YAML does not allow U+{ord(text[error.position]):04X} here; remove it or escape it"
            raise RequestError(f"{source}:{len(above)}:{len(above[-1]) + 1}: {problem}") from None
        self.root = self.document()
        step, newline = self.indents.get(dict, 2), "\r\n" if "\r\n" in text else "\n"
        self.layout = _Layout(step, self.indents.get(list, step), newline)

    def failure(self, mark: Any, message: str) -> RequestError:
        return RequestError(f"{self.source}:{mark.line + 1}:{mark.column + 1}: {message}")

    def event(self) -> Any:
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
            raise self.failure(mark, f"not valid YAML: {' '.join(said.split())}; {remedy}") from None

    def document(self) -> _Node | None:
        self.event()
        if isinstance(self.event(), yaml.StreamEndEvent):
            return None
        root = self.node(self.event(), 0)
        self.event()
        event = self.event()
        if isinstance(event, yaml.StreamEndEvent):
            return root
        raise self.failure(event.start_mark, "a second document begins here; put it into a file of its own")

    def node(self, event: Any, depth: int) -> _Node:
        mark = event.start_mark
        if depth > _DEEPEST:
            raise self.failure(mark, f"nested more than {_DEEPEST} levels deep; make the document flatter")
        if isinstance(event, yaml.AliasEvent):
            return self.alias(event, depth)
        is_scalar, is_map = isinstance(event, yaml.ScalarEvent), isinstance(event, yaml.MappingStartEvent)
        if event.tag not in (None, "!", _CORE + ("str" if is_scalar else "map" if is_map else "seq")):
            tag = event.tag.replace(_CORE, "!!")
            raise self.failure(mark, f"the tag {tag} means nothing here; remove it")
        self.anchors[event.anchor] = None
        if is_scalar:
            value, end, literal = self.scalar(event), event.end_mark.index, event.style in ("|", ">")
            if literal and value.strip("\n") and not value.endswith("\n\n"):
                # Blank lines below a block scalar are not its own, unless it keeps them in its value.
                end = mark.index + len(_BLANK_END.sub("", self.text[mark.index : end]))
            node = _Node(value, mark, mark.index, end, literal)
        else:
            node = self.collection(event, depth)
        self.anchors[event.anchor] = node
        return node

    def alias(self, event: Any, depth: int) -> _Node:
        name, mark, end = event.anchor, event.start_mark, event.end_mark.index
        target = self.anchors.get(name)
        if target is None:
            fault = "stands inside its own anchor" if name in self.anchors else "has no anchor before it"
            raise self.failure(mark, f"the alias *{name} {fault}; write the value out")
        self.copies += target.size
        if self.copies > _MOST_COPIES or depth + target.height > _DEEPEST:
            raise self.failure(mark, "the aliases make the document too large; use fewer of them")
        value = copy.deepcopy(target.value)
        self.aliases.append((mark.index, end, value))
        return _Node(value, mark, mark.index, end, False, 0, target.children, target.size, target.height)

    def scalar(self, event: Any) -> Any:
        try:
            # JSON writes a character beyond U+FFFF as two escapes, which are one character in the end.
            text = event.value.encode("utf-16-le", "surrogatepass").decode("utf-16-le")
            make = _maker(text) if event.tag is None and not event.style else None
            return make(text) if make else text
        except ValueError as error:
            what = "half a character" if isinstance(error, UnicodeError) else "a number with too many digits"
            raise self.failure(event.start_mark, f"{what} stands here; correct it") from None

    def collection(self, event: Any, depth: int) -> _Node:
        mark, opened, flow = event.start_mark, event.end_mark.index, event.flow_style
        is_map = isinstance(event, yaml.MappingStartEvent)
        braced = flow and self.text[opened - 1] == ("{" if is_map else "[")  # not so the mapping in `[a: 1]`
        node = _Node({} if is_map else [], mark, mark.index, opened, not flow, opened if braced else 0)
        event = self.event()
        while not isinstance(event, yaml.CollectionEndEvent):
            opening: Any = self.loader.opening
            # In `{a, b: 1}` nothing but its text opens `a`, and in flow lists nothing ever does.
            if flow and not (is_map and opening and node.end <= opening.index <= event.start_mark.index):
                opening = event.start_mark
            key = self.key(event, node, depth) if is_map else None
            child = self.node(self.event() if key else event, depth + 1)
            if key and child.start == child.end and self.text[child.start - 1] != ":":
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

    def key(self, event: Any, mapping: _Node, depth: int) -> _Node:
        key = self.node(event, depth + 1)
        if not isinstance(key.value, str):
            shown = " ".join(self.text[key.start : key.end].split())[:40] or "(none)"
            raise self.failure(key.mark, f"the key {shown} is no text; quote it, or choose another one")
        if key.value in mapping.value:
            before = mapping.children[list(mapping.value).index(key.value)].key or key
            twice = f"stands on line {before.mark.line + 1} and again on line {key.mark.line + 1}"
            raise self.failure(key.mark, f"the key {key.value!r} {twice}; keep one of them")
        return key

    def tail(self, position: int, column: int) -> int:
        """Return where an entry of a block ends: behind its line and the deeper comments below it."""
        line = "" if self.text[position - 1] in _BREAKS else _LINE_END.pattern
        below = rf"(?:(?:[ \t]*{_BREAK})*[ ]{{{column + 1},}}{_COMMENT}(?:{_BREAK}|\Z))*"
        return _match_end(re.compile(line + below), self.text, position)


def _match_end(pattern: re.Pattern[str], text: str, position: int) -> int:
    match = pattern.match(text, position)
    return match.end() if match else position


def _maker(text: str) -> Callable[[str], Any] | None:
    return next((make for pattern, make in _SCALARS if pattern.fullmatch(text)), None)


def _plain(data: Any, path: Path = ()) -> Any:
    """Return the data in the exact types that `read` gives, or raise for what has no form in YAML."""
    place = ".".join(map(str, path)) or "the data"
    if len(path) > _DEEPEST:
        raise RequestError(f"data more than {_DEEPEST} levels deep, or within itself; make it flatter")
    if data is None or isinstance(data, bool):
        return data
    try:
        if isinstance(data, str):
            return data.encode().decode()
        if isinstance(data, int | float):
            return int(str(int(data))) if isinstance(data, int) else float(data)
    except ValueError:
        raise RequestError(f"{place}: no file can hold this text or number; correct it") from None
    if isinstance(data, list | tuple):
        return [_plain(value, (*path, index)) for index, value in enumerate(data)]
    if isinstance(data, Mapping) and all(isinstance(key, str) for key in data):
        return {_plain(key, path): _plain(value, (*path, key)) for key, value in data.items()}
    raise TypeError(f"{place}: YAML has no form for this {type(data).__name__}: {data!r}")


def _canonical(value: Any) -> str:
    """Return a text that two values share if they differ in nothing but the order of their keys."""
    return json.dumps(value, sort_keys=True)


def _same(one: Any, other: Any) -> bool:
    return _canonical(one) == _canonical(other)


def _text(value: str, flow: bool, quote: str = "") -> str:
    """Return text as a scalar on one line: as it is if it then reads as this text, else in quotes."""
    if quote == "'" and value.isprintable():
        return "'" + value.replace("'", "''") + "'"
    taken = (": ", " #", *(",?[]{}" if flow else ""))
    plain = value.isprintable() and _maker(value) is None and not value.startswith("...")
    plain = plain and value[0] not in "-?:,[]{}#&*!|>'\"%@` " and value[-1] not in ": "
    if plain and quote != '"' and not any(sign in value for sign in taken):
        return value
    # JSON's escapes are YAML's too, but JSON leaves some characters as they are that YAML forbids.
    signs = json.dumps(value, ensure_ascii=False)
    return "".join(sign if sign.isprintable() else f"\\U{ord(sign):08x}" for sign in signs)


def _key(key: str | None, flow: bool, between: str) -> str:
    text = "-" if key is None else _text(key, flow)
    return text if key is None else f"{text}:" if len(text) <= _LONGEST_KEY else f"? {text}{between}:"


def _flow(value: Any, *, outer: bool = False, quote: str = "") -> str:
    """Return a value on one line; `outer` where it stands inside no brackets."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{_key(key, True, ' ')} {_flow(child)}" for key, child in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(_flow, value)) + "]"
    if isinstance(value, str):
        return _text(value, not outer, quote)
    if isinstance(value, float):
        return re.sub("(?=inf|nan)", ".", repr(value))
    return "null" if value is None else str(value).lower()


def _literal(value: Any) -> list[str] | None:
    """Return the lines of a text that can be a literal block with every line looking as it is."""
    lines = value.removesuffix("\n").split("\n") if isinstance(value, str) and "\n" in value else [""]
    clean = all(map(str.isprintable, lines))
    return lines if clean and lines[0] and lines[-1] and lines[0][0] != " " else None


def _inline(value: Any) -> str | None:
    """Return a value as it stands on the line of its key, or None if it wants lines of its own."""
    if isinstance(value, dict | list) and value:
        children = list(value.values()) if isinstance(value, dict) else value
        nested = any(isinstance(child, dict | list) or _literal(child) for child in children)
        return None if nested or len(text := _flow(value)) > _SHORT else text
    return None if _literal(value) else _flow(value, outer=True)


class _Layout(NamedTuple):
    """How a document indents: mappings by `step`, lists by `offset` from the key above them."""

    step: int = 2
    offset: int = 2
    newline: str = "\n"

    def lines(self, value: Any, column: int) -> list[str]:
        if not isinstance(value, dict | list) or not value:
            return [_flow(value, outer=True)]
        lines: list[str] = []
        for key, child in value.items() if isinstance(value, dict) else zip(itertools.repeat(None), value):
            head = _key(key, False, self.newline + " " * column)
            first, *rest = self.entry(head, child, column, _inline(child))
            lines += [" " * column + first, *rest]
        return lines

    def entry(self, head: str, value: Any, column: int, inline: str | None) -> list[str]:
        """Return the lines of a key or dash with its value, the first one without its indentation."""
        if inline is not None:
            return [f"{head} {inline}"]
        if literal := _literal(value):
            padding = " " * (column + (2 if head == "-" else self.step))
            header = f"{head} |" if value.endswith("\n") else f"{head} |-"
            return [header, *(line and padding + line for line in literal)]
        if head == "-":
            first, *rest = self.lines(value, column + 2)
            return [f"- {first.lstrip(' ')}", *rest]
        return [head, *self.lines(value, column + (self.offset if isinstance(value, list) else self.step))]


# One entry of the text to come: the number of the entry that it grows from, its key and its value.
_Change = tuple[int | None, str | None, Any]


def _changes(node: _Node, new: Any) -> list[_Change]:
    if isinstance(new, list):
        return list(zip(_origins(node.value, new), itertools.repeat(None), new, strict=False))
    kept: list[_Change] = [(origin, key, new[key]) for origin, key in enumerate(node.value) if key in new]
    return kept + [(None, key, value) for key, value in new.items() if key not in node.value]


def _origins(old: list[Any], new: list[Any]) -> list[int | None]:
    """Find for every new item the old item that it is, or comes from."""
    origins: list[int | None] = [None] * len(new)
    free = set(range(len(old)))
    labels: tuple[Callable[[Any], str | None], ...] = (_canonical, _name, _nameless, lambda _: "")
    for label_of in labels:
        waiting: dict[str | None, list[int]] = {}
        for origin in sorted(free):
            waiting.setdefault(label_of(old[origin]), []).append(origin)
        following = 0
        for target, value in enumerate(new):
            found = origins[target]
            label = label_of(value) if found is None else None
            if label is not None and (candidates := waiting.get(label)):
                # Among equal items the neighbour tells which is which.
                found = following if following in candidates else candidates[0]
                if label or (found == following and None in (_name(old[found]), _name(value))):
                    candidates.remove(found)
                    free.remove(found)
                    origins[target] = found
            if origins[target] is not None:
                following = (found or 0) + 1
    return origins


def _name(value: Any) -> str | None:
    name = value.get("name") if isinstance(value, dict) else None
    return name if isinstance(name, str) and name else None


def _nameless(value: Any) -> str | None:
    return _canonical({**value, "name": ""}) if _name(value) else None


def _grows(node: _Node, new: Any) -> bool:
    """Tell whether entries of the node can be kept, so that its text can become that of the new value."""
    return type(node.value) is type(new) and bool((node.block or node.opened) and node.children and new)


class _Rewriter(_Reader):
    """A reader that puts new values into its text, piece by piece."""

    def apply(self, data: Any) -> str:
        root, text = self.root, self.text
        if _same(root.value if root else None, data):
            return text
        before, after = (text[: root.start], text[root.end :]) if root else (text, "")
        if root and _grows(root, data):
            return (self.block(root, data, before) if root.block else before + self.flow(root, data)) + after
        return self.whole_lines(before) + self.layout.newline.join((*self.layout.lines(data, 0), "")) + after

    def whole_lines(self, text: str) -> str:
        return text if text[-1:] in _BREAKS else text + self.layout.newline

    def inline(self, node: _Node, new: Any, *, outer: bool) -> str:
        if _grows(node, new):
            return self.flow(node, new)
        return _flow(new, outer=outer, quote=self.text[node.start : node.start + 1])

    def block(self, node: _Node, new: Any, before: str) -> str:
        """Return `before` and the new text of a block collection, which ends where its last line ends."""
        entries, changes, column = node.children, _changes(node, new), node.children[0].column
        parts = [self.text[above.last : entry.first] for above, entry in itertools.pairwise(entries)]
        cuts = [("", " " * column), *(_LEAD.findall(part)[0] for part in parts)]
        gaps, leads = map(list, zip(*cuts, strict=True))
        gaps[0] = self.layout.newline if parts and all(gaps[1:]) else ""
        gaps.append("")
        used = {origin for origin, _, _ in changes}
        for number in range(1, len(entries)):
            # Comments with a blank line below them head a section, so they outlive the item.
            if number not in used and "#" in gaps[number]:
                gaps[number + 1] = gaps[number] + gaps[number + 1]
        out = before + self.text[node.start : entries[0].first]
        own_line = out.rstrip(" ")[-1:] in _BREAKS
        if own_line:
            out = out.removesuffix(leads[0])
            # Above the first key of a document stands what the document is about.
            if node is not self.root and any("#" in lead for lead in leads):
                out, lead = _LEAD.findall(out)[0]
                leads[0] = lead + leads[0]
        for index, change in enumerate(changes):
            gap, lead = gaps[change[0] or 0], " " * column if change[0] is None else leads[change[0]]
            gap = gap if index or "#" in gap else ""
            if index or own_line or "#" in gap + lead:
                out = self.whole_lines(out) + gap + lead
            out += self.block_entry(node, change, column)
        return self.whole_lines(out) + gaps[-1] if gaps[-1] else out

    def block_entry(self, parent: _Node, change: _Change, column: int) -> str:
        origin, key, value = change
        inline, head = _inline(value), _key(key, False, self.layout.newline + " " * column)
        if origin is None:
            # A new item looks like its siblings.
            alike = [child for child in parent.children if key is None and _grows(child, value)]
            inline = inline if not alike else None if alike[-1].block else _flow(value)
            return self.layout.newline.join((*self.layout.entry(head, value, column, inline), ""))
        node = parent.children[origin]
        old, before = self.text[node.start : node.end], self.text[node.first : node.start]
        after = self.text[node.end : node.last]
        if _same(node.value, value):
            return before + old + after
        if node.block and _grows(node, value):
            return self.block(node, value, before) + after
        in_place = not node.block and (old or before.endswith((":", "-")))
        if in_place and (_grows(node, value) or inline is not None):
            return before + ("" if old else " ") + self.inline(node, value, outer=True) + after
        # The value changes its form, so its comments gather behind its key.
        key_end = node.key.end if node.key else node.first
        header = old.splitlines()[0] if node.block and not node.children else ""
        cut = 0 if node.block else _match_end(_LINE_END, after, 0)
        comments = re.findall(_COMMENT, self.text[key_end : node.start] + header + after[:cut])
        if node.key and node.first == node.key.start:
            head = self.text[node.first : key_end] + ":"
        if after[cut:].strip() and inline is None and _literal(value):
            inline = _flow(value, outer=True)  # a literal block would take the comments below for its own
        first, *rest = self.layout.entry(head, value, column, inline)
        return self.layout.newline.join(("  ".join((first, *comments)), *rest, "")) + after[cut:]

    def flow(self, node: _Node, new: Any) -> str:
        """Return the new text of a collection in brackets."""
        entries, changes, position = node.children, _changes(node, new), node.opened
        out = self.text[node.start : position]
        leads, tails = [], []
        for entry in entries:
            leads.append(self.text[position : entry.first])
            position = _match_end(_TAIL, self.text, entry.last)
            tails.append(self.text[entry.last : position])
        usual = [re.sub(_COMMENT, "", lead) for lead in (leads[0], *leads[1:2], leads[0] or " ")]
        for index, (origin, key, value) in enumerate(changes):
            lead, tail = ("", "") if origin is None else (leads[origin], tails[origin])
            if origin is None or ((origin == 0) != (index == 0) and "#" not in lead):
                lead = usual[min(index, 1)]
            comma = index < len(changes) - 1 or bool(_COMMA.match(tails[-1]))
            if comma != bool(_COMMA.match(tail)):
                tail = "," + tail if comma else _COMMA.sub(r"\1", tail)
            body = self.flow_entry(None if origin is None else entries[origin], key, value)
            # No YAML text holds a NUL, so it can stand where a comment's line has to end.
            out += lead + body + tail + ("\0" if re.search(rf"{_COMMENT}\Z", tail) else "")
        out += self.text[position : node.end]
        return re.sub(rf"\0(?={_BREAK})", "", out).replace("\0", self.layout.newline)

    def flow_entry(self, node: _Node | None, key: str | None, value: Any) -> str:
        if node is None:
            return _flow(value) if key is None else _flow({key: value})[1:-1]
        before, old = self.text[node.first : node.start], self.text[node.start : node.end]
        if not old and value is not None:
            before += " " if before.endswith(":") else ": "
        return before + (old if _same(node.value, value) else self.inline(node, value, outer=False))

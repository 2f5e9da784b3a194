"""Changing an existing YAML document as little as new data asks for, so that comments and layout survive."""

from __future__ import annotations

import contextlib
import itertools
import re
from collections.abc import Callable
from typing import Any

from algorithms.errors import RequestError
from scenarios.files.marked_yaml.reading import Node, Reader, read
from scenarios.files.marked_yaml.syntax import BREAK, BREAKS, COMMA, COMMENT, LEAD, LINE_END, TAIL, match_end
from scenarios.files.marked_yaml.writing import (
    canonical,
    flow_text,
    inline_text,
    is_same,
    key_text,
    literal_text,
    plain_data,
    write,
)


def rewrite(text: str, data: Any, source: str = "text") -> str:
    """Change a document so that reading it gives `data`, and leave the rest of its text as it is.

    Keys stay in the order of the text, new ones follow. List items are recognised by equality, by their
    `name`, by their place, and take their comments along when they move. Comments directly above an item go
    when it goes; those above a first item belong to the list, unless other items have comments too. The
    result is read back before it is returned; where no small change does it, it is `write(data)`.

    Raises `RequestError` where the text cannot be read, and what `write` raises for `data`.
    """
    data = plain_data(data)
    spelled_out = text
    for start, end, value in reversed(Reader(text, source).aliases):
        spelled_out = spelled_out[:start] + flow_text(value) + spelled_out[end:]
    # An alias repeats what its anchor says, so a small change can change too much, or cut off the anchor;
    # with every alias spelled out it does neither.
    for attempt in (text, spelled_out):
        with contextlib.suppress(RequestError):
            changed = _Rewriter(attempt, "text").apply(data)
            if is_same(read(changed, "text").data, data):
                return changed
    return write(data)


# One entry of the text to come: the number of the entry that it grows from, its key and its value.
_Change = tuple[int | None, str | None, Any]


def _changes(node: Node, new: Any) -> list[_Change]:
    if isinstance(new, list):
        return list(zip(_origins(node.value, new), itertools.repeat(None), new, strict=False))
    kept: list[_Change] = [(origin, key, new[key]) for origin, key in enumerate(node.value) if key in new]
    return kept + [(None, key, value) for key, value in new.items() if key not in node.value]


def _origins(old: list[Any], new: list[Any]) -> list[int | None]:
    """Find for every new item the old item that it is, or comes from."""
    origins: list[int | None] = [None] * len(new)
    free = set(range(len(old)))
    labels: tuple[Callable[[Any], str | None], ...] = (canonical, _name, _nameless, lambda _: "")
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
    return canonical({**value, "name": ""}) if _name(value) else None


def _grows(node: Node, new: Any) -> bool:
    """Tell whether entries of the node can be kept, so that its text can become that of the new value."""
    return type(node.value) is type(new) and bool((node.block or node.opened) and node.children and new)


class _Rewriter(Reader):
    """A reader that puts new values into its text, piece by piece."""

    def apply(self, data: Any) -> str:
        root, text = self.root, self.text
        if is_same(root.value if root else None, data):
            return text
        before, after = (text[: root.start], text[root.end :]) if root else (text, "")
        if root and _grows(root, data):
            return (self.block(root, data, before) if root.block else before + self.flow(root, data)) + after
        return self.whole_lines(before) + self.layout.newline.join((*self.layout.lines(data, 0), "")) + after

    def whole_lines(self, text: str) -> str:
        return text if text[-1:] in BREAKS else text + self.layout.newline

    def inline(self, node: Node, new: Any, *, outer: bool) -> str:
        if _grows(node, new):
            return self.flow(node, new)
        return flow_text(new, outer=outer, quote=self.text[node.start : node.start + 1])

    def block(self, node: Node, new: Any, before: str) -> str:
        """Return `before` and the new text of a block collection, which ends where its last line ends."""
        entries, changes, column = node.children, _changes(node, new), node.children[0].column
        parts = [self.text[above.last : entry.first] for above, entry in itertools.pairwise(entries)]
        cuts = [("", " " * column), *(LEAD.findall(part)[0] for part in parts)]
        gaps, leads = map(list, zip(*cuts, strict=True))
        gaps[0] = self.layout.newline if parts and all(gaps[1:]) else ""
        gaps.append("")
        used = {origin for origin, _, _ in changes}
        for number in range(1, len(entries)):
            # Comments with a blank line below them head a section, so they outlive the item.
            if number not in used and "#" in gaps[number]:
                gaps[number + 1] = gaps[number] + gaps[number + 1]
        out = before + self.text[node.start : entries[0].first]
        own_line = out.rstrip(" ")[-1:] in BREAKS
        if own_line:
            out = out.removesuffix(leads[0])
            # Above the first key of a document stands what the document is about.
            if node is not self.root and any("#" in lead for lead in leads):
                out, lead = LEAD.findall(out)[0]
                leads[0] = lead + leads[0]
        for index, change in enumerate(changes):
            gap, lead = gaps[change[0] or 0], " " * column if change[0] is None else leads[change[0]]
            gap = gap if index or "#" in gap else ""
            if index or own_line or "#" in gap + lead:
                out = self.whole_lines(out) + gap + lead
            out += self.block_entry(node, change, column)
        return self.whole_lines(out) + gaps[-1] if gaps[-1] else out

    def block_entry(self, parent: Node, change: _Change, column: int) -> str:
        origin, key, value = change
        inline, head = inline_text(value), key_text(key, False, self.layout.newline + " " * column)
        if origin is None:
            # A new item looks like its siblings.
            alike = [child for child in parent.children if key is None and _grows(child, value)]
            inline = inline if not alike else None if alike[-1].block else flow_text(value)
            return self.layout.newline.join((*self.layout.entry(head, value, column, inline), ""))
        node = parent.children[origin]
        old, before = self.text[node.start : node.end], self.text[node.first : node.start]
        after = self.text[node.end : node.last]
        if is_same(node.value, value):
            return before + old + after
        if node.block and _grows(node, value):
            return self.block(node, value, before) + after
        in_place = not node.block and (old or before.endswith((":", "-")))
        if in_place and (_grows(node, value) or inline is not None):
            return before + ("" if old else " ") + self.inline(node, value, outer=True) + after
        # The value changes its form, so its comments gather behind its key.
        key_end = node.key.end if node.key else node.first
        header = old.splitlines()[0] if node.block and not node.children else ""
        cut = 0 if node.block else match_end(LINE_END, after, 0)
        comments = re.findall(COMMENT, self.text[key_end : node.start] + header + after[:cut])
        if node.key and node.first == node.key.start:
            head = self.text[node.first : key_end] + ":"
        if after[cut:].strip() and inline is None and literal_text(value):
            inline = flow_text(value, outer=True)  # a literal block would take the comments below for its own
        first, *rest = self.layout.entry(head, value, column, inline)
        return self.layout.newline.join(("  ".join((first, *comments)), *rest, "")) + after[cut:]

    def flow(self, node: Node, new: Any) -> str:
        """Return the new text of a collection in brackets."""
        entries, changes, position = node.children, _changes(node, new), node.opened
        out = self.text[node.start : position]
        leads, tails = [], []
        for entry in entries:
            leads.append(self.text[position : entry.first])
            position = match_end(TAIL, self.text, entry.last)
            tails.append(self.text[entry.last : position])
        usual = [re.sub(COMMENT, "", lead) for lead in (leads[0], *leads[1:2], leads[0] or " ")]
        for index, (origin, key, value) in enumerate(changes):
            lead, tail = ("", "") if origin is None else (leads[origin], tails[origin])
            if origin is None or ((origin == 0) != (index == 0) and "#" not in lead):
                lead = usual[min(index, 1)]
            comma = index < len(changes) - 1 or bool(COMMA.match(tails[-1]))
            if comma != bool(COMMA.match(tail)):
                tail = "," + tail if comma else COMMA.sub(r"\1", tail)
            body = self.flow_entry(None if origin is None else entries[origin], key, value)
            # No YAML text holds a NUL, so it can stand where a comment's line has to end.
            out += lead + body + tail + ("\0" if re.search(rf"{COMMENT}\Z", tail) else "")
        out += self.text[position : node.end]
        return re.sub(rf"\0(?={BREAK})", "", out).replace("\0", self.layout.newline)

    def flow_entry(self, node: Node | None, key: str | None, value: Any) -> str:
        if node is None:
            return flow_text(value) if key is None else flow_text({key: value})[1:-1]
        before, old = self.text[node.first : node.start], self.text[node.start : node.end]
        if not old and value is not None:
            before += " " if before.endswith(":") else ": "
        return before + (old if is_same(node.value, value) else self.inline(node, value, outer=False))

"""The tree of the set: its scenarios, initiators and experiments, scenes and clusterings."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from rich.text import Text
from textual.binding import Binding, BindingType
from textual.message import Message
from textual.widgets import Tree

if TYPE_CHECKING:
    from scenarios.model import ScenarioSet

Place = tuple[str, int]


class SetTree(Tree[Place]):
    """What the set holds; Enter shows it."""

    DEFAULT_CSS = """
    SetTree { background: $surface; padding: 0 1; scrollbar-size-vertical: 1; }
    """
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("j", "cursor_down", "Down", id="tree.down", show=False),
        Binding("k", "cursor_up", "Up", id="tree.up", show=False),
    ]

    class Chosen(Message):
        """A part of the set was chosen."""

        def __init__(self, part: str, index: int) -> None:
            super().__init__()
            self.part, self.index = part, index

    def __init__(self) -> None:
        super().__init__("set")
        self._names: dict[str, list[str]] = {}
        self.show_root = True
        self.guide_depth = 2

    def show(self, given: ScenarioSet) -> None:
        """Show a set; nothing happens where its names are as they were."""
        parts = ("scenarios", "initiators", "scenes", "clusterings", "experiments")
        names = {part: [found.name for found in getattr(given, part)] for part in parts}
        if names == self._names:
            return
        self._names = names
        self.clear()
        self.root.set_label(Text(given.name, style="bold"))
        self.root.expand()
        for part, listed in names.items():
            if not listed:
                continue
            branch = self.root.add(Text(part, style="dim"), expand=True)
            for index, name in enumerate(listed):
                branch.add_leaf(Text(name), data=(part, index))

    def on_tree_node_selected(self, event: Tree.NodeSelected[Place]) -> None:
        """Tell what was chosen."""
        event.stop()
        if event.node.data is not None:
            self.post_message(self.Chosen(*event.node.data))

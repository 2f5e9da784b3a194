"""YAML 1.2 text to plain data and back, with the line and column of every value.

`read` turns a document into dicts, lists and scalars and remembers where each of them stands, so that
whoever checks the data can point at the place. `write` prints data as a fresh document. `rewrite` changes
an existing text as little as the new data asks for, so that comments, order and layout survive.

It is our own because an edit must keep hand-made spacing and a neighbour's comment, which the round trip
of ruamel.yaml does not: it writes the whole document anew from its tree.
"""

from scenarios.files.marked_yaml.reading import Mark, MarkedDocument, read
from scenarios.files.marked_yaml.rewriting import rewrite
from scenarios.files.marked_yaml.writing import write

__all__ = ["Mark", "MarkedDocument", "read", "rewrite", "write"]

"""Initiators and clusterings with their parameters, as a set lists them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Annotated, Any, Literal, Protocol, Union, cast, get_args

from pydantic import BeforeValidator, Discriminator, Tag, create_model

from algorithms.clustering.parameters import MODES, Clustering
from algorithms.context import Context
from algorithms.initiators.base import Initiator
from algorithms.initiators.registry import exclude, initiator, initiators, why_missing
from algorithms.parameters import Declared, Name, Parameters, parameter, with_default
from scenarios.scenes import Scene


class HasContext(Protocol):
    """Scenario, as far as an initiator's entry is concerned with it."""

    @property
    def context(self) -> Context:
        """What an initiator knows of the sensor and the batch."""


class InitiatorEntry(Declared):
    """An initiator with its parameters, as a set lists it.

    The entries of a set are of subclasses, one for each known initiator, that have the
    initiator's parameters as further fields.
    """

    name: Name = parameter(help="what it is called in the set; the initiator's own name where that is enough")
    initiator: str = parameter(help="which initiator it is")

    @classmethod
    def matches_tag(cls, data: Mapping[str, Any]) -> bool:
        """Return whether data name this initiator, by `initiator` or else by `name`."""
        return bool(_which(data) == cls.model_fields["initiator"].default)

    @property
    def algorithm(self) -> Initiator:
        """The initiator itself."""
        return initiator(self.initiator)

    @property
    def parameters(self) -> Parameters:
        """The initiator's parameters, as they were given."""
        declared = self.algorithm.parameters
        return declared.model_construct(
            self.model_fields_set & set(declared.model_fields),
            **{name: getattr(self, name) for name in declared.model_fields},
        )

    def resolved_on(self, scenario: HasContext) -> Parameters:
        """Return the parameters with every `auto` worked out for a scenario."""
        return self.parameters.resolved(scenario.context)


def entry_model(declared: Initiator) -> type[InitiatorEntry]:
    """Return the model of the entries of one initiator."""
    kind: Any = Literal[declared.name]
    bases: Any = (InitiatorEntry, declared.parameters)
    return cast(
        "type[InitiatorEntry]",
        create_model(
            f"{declared.name.title().replace('-', '')}Entry",
            __base__=bases,
            __doc__=declared.summary,
            __cls_kwargs__=_told_by_name("initiator", declared.name),
            initiator=(kind, parameter(declared.name, help="which initiator it is")),
        ),
    )


def entry_models() -> dict[str, type[InitiatorEntry]]:
    """Return the models of the entries of all initiators, without plug-ins for which there can be none."""
    models = {}
    for name, declared in list(initiators().items()):
        try:
            models[name] = entry_model(declared)
        except Exception as error:
            exclude(name, error)
    return models


def _which(entry: Any) -> str | None:
    return _named(entry, "initiator")


def _require_initiator(entry: Any) -> Any:
    """Refuse an entry of an initiator that there is not, or whose plug-in could not be loaded."""
    name = _which(entry)
    if name is not None and name not in initiators():
        raise ValueError(why_missing(name))
    return entry


class ClusteringEntry(Declared):
    """A mode of clustering with its parameters, as a set lists it.

    The entries of a set are of subclasses, one for each mode, that have the mode's parameters as
    further fields.
    """

    name: Name = parameter(help="what it is called in the set; the mode's own name where that is enough")
    mode: str = parameter(help="how the points of a target are gathered")

    @classmethod
    def matches_tag(cls, data: Mapping[str, Any]) -> bool:
        """Return whether data name this mode, by `mode` or else by `name`."""
        return bool(_which_mode(data) == cls.model_fields["mode"].default)

    @property
    def parameters(self) -> Clustering:
        """The mode's parameters, as they were given."""
        declared = MODES[self.mode]
        return declared.model_construct(
            self.model_fields_set & set(declared.model_fields),
            **{name: getattr(self, name) for name in declared.model_fields},
        )

    def resolved_on(self, scene: Scene) -> Clustering:
        """Return the parameters with every `auto` worked out for a scene."""
        return self.parameters.resolved(len(scene.targets))


Stage = Literal["none", "ideal"]


class WithoutClustering(Declared):
    """What may stand where a scenario's points would be clustered before initiation."""

    name: Stage = parameter(help="none: every point is a plot; ideal: each target is seen as one point")


WITHOUT_CLUSTERING = {name: WithoutClustering(name=name) for name in get_args(Stage)}
"""By their names, which no entry can have."""


def clustering_entry_model(declared: type[Clustering]) -> type[ClusteringEntry]:
    """Return the model of the entries of one mode of clustering."""
    mode = declared.model_fields["mode"].default
    kind: Any = Literal[mode]
    bases: Any = (ClusteringEntry, declared)
    return cast(
        "type[ClusteringEntry]",
        create_model(
            f"{declared.__name__}Entry",
            __base__=bases,
            __doc__=declared.__doc__,
            __cls_kwargs__=_told_by_name("mode", mode),
            mode=(kind, with_default(declared, "mode", mode)),
        ),
    )


def _which_mode(entry: Any) -> str | None:
    return _named(entry, "mode")


def _told_by_name(field: str, name: str) -> dict[str, Any]:
    """Return what a schema needs: without the field the name says which it is."""
    return {
        "json_schema_extra": {
            "anyOf": [{"required": [field]}, {"properties": {"name": {"const": name}}}],
        }
    }


def _named(entry: Any, field: str) -> str | None:
    if isinstance(entry, Mapping):
        named = entry.get(field, entry.get("name"))
        return named if isinstance(named, str) else None
    return getattr(entry, field, None)


if TYPE_CHECKING:
    Entry = InitiatorEntry
    AnyClusteringEntry = ClusteringEntry
else:
    Entry = Annotated[
        Union[tuple(Annotated[model, Tag(name)] for name, model in entry_models().items())],  # noqa: UP007
        Discriminator(_which),
        BeforeValidator(_require_initiator),
    ]
    AnyClusteringEntry = Annotated[
        Union[tuple(Annotated[clustering_entry_model(known), Tag(mode)] for mode, known in MODES.items())],  # noqa: UP007
        Discriminator(_which_mode),
    ]

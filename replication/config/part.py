"""Base classes of the configuration's parts and of other immutable data."""

from pydantic import BaseModel, ConfigDict


class Frozen(BaseModel):
    """An immutable value that refuses unknown keys.

    Its validator is built when it is first needed, because a job needs few of these classes.
    """

    model_config = ConfigDict(frozen=True, extra="forbid", defer_build=True)


class Part(Frozen):
    """A part of the configuration. The docstring of each key is its description in the schema."""

    model_config = ConfigDict(use_attribute_docstrings=True)

"""What all parts of the configuration, and of what is made from it, have in common."""

from pydantic import BaseModel, ConfigDict


class Frozen(BaseModel):
    """A value that cannot be changed, and knows no other keys than its own.

    What checks it is built when it is first needed: a job needs few of all kinds.
    """

    model_config = ConfigDict(frozen=True, extra="forbid", defer_build=True)


class Part(Frozen):
    """A part of the configuration: below each key stands its meaning, for the schema."""

    model_config = ConfigDict(use_attribute_docstrings=True)

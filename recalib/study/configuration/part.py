"""What all parts of the configuration, and of what is made from it, have in common."""

from pydantic import BaseModel, ConfigDict


class Frozen(BaseModel):
    """A value that cannot be changed, and knows no other keys than its own."""

    model_config = ConfigDict(frozen=True, extra="forbid")


class Part(Frozen):
    """A part of the configuration: below each key stands its meaning.

    To find these texts takes time, so that what explains itself otherwise is but a `Frozen`.
    """

    model_config = ConfigDict(use_attribute_docstrings=True)

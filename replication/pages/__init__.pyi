"""The public names and their modules."""

from .article import typeset as typeset
from .choices import read_choices as read_choices
from .contents import Contents as Contents
from .names import OUTCOME as OUTCOME
from .names import pages_of as pages_of
from .writing import render as render
from .writing import write as write

"""Hundreds of configurations are read here."""

import pytest
import yaml

from recalib.study.configuration import values


@pytest.fixture(autouse=True)
def read_by_libyaml(monkeypatch):
    """In a tenth of the time, where it is there; what it refuses, PyYAML refuses in its words."""
    if not yaml.__with_libyaml__:
        return

    class Fast(yaml.CSafeLoader):
        yaml_implicit_resolvers = values._Loader.yaml_implicit_resolvers

    slow = values._Loader.get_single_node

    def node(loader):
        try:
            return yaml.compose(loader.buffer.rstrip("\0"), Fast)
        except yaml.YAMLError:
            return slow(loader)

    monkeypatch.setattr(values._Loader, "get_single_node", node)

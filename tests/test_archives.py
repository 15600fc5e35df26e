"""An archive comes back as it was written, or is refused by its name."""

import numpy as np
import pytest

from recalib import InvalidFile
from recalib.files import flat, read_archive, write_archive

KIND = "an archive", 1
GROUPS = {"0": {"near": {"theta": np.arange(3.0)}}, "1": {"moves": np.int64(3)}}


def read(path):
    """What one could tell apart."""
    header, groups = read_archive(path, KIND, "a test")
    return repr(header), {name: array.tolist() for name, array in flat(groups).items()}


@pytest.fixture
def path(tmp_path):
    path = tmp_path / "a.npz"
    write_archive(path, {"format": KIND[0], "version": KIND[1], "of": [1, "two"]}, GROUPS)
    return path


def test_groups_come_back_with_their_header(path):
    header, groups = read_archive(path, KIND, "a test")
    assert header == {"format": "an archive", "version": 1, "of": [1, "two"]}
    assert groups["0"]["near"]["theta"].tolist() == [0, 1, 2] and groups["1"] == {"moves": 3}


def test_whichever_bit_of_its_directory_is_flipped_nothing_else_is_read_in_silence(path):
    """Some hide an array, or have it seem encrypted. All before it has sums of its own."""
    written, whole, rng = path.read_bytes(), read(path), np.random.default_rng(1)
    directory = range(written.index(b"PK\x01\x02"), len(written))
    refused = 0
    for place in directory:
        damaged = bytearray(written)
        damaged[place] ^= 1 << rng.integers(8)
        path.write_bytes(damaged)
        try:
            assert read(path) == whole, place
        except InvalidFile:
            refused += 1
    assert refused > len(directory) / 8


def test_a_file_that_is_not_there_is_refused_with_the_reason(tmp_path, path):
    with pytest.raises(InvalidFile, match=r"gone\.npz: No such file"):
        read(tmp_path / "gone.npz")
    with pytest.raises(InvalidFile, match="Is a directory"):
        read(tmp_path)
    write_archive(path, {"format": KIND[0], "version": KIND[1]}, {"a": {"b": np.array([np.nan])}})
    with pytest.raises(InvalidFile, match=r"a\.npz: it contains numbers that are not finite"):
        read(path)

"""Compiled code writes to a descriptor, past `sys.stderr`."""

import os

from recalib.nominal import STDERR, caught_messages


def test_lines_are_caught_and_the_next_ones_are_written_again(capfd):
    with caught_messages() as lines:
        os.write(STDERR, b"Error: one\n two\n")
    os.write(STDERR, b"three\n")
    assert lines == ["Error: one", " two"]
    assert capfd.readouterr().err == "three\n"


def test_where_stderr_is_closed_nothing_is_caught():
    before = os.dup(STDERR)
    os.close(STDERR)
    try:
        with caught_messages() as lines:
            pass
    finally:
        os.dup2(before, STDERR)
        os.close(before)
    assert lines == []

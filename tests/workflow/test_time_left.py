import logging

import pytest
from snakemake_interface_logger_plugins.common import LogEvent

from workflow import time_left


def progress(done, event=LogEvent.PROGRESS):
    record = logging.makeLogRecord({"event": event, "done": done, "total": 64})
    return lambda handler: handler.handle(record)


@pytest.mark.parametrize(
    ("what", "after", "said"),
    [
        (progress(16), 600.0, "16 of 64 jobs done, about 30 min left\n"),
        (progress(60), 600.0, "60 of 64 jobs done, about a minute left\n"),
        (progress(16), 29.0, ""),
        (progress(0), 600.0, ""),
        (progress(64), 600.0, ""),
        (progress(16, LogEvent.JOB_FINISHED), 600.0, ""),
    ],
)
def test_how_long_a_run_goes_on_is_said_now_and_then(monkeypatch, capsys, what, after, said):
    clock = iter([0.0, after, after + 1])
    monkeypatch.setattr(time_left.time, "monotonic", lambda: next(clock))
    handler = time_left.TimeLeft()
    what(handler)
    assert capsys.readouterr().err == said
    if said:
        what(handler)
        assert not capsys.readouterr().err

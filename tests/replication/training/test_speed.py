from replication.running.outputs import write
from replication.training import speed


def test_what_is_said_of_speed(uneven, tmp_path, monkeypatch):
    """With a clock of our own: moves and angles count, not how long they take."""
    for name, value in (("RUNS", 2), ("MOVES", 3), ("REPEATS", 3)):
        monkeypatch.setattr(speed, name, value)
    spent, looped = iter([2.0, 1.0, 9.0, 3.0, 5.0, 1.0]), []

    def timeit(function, number):
        function()
        return next(spent)

    monkeypatch.setattr(speed, "timeit", timeit)
    monkeypatch.setattr(speed, "bare_loop", lambda *its: looped.append(its[-1].shape))
    write(path := tmp_path / "uneven.json", uneven)
    moves, bare, ratio = speed.measure_speed(path).splitlines()
    assert moves == "moves, 2 runs side by side: 1 a second"
    assert bare.endswith(" a move: 6 a second") and ratio == "ratio, median of 3 pairs: 3.0"
    assert looped == [(6, 6)] * 3

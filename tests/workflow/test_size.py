"""What the environment is made of, for whom."""

from dataclasses import dataclass, field

from workflow.size import main, parts


@dataclass
class Made:
    """A distribution, as far as it matters here."""

    requires: list[str] = field(default_factory=list)


def test_each_distribution_is_counted_once_where_it_is_needed_first():
    project = {
        "dependencies": ["numpy>=2"],
        "optional-dependencies": {"study": ["pandas", "absent"], "dev": ["Py_Test[x]"]},
    }
    found = {
        "numpy": Made(),
        "pandas": Made(["numpy", "tz", 'odd; extra == "all"', 'win; os_name == "no"']),
        "tz": Made(["pandas"]),
        "py-test": Made(["tz", 'plug; extra == "x"', 'other; extra == "y"']),
        "odd": Made(),
        "plug": Made(),
        "other": Made(),
    }
    assert parts(project, found) == {
        "the library": ["numpy"],
        "study": ["pandas", "tz"],
        "dev": ["plug", "py-test"],
        "others": ["odd", "other"],
    }


def test_the_table_names_what_is_large(capsys):
    main()
    lines = capsys.readouterr().out.splitlines()
    assert lines[2].startswith("the library") and "example-robot-data" in lines[2]
    sizes = [float(line.split()[-1]) for line in lines if line.startswith("all ")]
    assert sizes[0] > 1000

"""A small study on a Slurm of one node gives the same bytes as here, whatever befalls it."""

import re
import signal
import time
from importlib.util import find_spec

import pytest

from tests.faults.project import Project, kill, outcome_of
from tests.faults.yard import at_work
from tests.slurm.cluster import Cluster, missing

pytestmark = [
    pytest.mark.skipif(
        bool(missing()),
        reason=f"not installed: {', '.join(missing())} (on Debian in slurm-wlm and munge)",
    ),
    pytest.mark.skipif(
        not find_spec("snakemake_executor_plugin_slurm"),
        reason="Snakemake cannot talk to Slurm: `make cluster` installs what it needs",
    ),
]

TRAININGS, TOGETHER = 3, 2  # places of the study, and those of a job in Slurm
JOBS = 1 + 2 + 2  # the scenarios, the settings of two learners, the trainings
# short, since this Slurm has no other users
ON_SLURM = ["--profile", "profiles/slurm", "--slurm-init-seconds-before-status-checks", "1"]
ON_SLURM += ["--group-components", f"trainings={TOGETHER}"]


class Trainings:
    """The trainings of a study of this name, of which at most one run is on its way."""

    def __init__(self, project: Project, name: str, *arguments: str, **options):
        self._project, self._name, self._options = project, name, options
        self._arguments = [*arguments, "--config", f"name={name}", "--"]
        self._arguments += [f"results/studies/{name}/summary.csv"]
        self.start()

    def start(self):
        """Start it, or continue it."""
        self._process = self._project.start(*self._arguments, **self._options)

    def at_work(self):
        """The first job at work, as soon as there is one."""
        return at_work(self._project, self._process)[0]

    def kill(self):
        """End Snakemake at once, if it still runs, and leave its jobs in Slurm alone."""
        if self._process.poll() is None:
            kill(self._process)

    def results(self) -> tuple[dict[str, bytes], str]:
        """Wait for its end; the contents of its files by their paths, and its output."""
        output = outcome_of(self._process).expect_success().output
        folder = self._project.results / self._name
        files = [folder / "summary.csv", *(folder / "runs").rglob("*.*")]
        return {str(path.relative_to(folder)): path.read_bytes() for path in files}, output


@pytest.fixture(scope="module")
def project(tmp_path_factory) -> Project:
    """A copy of the project with a small study."""
    return Project(tmp_path_factory.mktemp("slurm"), "--configfile", "tests/slurm/study.yaml")


@pytest.fixture(scope="module")
def expected(project) -> dict[str, bytes]:
    """Its files without Slurm."""
    files, _ = Trainings(project, "here", "--cores", "2").results()
    assert len(files) == 1 + 2 * 2 * TRAININGS, "the table; of each learner, history and maps"
    return files


@pytest.fixture(scope="module")
def cluster(tmp_path_factory):
    with Cluster(tmp_path_factory.mktemp("cluster")) as slurm:
        yield slurm


@pytest.fixture
def trainings(project, expected, cluster, request):
    """On the cluster under the test's name; nothing of it outlives the test."""
    name = re.sub(r"\W+", "_", request.node.name)[-30:].strip("_")  # of a study: not a long one
    run = Trainings(project, name, *ON_SLURM, env=cluster.environment)
    yield run
    run.kill()
    cluster.clear()


def test_slurm_makes_the_same_bytes(trainings, expected):
    files, output = trainings.results()
    assert files == expected
    assert output.count("has been submitted with SLURM jobid") == JOBS


@pytest.mark.parametrize("how", ["cancelled", "killed"])
def test_a_job_that_is_ended_is_done_again(how, trainings, expected, cluster):
    job = trainings.at_work()
    if how == "killed":
        job.kill()
    else:
        cluster.ask("scancel", cluster.jobs("running")[0])
    files, output = trainings.results()
    assert files == expected and output.count("Trying to restart job") == 1


@pytest.mark.parametrize(
    ("daemon", "how", "away"),
    [
        ("slurmd", signal.SIGKILL, 0),
        ("slurmctld", signal.SIGTERM, 15),  # longer than between two questions
    ],
)
def test_a_daemon_may_be_away(daemon, how, away, trainings, expected, cluster):
    trainings.at_work()
    cluster.stop(daemon, how)
    time.sleep(away)
    cluster.start(daemon)
    assert trainings.results()[0] == expected


def test_a_killed_snakemake_goes_on(trainings, expected, cluster):
    trainings.at_work()
    trainings.kill()
    assert cluster.jobs("running"), "what it left in Slurm works on"
    trainings.start()
    assert trainings.results()[0] == expected

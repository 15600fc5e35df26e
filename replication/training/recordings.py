"""What is recorded of a scenario: each of a study has a recording."""

from replication.config.damages import Assigned
from replication.config.part import Frozen
from replication.config.study import LearnerSettings, Measuring, Study
from replication.scenarios.nominal import digest_of
from replication.training.trainings import measuring, rules, scenario_of, training

TODAYS, FEW = "geometric", 5  # the learner that is recorded beside the paper's, and its moves


class Recording(Frozen):
    """Learners that are recorded side by side, by name: today's have no settings, and few moves."""

    scenario: str
    learners: dict[str, LearnerSettings | None]
    measuring: Measuring
    seed: int
    published: dict[str, float]
    meshes_sha256: str
    """Digest of the meshes that are drawn."""

    def papers(self) -> list[str]:
        """Those of the paper, whose trainings are experiments of the study."""
        return [name for name, learner in self.learners.items() if learner]


def recorded(study: Study) -> list[str]:
    """The learners that are recorded side by side: those of the shortest trainings."""
    named = study.experiments.learners
    iterations = {name: training(study, name).iterations for name in named}
    return [name for name in named if iterations[name] == min(iterations.values())]


def recording(study: Study, scenario: str) -> Recording:
    """The recording of a scenario: of the study's own, with one of today's learners.

    What is published belongs to the paper's damage.
    """
    from recalib.nominal.descriptions import find_urdf
    from recalib.nominal.meshes import mesh_files

    robot = study.robots[scenario_of(study, scenario)[1]]
    assigned = any(isinstance(entry, Assigned) for entry in study.scenarios[study.scenario])
    papers = {learner: rules(study, learner) for learner in recorded(study)}
    is_own = scenario == study.scenario
    published = study.paper_damage.published.model_dump()
    return Recording(
        scenario=scenario,
        learners=papers | ({TODAYS: None} if is_own else {}),
        measuring=measuring(study),
        seed=study.seed,
        published=published if assigned and is_own else {},
        meshes_sha256=digest_of(mesh_files(find_urdf(robot.urdf))),
    )

"""A Slurm of one node on this machine, as whoever starts it, reachable from this machine alone.

`python -m tests.slurm.cluster` runs one until it is interrupted. All of its files lie in one
folder; its daemons are stopped by their process ids.
"""

import os
import pwd
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
from pathlib import Path

from tests.faults.project import wait_until

PROGRAMS = "munged", "slurmctld", "slurmd", "sbatch", "srun", "squeue", "scancel"
SYSTEM = f"{os.environ.get('PATH', os.defpath)}:/usr/local/sbin:/usr/sbin"  # where daemons lie
USER = pwd.getpwuid(os.getuid()).pw_name
PATIENCE = 300  # s, until something ends on a slow machine

SETTINGS = """\
ClusterName=tests
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={controller_port}
SlurmdPort={node_port}
CommunicationParameters=NoCtldInAddrAny,NoInAddrAny
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket
CredType=cred/munge
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core_Memory
SchedulerParameters=batch_sched_delay=0,sched_interval=2
ReturnToService=2
MessageTimeout=10
NodeName=here NodeHostname={host} NodeAddr=127.0.0.1 CPUs={cpus} RealMemory={memory}
PartitionName=all Nodes=here Default=YES MaxTime=INFINITE
"""


def missing() -> list[str]:
    """The programs of Slurm that this machine does not have."""
    return [program for program in PROGRAMS if not shutil.which(program, path=SYSTEM)]


class Cluster:
    """Munge, a controller and one node with the cores and the memory of this machine.

    Args:
        folder: of all its files; it must exist.
    """

    def __init__(self, folder: Path):
        self.folder = folder
        self.settings = folder / "slurm.conf"
        path = f"{folder / 'bin'}:{SYSTEM}"
        self.environment = os.environ | {"PATH": path, "SLURM_CONF": str(self.settings)}
        self._daemons: dict[str, subprocess.Popen] = {}

    def __enter__(self) -> "Cluster":
        ports = [_free_port() for _ in range(2)]
        settings = SETTINGS.format(
            host=socket.gethostname().split(".")[0],
            user=USER,
            folder=self.folder,
            controller_port=ports[0],
            node_port=ports[1],
            cpus=os.cpu_count(),
            memory=os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") // 2**20,
        )
        self.settings.write_text(settings, encoding="utf-8")
        for name in ("state", "spool", "bin"):
            (self.folder / name).mkdir()
        # Snakemake starts srun within a job without any of the variables that begin with SLURM
        program = shutil.which("srun", path=SYSTEM)
        self._script("srun", f'SLURM_CONF={self.settings} exec {program} "$@"')
        # there is no data base of jobs: questions for their states are answered from the queue
        states = "exec squeue --noheader --states=all --format='%i|%T'"
        self._script("sacct", f'[ "$1" = -X ] && {states}')
        key = self.folder / "munge.key"
        key.write_bytes(os.urandom(128))
        key.chmod(0o400)
        try:
            for daemon in ("munged", "slurmctld", "slurmd"):
                self.start(daemon)
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_) -> None:
        if "slurmctld" in self._daemons:
            self.clear()
        for daemon in ("slurmd", "slurmctld", "munged"):
            self.stop(daemon)

    def _script(self, name: str, line: str) -> None:
        path = self.folder / "bin" / name
        path.write_text(f"#!/bin/sh\n{line}\n", encoding="utf-8")
        path.chmod(0o755)

    def start(self, daemon: str) -> None:
        """Start a daemon, and wait until it answers."""
        files = "key", "log", "pid", "seed"
        munge = [f"--{name}-file={self.folder}/munge.{name}" for name in files]
        arguments = {
            "munged": ["-F", "--force", f"--socket={self.folder}/munge.socket", *munge],
            "slurmctld": ["-D"],
            "slurmd": ["-D", "-N", "here"],
        }
        with (self.folder / f"{daemon}.out").open("ab") as output:
            self._daemons[daemon] = subprocess.Popen(
                [shutil.which(daemon, path=SYSTEM), *arguments[daemon]],
                env=self.environment,
                stdout=output,
                stderr=subprocess.STDOUT,
            )
        ready = {
            "munged": (self.folder / "munge.socket").exists,
            "slurmctld": lambda: "UP" in self.ask("scontrol", "ping"),
            "slurmd": lambda: self.ask("sinfo", "-h", "-o", "%T") in {"idle", "mixed", "allocated"},
        }
        wait_until(f"{daemon} answers, see {self.folder},", ready[daemon])

    def stop(self, daemon: str, how: signal.Signals = signal.SIGTERM) -> None:
        """Stop a daemon, if it runs."""
        process = self._daemons.pop(daemon, None)
        if process:
            process.send_signal(how)
            process.wait(PATIENCE)

    def ask(self, *command: str) -> str:
        """The output of a command of Slurm; empty if it fails."""
        process = subprocess.run(
            command, env=self.environment, text=True, capture_output=True, check=False
        )
        return process.stdout.strip() if process.returncode == 0 else ""

    def clear(self) -> None:
        """Cancel all jobs, and wait until they have ended."""
        self.ask("scancel", "--signal=KILL", "--full", "--user", USER)
        self.ask("scancel", "--user", USER)
        wait_until("the queue is empty", lambda: not self.jobs())

    def jobs(self, states: str = "pending,running,completing") -> list[str]:
        """The numbers of the jobs in these states."""
        return self.ask("squeue", "-h", "-o", "%i", "--states", states).split()


def _free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


if __name__ == "__main__":
    if missing():
        sys.exit(f"not installed: {', '.join(missing())}")
    with tempfile.TemporaryDirectory(prefix="slurm") as folder, Cluster(Path(folder)) as cluster:
        names = "SLURM_CONF", "PATH"
        print("export", *(f"{name}={cluster.environment[name]}" for name in names), flush=True)
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, lambda *_: sys.exit())
        signal.pause()

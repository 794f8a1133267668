"""Slurm on one node and PostgreSQL, each with its own folder, ports and keys: nothing of the system's is used.

Needs root, for the daemons run as their own users; packages as in scripts/fleet_night.
"""
import glob
import os
import pathlib
import secrets
import shutil
import socket
import subprocess
import time

SLURM = """\
ClusterName=hammer_loads
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={controller}
SlurmdPort={daemon}
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket
CryptoType=crypto/munge
SlurmUser=root
SlurmdUser=root
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
AccountingStorageType=accounting_storage/none
JobAcctGatherType=jobacct_gather/none
MpiDefault=none
ReturnToService=2
NodeName={host} NodeAddr=127.0.0.1 CPUs=2 RealMemory=1000 State=UNKNOWN
PartitionName=all Nodes={host} Default=YES MaxTime=INFINITE State=UP
"""


def free_port():
    with socket.socket() as listener:
        listener.bind(("127.0.0.1", 0))
        return listener.getsockname()[1]


def until(condition, what, seconds=60.0):
    deadline = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > deadline:
            raise TimeoutError(what)
        time.sleep(0.2)


class Slurm:
    def __init__(self, folder):
        """`folder` must be short: a socket's name has at most some 100 characters."""
        self.folder, self._processes = pathlib.Path(folder), []
        self.folder.mkdir(mode=0o755)
        self._munge()
        text = SLURM.format(folder=self.folder, host=socket.gethostname(), controller=free_port(), daemon=free_port())
        configuration = self.folder / "slurm.conf"
        configuration.write_text(text)
        (self.folder / "state").mkdir()
        (self.folder / "spool").mkdir()
        self.environment = dict(os.environ, SLURM_CONF=str(configuration))
        for daemon in ("slurmctld", "slurmd"):
            self._start([daemon, "-D", "-f", str(configuration)])
        until(lambda: "idle" in self.ask("sinfo", "-h", "-o", "%T"), "no node is idle")

    def _munge(self):
        place = self.folder / "munge"
        place.mkdir(mode=0o700)
        key = place / "munge.key"
        key.write_bytes(secrets.token_bytes(1024))
        key.chmod(0o400)
        for path in (place, key):
            shutil.chown(path, "munge", "munge")
        self._start(["runuser", "-u", "munge", "--", "munged", "--foreground", "--force", f"--key-file={key}",
                     f"--socket={place}/munge.socket", f"--pid-file={place}/munged.pid", f"--log-file={place}/munged.log",
                     f"--seed-file={place}/munged.seed"])
        until((place / "munge.socket").exists, "munged gives no socket")
        place.chmod(0o755)
        (self.folder / "munge.socket").symlink_to(place / "munge.socket")

    def _start(self, arguments):
        self._processes.append(subprocess.Popen(arguments, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                                                env=getattr(self, "environment", None)))

    def ask(self, *arguments):
        return subprocess.run(arguments, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True,
                              env=self.environment).stdout

    def stop(self):
        self.ask("scancel", "--user=root")
        for process in reversed(self._processes):
            process.terminate()
            process.wait()


class Postgres:
    def __init__(self, folder):
        self.folder, self.port = pathlib.Path(folder), free_port()
        self.folder.mkdir()
        shutil.chown(self.folder, "postgres", "postgres")
        self._programs = sorted(glob.glob("/usr/lib/postgresql/*/bin"))[-1]
        self._run("initdb", "--auth=trust", "--username=postgres", "--no-sync", "-D", f"{self.folder}/data")
        self._run("pg_ctl", "-D", f"{self.folder}/data", "-w", "-l", f"{self.folder}/log", "-o",
                  f"-k {self.folder} -p {self.port} -c listen_addresses=''", "start")
        self.url = f"postgresql://postgres@/postgres?host={self.folder}&port={self.port}"

    def _run(self, name, *arguments):
        subprocess.run(["runuser", "-u", "postgres", "--", f"{self._programs}/{name}", *arguments], check=True,
                       stdout=subprocess.DEVNULL, cwd="/")

    def stop(self):
        self._run("pg_ctl", "-D", f"{self.folder}/data", "-m", "fast", "-w", "stop")

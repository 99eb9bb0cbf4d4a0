"""Studies by queues: a Slurm of one node, which the test starts and stops itself, and GNU parallel.

queues_test.py BIN    BIN is the folder with the programs. 77, which ctest takes for skipped, if a
                      part had to be left out; its reason stands in a line that begins with SKIPPED.
"""

import json
import os
import pathlib
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time

BIN = pathlib.Path(sys.argv[1]).resolve()
SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "scripts" / "study_slurm.sh"
PATIENCE = 240  # s: a queue that hangs fails the test; a loaded machine does not

SCENE = """[scene]
gravity = [0, -9.8, 0, 0]
frames = {frames}

[[body]]
name = "bar"
mesh = "bar.pent"

[[constraint]]
body = "bar"
select = {{ half_space = {{ normal = [1, 0, 0, 0], offset = -0.7 }} }}
"""
# Units 1 to 3 are the reference; 4, whose step has one iteration, diverges; 5 finishes.
VARY = ["--vary", "max_iterations=1,3000", "--vary", "max_halvings=0", "--repeat", "1", "--threads", "1"]


def run(*words, **options):
    """What a program prints; an error if it fails."""
    done = subprocess.run([str(word) for word in words], text=True, capture_output=True, **options)
    if done.returncode != 0:
        raise AssertionError(f"{words}: exit code {done.returncode}: {done.stdout}{done.stderr}")
    return done.stdout


def study(*words):
    return run(BIN / "pent-study", *words)


def check(is_right, what):
    if not is_right:
        raise AssertionError(what)


def wait_until(condition, what):
    end = time.monotonic() + PATIENCE
    while not condition():
        check(time.monotonic() < end, f"{what}: not within {PATIENCE} s")
        time.sleep(0.1)


def findings(folder):
    """Everything that a study found but the times and what follows from them."""
    found = json.loads((folder / "study.json").read_text())
    for key in ["frontier", "sentences"]:
        del found[key]
    del found["reference"]["cost"]
    for result in found["results"]:
        del result["cost"]
    return found


def states(folder):
    return [line.split()[3] for line in study("-o", folder, "--list-runs").splitlines()]


def write_scene(folder, frames):
    run(BIN / "pent-mesh", "--box", "3,1,1,1", "--size", "1.5,0.5,0.5,0.5", "-o", folder / "bar.pent", "--quiet")
    path = folder / "bar.toml"
    path.write_text(SCENE.format(frames=frames))
    return path


def test_parallel(folder):
    """The lines of docs/distributed.md, all units at once."""
    scene = write_scene(folder, 4)
    study(scene, "-o", folder / "whole", *VARY)
    study(scene, "-o", folder / "parts", *VARY, "--prepare")
    units = study("-o", folder / "parts", "--list-runs")
    words = ["parallel", "--colsep", " ", "-j", "5", BIN / "pent-study", "-o", folder / "parts", "--run", "{1}"]
    for _ in range(2):  # the second time nothing is left to do
        run(*words, input=units)
    check(states(folder / "parts") == ["done"] * 5, "units that are open")
    study("-o", folder / "parts", "--collect")
    check(findings(folder / "parts") == findings(folder / "whole"), "another result than in one go")


class Slurm:
    """One node with its controller and its munge, all in one folder; needs root."""

    def __init__(self, folder):
        self.folder = folder
        self.daemons = []
        # The names of munge's folders must lead to it for everybody.
        folder.chmod(0o755)
        (folder / "munge").mkdir(mode=0o755)
        key = folder / "munge" / "key"
        key.write_bytes(os.urandom(1024))
        key.chmod(0o400)
        for name in ["state", "spool"]:
            (folder / name).mkdir()
        self.munge = folder / "munge" / "socket"
        ports = [free_port(), free_port()]
        node = socket.gethostname().split(".")[0]
        (folder / "slurm.conf").write_text(f"""ClusterName=pentimento
SlurmctldHost={node}(127.0.0.1)
AuthType=auth/munge
AuthInfo=socket={self.munge},cred_expire=2
SlurmUser=root
SlurmctldPort={ports[0]}
SlurmdPort={ports[1]}
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
ProctrackType=proctrack/pgid
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerParameters=batch_sched_delay=0,sched_interval=1
AccountingStorageType=accounting_storage/none
JobAcctGatherType=jobacct_gather/none
MaxArraySize=4
ReturnToService=2
NodeName={node} NodeAddr=127.0.0.1 CPUs={os.cpu_count()} State=UNKNOWN
PartitionName=all Nodes={node} Default=YES MaxTime=INFINITE State=UP
""")
        os.environ["SLURM_CONF"] = str(folder / "slurm.conf")

    def __enter__(self):
        try:
            self.start(["munged", "--foreground", "--force", f"--key-file={self.folder}/munge/key",
                        f"--socket={self.munge}", f"--pid-file={self.folder}/munge/pid",
                        f"--seed-file={self.folder}/munge/seed", f"--log-file={self.folder}/munge/log"])
            wait_until(self.munge.exists, "munge")
            self.start(["slurmctld", "-D"])
            self.start(["slurmd", "-D"])
            wait_until(lambda: self.say("sinfo", "-h", "-o", "%t") == "idle", "a node of Slurm")
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_):
        for daemon in reversed(self.daemons):
            daemon.send_signal(signal.SIGTERM)
            try:
                daemon.wait(30)
            except subprocess.TimeoutExpired:
                daemon.kill()
                daemon.wait()

    def start(self, words):
        path = os.environ["PATH"] + ":/usr/sbin:/sbin"
        log = open(self.folder / f"{words[0]}.out", "wb")
        self.daemons.append(subprocess.Popen([shutil.which(words[0], path=path), *words[1:]], stdout=log, stderr=log))

    def say(self, *words):
        return subprocess.run(words, text=True, capture_output=True).stdout.strip()

    def submit(self, folder, *options):
        environment = dict(os.environ, PENT_STUDY=str(BIN / "pent-study"))
        return run(SCRIPT, folder, *options, env=environment)

    def wait(self):
        wait_until(lambda: self.say("squeue", "-h") == "", "the end of all jobs")

    def exit_codes(self, name):
        """Of all finished tasks of a name, by state."""
        codes = []
        for job in self.say("scontrol", "-o", "show", "job").splitlines():
            words = dict(word.split("=", 1) for word in job.split() if "=" in word)
            if words["JobName"] == name:
                codes.append((words["JobState"], words["ExitCode"]))
        return sorted(codes)


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def logs(folder):
    return "".join(path.read_text() for path in (folder / "slurm").glob("*.log"))


def test_slurm(folder):
    scene = write_scene(folder, 600)  # the finest level takes seconds: it is there when it is told
    whole, parts, broken = folder / "whole", folder / "parts", folder / "broken"
    study(scene, "-o", whole, *VARY)
    (folder / "slurm").mkdir()
    with Slurm(folder / "slurm") as slurm:
        # A level of the reference is told that its time ends: it goes on in the same task.
        study(scene, "-o", parts, *VARY, "--prepare")
        said = slurm.submit(parts, "--time=60")
        check("tasks 1,2,3\n" in said and "combination, tasks 0,1 + 4" in said, said)
        level = parts / "references" / "steps-4"
        wait_until((level / "frames" / "bar_000002.pent").exists, "the finest level")
        first = said.split("job ")[1].split(":")[0]
        run("scancel", "--batch", "--signal=USR1", f"{first}_3")
        slurm.wait()
        check(len(json.loads((level / "report.json").read_text())["parts"]) == 2, "a level in one part")
        check("queued again" in logs(parts), logs(parts))
        # That settings diverge is a result.
        check(slurm.exit_codes("study-combination") == [("COMPLETED", "0:0")] * 2, slurm.say("scontrol", "show", "job"))
        check(findings(parts) == findings(whole), "another result than in one go")

        # A level that fails keeps its exit code, nothing is run behind it, and the collection says so.
        study(scene, "-o", broken, *VARY, "--prepare")
        (folder / "bar.pent").rename(folder / "away.pent")
        slurm.submit(broken)
        slurm.wait()
        check(("FAILED", "1:0") in slurm.exit_codes("study-reference"), slurm.say("scontrol", "show", "job"))
        check(states(broken) == ["open"] * 5, "units that were run")
        check("bar.pent" in logs(broken) and "not been run to their end: 1-5" in logs(broken), logs(broken))
        # Mended, what is open is submitted again.
        (folder / "away.pent").rename(folder / "bar.pent")
        slurm.submit(broken)
        slurm.wait()
        check(findings(broken) == findings(whole), "another result than in one go")
        check("collection" in slurm.submit(broken), "nothing is open")
        slurm.wait()


def missing(programs):
    path = os.environ["PATH"] + ":/usr/sbin:/sbin"
    return [program for program in programs if shutil.which(program, path=path) is None]


def main():
    skipped = False
    for test, programs in [
        (test_parallel, ["parallel"]),
        (test_slurm, ["munged", "slurmctld", "slurmd", "sbatch", "squeue", "scontrol"]),
    ]:
        lacks = missing(programs)
        reason = f"{' and '.join(lacks)} not installed: scripts/setup.sh --distributed" if lacks else ""
        if not reason and test is test_slurm and os.geteuid() != 0:
            reason = "only root starts a Slurm"
        if not reason and not (BIN / "pent-mesh").exists():
            reason = "built without the mesher"
        if reason:
            print(f"SKIPPED: {test.__name__}: {reason}")
            skipped = True
            continue
        start = time.monotonic()
        with tempfile.TemporaryDirectory(prefix="pent-queues-") as folder:
            try:
                test(pathlib.Path(folder))
            except BaseException:
                for log in pathlib.Path(folder).rglob("*.log"):
                    print(f"--- {log}\n{log.read_text(errors='replace')[-3000:]}")
                raise
        print(f"passed: {test.__name__} ({time.monotonic() - start:.0f} s)")
    return 77 if skipped else 0


if __name__ == "__main__":
    sys.exit(main())

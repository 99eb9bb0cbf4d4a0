"""Studies the scenes of data/study and writes docs/accuracy.md: see accuracy.sh.

    accuracy.py FOLDER_OF_PROGRAMS OUTPUT_FOLDER PAGE
"""

import json
import os
import shutil
import subprocess
import sys

sys.path.insert(0, os.path.join(os.path.dirname(__file__), "..", "docs"))
from read_pent import read_pent  # noqa: E402

DTS = ("1/30", "1/60", "1/120")
PRESETS = ("fast", "balanced", "accurate")
REPEATS = 3
# With contact the motion has kinks: the reference takes smaller steps.
STUDIES = (
    ("bar", 30, []),
    ("beam", 8, []),
    ("octopus", 8, []),
    ("alien", 8, []),
    ("drop", 15, ["--reference-halvings", "4"]),
    ("collision", 15, ["--reference-halvings", "4"]),
)
CELLS = (2, 4, 8)
POISSONS = (0, 0.28, 0.32)


def run(programs, name, *arguments):
    subprocess.run([os.path.join(programs, name), *arguments, "--quiet"], check=True)


def study(programs, out, page, scene, frames, options):
    folder = os.path.join(out, scene)
    print("accuracy:", scene, flush=True)
    run(programs, "pent-study", f"data/study/{scene}.toml", "-o", folder, "--frames", str(frames),
        "--threads", "1", "--repeat", str(REPEATS), "--vary", "preset=" + ",".join(PRESETS), "--vary", "dt=" + ",".join(DTS),
        *options)
    images = os.path.join(os.path.dirname(page), "images")
    shutil.copy(os.path.join(folder, "frontier.png"),
                os.path.join(images, f"accuracy-{scene}.png"))
    with open(os.path.join(folder, "study.json"), encoding="utf-8") as file:
        return json.load(file)


def bend(programs, out, cells, poisson):
    """Deflection of a beam under its own weight over that of Timoshenko's theory."""
    length, width, young = 4.0, 1.0, 1e6
    density, gravity = 1.0, 1.0
    name = os.path.join(out, f"beam-{cells}-{poisson}")
    run(programs, "pent-mesh", "--box", f"{4 * cells},{cells},{cells},1", "--size",
        f"{length},{width},{width},0.25", "-o", name + ".pent")
    with open(name + ".toml", "w", encoding="utf-8") as scene:
        scene.write(f"""[scene]
gravity = [0, -{gravity}, 0, 0]
frames = 1
[[body]]
name = "beam"
mesh = "{os.path.basename(name)}.pent"
material = {{ model = "linear", young = {young}, poisson = {poisson}, density = {density} }}
[[constraint]]
body = "beam"
select = {{ half_space = {{ normal = [1, 0, 0, 0], offset = {-length / 2 + 1e-6} }} }}
[solver]
integrator = "quasistatic"
precision = "double"
tolerance = 1e-8
newton_tolerance = 1e-6
""")
    run(programs, "pent-sim", name + ".toml", "-o", name, "--force")
    _, start = read_pent(os.path.join(name, "frames", "beam_000000.pent"))
    _, end = read_pent(os.path.join(name, "frames", "beam_000001.pent"))
    tip = start["vertex"]["x"] > length / 2 - 1e-6
    sag = (start["vertex"]["y"] - end["vertex"]["y"])[tip].mean()
    shear = young / (2 * (1 + poisson))
    kappa = 10 * (1 + poisson) / (12 + 11 * poisson)  # rectangle, Cowper
    theory = density * gravity * (12 * length**4 / (8 * young * width**2)
                                  + length**2 / (2 * kappa * shear))
    return sag / theory


def machine(out):
    """What the times were measured on: noted with the first measurement in a folder."""
    note = os.path.join(out, "machine.txt")
    if not os.path.exists(note):
        with open("/proc/cpuinfo", encoding="utf-8") as file:
            models = [line.split(":", 1)[1].strip() for line in file if line.startswith("model name")]
        commit = subprocess.run(["git", "describe", "--always", "--dirty"], capture_output=True,
                                text=True, check=False).stdout.strip()
        with open(note, "w", encoding="utf-8") as file:
            file.write(f"{models[0] if models else 'an unknown processor'} with {os.cpu_count()} cores,"
                       f" load {os.getloadavg()[0]:.1f} at the start, commit {commit}")
    with open(note, encoding="utf-8") as file:
        return file.read()


def percent(fraction):
    return f"{100 * fraction:.0f}%" if fraction >= 1 else f"{100 * fraction:.2g}%"


def presets_table(studies):
    """Seconds per frame and error of each preset, scene by scene."""
    lines = ["| scene | cells | dt | " + " | ".join(PRESETS) + " | reference |",
             "| --- | --- | --- |" + " --- |" * (len(PRESETS) + 1)]
    for scene, report in studies:
        reference = report["reference"]
        bar = reference["error_bar"]
        for dt in DTS:
            cells = []
            for preset in PRESETS:
                for result in report["results"]:
                    if result["settings"] == {"preset": preset, "dt": dt}:
                        cost = result["cost"]["seconds_per_frame"]
                        error = result["errors"]["position"]
                        text = "below " + percent(bar) if error < bar else percent(error)
                        cells.append(f"{cost:.2g} s, {text}" if result["verdict"] == "finished"
                                     else result["verdict"])
            head = (f"| {scene} | {report['cells']} |" if dt == DTS[0] else "| | |")
            tail = ""
            if dt == DTS[0]:
                order = f"order {reference['order']:.2g}" if reference["is_converged"] else \
                    "not converged"
                tail = (f"{reference['cost']['seconds_per_frame']:.2g} s, {order},"
                        f" error bar {percent(bar)}")
            lines.append(f"{head} {dt} | " + " | ".join(cells) + f" | {tail} |")
    return "\n".join(lines)


def contact_table(studies):
    """What still converges behind the first contact."""
    lines = ["| scene | preset | dt | energy | contact energy | center | deepest, m |",
             "| --- | --- | --- | --- | --- | --- | --- |"]
    for scene, report in studies:
        if report["reference"]["has_contact"]:
            for result in report["results"]:
                errors = result["errors"]
                settings = result["settings"]
                if result["verdict"] == "finished":
                    lines.append(
                        f"| {scene} | {settings['preset']} | {settings['dt']} |"
                        f" {percent(errors['energy'])} | {percent(errors['contact_energy'])} |"
                        f" {percent(errors['center'])} | {errors['deepest_penetration']:.2g} |")
    return "\n".join(lines)


def locking_table(programs, out):
    lines = ["| cells thick | " + " | ".join(f"nu = {p}" for p in POISSONS) + " |",
             "| --- |" + " --- |" * len(POISSONS)]
    for cells in CELLS:
        bends = [f"{100 * bend(programs, out, cells, p):.0f}%" for p in POISSONS]
        lines.append(f"| {cells} | " + " | ".join(bends) + " |")
    return "\n".join(lines)


def main():
    programs, out, page = sys.argv[1:]
    os.makedirs(out, exist_ok=True)
    where = machine(out)
    studies = [(scene, study(programs, out, page, scene, frames, options))
               for scene, frames, options in STUDIES]
    with open("data/study/accuracy.md.in", encoding="utf-8") as template:
        text = template.read()
    times = "single runs" if REPEATS == 1 else f"medians of {REPEATS} runs that alternate"
    text = text.replace("@TIMES@", times).replace("@MACHINE@", where)
    text = text.replace("@PRESETS@", presets_table(studies))
    text = text.replace("@CONTACT@", contact_table(studies))
    text = text.replace("@LOCKING@", locking_table(programs, out))
    text = text.replace("@PLOTS@", "\n\n".join(
        f"![Error against time, {scene}](images/accuracy-{scene}.png)" for scene, _ in studies))
    with open(page, "w", encoding="utf-8") as file:
        file.write(text)
    print("accuracy:", page)


if __name__ == "__main__":
    main()

"""Studies the scenes of data/study and writes docs/accuracy.md: see accuracy.sh.

    accuracy.py FOLDER_OF_PROGRAMS WRITE_LOCKING OUTPUT_FOLDER PAGE
"""

import json
import os
import shutil
import subprocess
import sys

DTS = ("1/30", "1/60", "1/120")
PRESETS = ("fast", "balanced", "accurate")
VARY_PRESETS = ["preset=" + ",".join(PRESETS), "dt=" + ",".join(DTS)]
REPEATS = 3
# Scene, frames, halvings of the reference. Contacts come and go within milliseconds: it takes smaller steps.
STUDIES = (("bar", 30, 2), ("beam", 8, 2), ("octopus", 8, 2), ("alien", 8, 2), ("drop", 15, 4), ("collision", 15, 5))
# What the presets leave to one setting alone, on the beam: integrator, dt, halvings to the same reference.
SETTINGS = (
    ("linear_euler", "1/30", 4, ["tolerance=1e-1,1e-2,1e-4"]),
    ("bdf2", "1/60", 3, ["newton_tolerance=1e-2,1e-4,1e-7", "precision=float,double"]),
)
LEVELS = ("10%", "5%", "2%", "1%")
ELEMENTS = ("linear", "smoothed", "quadratic")
# What the mesh costs in accuracy: a beam one quadratic cell thick, and its edges cut into so many.
SUBDIVISIONS = (1, 2)
BEND_FRAMES = 10
COARSEST = 1536  # cells


def run(programs, name, *arguments):
    subprocess.run([os.path.join(programs, name), *arguments, "--quiet"], check=True)


def study(programs, out, scene, frames, halvings, vary):
    """What pent-study finds; references that are in the folder of the scene are used again."""
    folder = os.path.join(out, scene)
    axes = [word for axis in vary for word in ("--vary", axis)]
    run(programs, "pent-study", f"data/study/{scene}.toml", "-o", folder, "--frames", str(frames), "--threads", "1",
        "--repeat", str(REPEATS), "--reference-halvings", str(halvings), *axes)
    with open(os.path.join(folder, "study.json"), encoding="utf-8") as file:
        return json.load(file)


def study_and_plot(programs, out, page, scene, frames, halvings, vary):
    print("accuracy:", scene, flush=True)
    report = study(programs, out, scene, frames, halvings, vary)
    shutil.copy(os.path.join(out, scene, "frontier.png"),
                os.path.join(os.path.dirname(page), "images", f"accuracy-{scene}.png"))
    return report


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


def table(head, rows):
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def cost_and_error(result, bar, digits):
    if result["verdict"] != "finished":
        return result["verdict"]
    error = result["errors"]["position"]
    text = "below " + percent(bar) if error < bar else f"{100 * error:.{digits}g}%"
    return f"{result['cost']['seconds_per_frame']:.2g} s, {text}"


def presets_table(studies):
    """Seconds per frame and error of each preset, scene by scene."""
    rows = []
    for scene, report in studies:
        reference = report["reference"]
        bar = reference["error_bar"]
        for dt in DTS:
            cells = [cost_and_error(result, bar, 2) for preset in PRESETS for result in report["results"]
                     if result["settings"] == {"preset": preset, "dt": dt}]
            order = f"order {reference['order']:.2g}" if reference["is_converged"] else "not converged"
            is_first = dt == DTS[0]
            rows.append([scene if is_first else "", str(report["cells"]) if is_first else "", dt, *cells,
                         f"{reference['cost']['seconds_per_frame']:.2g} s, {order}, error bar {percent(bar)}"
                         if is_first else ""])
    return table(["scene", "cells", "dt", *PRESETS, "reference"], rows)


def cheapest_table(studies):
    """The cheapest settings within some errors, as pent-study says them."""
    rows = []
    for scene, report in studies:
        found = dict(sentence[len("within "):].split(": ", 1) for sentence in report["sentences"])
        settings = [found[level].split(",")[0] if level in found else "none" for level in LEVELS]
        rows.append([scene, *(text.replace("preset=", "").replace("dt=", "").replace("none of these settings", "none")
                              for text in settings)])
    return table(["scene", *("within " + level for level in LEVELS)], rows)


def settings_table(programs, out):
    """The error of the beam where one setting of its solver changes."""
    rows = []
    frames = dict((scene, frames) for scene, frames, _ in STUDIES)["beam"]
    for integrator, dt, halvings, axes in SETTINGS:
        print("accuracy: beam,", integrator, flush=True)
        report = study(programs, out, "beam", frames, halvings, ["integrator=" + integrator, "dt=" + dt, *axes])
        for result in report["results"]:
            settings = result["settings"]
            others = " ".join(f"{axis}={value}" for axis, value in settings.items() if axis not in ("integrator", "dt"))
            rows.append([f"`{integrator}`", dt, others, cost_and_error(result, report["reference"]["error_bar"], 4)])
    return table(["integrator", "dt", "setting", "cost and error"], rows)


def contact_row(scene, settings, dt, errors):
    return [scene, settings, dt, percent(errors["energy"]), percent(errors["contact_work"]), percent(errors["center"]),
            f"{errors['deepest_penetration']:.2g}"]


def contact_table(studies):
    """What still converges behind the first contact; first, how far the reference itself is from that."""
    rows = []
    for scene, report in studies:
        reference = report["reference"]
        if reference["has_contact"]:
            rows.append(contact_row(scene, "reference", f"{reference['dt'][-2]:.2g} s", reference["last"]))
            rows += [contact_row(scene, result["settings"]["preset"], result["settings"]["dt"], result["errors"])
                     for result in report["results"] if result["verdict"] == "finished"]
    return table(["scene", "preset", "dt", "energy", "contact work", "center", "deepest, m"], rows)


def locking_table(program):
    return subprocess.run([program], capture_output=True, text=True, check=True).stdout.strip()


def elements_table(report):
    """Processor time per frame and error of each kind of elements, mesh by mesh."""
    def cell(result):
        return f"{result['cost']['cpu_seconds'] / BEND_FRAMES:.2g} s, {100 * result['errors']['position']:.2g}%"

    rows = []
    for level in SUBDIVISIONS:
        cells = [cell(result) for elements in ELEMENTS for result in report["results"]
                 if result["settings"] == {"elements": elements, "subdivide": str(level)}]
        rows.append([str(2 * level), str(COARSEST * level**4), *cells])
    return table(["cells thick", "cells", *ELEMENTS], rows)


def main():
    programs, write_locking, out, page = sys.argv[1:]
    os.makedirs(out, exist_ok=True)
    where = machine(out)
    studies = [(scene, study_and_plot(programs, out, page, scene, frames, halvings, VARY_PRESETS))
               for scene, frames, halvings in STUDIES]
    kinds = study_and_plot(programs, out, page, "bend", BEND_FRAMES, 2,
                           ["elements=" + ",".join(ELEMENTS), "subdivide=" + ",".join(map(str, SUBDIVISIONS))])
    times = "single runs" if REPEATS == 1 else f"medians of {REPEATS} runs that alternate"
    plots = "\n\n".join(f"![Error against time, {scene}](images/accuracy-{scene}.png)" for scene, _ in studies)
    with open("data/study/accuracy.md.in", encoding="utf-8") as template:
        text = template.read()
    for name, value in (("TIMES", times), ("MACHINE", where), ("PRESETS", presets_table(studies)),
                        ("CHEAPEST", cheapest_table(studies)), ("SETTINGS", settings_table(programs, out)),
                        ("CONTACT", contact_table(studies)), ("LOCKING", locking_table(write_locking)),
                        ("FINEST", f"{COARSEST * SUBDIVISIONS[-1]**4:,}"),
                        ("ELEMENTS", elements_table(kinds)), ("PLOTS", plots)):
        text = text.replace(f"@{name}@", value)
    with open(page, "w", encoding="utf-8") as file:
        file.write(text)
    print("accuracy:", page)


if __name__ == "__main__":
    main()

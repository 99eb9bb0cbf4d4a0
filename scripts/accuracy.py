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
# What elements and meshes cost in accuracy by the preset accurate: the six scenes on meshes for quadratic elements, as
# coarse as they can be and with every edge cut in two. Scene, frames, halvings of the reference, timed runs of each.
ELEMENT_STUDIES = (("bend", 10, 2, 3), ("beam_coarse", 8, 2, 3), ("octopus_coarse", 4, 2, 1), ("alien_coarse", 4, 2, 1),
                   ("drop_coarse", 15, 4, 3), ("collision_coarse", 15, 3, 1))
SUBDIVISIONS = (1, 2)
VARY_ELEMENTS = ["elements=" + ",".join(ELEMENTS), "subdivide=" + ",".join(map(str, SUBDIVISIONS))]
DRAWN = ("bend", "beam_coarse", "octopus_coarse")


def run(programs, name, *arguments):
    subprocess.run([os.path.join(programs, name), *arguments, "--quiet"], check=True)


def study(programs, out, scene, frames, halvings, vary, repeats=REPEATS):
    """What pent-study finds; references that are in the folder of the scene are used again."""
    print("accuracy:", scene, *vary, flush=True)
    folder = os.path.join(out, scene)
    axes = [word for axis in vary for word in ("--vary", axis)]
    run(programs, "pent-study", f"data/study/{scene}.toml", "-o", folder, "--frames", str(frames), "--threads", "1",
        "--repeat", str(repeats), "--reference-halvings", str(halvings), *axes)
    with open(os.path.join(folder, "study.json"), encoding="utf-8") as file:
        return json.load(file)


def keep_plot(out, page, scene):
    shutil.copy(os.path.join(out, scene, "frontier.png"),
                os.path.join(os.path.dirname(page), "images", f"accuracy-{scene}.png"))


def plots(scenes, what):
    return "\n\n".join(f"![{what}, {scene}](images/accuracy-{scene}.png)" for scene in scenes)


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


def by_elements(report):
    """The result of each kind of elements on each mesh of a study, processor time per frame, and error."""
    found = {}
    for result in report["results"]:
        settings = result["settings"]
        cost = result["cost"]["cpu_seconds"] / report["frames"]
        found[settings["elements"], int(settings["subdivide"])] = (cost, result["errors"]["position"], result)
    return found


def elements_table(studies):
    """Processor time per frame and error of each kind of elements, scene by scene and mesh by mesh."""
    rows = []
    for scene, report in studies:
        found = by_elements(report)
        reference = report["reference"]
        reached = percent(reference["error_bar"]) + ("" if reference["is_converged"] else ", not converged")
        for level in SUBDIVISIONS:
            cells = report["cells"] * level**4 // SUBDIVISIONS[-1]**4
            kinds = [found[kind, level] for kind in ELEMENTS]
            rows.append([scene if level == SUBDIVISIONS[0] else "", f"{cells:,}",
                         *(f"{cost:.2g} s, {100 * error:.2g}%" for cost, error, _ in kinds),
                         reached if level == SUBDIVISIONS[0] else ""])
    return table(["scene", "cells", *ELEMENTS, "error bar of the reference"], rows)


def gain_table(studies):
    """What quadratic elements take and give where linear ones were: on their mesh, and on the next coarser."""
    rows = []
    for scene, report in studies:
        found = by_elements(report)
        coarse, fine = SUBDIVISIONS
        row = [scene]
        for level in (coarse, fine):
            (cost, error, _), (old_cost, old_error, _) = found["quadratic", coarse], found["linear", level]
            row.append(f"{cost / old_cost:.2g}, {error / old_error:.2g}")
        least = [found[kind, coarse][2]["errors"]["smallest_J"] for kind in ("linear", "quadratic")]
        rows.append([*row, " and ".join(f"{J:.2f}" for J in least)])
    return table(["scene", "on the same mesh: time, error", "a mesh coarser: time, error",
                  "least det F, linear and quadratic"], rows)


def main():
    programs, write_locking, out, page = sys.argv[1:]
    os.makedirs(out, exist_ok=True)
    where = machine(out)
    studies = [(scene, study(programs, out, scene, frames, halvings, VARY_PRESETS))
               for scene, frames, halvings in STUDIES]
    kinds = [(scene, study(programs, out, scene, frames, halvings, VARY_ELEMENTS, repeats))
             for scene, frames, halvings, repeats in ELEMENT_STUDIES]
    scenes = [scene for scene, _ in studies]
    for scene in (*scenes, *DRAWN):
        keep_plot(out, page, scene)
    times = "single runs" if REPEATS == 1 else f"medians of {REPEATS} runs that alternate"
    with open("data/study/accuracy.md.in", encoding="utf-8") as template:
        text = template.read()
    for name, value in (("TIMES", times), ("MACHINE", where), ("PRESETS", presets_table(studies)),
                        ("CHEAPEST", cheapest_table(studies)), ("SETTINGS", settings_table(programs, out)),
                        ("CONTACT", contact_table(studies)), ("LOCKING", locking_table(write_locking)),
                        ("ELEMENTS", elements_table(kinds)), ("GAIN", gain_table(kinds)),
                        ("PLOTS", plots(scenes, "Error against time")),
                        ("PLOTS_OF_ELEMENTS", plots(DRAWN, "Error against time of three kinds of elements"))):
        text = text.replace(f"@{name}@", value)
    with open(page, "w", encoding="utf-8") as file:
        file.write(text)
    print("accuracy:", page)


if __name__ == "__main__":
    main()

"""Loads the slices that pent-slice wrote into Blender 4.0 or later, each shown at its own frame.

    blender --python scripts/blender_import.py -- SLICES/ [SERIES ...]

SERIES are names as in octopus_s01; default: all. Reads slices.csv, so the folder may hold other files.
Axes become Blender's (z up), colors are shown, and the scene plays at the speed of the simulation.
"""
import csv
import pathlib
import sys


def read_series(folder):
    """The slices by series: {name: [(frame, time in s, path), ...]}, in the order of time."""
    series = {}
    table = pathlib.Path(folder) / "slices.csv"
    with open(table, encoding="utf-8", errors="surrogateescape", newline="") as file:
        for row in csv.DictReader(file):
            path = pathlib.Path(folder) / row["file"]
            if path.suffix != ".ply":
                raise SystemExit(f"{path}: Blender reads PLY; run pent-slice with --format ply")
            name = path.stem.rpartition("_")[0]
            series.setdefault(name, []).append((int(row["frame"]), float(row["time"]), path))
    return {name: sorted(slices) for name, slices in series.items()}


def frames_per_second(slices):
    """Of the frames sliced, as Blender wants it: a whole number and what to divide it by."""
    if len(slices) < 2:
        return 30, 1.0
    rate = (len(slices) - 1) / (slices[-1][1] - slices[0][1])
    whole = max(1, round(rate))
    return whole, whole / rate


def show_only_at(thing, frame):
    """Keys that show an object at one frame of Blender's."""
    for at, is_hidden in ((frame - 1, True), (frame, False), (frame + 1, True)):
        thing.hide_viewport = thing.hide_render = is_hidden
        thing.keyframe_insert("hide_viewport", frame=at)
        thing.keyframe_insert("hide_render", frame=at)


def add_material(bpy, name):
    """A material that shows the colors of vertices."""
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    colors = material.node_tree.nodes.new("ShaderNodeVertexColor")
    shader = material.node_tree.nodes["Principled BSDF"]
    material.node_tree.links.new(colors.outputs["Color"], shader.inputs["Base Color"])
    return material


def load(bpy, folder, wanted):
    """Imports the series into the open scene; returns how many slices."""
    series = read_series(folder)
    for name in wanted:
        if name not in series:
            raise SystemExit(f"{folder}: no series {name}; there are {', '.join(series)}")
    count = 0
    for name, slices in series.items():
        if wanted and name not in wanted:
            continue
        material = add_material(bpy, name)
        for place, (_, _, path) in enumerate(slices):
            bpy.ops.wm.ply_import(filepath=str(path), forward_axis="NEGATIVE_Z", up_axis="Y", import_colors="SRGB")
            thing = bpy.context.object
            thing.data.materials.append(material)
            show_only_at(thing, place + 1)
            count += 1
        scene = bpy.context.scene
        scene.frame_start, scene.frame_end = 1, max(len(slices), 1)
        scene.render.fps, scene.render.fps_base = frames_per_second(slices)
    return count


def main():
    words = sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else []
    if not words:
        raise SystemExit(__doc__)
    import bpy  # only Blender's own Python has it
    print(f"blender_import: {load(bpy, words[0], words[1:])} slices from {words[0]}")


if __name__ == "__main__":
    main()

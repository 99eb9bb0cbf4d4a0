"""A picture of a run, made in Blender without a display, where the add-on is installed.

    blender -b --python blender/example.py -- RUN PICTURE.png [FRAME [SAMPLES]]

It shows how a script drives the add-on: import, keys for hyperplane and colors, camera and lamps.
"""

import sys

import addon_utils
import bpy
from mathutils import Vector


def import_run(path):
    addon_utils.enable("pentimento_slices")
    bpy.ops.wm.read_homefile(use_empty=True)
    bpy.ops.pentimento.import_run(filepath=path)
    return bpy.context.view_layer.objects.active


def add_lamp(name, size, energy, place, target):
    lamp = bpy.data.lights.new(name, "AREA")
    lamp.size, lamp.energy = size, energy
    thing = bpy.data.objects.new(name, lamp)
    bpy.context.collection.objects.link(thing)
    aim(thing, place, target)


def aim(thing, place, target):
    thing.location = place
    thing.rotation_euler = (target - place).to_track_quat("-Z", "Y").to_euler()


def add_floor(height, reach):
    mesh = bpy.data.meshes.new("floor")
    corners = [(x, y, height) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    mesh.from_pydata([(40 * reach * x, 40 * reach * y, z) for x, y, z in corners], [], [range(4)])
    material = bpy.data.materials.new("floor")
    material.use_nodes = True
    shader = material.node_tree.nodes["Principled BSDF"]
    shader.inputs["Base Color"].default_value = (0.56, 0.55, 0.53, 1)
    shader.inputs["Roughness"].default_value = 0.9
    mesh.materials.append(material)
    bpy.context.collection.objects.link(bpy.data.objects.new("floor", mesh))


def set_up(run):
    """Camera and lamps around what is seen now."""
    points = [
        vertex.co for thing in bpy.data.objects if thing.pentimento_body.run == run
        for vertex in thing.data.vertices
    ]  # fmt: skip
    low = Vector(min(p[i] for p in points) for i in range(3))
    high = Vector(max(p[i] for p in points) for i in range(3))
    middle, reach = (low + high) / 2, (high - low).length / 2
    add_floor(low.z, reach)
    add_lamp("key", 2 * reach, 155 * reach**2, middle + reach * Vector((-2.2, -2.0, 3.2)), middle)
    add_lamp("fill", 4 * reach, 36 * reach**2, middle + reach * Vector((3.4, -2.6, 1.4)), middle)
    add_lamp("rim", 1.5 * reach, 90 * reach**2, middle + reach * Vector((1.2, 3.2, 2.4)), middle)
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    bpy.context.collection.objects.link(camera)
    camera.data.lens = 70
    aim(camera, middle + reach * Vector((1.3, -3.7, 1.25)), middle + reach * Vector((0, 0, -0.04)))
    world = bpy.data.worlds.new("sky")
    world.use_nodes = True
    world.node_tree.nodes["Background"].inputs["Color"].default_value = (0.62, 0.72, 0.85, 1)
    world.node_tree.nodes["Background"].inputs["Strength"].default_value = 0.35
    scene = bpy.context.scene
    scene.camera, scene.world = camera, world
    scene.view_settings.look = "Medium High Contrast"


def render(path, samples):
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.samples = samples
    scene.cycles.use_denoising = False  # which Debian's Blender cannot
    scene.cycles.sample_clamp_indirect = 3
    scene.render.resolution_x, scene.render.resolution_y = 720, 480
    scene.render.filepath = path
    bpy.ops.render.render(write_still=True)


def main():
    path, picture, *rest = sys.argv[sys.argv.index("--") + 1 :]
    frame, samples = [*map(int, rest), *(1, 64)[len(rest) :]]
    run = import_run(path)
    run.pentimento.color = "strain"
    bpy.context.scene.frame_set(frame)
    bpy.ops.pentimento.fit_colors()
    set_up(run)
    render(picture, samples)


if __name__ == "__main__":
    main()

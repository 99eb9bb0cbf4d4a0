#!/usr/bin/env python3
"""Makes a moving mesh by formula: a thick-walled cup with a bulge at one side, a heart as a child draws
it, that shortens, thickens and wrings itself once in 0.8 s.

    python3 scripts/beating_heart.py FOLDER [FRAMES]     FOLDER/heart.pvd and FOLDER/heart_000.vtu and so on
    pent-mesh FOLDER/heart.pvd --space-time --time-scale 0.08 -o heart.pent

Nothing but Python's own library. Arrays are in base64 and compressed by zlib. Cells have a region (1 inside,
2 outside of the middle of the wall), fibers and a contraction; labels of the triangles of the surface are 1
inside, 2 outside and 3 at the rim. Lengths are meters, times seconds.
"""
import base64
import itertools
import math
import pathlib
import struct
import sys
import zlib

ACROSS = 20  # cubes from rim to rim through the tip
THROUGH = 3  # cubes through the wall
PERIOD = 0.8


def place(i, j, k):
    """Where a point of the grid is at rest, by its angles and its place in the wall."""
    a, b = 2 * i / ACROSS - 1, 2 * j / ACROSS - 1
    # From a square to a disk, but for its last corners, where a full disk would have flat cells.
    x = a * (0.25 + 0.75 * math.sqrt(1 - b * b / 2))
    y = b * (0.25 + 0.75 * math.sqrt(1 - a * a / 2))
    return math.hypot(x, y) * 1.55, math.atan2(y, x), k / THROUGH


def squeeze(t):
    """0 when the heart is wide, 1 when it is narrow: quick to close, slow to open."""
    s = t / PERIOD % 1
    return math.sin(math.pi * s ** 0.7) ** 2


def position(point, t):
    theta, phi, through = point
    c = squeeze(t)
    # The wall thickens as the hollow in it shrinks.
    inner = 0.022 * (1 - 0.32 * c)
    wall = 0.010 * (1 + 0.45 * c)
    bulge = 1 + 0.28 * math.exp(-((phi - 0.4) / 0.9) ** 2) * math.sin(min(theta, math.pi / 2))
    r = (inner + wall * through) * bulge
    height = -1.55 * (1 - 0.15 * c) * r * math.cos(theta)
    turn = phi + 0.35 * c * math.cos(theta)  # the tip against the rim
    return r * math.sin(theta) * math.cos(turn), height, -r * math.sin(theta) * math.sin(turn)


def fiber(corners, through):
    """Along the wall, turning from +60 to -60 degrees from inside to outside."""
    x = [sum(p[axis] for p in corners) / 4 for axis in range(3)]
    around = (x[2], 0.0, -x[0])
    length = math.hypot(*around) or 1.0
    angle = math.radians(60 - 120 * through)
    return (math.cos(angle) * around[0] / length, math.sin(angle), math.cos(angle) * around[2] / length)


def grid():
    """Points, tetrahedra (six of each cube, along the paths from its lowest corner to its highest), their places in
    the wall, and the triangles of the surface with labels."""
    side = ACROSS + 1
    number = lambda i, j, k: (k * side + j) * side + i
    points = [place(i, j, k) for k in range(THROUGH + 1) for j in range(side) for i in range(side)]
    tets, through, triangles = [], [], []
    for k, j, i in itertools.product(range(THROUGH), range(ACROSS), range(ACROSS)):
        for path in itertools.permutations(range(3)):
            at = [i, j, k]
            corners = [number(*at)]
            for axis in path:
                at[axis] += 1
                corners.append(number(*at))
            tets.append(corners)
            through.append((k + 0.5) / THROUGH)
    count = {}
    for tet in tets:
        for face in itertools.combinations(tet, 3):
            key = tuple(sorted(face))
            count[key] = count.get(key, 0) + 1
    for face in (face for face, times in count.items() if times == 1):
        depths = {points[v][2] for v in face}
        label = 1 if depths == {0.0} else 2 if depths == {1.0} else 3
        triangles.append((face, label))
    return points, tets, through, triangles


def array(name, kind, code, components, values):
    """A DataArray, compressed in one block: base64 of the numbers of bytes, then of the bytes."""
    data = struct.pack(f"<{len(values)}{code}", *values)
    packed = zlib.compress(data)
    head = base64.b64encode(struct.pack("<4Q", 1, len(data), 0, len(packed))).decode()
    text = head + base64.b64encode(packed).decode()
    return (f'<DataArray type="{kind}" Name="{name}" NumberOfComponents="{components}" format="binary">\n'
            f"{text}\n</DataArray>\n")


def vtu(mesh, t):
    points, tets, through, triangles = mesh
    places = [position(point, t) for point in points]
    cells = [list(tet) for tet in tets] + [list(face) for face, _ in triangles]
    fibers = [fiber([places[v] for v in tet], s) for tet, s in zip(tets, through)]
    fibers += [(0.0, 0.0, 0.0)] * len(triangles)
    regions = [1 if s < 0.5 else 2 for s in through] + [label for _, label in triangles]
    ends = list(itertools.accumulate(len(cell) for cell in cells))
    flat = lambda rows: [value for row in rows for value in row]
    return (
        '<?xml version="1.0"?>\n<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian" '
        'header_type="UInt64" compressor="vtkZLibDataCompressor">\n<UnstructuredGrid>\n'
        f'<Piece NumberOfPoints="{len(points)}" NumberOfCells="{len(cells)}">\n<PointData>\n'
        + array("contraction", "Float64", "d", 1, [squeeze(t)] * len(points))
        + "</PointData>\n<CellData>\n"
        + array("region", "Int32", "i", 1, regions)
        + array("fiber", "Float64", "d", 3, flat(fibers))
        + "</CellData>\n<Points>\n"
        + array("Points", "Float64", "d", 3, flat(places))
        + "</Points>\n<Cells>\n"
        + array("connectivity", "Int64", "q", 1, flat(cells))
        + array("offsets", "Int64", "q", 1, ends)
        + array("types", "UInt8", "B", 1, [10] * len(tets) + [5] * len(triangles))
        + "</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n")


def main():
    if sys.argv[1:] in (["-h"], ["--help"]):
        print(__doc__)
        return
    if len(sys.argv) not in (2, 3) or sys.argv[1].startswith("-"):
        sys.exit("beating_heart: expected a folder and, if you like, a number of frames")
    folder = pathlib.Path(sys.argv[1])
    frames = int(sys.argv[2]) if len(sys.argv) == 3 else 24
    folder.mkdir(parents=True, exist_ok=True)
    mesh = grid()
    entries = []
    for frame in range(frames + 1):
        t = PERIOD * frame / frames
        name = f"heart_{frame:03d}.vtu"
        (folder / name).write_text(vtu(mesh, t))
        entries.append(f'<DataSet timestep="{t!r}" part="0" file="{name}"/>\n')
    (folder / "heart.pvd").write_text(
        '<?xml version="1.0"?>\n<VTKFile type="Collection" version="1.0">\n<Collection>\n'
        + "".join(entries) + "</Collection>\n</VTKFile>\n")


if __name__ == "__main__":
    main()

"""The direction of dependence that docs/architecture.md and CONTRIBUTING.md describe, read from the includes.

    layers_test.py REPOSITORY
"""

import re
import sys
import unittest
from pathlib import Path

ROOT = Path(sys.argv.pop(1)).resolve()
INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]', re.MULTILINE)

# Which libraries a library may include. What is not named here is a library of others.
LIBRARIES = {
    "format": set(),
    "contact": {"format"},
    "exchange": {"format"},
    "mesher": {"format", "exchange"},
    "simulator": {"format", "contact"},
    "viewer": {"format"},
    "runs": {"format", "contact", "simulator"},
    "distributed": {"format", "contact", "simulator"},
    "study": {"format", "contact", "simulator", "runs", "viewer"},
    "plugin": {"format", "contact", "simulator", "runs", "viewer"},
}

# What a library must never include of others, by the beginning of the name.
FOREIGN = {
    "contact": ("toml", "nlohmann", "CGAL", "mpi", "petsc", "tbb", "oneapi"),
    "simulator": ("toml", "nlohmann", "CGAL", "mpi", "petsc", "tbb", "oneapi", "pent/toml_table.h"),
    "runs": ("CGAL", "mpi", "petsc", "tbb", "oneapi"),
    "viewer": ("CGAL", "mpi", "petsc", "tbb", "oneapi"),
}

# The folders of simulator/src, each with those whose headers it may have, itself aside.
ROOMS = {
    "linear": set(),
    "kernels": {"linear"},
    "model": {"linear", "kernels"},
    "potentials": {"linear", "kernels", "model"},
    "step": {"linear", "kernels", "model", "potentials"},
    "theory": set(),
}

# Public headers of the simulator below the scene, as far as a room may see; others see them all.
OPTIONS = {"ranks.h", "solver_options.h", "words.h"}
MATERIAL = OPTIONS | {"material.h"}
OF_A_STEP = {"simulation.h", "simulation_options.h", "snapshot.h", "picking.h", "crossing_error.h"}
SEEN = {
    "linear": OPTIONS,
    "kernels": MATERIAL,
    "theory": MATERIAL | {"energy.h", "eigen_proof.h"},
}
HIDDEN = {
    "model": OF_A_STEP | {"step_report.h", "host.h", "energies.h"},
    "potentials": OF_A_STEP,
}

# contact/src from the bottom up: a file includes headers of its own layer and of those above it in
# this list, and public ones. What finds crossings is a witness: it knows no candidates.
CONTACT = [
    ("lanes", "lanes lanes_avx2 lanes_avx512 lanes_baseline lanes_isa lanes_table motion_lanes"
              " motion_lanes_kernel near_lanes near_lanes_kernel near_lanes_shapes patch_bound"
              " spectra_lanes spectra_lanes_kernel"),
    ("simplices", "apart ccd closest_point_search convex_reference distance_energy distance_hessian"
                  " filter gather normals obstacles orientation pair_contact paths"
                  " simplex_crossing spanned_volume spectra stencil surface friction valley"),
    ("trees", "box_tree boxes_around chunks halving patch_lanes patch_partition patch_vertices"
              " patches refit_tree surface_patches surface_trees winding_number"),
    ("search", "candidate colliders convex_body near_on_paths near_pairs overlaps pair_at path_cover"
               " self_proximity self_proximity_search shared_work"),
    ("crossings", "crossings obstacle_contacts"),
    ("candidates", "candidates meetings passing_candidates"),
    ("contacts", "barrier_contacts contact_energy pair_spectra penalty_contacts step_limit"),
    ("finder", "contact_finder"),
]
# Helpers of loops and of processes, for all.
EVERYWHERE = {"chunks", "shared_work"}


def sources(folder):
    return sorted(p for p in (ROOT / folder).rglob("*") if p.suffix in (".h", ".cpp", ".c"))


def includes(path):
    return INCLUDE.findall(path.read_text(encoding="utf-8"))


def library_of(header):
    """The library that a header in angle brackets is of; "" for those of others."""
    match = re.match(r"pent/(?:([a-z_]+)/)?", header)
    return "" if match is None else match.group(1) or "format"


def public(header, library):
    """The name of a public header of a library; "" for others."""
    start = f"pent/{library}/"
    return header[len(start):] if header.startswith(start) else ""


class Layers(unittest.TestCase):
    def nothing(self, faults):
        self.assertEqual(faults, [], "\n" + "\n".join(faults))

    def test_libraries_include_those_below_them_alone(self):
        faults = []
        count = 0
        for library, below in LIBRARIES.items():
            self.assertTrue((ROOT / library / "src").is_dir(), library)
            for path in sources(library):
                for header in includes(path):
                    of = library_of(header)
                    count += of != ""
                    if of not in ("", library) and of not in below:
                        faults.append(f"{path.relative_to(ROOT)}: includes <{header}> of {of}")
                    if header.startswith(FOREIGN.get(library, ("?",))):
                        faults.append(f"{path.relative_to(ROOT)}: includes <{header}>")
        self.nothing(faults)
        self.assertGreater(count, 1000)

    def test_private_headers_stay_in_their_library(self):
        faults = []
        for library in LIBRARIES:
            own = {str(p.relative_to(ROOT / library / "src")) for p in sources(f"{library}/src")}
            for path in sources(f"{library}/src"):
                for header in re.findall(r'#include "([^"]+)"', path.read_text(encoding="utf-8")):
                    here = path.parent / header
                    if header not in own and not here.is_file() and not header.startswith("pent"):
                        faults.append(f'{path.relative_to(ROOT)}: includes "{header}"')
        self.nothing(faults)

    def test_mesher_and_simulator_never_include_each_other(self):
        for one, other in (("mesher", "simulator"), ("simulator", "mesher")):
            self.assertNotIn(other, LIBRARIES[one])
            reached = set()
            waiting = [one]
            while waiting:  # nor by way of others
                for library in LIBRARIES[waiting.pop()] - reached:
                    reached.add(library)
                    waiting.append(library)
            self.assertNotIn(other, reached)

    def test_rooms_of_the_simulator_include_those_below_them_alone(self):
        faults = []
        folders = {p.name for p in (ROOT / "simulator/src").iterdir() if p.is_dir()}
        self.assertEqual(folders, set(ROOMS), "a folder has its line in ROOMS")
        for room, below in ROOMS.items():
            for path in sources(f"simulator/src/{room}"):
                for header in includes(path):
                    of = header.split("/")[0]
                    name = public(header, "simulator")
                    if (of in ROOMS and of != room and of not in below) or name in HIDDEN.get(room, ()):
                        faults.append(f"{path.relative_to(ROOT)}: includes {header}")
                    if name and room in SEEN and name not in SEEN[room]:
                        faults.append(f"{path.relative_to(ROOT)}: includes {header}, above {room}")
        self.nothing(faults)

    def test_linear_algebra_and_kernels_know_nothing_of_contact(self):
        faults = []
        for room in ("linear", "kernels", "theory"):
            for path in sources(f"simulator/src/{room}"):
                faults += [f"{path.relative_to(ROOT)}: includes {header}"
                           for header in includes(path) if library_of(header) == "contact"]
        self.nothing(faults)

    def test_public_headers_of_scenes_know_nothing_of_steps(self):
        faults = []
        for path in sources("simulator/include"):
            if path.name not in OF_A_STEP:
                faults += [f"{path.name}: includes {header}" for header in includes(path)
                           if public(header, "simulator") in OF_A_STEP]
        self.nothing(faults)

    def test_rooms_stand_in_the_order_of_the_map(self):
        """What the table of docs/architecture.md says: each room includes those above it."""
        text = (ROOT / "docs/architecture.md").read_text(encoding="utf-8")
        order = re.findall(r"^\| `(?:simulator/src/)?([a-z]+)/`", text, re.MULTILINE)
        for room, below in {**ROOMS, **LIBRARIES}.items():
            if room in order:
                for other in below & set(order):
                    self.assertLess(order.index(other), order.index(room), f"{other}, {room}")

    def test_layers_of_contact_include_those_below_them_alone(self):
        layer_of = {name: layer for layer, (_, names) in enumerate(CONTACT) for name in names.split()}
        faults = []
        for path in sources("contact/src"):
            self.assertIn(path.stem, layer_of, "a file of contact/src has its place in CONTACT")
            for header in includes(path):
                other = Path(header).stem
                is_private = not header.startswith("pent/") and other in layer_of
                if is_private and other not in EVERYWHERE and layer_of[other] > layer_of[path.stem]:
                    faults.append(f"{path.name}: includes {header}, which stands on it")
        self.nothing(faults)


if __name__ == "__main__":
    unittest.main()

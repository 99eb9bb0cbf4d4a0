"""Checks what pent-slice writes for ParaView with VTK's own reader and contour filter.

Usage: vtu_test.py PENT_SLICE WRITE_RUN. Exits with 77 where python3-vtk9 is not installed.

The contour w = c of the exported boundary must be the slice that pent-slice makes itself: closed, with
the same area and volume.
"""

import csv
import pathlib
import subprocess
import sys
import tempfile

try:
    from vtkmodules.vtkCommonDataModel import vtkDataObject
    from vtkmodules.vtkFiltersCore import (vtkContourFilter, vtkFeatureEdges, vtkMassProperties,
                                           vtkTriangleFilter)
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader
except ImportError:
    sys.exit(77)

OFFSET = 0.37  # through no vertex of the test's run


def read(path):
    reader = vtkXMLUnstructuredGridReader()
    assert reader.CanReadFile(str(path)), path
    reader.SetFileName(str(path))
    reader.Update()
    return reader


def contour(reader, array, value):
    contours = vtkContourFilter()
    contours.SetInputConnection(reader.GetOutputPort())
    contours.SetInputArrayToProcess(0, 0, 0, vtkDataObject.FIELD_ASSOCIATION_POINTS, array)
    contours.SetValue(0, value)
    triangles = vtkTriangleFilter()
    triangles.SetInputConnection(contours.GetOutputPort())
    triangles.Update()
    return triangles


def count_open_edges(surface):
    edges = vtkFeatureEdges()
    edges.SetInputConnection(surface.GetOutputPort())
    edges.BoundaryEdgesOn()
    edges.NonManifoldEdgesOn()
    edges.FeatureEdgesOff()
    edges.ManifoldEdgesOff()
    edges.Update()
    return edges.GetOutput().GetNumberOfCells()


def near(found, expected):
    # VTK computes contours in the double precision of the points; volumes are sums of thousands.
    return abs(found - expected) <= 1e-9 * abs(expected)


def main():
    pent_slice, write_run = sys.argv[1:3]
    with tempfile.TemporaryDirectory() as folder:
        run, out = pathlib.Path(folder, "run"), pathlib.Path(folder, "out")
        subprocess.run([write_run, run], check=True)
        subprocess.run([pent_slice, run, "-o", out, "--quiet", "--boundary", "--format", "vtu",
                        "--color", "strain", "--w", str(OFFSET)], check=True)
        rows = list(csv.DictReader(open(out / "slices.csv", encoding="ascii")))
        assert rows
        for row in rows:
            own = read(out / row["file"]).GetOutput()
            assert own.GetNumberOfPoints() == int(row["vertices"])
            assert own.GetNumberOfCells() == int(row["triangles"])
            assert own.GetPointData().HasArray("strain")

            boundary = read(out / row["file"].replace("_0", ".boundary_0", 1))
            for array in ("w", "speed", "strain"):
                assert boundary.GetOutput().GetPointData().HasArray(array), array
            surface = contour(boundary, "w", OFFSET)
            assert surface.GetOutput().GetNumberOfCells() > 0
            assert count_open_edges(surface) == 0
            mass = vtkMassProperties()
            mass.SetInputConnection(surface.GetOutputPort())
            mass.Update()
            assert near(mass.GetSurfaceArea(), float(row["area"])), mass.GetSurfaceArea()
            assert near(mass.GetVolume(), float(row["volume"])), mass.GetVolume()
    print("VTK reads", len(rows), "slices and agrees with them")


main()

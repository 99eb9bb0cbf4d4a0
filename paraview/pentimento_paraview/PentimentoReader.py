"""A reader of runs and meshes of four dimensions for ParaView, which slices: docs/paraview.md."""

import pathlib
import sys

import numpy as np
from paraview import print_error
from paraview.util.vtkAlgorithm import VTKPythonAlgorithmBase, smproperty, smproxy
from vtkmodules.numpy_interface import dataset_adapter
from vtkmodules.util.numpy_support import numpy_to_vtkIdTypeArray
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkMultiBlockDataSet, vtkPolyData

_HERE = pathlib.Path(__file__).resolve().parent
if (_HERE / "pentimento").is_dir():  # not where it is written
    sys.path.insert(0, str(_HERE))
from pentimento import Error, View  # noqa: E402


def _angle(plane):
    """The property of an angle: a slider."""
    start, end = plane
    return f"""
<DoubleVectorProperty name="Rotate{plane.upper()}" label="{plane}"
    command="SetRotate{plane.upper()}" number_of_elements="1" default_values="0">
  <DoubleRangeDomain name="range" min="-180" max="180"/>
  <Documentation>Turns the bodies about the origin, {start} towards {end}, in degrees. The turns
  come in the order {" ".join(View.PLANES)}.</Documentation>
</DoubleVectorProperty>"""


_PROPERTIES = f"""
<StringVectorProperty name="FileName" command="SetFileName" number_of_elements="1"
    panel_visibility="never" animateable="0">
  <FileListDomain name="files"/>
  <Documentation>A run folder, its scene.toml, or a .pent mesh.</Documentation>
</StringVectorProperty>
<DoubleVectorProperty name="TimestepValues" information_only="1" si_class="vtkSITimeStepsProperty"/>
<DoubleVectorProperty name="OffsetRange" command="GetOffsetRange" information_only="1"
    number_of_elements="2" default_values="-1 1"/>
<DoubleVectorProperty name="Offset" command="SetOffset" number_of_elements="1"
    default_values="0">
  <DoubleRangeDomain name="range" default_mode="mid">
    <RequiredProperties><Property name="OffsetRange" function="RangeInfo"/></RequiredProperties>
  </DoubleRangeDomain>
  <Documentation>The slice is w = offset of the turned bodies, in m; from end to end of where the
  bodies are at the start.</Documentation>
</DoubleVectorProperty>
<IntVectorProperty name="Smooth" command="SetSmooth" number_of_elements="1" default_values="0">
  <BooleanDomain name="bool"/>
  <Documentation>Normals of the body's own boundary in all its dimensions, as pent-render has them.
  Vertices on its edges are doubled, so the surface is no more closed there.</Documentation>
</IntVectorProperty>
{"".join(_angle(plane) for plane in ("xy", "xz", "yz", "xw", "yw", "zw"))}
"""


@smproxy.reader(
    name="PentimentoReader",
    label="Pentimento Reader",
    extensions="pent toml",
    file_description="Pentimento runs (scene.toml in the folder) and meshes",
    support_reload=False,
)
@smproperty.xml(_PROPERTIES)
class PentimentoReader(VTKPythonAlgorithmBase):
    """Gives a block for each body, by its name: the slice, or in three dimensions the surface."""

    def __init__(self):
        super().__init__(nInputPorts=0, nOutputPorts=1, outputType="vtkMultiBlockDataSet")
        self._path = None
        self._view = None
        self._offset = 0.0
        self._angles = {}
        self._is_smooth = False

    def SetFileName(self, path):
        if path != self._path:
            self._path, self._view = path, None
            self.Modified()

    def SetOffset(self, offset):
        if offset != self._offset:
            self._offset = offset
            self.Modified()

    def SetSmooth(self, is_smooth):
        if bool(is_smooth) != self._is_smooth:
            self._is_smooth = bool(is_smooth)
            self.Modified()

    def _set_angle(self, plane, degrees):
        if degrees != self._angles.get(plane, 0.0):
            self._angles[plane] = degrees
            self.Modified()

    def SetRotateXY(self, degrees):
        self._set_angle("xy", degrees)

    def SetRotateXZ(self, degrees):
        self._set_angle("xz", degrees)

    def SetRotateYZ(self, degrees):
        self._set_angle("yz", degrees)

    def SetRotateXW(self, degrees):
        self._set_angle("xw", degrees)

    def SetRotateYW(self, degrees):
        self._set_angle("yw", degrees)

    def SetRotateZW(self, degrees):
        self._set_angle("zw", degrees)

    def GetOffsetRange(self):
        """Its middle is where pent-slice slices by itself."""
        try:
            low, high = self._opened().extent(self._rotations())
            middle = self._opened().middle(self._rotations())
        except _FAILURES:
            return (-1.0, 1.0)  # RequestInformation() says what is wrong
        half = max(middle - low, high - middle)
        return (middle - half, middle + half)

    def GetTimestepValues(self):
        try:
            return self._times()
        except _FAILURES:
            return None

    def FillOutputPortInformation(self, _port, info):
        info.Set(vtkMultiBlockDataSet.DATA_TYPE_NAME(), "vtkMultiBlockDataSet")
        return 1

    def RequestInformation(self, _request, _inputs, outputs):
        executive = self.GetExecutive()
        info = outputs.GetInformationObject(0)
        info.Remove(executive.TIME_STEPS())
        info.Remove(executive.TIME_RANGE())
        try:
            times = self._times()
        except _FAILURES as error:
            _tell(error)
            return 1
        for time in times:
            info.Append(executive.TIME_STEPS(), time)
        if times:
            info.Append(executive.TIME_RANGE(), times[0])
            info.Append(executive.TIME_RANGE(), times[-1])
        return 1

    def RequestData(self, _request, _inputs, outputs):
        """A frame that is damaged gives nothing, and a line that says why."""
        output = vtkMultiBlockDataSet.GetData(outputs, 0)
        info = outputs.GetInformationObject(0)
        key = self.GetExecutive().UPDATE_TIME_STEP()
        try:
            view = self._opened()
            number = self._frame(info.Get(key) if info.Has(key) else None)
            look = {"rotate": self._rotations(), "offset": self._offset, "shading": self._is_smooth}
            surfaces = [view.slice(body, number, **look) for body in view.bodies]
        except _FAILURES as error:
            _tell(error)
            return 1
        for index, (body, surface) in enumerate(zip(view.bodies, surfaces)):
            output.SetBlock(index, _poly_data(surface))
            output.GetMetaData(index).Set(vtkMultiBlockDataSet.NAME(), _printable(body))
        return 1

    def _opened(self):
        if self._view is None:
            if self._path is None:
                raise Error("no file was chosen; expected a run folder or a .pent mesh")
            self._view = View(self._path)
        return self._view

    def _rotations(self):
        return {plane: self._angles[plane] for plane in View.PLANES if self._angles.get(plane)}

    def _times(self):
        """Of the frames, s; none for a mesh."""
        view = self._opened()
        rate = view.frames_per_second
        if rate == 0:
            return []
        start = view.time(view.frames[0])
        return [start + (number - view.frames[0]) / rate for number in view.frames]

    def _frame(self, time):
        """The last frame up to a time."""
        view, times = self._opened(), self._times()
        if time is None or not times:
            return view.frames[0]
        slack = 1e-6 * (times[-1] - times[0])
        return view.frames[max(int(np.searchsorted(times, time + slack, side="right")) - 1, 0)]


_FAILURES = (Error, OSError, IndexError)


def _tell(error):
    print_error("pentimento: " + _printable(" ".join(str(error).split())))


def _printable(text):
    """With a "?" for what is not UTF-8, as names of files may have it: VTK would end the program
    for it."""
    return text.encode("utf-8", "replace").decode("utf-8")


def _poly_data(surface):
    points, triangles, attributes = surface.points, surface.triangles, surface.attributes
    if surface.normals is not None:
        kept, triangles, normals = _split(surface)
        points = points[kept]
        attributes = {name: values[kept] for name, values in attributes.items()}
        attributes["Normals"] = normals
    data = vtkPolyData()
    wrapped = dataset_adapter.WrapDataObject(data)
    wrapped.Points = np.ascontiguousarray(points)
    cells = vtkCellArray()
    offsets = np.arange(0, triangles.size + 1, 3, dtype=np.int64)
    corners = triangles.astype(np.int64).ravel()
    cells.SetData(*(numpy_to_vtkIdTypeArray(numbers, deep=True) for numbers in (offsets, corners)))
    data.SetPolys(cells)
    for name, values in attributes.items():
        wrapped.PointData.append(np.ascontiguousarray(values), name)
    if surface.normals is not None:
        data.GetPointData().SetActiveNormals("Normals")
    return data


def _split(surface):
    """A vertex for each normal that a vertex has: whose it is, the triangles, and the normals."""
    normals = surface.normals.reshape(-1, 3)
    keys = np.column_stack([surface.triangles.ravel(), np.round(normals * 1e4)]).astype(np.int64)
    _, first, place = np.unique(keys, axis=0, return_index=True, return_inverse=True)
    return surface.triangles.ravel()[first], place.reshape(-1, 3), normals[first]

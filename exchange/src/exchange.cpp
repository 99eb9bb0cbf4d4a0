#include "formats.h"

#include <pent/counted.h>
#include <pent/error.h>
#include <pent/input_path.h>

#include <algorithm>
#include <array>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace pent::exchange {

namespace {

constexpr std::array<std::string_view, 1> kPent = {".pent"};
constexpr std::array<std::string_view, 2> k4off = {".off", ".4off"};
constexpr std::array<std::string_view, 2> kG4mf = {".g4tf", ".g4b"};
constexpr std::array<std::string_view, 1> k4do = {".4do"};
constexpr std::array<std::string_view, 1> k4obj = {".obj"};
constexpr std::array<std::string_view, 2> kMfem = {".mesh", ".mfem"};

constexpr std::array<std::string_view, 1> kVtk = {".vtk"};
constexpr std::array<std::string_view, 1> kGmsh = {".msh"};

constexpr std::array kFormats = {
    Format{".pent", kPent, true, false, read_pent, write_pent, true},
    Format{"4OFF", k4off, false, false, read_4off, write_4off},
    Format{"G4MF", kG4mf, false, true, read_g4mf, write_g4mf},
    Format{"4DO", k4do, false, false, read_4do, write_4do},
    Format{"OBJ of tesserxel", k4obj, false, false, read_4obj, write_4obj},
    Format{"MFEM mesh", kMfem, true, false, read_mfem, write_mfem},
    Format{"legacy VTK", kVtk, false, false, nullptr, write_legacy_vtk},
    Format{"Gmsh mesh", kGmsh, false, false, nullptr, write_gmsh},
};

void check_frames(const std::filesystem::path& path,
                  const Format& format,
                  const Content& content,
                  const WriteOptions& options) {
    if (options.frames.empty()) {
        return;
    }
    if (!format.has_frames) {
        throw Error(path.string() + ": " + std::string(format.name)
                    + " has no frames; expected .g4tf or .g4b");
    }
    const auto* body = std::get_if<Body>(&content);
    const Eigen::Index points =
        body != nullptr ? body->mesh.vertex_count() : std::get<TetSurface>(content).points.cols();
    std::set<std::string_view> names;
    for (const FramePoints& frame : options.frames) {
        if (!names.insert(frame.name).second) {
            throw Error(path.string() + ": two frames are called \"" + frame.name
                        + "\"; expected each frame once, from files of different names");
        }
        if (frame.points.cols() != points) {
            throw Error(path.string() + ": frame " + frame.name + " has "
                        + counted(frame.points.cols(), "point", "points") + "; expected "
                        + std::to_string(points));
        }
    }
}

// The boundary of a body, and of each frame what it has of the points.
void write_boundary(const std::filesystem::path& path,
                    const Format& format,
                    const SimplexMesh<4>& mesh,
                    const WriteOptions& options) {
    BodyBoundary boundary = boundary_with_vertices(mesh);
    WriteOptions own = options;
    for (FramePoints& frame : own.frames) {
        frame.points = Positions<4>(frame.points(Eigen::all, boundary.vertices));
    }
    format.write(path, std::move(boundary.surface), own);
}

}  // namespace

Content read_pent(const std::filesystem::path& path) {
    MeshFile<4> file = read_mesh<4>(path);
    return Body{std::move(file.mesh), std::move(file.extras)};
}

void write_pent(const std::filesystem::path& path,
                const Content& content,
                const WriteOptions& options) {
    const auto& body = std::get<Body>(content);
    static_cast<void>(
        write_mesh<4>(path, body.mesh, {.created_by = options.created_by}, body.extras));
}

std::span<const Format> formats() {
    return kFormats;
}

const Format& format_of(const std::filesystem::path& path) {
    const std::string ending = pent::format_of(path, "");
    std::string known;
    for (const Format& format : kFormats) {
        const auto& endings = format.endings;
        if (std::find(endings.begin(), endings.end(), ending) != endings.end()) {
            return format;
        }
        for (const std::string_view one : format.endings) {
            known += (known.empty() ? "" : ", ") + std::string(one);
        }
    }
    throw Error(path.string() + ": "
                + (ending.empty() ? "a name without an ending" : "a name that ends in " + ending)
                + "; expected one of " + known);
}

std::string left_out(const Body& body, const Format& format) {
    const auto& [mesh, extras] = body;
    std::vector<std::pair<bool, std::string>> parts = {
        {!format.has_cells && !mesh.regions.empty(), "regions"},
        {!format.has_cells && !extras.labels.empty(), "labels of the boundary"},
        {!extras.base_labels.empty(), "labels of the base"},
        {mesh.fibers.cols() > 0, "fibers"},
        {!mesh.parents.empty(), "quadratic cells"},
        {!mesh.layers.empty(), "layers"},
        {!extras.bisection_tags.empty(), "tags for bisection"}};
    for (const auto* fields : {&extras.vertex_fields, &extras.cell_fields}) {
        for (const VertexField& field : *fields) {
            parts.emplace_back(true, field.name);
        }
    }
    std::string names;
    for (const auto& [is_there, name] : parts) {
        if (is_there && !format.has_extras) {
            names += (names.empty() ? "" : ", ") + name;
        }
    }
    return names;
}

Content read(const std::filesystem::path& path, const ReadOptions& options) {
    const Format& format = format_of(path);
    if (format.read == nullptr) {
        throw Error(path.string() + ": " + std::string(format.name)
                    + " holds points of three dimensions, and is written only");
    }
    require_file(path);
    Content content = format.read(path);
    if (auto* surface = std::get_if<TetSurface>(&content)) {
        if (options.is_welded) {
            // What is closed as it stands may touch itself where points are at one place.
            *surface = check(*surface).is_closed() ? without_unused_points(*surface)
                                                   : weld(*surface).surface;
        }
        if (surface->tetrahedra.cols() == 0) {
            throw Error(path.string() + ": no tetrahedron in it; expected the boundary of a body of"
                                        " four dimensions");
        }
        orient(*surface, path.string());
    }
    return content;
}

void write(const std::filesystem::path& path, const Content& content, const WriteOptions& options) {
    const Format& format = format_of(path);
    const auto* body = std::get_if<Body>(&content);
    check_frames(path, format, content, options);
    if (body != nullptr && !format.has_cells) {
        write_boundary(path, format, body->mesh, options);
    } else if (body == nullptr && format.has_cells) {
        format.write(path, Body{cone_of(std::get<TetSurface>(content), path.string())}, options);
    } else {
        format.write(path, content, options);
    }
}

}  // namespace pent::exchange

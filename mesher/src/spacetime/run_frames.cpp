#include "run_frames.h"

#include "moving_fields.h"

#include <pent/counted.h>
#include <pent/error.h>
#include <pent/formatted.h>
#include <pent/run_files.h>

#include <Eigen/LU>

#include <algorithm>
#include <numeric>
#include <set>
#include <utility>

namespace pent::mesher {

namespace {

namespace fs = std::filesystem;

constexpr const char* kExpected = "a run folder of pent-sim, with meshes/ and frames/";

std::string body_of(const fs::path& folder, const std::string& asked) {
    const std::vector<std::string> bodies = bodies_of_run(folder, kExpected);
    std::string all;
    for (const std::string& body : bodies) {
        all += (all.empty() ? "" : ", ") + body;
    }
    if (asked.empty() && bodies.size() == 1) {
        return bodies.front();
    }
    if (asked.empty() || std::find(bodies.begin(), bodies.end(), asked) == bodies.end()) {
        throw Error(folder.string() + ": "
                    + (asked.empty() ? "several bodies or none" : "no body \"" + asked + "\"")
                    + "; expected one by --body: " + (all.empty() ? "there is none" : all));
    }
    return asked;
}

// The frames of a body, in their order.
std::vector<fs::path> frames_of(const fs::path& folder, const std::string& body) {
    std::vector<fs::path> frames;
    const std::set<int> numbers = frames_of_run(folder, kExpected)[body];
    for (const int frame : numbers) {
        frames.push_back(folder / frame_file(body, frame));
    }
    return frames;
}

void add_field(const std::string& name,
               const Eigen::MatrixXd& values,
               std::vector<MovingField>& fields) {
    if (values.cols() == 0) {
        return;
    }
    const auto known = std::find_if(fields.begin(), fields.end(),
                                    [&](const MovingField& field) { return field.name == name; });
    MovingField& field =
        known == fields.end() ? fields.emplace_back(MovingField{name, {}}) : *known;
    add_values(values, field);
}

Eigen::Matrix3d edges_of(const Positions<3>& positions, const Simplices<4>& cells, Eigen::Index c) {
    Eigen::Matrix3d edges;
    for (int k = 0; k < 3; ++k) {
        edges.col(k) = positions.col(cells(k + 1, c)) - positions.col(cells(0, c));
    }
    return edges;
}

// Fibers go with the body: F times those at rest.
Eigen::MatrixXd moved_fibers(const SimplexMesh<3>& rest, const Positions<3>& positions) {
    Eigen::MatrixXd fibers = rest.fibers;
    for (Eigen::Index cell = 0; cell < fibers.cols(); ++cell) {
        const Eigen::Matrix3d Dm = edges_of(rest.positions, rest.cells, cell);
        const Eigen::Matrix3d Ds = edges_of(positions, rest.cells, cell);
        fibers.col(cell) = Ds * (Dm.inverse() * rest.fibers.col(cell));
    }
    return fibers;
}

void leave_out(const std::string& what, MovingMesh& mesh) {
    mesh.left_out += (mesh.left_out.empty() ? "" : ", ") + what;
}

// Numbers of the mesh at rest stay what they are in every frame, where frames do not have them;
// which way a vector goes with the body the file does not say.
void add_fields_of_mesh(const std::vector<VertexField>& of_mesh,
                        std::vector<MovingField>& fields,
                        MovingMesh& mesh) {
    for (const VertexField& field : of_mesh) {
        if (std::any_of(fields.begin(), fields.end(),
                        [&](const MovingField& known) { return known.name == field.name; })) {
            continue;
        }
        if (field.values.rows() == 1) {
            fields.push_back({field.name, std::vector(mesh.frame_count(), field.values)});
        } else {
            leave_out("vector " + field.name + " of the mesh", mesh);
        }
    }
}

// What fields are called in the file, and what is said of those that are not carried.
void finish_fields(MovingMesh& mesh) {
    for (const std::string& removed :
         remove_unfinished(mesh.vertex_fields, mesh.frame_count(), "quantity")) {
        leave_out(removed, mesh);
    }
    FieldNames names(reserved_vertex_names(4));
    std::set<std::string> of_vertices;
    for (MovingField& field : mesh.vertex_fields) {
        field.name = names.take(field.name, field.values.front().rows() == 3);
        of_vertices.insert(field.name);
    }
    FieldNames cell_names(reserved_cell_names(4), std::move(of_vertices));
    for (MovingField& field : mesh.cell_fields) {
        if (field.values.front().rows() == 1) {  // all but the fibers
            field.name = cell_names.take(field.name, false);
        }
    }
}

void add_frame(const Frame<3>& frame, const fs::path& path, double scale, MovingMesh& mesh) {
    if (frame.positions.cols() != mesh.base.vertex_count()) {
        throw Error(path.string() + ": " + std::to_string(frame.positions.cols())
                    + " vertices, expected " + std::to_string(mesh.base.vertex_count())
                    + " as its mesh has");
    }
    if (!mesh.times.empty() && frame.time <= mesh.times.back()) {
        throw Error(path.string()
                    + formatted(": the time %g behind %g; expected times that"
                                " increase",
                                frame.time, mesh.times.back()));
    }
    mesh.times.push_back(frame.time);
    mesh.frames.push_back(path.filename().string());
    mesh.positions.push_back(frame.positions * scale);
    add_field("velocity", frame.velocities * scale, mesh.vertex_fields);
    add_field("contact_force", frame.contact_forces, mesh.vertex_fields);
    for (const VertexField& field : frame.fields) {
        add_field(field.name, field.values, mesh.vertex_fields);
    }
}

}  // namespace

MovingMesh read_run_frames(const fs::path& folder, const SeriesOptions& options) {
    const std::string body = body_of(folder, options.body);
    const fs::path mesh_path = folder / mesh_file(body);
    const FileInfo info = read_info(mesh_path);
    if (info.dimension != 3) {
        throw Error(mesh_path.string() + ": has dimension " + std::to_string(info.dimension)
                    + "; a space-time mesh is of tetrahedra that move in three dimensions");
    }
    const MeshFile<3> file = read_mesh<3>(mesh_path);
    MovingMesh mesh;
    mesh.base = file.mesh;
    mesh.triangles = file.extras.boundary;
    mesh.triangle_labels = file.extras.labels;
    mesh.left_out = file.mesh.parents.empty() ? "" : "parents of cells";
    mesh.cell_numbers.resize(static_cast<std::size_t>(mesh.base.cell_count()));
    std::iota(mesh.cell_numbers.begin(), mesh.cell_numbers.end(), 0U);
    const std::vector<fs::path> frames = frames_of(folder, body);
    if (frames.size() < 2) {
        throw Error(folder.string() + ": " + counted(frames.size(), "frame", "frames") + " of "
                    + body + "; a space-time mesh needs two or more");
    }
    for (std::size_t i = 0; i < frames.size(); i += static_cast<std::size_t>(options.every)) {
        const Frame<3> frame = read_frame<3>(frames[i]);
        if (frame.mesh_crc != info.crc32c) {
            throw Error(frames[i].string() + ": is a frame of another mesh than "
                        + mesh_path.string());
        }
        add_frame(frame, frames[i], options.scale, mesh);
        add_field("fiber", moved_fibers(file.mesh, frame.positions), mesh.cell_fields);
    }
    mesh.base.positions = mesh.positions.front();
    add_fields_of_mesh(file.extras.vertex_fields, mesh.vertex_fields, mesh);
    add_fields_of_mesh(file.extras.cell_fields, mesh.cell_fields, mesh);
    finish_fields(mesh);
    return mesh;
}

}  // namespace pent::mesher

#include "pent/viewer/run_folder.h"

#include <pent/error.h>
#include <pent/obstacles_file.h>
#include <pent/run_files.h>
#include <pent/viewer/attributes.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <set>
#include <sstream>
#include <utility>

namespace pent::viewer {

namespace {

namespace fs = std::filesystem;

constexpr const char* kExpected =
    "a run folder of pent-sim, with meshes/ and frames/, or a .pent mesh";

fs::path mesh_path(const RunFolder& run, const std::string& body) {
    return run.is_mesh ? run.path : run.path / mesh_file(body);
}

fs::path frame_path(const RunFolder& run, const std::string& body, int frame) {
    return run.path / frame_file(body, frame);
}

std::optional<int> to_number(const std::string& text) {
    int number = 0;
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, number);
    if (text.empty() || error != std::errc() || stop != end || number < 0) {
        return std::nullopt;
    }
    return number;
}

RunFolder single_mesh(const fs::path& path) {
    const FileInfo info = read_info(path);
    if (info.is_frame) {
        throw Error(path.string()
                    + ": is a frame, without cells; expected its run folder or a mesh");
    }
    RunFolder run;
    run.path = path;
    run.is_mesh = true;
    run.dimension = info.dimension;
    run.bodies = {path.stem().string()};
    run.frames = {0};
    return run;
}

void require_dimension(const fs::path& path, int found, int expected) {
    if (found != expected || found < 3) {
        throw Error(path.string() + ": has dimension " + std::to_string(found) + "; expected "
                    + (found < 3 ? std::string("3 or 4")
                                 : std::to_string(expected) + " as the other bodies have"));
    }
}

std::vector<int> common_frames(const RunFolder& run) {
    const auto by_body = frames_of_run(run.path, kExpected);
    std::vector<int> common;
    for (const std::string& body : run.bodies) {
        const auto found = by_body.find(body);
        if (found == by_body.end()) {
            throw Error(frame_path(run, body, 0).string()
                        + ": no such frame nor a later one of this body; did pent-sim run?");
        }
        std::vector<int> kept;
        if (&body == &run.bodies.front()) {
            kept.assign(found->second.begin(), found->second.end());
        } else {
            std::set_intersection(common.begin(), common.end(), found->second.begin(),
                                  found->second.end(), std::back_inserter(kept));
        }
        common = std::move(kept);
    }
    if (common.empty()) {
        throw Error((run.path / kFramesFolder).string() + ": no frame that all bodies have");
    }
    return common;
}

// One of the parts between commas, as the numbers it stands for.
std::vector<int> select_range(const std::vector<int>& frames, const std::string& part) {
    if (part == "last") {
        return {frames.back()};
    }
    std::vector<std::string> fields;
    std::istringstream stream(part + ":");
    for (std::string field; std::getline(stream, field, ':');) {
        fields.push_back(field);
    }
    const auto number = [&](std::size_t i, int otherwise) {
        if (i >= fields.size() || fields[i].empty()) {
            return otherwise;
        }
        const std::optional<int> value = to_number(fields[i]);
        if (!value) {
            throw Error("frames: found \"" + part
                        + "\"; expected a number, A:B, A:B:STEP or last, with commas between");
        }
        return *value;
    };
    const bool is_single = fields.size() == 1;
    const int from = number(0, frames.front());
    const int to = is_single ? from : number(1, frames.back());
    const int step = number(2, 1);
    if (fields.size() > 3 || step == 0 || part.empty()) {
        throw Error("frames: found \"" + part
                    + "\"; expected a number, A:B, A:B:STEP or last, with STEP at least 1");
    }
    std::vector<int> selected;
    for (const int frame : frames) {
        if (frame >= from && frame <= to && (frame - from) % step == 0) {
            selected.push_back(frame);
        }
    }
    if (is_single && selected.empty()) {
        throw Error("frames: no frame " + part + "; there are " + std::to_string(frames.size())
                    + ", from " + std::to_string(frames.front()) + " to "
                    + std::to_string(frames.back()));
    }
    return selected;
}

}  // namespace

RunFolder open_run(const std::filesystem::path& path) {
    std::error_code error;
    if (fs::is_regular_file(path, error)) {
        RunFolder run = single_mesh(path);
        require_dimension(path, run.dimension, run.dimension);
        return run;
    }
    if (!fs::exists(path, error)) {
        throw Error(path.string()
                    + ": no such file or folder; expected a run folder or a .pent mesh");
    }
    RunFolder run;
    run.path = path;
    run.bodies = bodies_of_run(path, kExpected);
    if (run.bodies.empty()) {
        throw Error((path / kMeshesFolder).string()
                    + ": no .pent mesh; expected one for every body");
    }
    for (const std::string& body : run.bodies) {
        const FileInfo info = read_info(mesh_path(run, body));
        run.dimension = &body == &run.bodies.front() ? info.dimension : run.dimension;
        require_dimension(mesh_path(run, body), info.dimension, run.dimension);
    }
    run.frames = common_frames(run);
    return run;
}

namespace {

template <int Dim>
std::vector<VertexField> vertex_fields_of(const MeshFile<Dim>& file) {
    std::vector<VertexField> fields = file.extras.vertex_fields;
    for (const VertexField& of_cells : file.extras.cell_fields) {
        const auto is_same = [&](const VertexField& field) { return field.name == of_cells.name; };
        if (std::none_of(fields.begin(), fields.end(), is_same)) {
            fields.push_back({of_cells.name, vertex_means(file.mesh, of_cells.values)});
        }
    }
    return fields;
}

}  // namespace

template <int Dim>
std::vector<Body<Dim>> load_bodies(const RunFolder& run) {
    std::vector<Body<Dim>> bodies;
    for (const std::string& name : run.bodies) {
        const fs::path path = mesh_path(run, name);
        MeshFile<Dim> file = read_mesh<Dim>(path);
        Boundary<Dim> boundary = make_boundary(file.mesh, path.string());
        std::vector<VertexField> fields = vertex_fields_of(file);
        bodies.push_back(
            {name, std::move(file.mesh), file.info.crc32c, std::move(boundary), std::move(fields)});
    }
    return bodies;
}

template <int Dim>
Frame<Dim> load_frame(const RunFolder& run, const Body<Dim>& body, int frame) {
    if (run.is_mesh) {
        Frame<Dim> start;
        start.positions = body.mesh.positions;
        start.velocities.resize(Dim, 0);
        start.mesh_name = run.path.filename().string();
        start.mesh_crc = body.mesh_crc;
        return start;
    }
    const fs::path path = frame_path(run, body.name, frame);
    Frame<Dim> result = read_frame<Dim>(path);
    if (result.mesh_crc != body.mesh_crc || result.positions.cols() != body.mesh.positions.cols()) {
        throw Error(path.string() + ": belongs to another mesh than "
                    + mesh_path(run, body.name).string() + "; expected both from one run");
    }
    return result;
}

template <int Dim>
std::vector<ObstacleShape<Dim>> load_obstacles(const RunFolder& run, int frame) {
    std::error_code error;
    const fs::path at_rest = run.path / kObstaclesFile;
    if (run.is_mesh
        || (!fs::exists(at_rest, error) && !fs::exists(run.path / kObstaclesFolder, error))) {
        return {};
    }
    return read_obstacles<Dim>(fs::exists(at_rest, error) ? at_rest
                                                          : run.path / obstacles_file(frame));
}

std::vector<int> select_frames(const std::vector<int>& frames, const std::string& text) {
    if (text.empty()) {
        return frames;
    }
    std::set<int> selected;
    std::istringstream stream(text + ",");
    for (std::string part; std::getline(stream, part, ',');) {
        const std::vector<int> range = select_range(frames, part);
        selected.insert(range.begin(), range.end());
    }
    if (selected.empty()) {
        throw Error("frames: none in " + text + "; there are " + std::to_string(frames.size())
                    + ", from " + std::to_string(frames.front()) + " to "
                    + std::to_string(frames.back()));
    }
    return {selected.begin(), selected.end()};
}

template std::vector<Body<3>> load_bodies<3>(const RunFolder& run);
template std::vector<Body<4>> load_bodies<4>(const RunFolder& run);
template Frame<3> load_frame<3>(const RunFolder& run, const Body<3>& body, int frame);
template Frame<4> load_frame<4>(const RunFolder& run, const Body<4>& body, int frame);
template std::vector<ObstacleShape<3>> load_obstacles<3>(const RunFolder& run, int frame);
template std::vector<ObstacleShape<4>> load_obstacles<4>(const RunFolder& run, int frame);

}  // namespace pent::viewer

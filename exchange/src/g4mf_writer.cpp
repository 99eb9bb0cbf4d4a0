#include "formats.h"
#include "g4mf.h"

#include <pent/base64.h>
#include <pent/error.h>
#include <pent/input_path.h>
#include <pent/output_file.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

namespace pent::exchange {

namespace {

using Json = nlohmann::ordered_json;
using g4mf::kDataUri;
using g4mf::kHeader;
using g4mf::kMagic;

template <typename Number>
void append_bytes(std::string& bytes, const Number& number) {
    bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
}

// Bytes of a buffer, with the views and accessors of what is in it.
class Buffer {
public:
    explicit Buffer(bool in_double) : in_double_(in_double) {}

    // Returns the number of the accessor.
    std::size_t add_points(const Positions<4>& points) {
        const std::size_t start = bytes_.size();
        for (const double coordinate : points.reshaped()) {
            if (in_double_) {
                append_bytes(bytes_, coordinate);
            } else {
                append_bytes(bytes_, static_cast<float>(coordinate));
            }
        }
        return add_accessor(start, in_double_ ? "float64" : "float32", 4);
    }

    // Turned over.
    std::size_t add_tetrahedra(const Simplices<4>& tetrahedra) {
        const std::size_t start = bytes_.size();
        for (const auto& tetrahedron : tetrahedra.colwise()) {
            for (const int corner : {0, 1, 3, 2}) {
                append_bytes(bytes_, tetrahedron[corner]);
            }
        }
        return add_accessor(start, "uint32", 4);
    }

    // 0, 1, 2, ...
    std::size_t add_indices(Eigen::Index count) {
        const std::size_t start = bytes_.size();
        for (Eigen::Index i = 0; i < count; ++i) {
            append_bytes(bytes_, static_cast<std::uint32_t>(i));
        }
        return add_accessor(start, "uint32", 1);
    }

    [[nodiscard]] const std::string& bytes() const { return bytes_; }
    [[nodiscard]] const Json& accessors() const { return accessors_; }
    [[nodiscard]] const Json& views() const { return views_; }

private:
    std::size_t add_accessor(std::size_t start, const char* type, int size) {
        Json view = {{"buffer", 0}, {"byteLength", bytes_.size() - start}};
        if (start > 0) {
            view["byteOffset"] = start;
        }
        // The next one starts at a multiple of what a number takes.
        while (bytes_.size() % sizeof(double) != 0) {
            bytes_ += '\0';
        }
        Json accessor = {{"bufferView", views_.size()}, {"componentType", type}};
        if (size > 1) {
            accessor["vectorSize"] = size;
        }
        views_.push_back(std::move(view));
        accessors_.push_back(std::move(accessor));
        return accessors_.size() - 1;
    }

    bool in_double_;
    std::string bytes_;
    Json accessors_ = Json::array();
    Json views_ = Json::array();
};

void append_chunk(std::string& file, const char* type, const std::string& data, char padding) {
    file += type;
    append_bytes(file, std::uint32_t{0});  // not compressed
    append_bytes(file, static_cast<std::uint64_t>(data.size()));
    file += data;
    while (file.size() % kHeader != 0) {
        file += padding;
    }
}

// How far the points go to each frame, as shapes to blend by amounts of 0 to 1.
Json blend_of(const TetSurface& surface, const std::vector<FramePoints>& frames, Buffer& buffer) {
    const std::size_t indices = buffer.add_indices(surface.points.cols());
    Json shapes = Json::array();
    for (const FramePoints& frame : frames) {
        const std::size_t offsets = buffer.add_points(frame.points - surface.points);
        shapes.push_back(
            {{"name", frame.name}, {"position", {{"indices", indices}, {"offsets", offsets}}}});
    }
    return {{"shapes", std::move(shapes)}};
}

Json mesh_of(const TetSurface& surface,
             const std::string& name,
             const WriteOptions& options,
             Buffer& buffer) {
    const std::size_t vertices = buffer.add_points(surface.points);
    const std::size_t simplexes = buffer.add_tetrahedra(surface.tetrahedra);
    Json mesh = {{"name", name + " mesh"},
                 {"surfaces", {{{"simplexes", simplexes}}}},
                 {"vertices", vertices}};
    if (!options.frames.empty()) {
        mesh["blend"] = blend_of(surface, options.frames, buffer);
    }
    return mesh;
}

void require_floats(const std::filesystem::path& path,
                    const TetSurface& surface,
                    const WriteOptions& options) {
    double largest = surface.points.cwiseAbs().maxCoeff();
    for (const FramePoints& frame : options.frames) {
        largest = std::max(largest, (frame.points - surface.points).cwiseAbs().maxCoeff());
    }
    if (!options.in_double && largest > double{std::numeric_limits<float>::max()}) {
        throw Error(path.string() + ": coordinates beyond what float holds; write doubles");
    }
}

}  // namespace

void write_g4mf(const std::filesystem::path& path,
                const Content& content,
                const WriteOptions& options) {
    const auto& surface = std::get<TetSurface>(content);
    require_floats(path, surface, options);
    const std::string name = path.stem().string();
    Buffer buffer(options.in_double);
    const Json mesh = mesh_of(surface, name, options, buffer);
    const std::string& bytes = buffer.bytes();
    Json json = {
        {"asset", {{"dimension", 4}, {"generator", options.created_by}}},
        {"accessors", buffer.accessors()},
        {"bufferViews", buffer.views()},
        {"buffers", {{{"byteLength", bytes.size()}}}},
        {"meshes", Json::array({mesh})},
        {"nodes",
         {{{"name", "root"}, {"children", {1}}},
          {{"name", name}, {"meshInstance", {{"mesh", 0}}}}}},
    };
    if (pent::format_of(path, "") == ".g4b") {
        json["buffers"][0]["chunk"] = 1;
        std::string file(kMagic);
        append_bytes(file, std::uint32_t{0});  // of a draft
        append_bytes(file, std::uint64_t{0});  // the size, when it is known
        append_chunk(file, "JSON", json.dump(-1, ' ', false, Json::error_handler_t::replace), ' ');
        append_chunk(file, "BLOB", bytes, '\0');
        const auto size = static_cast<std::uint64_t>(file.size());
        std::memcpy(file.data() + 8, &size, sizeof size);
        write_text(path, file);
        return;
    }
    json["buffers"][0]["uri"] = std::string(kDataUri) + to_base64(bytes);
    write_text(path, json.dump(1, '\t', false, Json::error_handler_t::replace) + "\n");
}

}  // namespace pent::exchange

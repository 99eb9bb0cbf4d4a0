#include "formats.h"
#include "g4mf.h"

#include <pent/base64.h>
#include <pent/error.h>
#include <pent/output_file.h>

#include <cstdint>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>

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

// The points, then the tetrahedra, turned over.
std::string bytes_of(const TetSurface& surface, bool in_double) {
    std::string bytes;
    for (const double coordinate : surface.points.reshaped()) {
        if (in_double) {
            append_bytes(bytes, coordinate);
        } else {
            append_bytes(bytes, static_cast<float>(coordinate));
        }
    }
    for (const auto& tetrahedron : surface.tetrahedra.colwise()) {
        for (const int corner : {0, 1, 3, 2}) {
            append_bytes(bytes, tetrahedron[corner]);
        }
    }
    return bytes;
}

Json json_of(const TetSurface& surface, const std::string& name, const WriteOptions& options) {
    const std::size_t number = options.in_double ? sizeof(double) : sizeof(float);
    const std::size_t points = 4 * number * static_cast<std::size_t>(surface.points.cols());
    const std::size_t tetrahedra =
        4 * sizeof(std::uint32_t) * static_cast<std::size_t>(surface.tetrahedra.cols());
    return {
        {"asset", {{"dimension", 4}, {"generator", options.created_by}}},
        {"accessors",
         {{{"bufferView", 0},
           {"componentType", options.in_double ? "float64" : "float32"},
           {"vectorSize", 4}},
          {{"bufferView", 1}, {"componentType", "uint32"}, {"vectorSize", 4}}}},
        {"bufferViews",
         {{{"buffer", 0}, {"byteLength", points}},
          {{"buffer", 0}, {"byteOffset", points}, {"byteLength", tetrahedra}}}},
        {"buffers", {{{"byteLength", points + tetrahedra}}}},
        {"meshes",
         {{{"name", name + " mesh"}, {"surfaces", {{{"simplexes", 1}}}}, {"vertices", 0}}}},
        {"nodes",
         {{{"name", "root"}, {"children", {1}}},
          {{"name", name}, {"meshInstance", {{"mesh", 0}}}}}},
    };
}

void append_chunk(std::string& file, const char* type, const std::string& data, char padding) {
    file += type;
    append_bytes(file, std::uint32_t{0});  // not compressed
    append_bytes(file, static_cast<std::uint64_t>(data.size()));
    file += data;
    while (file.size() % kHeader != 0) {
        file += padding;
    }
}

}  // namespace

void write_g4mf(const std::filesystem::path& path,
                const Content& content,
                const WriteOptions& options) {
    const auto& surface = std::get<TetSurface>(content);
    if (!options.in_double
        && surface.points.cwiseAbs().maxCoeff() > double{std::numeric_limits<float>::max()}) {
        throw Error(path.string() + ": coordinates beyond what float holds; write doubles");
    }
    const std::string bytes = bytes_of(surface, options.in_double);
    Json json = json_of(surface, path.stem().string(), options);
    if (path.extension() == ".g4b") {
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

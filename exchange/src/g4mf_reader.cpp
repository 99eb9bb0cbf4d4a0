#include "formats.h"
#include "g4mf.h"
#include "text_lines.h"

#include <pent/base64.h>
#include <pent/counted.h>
#include <pent/error.h>
#include <pent/read_text.h>

#include <Eigen/Geometry>

#include <array>
#include <cstring>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace pent::exchange {

namespace {

using Json = nlohmann::ordered_json;
using g4mf::kDataUri;
using g4mf::kHeader;
using g4mf::kMagic;

// Little-endian, as this program's own machines are.
template <typename Number>
Number number_at(std::string_view bytes, std::size_t at) {
    Number number{};
    std::memcpy(&number, bytes.data() + at, sizeof number);
    return number;
}

// A file's JSON and the bytes of its buffers.
class Document {
public:
    explicit Document(const std::filesystem::path& path)
        : path_(path), bytes_(read_text(path, "a G4MF file")) {
        try {
            if (std::string_view(bytes_).starts_with(kMagic)) {
                read_chunks();
            }
            json_ = Json::parse(chunks_.empty() ? std::string_view(bytes_) : chunks_[0]);
            const auto dimension = json_.at("asset").at("dimension").get<std::int64_t>();
            if (dimension != 4) {
                fail("a model of " + counted(dimension, "dimension", "dimensions")
                     + "; expected 4");
            }
        } catch (const Json::exception& error) {
            fail_json(error);
        }
    }

    [[nodiscard]] const Json& json() const { return json_; }

    [[noreturn]] void fail(const std::string& message) const {
        throw Error(path_.string() + ": " + message);
    }
    [[noreturn]] void fail_json(const Json::exception& error) const {
        fail(std::string("is no G4MF file (") + error.what() + ")");
    }

    // The numbers of an accessor whose elements have `size` of them.
    template <typename Number>
    [[nodiscard]] std::vector<Number> numbers(std::size_t accessor, std::size_t size) {
        const Json& entry = json_.at("accessors").at(accessor);
        const std::string place = "accessor " + std::to_string(accessor);
        if (entry.value("vectorSize", std::size_t{1}) != size) {
            fail(place + ": elements of "
                 + counted(entry.value("vectorSize", 1), "number", "numbers") + "; expected "
                 + std::to_string(size));
        }
        // Drafts of the format have called it both.
        const char* key = entry.contains("componentType") ? "componentType" : "primitiveType";
        const auto type = entry.at(key).get<std::string>();
        const std::string_view bytes = view(entry.at("bufferView").get<std::size_t>());
        if constexpr (std::is_floating_point_v<Number>) {
            if (type == "float32") {
                return converted<Number, float>(bytes, size, place);
            }
            if (type == "float64") {
                return converted<Number, double>(bytes, size, place);
            }
        } else {
            if (type == "uint8") {
                return converted<Number, std::uint8_t>(bytes, size, place);
            }
            if (type == "uint16") {
                return converted<Number, std::uint16_t>(bytes, size, place);
            }
            if (type == "uint32" || type == "int32") {
                return converted<Number, std::uint32_t>(bytes, size, place);
            }
        }
        fail(place + ": numbers of type " + type + "; expected "
             + (std::is_floating_point_v<Number> ? "float32 or float64"
                                                 : "uint8, uint16 or uint32"));
    }

private:
    void read_chunks() {
        if (bytes_.size() < 2 * kHeader || number_at<std::uint32_t>(bytes_, 4) != 0
            || number_at<std::uint64_t>(bytes_, 8) != bytes_.size()) {
            fail("a damaged header; expected that of a G4MF draft with "
                 + std::to_string(bytes_.size()) + " bytes in the file");
        }
        for (std::size_t at = kHeader; at + kHeader <= bytes_.size();) {
            const auto compression = number_at<std::uint32_t>(bytes_, at + 4);
            const auto size = number_at<std::uint64_t>(bytes_, at + 8);
            if (size > bytes_.size() - at - kHeader) {
                fail("chunk " + std::to_string(chunks_.size()) + " has "
                     + counted(size, "byte", "bytes") + "; the file ends before");
            }
            if (compression != 0) {
                fail("chunk " + std::to_string(chunks_.size())
                     + " is compressed; expected one that is not");
            }
            chunks_.push_back(std::string_view(bytes_).substr(at + kHeader, size));
            at += kHeader + (size + kHeader - 1) / kHeader * kHeader;
        }
        if (std::string_view(bytes_).substr(kHeader, 4) != "JSON") {
            fail("no JSON in its first chunk");
        }
    }

    // The bytes of a buffer, from the text, a file beside this one, or a chunk.
    const std::string& buffer(std::size_t index) {
        const Json& entry = json_.at("buffers").at(index);
        buffers_.resize(json_.at("buffers").size());
        std::optional<std::string>& known = buffers_[index];
        if (known) {
            return *known;
        }
        const std::string place = "buffer " + std::to_string(index);
        if (entry.contains("encoding") || entry.contains("compression")) {
            fail(place + ": is compressed; expected one that is not");
        }
        if (!entry.contains("uri")) {
            const auto chunk = entry.value("chunk", index + 1);
            if (chunk >= chunks_.size()) {
                fail(place + ": chunk " + std::to_string(chunk) + " of "
                     + std::to_string(chunks_.size()));
            }
            known = chunks_[chunk];
        } else {
            const auto uri = entry.at("uri").get<std::string>();
            known = uri.starts_with(kDataUri) ? from_base64(uri.substr(kDataUri.size()))
                                              : read_text(path_.parent_path() / uri, "a buffer");
        }
        if (!known || known->size() < entry.at("byteLength").get<std::size_t>()) {
            fail(place + ": has fewer bytes than its byteLength, or is no base64");
        }
        return *known;
    }

    std::string_view view(std::size_t index) {
        const Json& entry = json_.at("bufferViews").at(index);
        const std::string_view bytes = buffer(entry.value("buffer", std::size_t{0}));
        const auto offset = entry.value("byteOffset", std::size_t{0});
        const auto length = entry.at("byteLength").get<std::size_t>();
        if (offset > bytes.size() || length > bytes.size() - offset) {
            fail("bufferView " + std::to_string(index) + ": reaches beyond its buffer");
        }
        return bytes.substr(offset, length);
    }

    template <typename Number, typename Stored>
    std::vector<Number> converted(std::string_view bytes,
                                  std::size_t size,
                                  const std::string& place) const {
        if (bytes.size() % (size * sizeof(Stored)) != 0) {
            fail(place + ": its bytes are no whole number of elements");
        }
        std::vector<Number> numbers;
        for (std::size_t at = 0; at < bytes.size(); at += sizeof(Stored)) {
            numbers.push_back(static_cast<Number>(number_at<Stored>(bytes, at)));
        }
        return numbers;
    }

    std::filesystem::path path_;
    std::string bytes_;
    std::vector<std::string_view> chunks_;
    std::vector<std::optional<std::string>> buffers_;
    Json json_;
};

// Puts the meshes of a document where its nodes have them, or as they are if there are no nodes.
class MeshReader {
public:
    explicit MeshReader(Document& document) : document_(document), json_(document.json()) {}

    SurfaceBuilder operator()() {
        if (json_.contains("nodes") && !json_.at("nodes").empty()) {
            add_nodes();
        } else if (json_.contains("meshes")) {
            for (std::size_t mesh = 0; mesh < json_.at("meshes").size(); ++mesh) {
                add_mesh(mesh, Affine::Identity());
            }
        }
        return std::move(builder_);
    }

private:
    using Affine = Eigen::Transform<double, 4, Eigen::Affine>;

    // All that hang on the first one, each below its parent.
    void add_nodes() {
        const Json& nodes = json_.at("nodes");
        std::vector<bool> is_visited(nodes.size(), false);
        std::vector<std::pair<std::size_t, Affine>> waiting = {{0, Affine::Identity()}};
        while (!waiting.empty()) {
            const auto [index, above] = waiting.back();
            waiting.pop_back();
            const Json& node = nodes.at(index);
            if (is_visited[index]) {
                document_.fail("node " + std::to_string(index) + ": is the child of two nodes");
            }
            is_visited[index] = true;
            const Affine place = above * placement(node, index);
            if (node.contains("meshInstance")) {
                add_mesh(node.at("meshInstance").at("mesh").get<std::size_t>(), place);
            } else if (node.contains("mesh")) {  // in earlier drafts
                add_mesh(node.at("mesh").get<std::size_t>(), place);
            }
            for (const Json& child : node.value("children", Json::array())) {
                waiting.emplace_back(child.get<std::size_t>(), place);
            }
        }
    }

    Affine placement(const Json& node, std::size_t index) const {
        const auto numbers = [&](const char* key, std::size_t count) {
            const auto list = node.at(key).get<std::vector<double>>();
            if (list.size() != count) {
                document_.fail("node " + std::to_string(index) + ": " + key + " has "
                               + counted(list.size(), "number", "numbers") + "; expected "
                               + std::to_string(count));
            }
            return list;
        };
        if (node.contains("rotor")) {
            document_.fail("node " + std::to_string(index)
                           + ": is turned by a rotor; expected a basis");
        }
        Affine place = Affine::Identity();
        if (node.contains("position")) {
            place.translation() = Eigen::Map<const Eigen::Vector4d>(numbers("position", 4).data());
        }
        if (node.contains("basis")) {  // column by column
            place.linear() = Eigen::Map<const Eigen::Matrix4d>(numbers("basis", 16).data());
        } else if (node.contains("scale")) {
            const bool is_uniform = node.at("scale").size() == 1;
            const std::vector<double> scale = numbers("scale", is_uniform ? 1 : 4);
            for (int axis = 0; axis < 4; ++axis) {
                place.linear()(axis, axis) =
                    scale[is_uniform ? 0U : static_cast<std::size_t>(axis)];
            }
        }
        return place;
    }

    void add_mesh(std::size_t index, const Affine& place) {
        const Json& mesh = json_.at("meshes").at(index);
        const std::vector<double> points =
            document_.numbers<double>(mesh.at("vertices").get<std::size_t>(), 4);
        const std::int64_t first = builder_.point_count();
        for (std::size_t at = 0; at < points.size(); at += 4) {
            const Eigen::Vector4d point = place * Eigen::Map<const Eigen::Vector4d>(&points[at]);
            if (!point.allFinite()) {
                document_.fail("mesh " + std::to_string(index) + ": point " + std::to_string(at / 4)
                               + " is not finite");
            }
            builder_.add_point(point);
        }
        const auto count = static_cast<std::uint32_t>(builder_.point_count() - first);
        // Its outside is our inside; a mirrored node turns it once more.
        const bool is_turned = place.linear().determinant() > 0;
        for (const Json& surface : mesh.at("surfaces")) {
            for (const char* key : {"simplexes", "cells"}) {  // as drafts have called them
                if (surface.contains(key)) {
                    add_tetrahedra(surface.at(key).get<std::size_t>(), {first, count}, is_turned);
                }
            }
        }
    }

    // The points of a mesh among all.
    struct Range {
        std::int64_t first;
        std::uint32_t count;
    };

    void add_tetrahedra(std::size_t accessor, const Range& points, bool is_turned) {
        const auto corners = document_.numbers<std::uint32_t>(accessor, 4);
        for (std::size_t at = 0; at < corners.size(); at += 4) {
            std::array<std::uint32_t, 4> tetrahedron{};
            for (std::size_t k = 0; k < 4; ++k) {
                if (corners[at + k] >= points.count) {
                    document_.fail("accessor " + std::to_string(accessor) + ": index "
                                   + std::to_string(corners[at + k]) + " of "
                                   + std::to_string(points.count));
                }
                tetrahedron[k] = static_cast<std::uint32_t>(points.first) + corners[at + k];
            }
            if (is_turned) {
                std::swap(tetrahedron[2], tetrahedron[3]);
            }
            builder_.add_tetrahedron(tetrahedron);
        }
    }

    Document& document_;
    const Json& json_;
    SurfaceBuilder builder_;
};

}  // namespace

Content read_g4mf(const std::filesystem::path& path) {
    Document document(path);
    try {
        const SurfaceBuilder builder = MeshReader(document)();
        auto [positions, tetrahedra] = builder.take();
        return TetSurface{std::move(positions), std::move(tetrahedra)};
    } catch (const Json::exception& error) {
        document.fail_json(error);
    }
}

}  // namespace pent::exchange

#include "polytopes.h"
#include "support/kuhn_box.h"

#include <pent/base64.h>
#include <pent/error.h>

#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <type_traits>
#include <utility>
#include <vector>

namespace pent::exchange {
namespace {

using test::error_as;
using test::five_cell;
using test::read_as;
using test::sixteen_cell;
using test::text_as;
using Json = nlohmann::ordered_json;

TetSurface with_digits() {
    TetSurface surface = sixteen_cell();
    surface.points = 0.1 * surface.points.array() + 1.0 / 3;
    return surface;
}

TEST(G4mf, IsReadAsItWasWritten) {
    for (const char* name : {"a.g4tf", "a.g4b"}) {
        // A float has 24 bits.
        test::expect_same_surface(read_as(name, text_as(name, with_digits())), with_digits(), 3e-8);
        test::expect_same_surface(read_as(name, text_as(name, with_digits(), {.in_double = true})),
                                  with_digits(), 0);
    }
}

// Offsets from the points to those of the frame, of all points by their indices; without amounts
// all are 0, so that a reader without shapes sees the mesh as it is.
TEST(G4mf, HasFramesAsBlendShapes) {
    for (const bool in_double : {false, true}) {
        // An odd number of points, too: what follows their indices starts at a multiple of 8.
        const TetSurface surface = in_double ? five_cell() : sixteen_cell();
        const auto count = static_cast<std::size_t>(surface.points.cols());
        const Positions<4> turned = surface.points.colwise().reverse();
        const Positions<4> larger = 3 * surface.points;
        const std::string text =
            text_as("a.g4tf", surface,
                    {.in_double = in_double, .frames = {{"turned", turned}, {"larger", larger}}});
        const Json json = Json::parse(text);
        const auto uri = json["buffers"][0]["uri"].get<std::string>();
        const std::string bytes = *from_base64(uri.substr(uri.find(',') + 1));
        const Json& shapes = json["meshes"][0]["blend"]["shapes"];
        ASSERT_EQ(shapes.size(), 2U);
        EXPECT_EQ(shapes[0]["name"], "turned");
        const auto values_of = [&]<typename Number>(const Json& number, Number) {
            const Json& accessor = json["accessors"][number.get<std::size_t>()];
            EXPECT_EQ(accessor.value("vectorSize", 1), std::is_integral_v<Number> ? 1 : 4);
            const Json& view = json["bufferViews"][accessor["bufferView"].get<std::size_t>()];
            std::vector<Number> values(view["byteLength"].get<std::size_t>() / sizeof(Number));
            EXPECT_EQ(view["byteOffset"].get<std::size_t>() % sizeof(Number), 0U);
            std::memcpy(values.data(), bytes.data() + view["byteOffset"].get<std::size_t>(),
                        values.size() * sizeof(Number));
            return values;
        };
        const Json& target = shapes[1]["position"];
        const auto indices = values_of(target["indices"], std::uint32_t{});
        ASSERT_EQ(indices.size(), count);
        std::vector<double> offsets;
        if (in_double) {
            offsets = values_of(target["offsets"], double{});
        } else {
            const auto floats = values_of(target["offsets"], float{});
            offsets.assign(floats.begin(), floats.end());
        }
        ASSERT_EQ(offsets.size(), 4 * count);
        for (std::size_t i = 0; i < indices.size(); ++i) {
            const Eigen::Vector4d offset(&offsets[4 * i]);
            EXPECT_EQ(surface.points.col(indices[i]) + offset, larger.col(indices[i]));
        }
        test::expect_same_surface(read_as("a.g4tf", text), surface, 0);
    }
}

// Of a body frames have all vertices; the shapes move those of the boundary.
TEST(G4mf, HasOfTheFramesOfABodyWhatItsBoundaryHas) {
    const SimplexMesh<4> box = pent::test::kuhn_box<4>({2, 2, 2, 2}, {1, 1, 1, 1});
    Positions<4> moved = box.positions;
    moved.row(0) += Eigen::RowVectorXd::LinSpaced(81, 1, 81);  // each vertex its own way
    const TetSurface boundary = boundary_of(box);
    ASSERT_LT(boundary.points.cols(), box.vertex_count());
    Positions<4> expected = boundary.points;
    for (Eigen::Index p = 0; p < expected.cols(); ++p) {
        for (Eigen::Index v = 0; v < box.vertex_count(); ++v) {
            if (box.positions.col(v) == boundary.points.col(p)) {
                expected.col(p) = moved.col(v);
            }
        }
    }
    for (const char* name : {"a.g4tf", "a.g4b"}) {
        EXPECT_EQ(text_as(name, Body{box}, {.frames = {{"moved", moved}}}),
                  text_as(name, boundary, {.frames = {{"moved", expected}}}));
    }
}

TEST(G4mf, HasDoublesWhereFloatsAreTooSmall) {
    TetSurface far = five_cell();
    far.points *= 1e39;
    const TetSurface near = five_cell();
    TetSurface left = near;
    TetSurface right = near;
    left.points *= -3e38;  // floats hold both, and not the way from one to the other
    right.points *= 3e38;
    for (const auto& moved : {std::pair(far, far), std::pair(near, far), std::pair(left, right)}) {
        const TetSurface& surface = moved.first;
        const std::vector<FramePoints> frames = {{"moved", moved.second.points}};
        pent::test::expect_contains(
            pent::test::error_of([&] { (void)text_as("a.g4b", surface, {.frames = frames}); }),
            {"a.g4b: coordinates beyond what float holds; write doubles"});
        const auto again = std::get<TetSurface>(
            read_as("a.g4b", text_as("a.g4b", surface, {.in_double = true, .frames = frames})));
        EXPECT_EQ(again.points, surface.points);
    }
    TetSurface largest = near;  // that a float holds
    largest.points *= double{std::numeric_limits<float>::max()};
    EXPECT_EQ(std::get<TetSurface>(read_as("a.g4b", text_as("a.g4b", largest))).points,
              largest.points);
}

TEST(G4mf, AloneHasFrames) {
    const TetSurface surface = five_cell();
    const auto error_of = [&](const char* name, const Positions<4>& points) -> std::string {
        try {
            (void)text_as(name, surface, {.frames = {{"moved", points}}});
        } catch (const Error& error) {
            return error.what();
        }
        return "";
    };
    pent::test::expect_contains(error_of("a.4off", surface.points), {"4OFF has no frames", ".g4b"});
    const FramePoints frame{"moved", surface.points};
    pent::test::expect_contains(pent::test::error_of([&] {
                                    (void)text_as("a.g4b", surface, {.frames = {frame, frame}});
                                }),
                                {"a.g4b: two frames are called \"moved\"", "each frame once"});
    pent::test::expect_contains(error_of("a.g4b", surface.points.leftCols(3)),
                                {"frame moved has 3 points; expected 5"});
}

// Its outside: perpendicular to the edges from the first corner, with perp(x, y, z) = w.
TEST(G4mf, FacesOutwardInItsOwnWay) {
    const TetSurface surface = sixteen_cell();
    const Json json = Json::parse(text_as("a.g4tf", surface));
    const auto uri = json["buffers"][0]["uri"].get<std::string>();
    const std::string bytes = *from_base64(uri.substr(uri.find(',') + 1));
    const auto offset = json["bufferViews"][1]["byteOffset"].get<std::size_t>();
    for (Eigen::Index t = 0; t < surface.tetrahedra.cols(); ++t) {
        std::array<std::uint32_t, 4> corners{};
        std::memcpy(corners.data(), bytes.data() + offset + 16 * static_cast<std::size_t>(t), 16);
        const Eigen::Vector4d origin = surface.points.col(corners[0]);
        const auto edge = [&](std::size_t k) -> Eigen::Vector4d {
            return surface.points.col(corners[k]) - origin;
        };
        EXPECT_GT(test::perpendicular(edge(1), edge(2), edge(3)).dot(origin), 0);
    }
}

TEST(G4mf, InChunksHasTheLayoutOfTheFormat) {
    const std::string file = text_as("a.g4b", five_cell());
    EXPECT_EQ(file.substr(0, 8), std::string("G4MF\0\0\0\0", 8));
    std::uint64_t size = 0;
    std::memcpy(&size, file.data() + 8, 8);
    EXPECT_EQ(size, file.size());
    EXPECT_EQ(file.substr(16, 4), "JSON");
    const std::size_t blob = file.find("BLOB");
    EXPECT_EQ(blob % 16, 0U);
    std::memcpy(&size, file.data() + blob + 8, 8);
    EXPECT_EQ(size, 5U * 16 + 5 * 16);
    EXPECT_EQ(file.size() % 16, 0U);
    std::memcpy(&size, file.data() + 24, 8);
    const Json json = Json::parse(file.substr(32, size));
    EXPECT_EQ(json["buffers"], Json::parse(R"([{"byteLength": 160, "chunk": 1}])"));
}

// What has the value that the format gives what is not there, and a tab a level.
TEST(G4mf, LeavesOutWhatMayBeLeftOut) {
    const std::string text =
        text_as("a.g4tf", five_cell(), {.frames = {{"larger", 2 * five_cell().points}}});
    EXPECT_TRUE(text.starts_with("{\n\t\"asset\": {\n\t\t\"dimension\": 4,\n"));
    const Json json = Json::parse(text);
    EXPECT_EQ(json["bufferViews"][0], Json::parse(R"({"buffer": 0, "byteLength": 80})"));
    EXPECT_EQ(json["accessors"][2], Json::parse(R"({"bufferView": 2, "componentType": "uint32"})"));
}

// Chunks end at multiples of 16 bytes, wherever what is in them ends.
TEST(G4mf, HasChunksOfAnySize) {
    std::string by("x");
    for (; by.size() < 34; by += 'x') {
        const std::string file = text_as("a.g4b", five_cell(), {.created_by = by});
        std::uint64_t size = 0;
        std::memcpy(&size, file.data() + 24, 8);
        EXPECT_EQ(file.find("BLOB"), 32 + (size + 15) / 16 * 16);
        test::expect_same_surface(read_as("a.g4b", file), five_cell(), 0);
    }
}

TEST(G4mf, IsInChunksOrTextAsTheEndingSaysInLettersOfAnySize) {
    for (const auto& [large, small] : {std::pair("A.G4B", "A.g4b"), {"A.G4TF", "A.g4tf"}}) {
        EXPECT_EQ(text_as(large, five_cell()), text_as(small, five_cell()));
    }
}

// As others may write it: two meshes that nodes put in their places, the words of earlier drafts,
// indices in two bytes, points in a buffer of their own.
TEST(G4mf, PutsItsMeshesWhereItsNodesHaveThem) {
    const TetSurface cell = sixteen_cell();
    std::string points;
    for (const double coordinate : cell.points.reshaped()) {
        const auto number = static_cast<float>(coordinate);
        points.append(reinterpret_cast<const char*>(&number), 4);
    }
    std::string indices;
    for (const std::uint32_t corner : cell.tetrahedra.reshaped()) {
        const auto number = static_cast<std::uint16_t>(corner);
        indices.append(reinterpret_cast<const char*>(&number), 2);
    }
    const std::string start = "data:application/octet-stream;base64,";
    const Json json = {{"asset", {{"dimension", 4}}},
                       {"buffers",
                        {{{"byteLength", points.size()}, {"uri", start + to_base64(points)}},
                         {{"byteLength", indices.size()}, {"uri", start + to_base64(indices)}}}},
                       {"bufferViews",
                        {{{"buffer", 0}, {"byteLength", points.size()}},
                         {{"buffer", 1}, {"byteLength", indices.size()}}}},
                       {"accessors",
                        {{{"bufferView", 0}, {"primitiveType", "float32"}, {"vectorSize", 4}},
                         {{"bufferView", 1}, {"primitiveType", "uint16"}, {"vectorSize", 4}}}},
                       {"meshes", {{{"vertices", 0}, {"surfaces", {{{"cells", 1}}}}}}},
                       {"nodes",
                        {{{"children", {1, 2}}},
                         {{"mesh", 0}, {"position", {5, 0, 0, 0}}},
                         {{"children", {3}}, {"scale", {2}}},
                         {{"meshInstance", {{"mesh", 0}}},
                          {"basis", {0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}}}}};
    const auto surface = std::get<TetSurface>(read_as("a.g4tf", json.dump()));
    EXPECT_TRUE(check(surface).is_oriented());
    EXPECT_NEAR(enclosed_hypervolume(surface), 2.0 / 3 * (1 + 16), 1e-5);
    EXPECT_EQ(surface.points.row(0).maxCoeff(), 6);
    EXPECT_EQ(surface.points.row(3).minCoeff(), -2);
}

// What a file leaves out has the values of the format; what drafts have called otherwise is read.
TEST(G4mf, IsReadWithoutWhatMayBeLeftOut) {
    const Json full = Json::parse(text_as("a.g4tf", five_cell()));
    const auto expect_the_same = [](const Json& json) {
        test::expect_same_surface(read_as("a.g4tf", json.dump()), five_cell(), 0);
    };
    Json json = full;
    json["nodes"] = Json::array();
    expect_the_same(json);
    json.erase("nodes");
    expect_the_same(json);
    json.erase("meshes");
    pent::test::expect_contains(error_as("a.g4tf", json.dump()), {"a.g4tf: no tetrahedron in it"});
    json = full;
    for (Json& view : json["bufferViews"]) {
        view.erase("buffer");
    }
    expect_the_same(json);
    json["accessors"][1]["componentType"] = "int32";
    expect_the_same(json);
    const TetSurface cell = five_cell();
    std::string corners;
    for (const std::uint32_t corner : cell.tetrahedra.reshaped()) {
        corners += static_cast<char>(corner);
    }
    json["buffers"].push_back(
        {{"byteLength", corners.size()},
         {"uri", "data:application/octet-stream;base64," + to_base64(corners)}});
    json["bufferViews"][1] = {{"buffer", 1}, {"byteLength", corners.size()}};
    json["accessors"][1]["componentType"] = "uint8";
    expect_the_same(json);
    // A surface without tetrahedra may begin where the buffer ends.
    json = full;
    const std::size_t size = json["buffers"][0]["byteLength"].get<std::size_t>();
    json["bufferViews"].push_back({{"buffer", 0}, {"byteLength", 0}, {"byteOffset", size}});
    json["accessors"].push_back(
        {{"bufferView", 2}, {"componentType", "uint32"}, {"vectorSize", 4}});
    json["meshes"][0]["surfaces"].push_back({{"simplexes", 2}});
    expect_the_same(json);
    const std::string binary = text_as("a.g4b", five_cell());
    const std::string key = R"(,"chunk":1)";  // the first buffer is the first chunk behind the JSON
    std::string without = binary;
    without.replace(without.find(key), key.size(), key.size(), ' ');
    test::expect_same_surface(read_as("a.g4b", without), five_cell(), 0);
}

// The columns of a basis are where the axes go.
TEST(G4mf, PutsItsMeshesByTheColumnsOfABasis) {
    Json json = Json::parse(text_as("a.g4tf", five_cell()));
    json["nodes"][1]["basis"] = {1, 2, 3, 4, 0, 1, 5, 6, 0, 0, 1, 7, 0, 0, 0, 1};
    json["nodes"][1]["position"] = {10, 20, 30, 40};
    Positions<4> expected(4, 5);
    expected << 10, 11, 10, 10, 10,  //
        20, 22, 21, 20, 20,          //
        30, 33, 35, 31, 30,          //
        40, 44, 46, 47, 41;
    EXPECT_EQ(std::get<TetSurface>(read_as("a.g4tf", json.dump())).points, expected);
}

TEST(G4mf, IsRefusedWithWhatIsWrong) {
    Json good = Json::parse(text_as("a.g4tf", five_cell()));
    const auto error_with = [&](const Json::json_pointer& at, const Json& value) {
        Json bad = good;
        bad[at] = value;
        return error_as("a.g4tf", bad.dump());
    };
    using Pointer = Json::json_pointer;
    pent::test::expect_contains(error_with(Pointer("/asset/dimension"), 3),
                                {"a.g4tf: a model of 3 dimensions"});
    pent::test::expect_contains(error_with(Pointer("/buffers/0/uri"), "none.bin"), {"none.bin"});
    pent::test::expect_contains(error_with(Pointer("/buffers/0/byteLength"), 9999), {"buffer 0"});
    pent::test::expect_contains(error_with(Pointer("/bufferViews/1/byteLength"), 9999),
                                {"bufferView 1: reaches beyond"});
    pent::test::expect_contains(error_with(Pointer("/bufferViews/1/byteLength"), 15),
                                {"accessor 1", "no whole number"});
    pent::test::expect_contains(error_with(Pointer("/accessors/1/componentType"), "int128"),
                                {"accessor 1", "int128", "expected uint8, uint16 or uint32"});
    pent::test::expect_contains(error_with(Pointer("/accessors/0/componentType"), "int128"),
                                {"accessor 0", "int128", "expected float32 or float64"});
    pent::test::expect_contains(error_with(Pointer("/accessors/0/vectorSize"), 3),
                                {"accessor 0: elements of 3 numbers; expected 4"});
    Json scalars = good;
    scalars["accessors"][0].erase("vectorSize");
    pent::test::expect_contains(error_as("a.g4tf", scalars.dump()),
                                {"accessor 0: elements of 1 number; expected 4"});
    Json second = good;  // a second mesh has the indices of the first one and a point less
    second["bufferViews"].push_back({{"buffer", 0}, {"byteLength", 64}});
    second["accessors"].push_back(
        {{"bufferView", 2}, {"componentType", "float32"}, {"vectorSize", 4}});
    second["meshes"].push_back({{"vertices", 2}, {"surfaces", good["meshes"][0]["surfaces"]}});
    second.erase("nodes");
    pent::test::expect_contains(error_as("a.g4tf", second.dump()), {"accessor 1: index 4 of 4"});
    pent::test::expect_contains(error_with(Pointer("/bufferViews/0/byteLength"), 64),
                                {"accessor 1: index 4 of 4"});
    for (const int offset : {81, 9999}) {  // 80 is where it was
        pent::test::expect_contains(error_with(Pointer("/bufferViews/1/byteOffset"), offset),
                                    {"bufferView 1: reaches beyond"});
    }
    for (const char* key : {"/buffers/0/encoding", "/buffers/0/compression"}) {
        pent::test::expect_contains(error_with(Pointer(key), "lz4"),
                                    {"buffer 0: is compressed; expected one that is not"});
    }
    pent::test::expect_contains(
        error_with(Pointer("/buffers/0/uri"), "data:application/octet-stream;base64,!!!!"),
        {"buffer 0: ", "is no base64"});
    Json chunk = good;
    chunk["buffers"][0].erase("uri");
    pent::test::expect_contains(error_as("a.g4tf", chunk.dump()), {"buffer 0: chunk 1 of 0"});
    pent::test::expect_contains(error_with(Pointer("/nodes/1/position"), {1, 2, 3}),
                                {"node 1: position has 3 numbers; expected 4"});
    pent::test::expect_contains(error_with(Pointer("/nodes/1/basis"), {1, 2, 3}),
                                {"node 1: basis has 3 numbers; expected 16"});
    Json far = good;
    far["nodes"][1]["scale"] = {1e308};
    far["nodes"][1]["position"] = {1e308, 0, 0, 0};
    pent::test::expect_contains(error_as("a.g4tf", far.dump()), {"mesh 0: point 1 is not finite"});
    pent::test::expect_contains(error_with(Pointer("/nodes/1/children"), {0}), {"node 0"});
    pent::test::expect_contains(error_with(Pointer("/nodes/1/rotor"), {1, 0, 0, 0, 0, 0, 0}),
                                {"node 1", "rotor"});
    pent::test::expect_contains(error_with(Pointer("/meshes/0/vertices"), 7), {"is no G4MF file"});
    // Looked for before there is room for so many.
    pent::test::expect_contains(error_with(Pointer("/bufferViews/1/buffer"), 1000000000000),
                                {"is no G4MF file", "1000000000000 is out of range"});
    pent::test::expect_contains(error_as("a.g4tf", "{"), {"is no G4MF file"});
}

// A header of 16 bytes: four letters, a version or how it is compressed, and a size; of the file,
// then of each chunk.
TEST(G4mf, IsRefusedWithWhatIsWrongInItsChunks) {
    const std::string binary = text_as("a.g4b", five_cell());
    const auto error_with = [&](std::size_t at, char byte) {
        std::string bad = binary;
        bad[at] = byte;
        return error_as("a.g4b", bad);
    };
    const std::size_t blob = binary.find("BLOB");
    pent::test::expect_contains(error_with(4, 1), {"a.g4b: a damaged header"});
    pent::test::expect_contains(error_with(8, static_cast<char>(binary[8] + 16)),
                                {"a damaged header", std::to_string(binary.size()) + " bytes"});
    pent::test::expect_contains(error_as("a.g4b", binary + "more"), {"a damaged header"});
    pent::test::expect_contains(error_with(16, 'X'), {"no JSON in its first chunk"});
    pent::test::expect_contains(error_with(20, 1), {"chunk 0 is compressed"});
    pent::test::expect_contains(error_with(blob + 4, 1), {"chunk 1 is compressed"});
    pent::test::expect_contains(error_with(blob + 8, static_cast<char>(binary[blob + 8] + 1)),
                                {"chunk 1 has 161 bytes; the file ends before"});
    std::string other = binary;
    other.replace(other.find("\"chunk\":1"), 9, "\"chunk\":2");
    pent::test::expect_contains(error_as("a.g4b", other), {"buffer 0: chunk 2 of 2"});
    // One without bytes is one, also at the end of the file.
    other.replace(other.find("\"chunk\":2"), 9, "\"chunk\":3");
    other += "BLOB" + std::string(12, '\0');
    const auto longer = static_cast<std::uint64_t>(other.size());
    std::memcpy(other.data() + 8, &longer, sizeof longer);
    pent::test::expect_contains(error_as("a.g4b", other), {"buffer 0: chunk 3 of 3"});
    for (const std::string json : {"", "{}"}) {  // with 32 bytes and with 34
        std::string bare = binary.substr(0, 32) + json;
        const auto bytes = static_cast<std::uint64_t>(bare.size());
        const auto of_json = static_cast<std::uint64_t>(json.size());
        std::memcpy(bare.data() + 8, &bytes, sizeof bytes);
        std::memcpy(bare.data() + 24, &of_json, sizeof of_json);
        pent::test::expect_contains(error_as("a.g4b", bare), {"a.g4b: is no G4MF file"});
    }
    std::string none = binary.substr(0, 16);
    for (const std::size_t size : {none.size(), none.size() + 8}) {
        none.resize(size, ' ');
        const auto bytes = static_cast<std::uint64_t>(size);
        std::memcpy(none.data() + 8, &bytes, sizeof bytes);
        pent::test::expect_contains(error_as("a.g4b", none),
                                    {size < 32 ? "a damaged header" : "no JSON"});
    }
    for (std::size_t size = 4; size < binary.size(); size += 7) {
        EXPECT_NE(error_as("a.g4b", binary.substr(0, size)), "") << size;
    }
}

}  // namespace
}  // namespace pent::exchange

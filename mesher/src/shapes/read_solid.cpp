#include <pent/error.h>
#include <pent/geometry.h>
#include <pent/input_path.h>
#include <pent/mesher/boundary_solid.h>
#include <pent/mesher/image_solid.h>
#include <pent/mesher/primitives.h>
#include <pent/mesher/read_solid.h>
#include <pent/read_text.h>
#include <pent/toml_table.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <iterator>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace pent::mesher {

namespace {

constexpr const char* kKindOfFile = "a file of shapes (TOML)";
constexpr std::size_t kMaxShapes = 4096;
constexpr std::int64_t kMaxCells = 600;  // of a regular polytope

// Stands for a table where a reader is asked which keys it reads.
struct KeyRecorder {
    std::vector<std::string> keys;

    double number(std::string_view key) { return note(key, 0.0); }
    std::int64_t integer(std::string_view key,
                         std::optional<std::int64_t> /*fallback*/,
                         std::int64_t low,
                         std::int64_t /*high*/) {
        return note(key, low);
    }
    bool flag(std::string_view key, bool fallback) { return note(key, fallback); }
    std::string text(std::string_view key) { return note(key, std::string()); }
    Eigen::VectorXd vector(std::string_view key, int length) {
        return note(key, Eigen::VectorXd(Eigen::VectorXd::Zero(length)));
    }
    [[nodiscard]] static std::string file() { return ""; }

private:
    template <typename Value>
    Value note(std::string_view key, Value value) {
        keys.emplace_back(key);
        return value;
    }
};

// Reads the keys of a primitive and gives what makes it.
using Maker = std::function<Solid()>;
template <typename Table>
using Reader = std::function<Maker(Table&)>;

// A file that a shape file names: seen from its folder.
template <typename Table>
std::filesystem::path file_named_in(Table& table) {
    const std::filesystem::path here = table.file();
    return here.parent_path() / table.text("file");
}

// The primitives by their keys.
template <typename Table>
const std::vector<std::pair<std::string, Reader<Table>>>& primitives() {
    static const std::vector<std::pair<std::string, Reader<Table>>> all = {
        {"ball",
         [](Table& t) -> Maker {
             return [radius = t.number("radius")] { return ball_solid(radius); };
         }},
        {"box",
         [](Table& t) -> Maker {
             return [size = t.vector("size", 4)] { return box_solid(size); };
         }},
        {"capsule",
         [](Table& t) -> Maker {
             return [radius = t.number("radius"), length = t.number("length")] {
                 return capsule_solid(radius, length);
             };
         }},
        {"spherinder",
         [](Table& t) -> Maker {
             return [radius = t.number("radius"), length = t.number("length")] {
                 return spherinder_solid(radius, length);
             };
         }},
        {"cubinder",
         [](Table& t) -> Maker {
             return [radius = t.number("radius"), size = t.vector("size", 2)] {
                 return cubinder_solid(radius, size);
             };
         }},
        {"duocylinder",
         [](Table& t) -> Maker {
             return [radii = t.vector("radii", 2)] { return duocylinder_solid(radii); };
         }},
        {"spheritorus",
         [](Table& t) -> Maker {
             return [ring_radius = t.number("ring_radius"), tube_radius = t.number("tube_radius")] {
                 return spheritorus_solid(ring_radius, tube_radius);
             };
         }},
        {"torisphere",
         [](Table& t) -> Maker {
             return [ring_radius = t.number("ring_radius"), tube_radius = t.number("tube_radius")] {
                 return torisphere_solid(ring_radius, tube_radius);
             };
         }},
        {"tiger",
         [](Table& t) -> Maker {
             return
                 [ring_radii = t.vector("ring_radii", 2), tube_radius = t.number("tube_radius")] {
                     return tiger_solid(ring_radii, tube_radius);
                 };
         }},
        {"ditorus",
         [](Table& t) -> Maker {
             return
                 [ring_radii = t.vector("ring_radii", 2), tube_radius = t.number("tube_radius")] {
                     return ditorus_solid(ring_radii, tube_radius);
                 };
         }},
        {"clifford_torus",
         [](Table& t) -> Maker {
             return [radius = t.number("radius"), thickness = t.number("thickness")] {
                 return clifford_torus_solid(radius, thickness);
             };
         }},
        {"polytope",
         [](Table& t) -> Maker {
             return [cells = t.integer("cells", {}, 1, kMaxCells), radius = t.number("radius")] {
                 return polytope_solid(static_cast<int>(cells), radius);
             };
         }},
        {"half_space",
         [](Table& t) -> Maker {
             return [normal = t.vector("normal", 4), offset = t.number("offset")] {
                 return half_space_solid(normal, offset);
             };
         }},
        {"expression",
         [](Table& t) -> Maker {
             return [formula = t.text("formula"), low = t.vector("low", 4),
                     high = t.vector("high", 4)] {
                 return expression_solid(formula, {low, high});
             };
         }},
        {"boundary",
         [](Table& t) -> Maker {
             return [file = file_named_in(t), mend = t.flag("mend", false)] {
                 return boundary_solid(read_boundary(file), file.string(), mend).solid;
             };
         }},
        {"image",
         [](Table& t) -> Maker {
             return [file = file_named_in(t), level = t.number("level")] {
                 return image_solid(std::make_shared<const Image>(read_image(file)), level);
             };
         }},
    };
    return all;
}

// Those of a shape beside its kind, and of a turn.
constexpr std::string_view kShapeKeys[] = {"op", "smooth", "scale", "rotate", "translate"};
constexpr std::string_view kTurnKeys[] = {"plane", "degrees"};

// "\"radius\" belongs to \"ball\" or \"capsule\" of [[shape]]" for a key that shape files have
// elsewhere; else "".
std::string owners_text(const std::string& key) {
    const auto is_key = [&](const auto& one) { return one == key; };
    bool is_of_shape = std::any_of(std::begin(kShapeKeys), std::end(kShapeKeys), is_key);
    std::string owners;
    const auto add = [&](const std::string& owner) {
        owners += (owners.empty() ? "\"" : " or \"") + owner + "\"";
    };
    for (const auto& [kind, read] : primitives<KeyRecorder>()) {
        KeyRecorder recorder;
        static_cast<void>(read(recorder));
        is_of_shape = is_of_shape || kind == key;
        if (std::any_of(recorder.keys.begin(), recorder.keys.end(), is_key)) {
            add(kind);
        }
    }
    if (std::any_of(std::begin(kTurnKeys), std::end(kTurnKeys), is_key)) {
        add("rotate");
    }
    if (is_of_shape) {
        return "\"" + key + "\" belongs to [[shape]]";
    }
    return owners.empty() ? "" : "\"" + key + "\" belongs to " + owners + " of [[shape]]";
}

Eigen::Matrix4d rotation_of(std::vector<TableReader> turns) {
    Eigen::Matrix4d rotation = Eigen::Matrix4d::Identity();
    for (TableReader& turn : turns) {
        const std::string plane = turn.text("plane");
        const auto axis_of = [](char letter) {
            return static_cast<int>(std::string_view("xyzw").find(letter));
        };
        const bool is_plane = plane.size() == 2
                              && plane.find_first_not_of("xyzw") == std::string::npos
                              && plane[0] != plane[1];
        if (!is_plane) {
            turn.fail("plane",
                      "\"plane\" is \"" + plane + "\"; expected two of x y z w, as in \"xw\"");
        }
        const double angle = turn.number("degrees") * std::numbers::pi / 180;
        rotation = plane_rotation<4>(axis_of(plane[0]), axis_of(plane[1]), angle) * rotation;
        turn.finish(owners_text);
    }
    return rotation;
}

Solid combined_shapes(TableReader& table, std::size_t& count);

// The primitive or group of a shape, as it is before it is placed.
Solid shape_alone(TableReader& table, std::size_t& count) {
    std::vector<std::string> kinds = {"shape"};
    for (const auto& [kind, reader] : primitives<TableReader>()) {
        kinds.push_back(kind);
    }
    const std::string kind = table.one_of(kinds);
    if (kind == "shape") {
        return combined_shapes(table, count);
    }
    const auto& known = primitives<TableReader>();
    const auto found = std::find_if(known.begin(), known.end(),
                                    [&](const auto& entry) { return entry.first == kind; });
    TableReader values = table.table(kind);
    const Maker make = found->second(values);
    values.finish(owners_text);
    try {
        return make();
    } catch (const Error& error) {
        values.fail("", kind + ": " + error.what());
    }
}

Solid placed_shape(TableReader& table, std::size_t& count) {
    const double scale = table.number("scale", 1);
    if (!(scale > 0)) {
        table.fail("scale", "\"scale\" is not above 0; expected a factor");
    }
    const Eigen::Matrix4d rotation = rotation_of(table.tables("rotate"));
    const Eigen::Vector4d translation = table.has("translate")
                                            ? Eigen::Vector4d(table.vector("translate", 4))
                                            : Eigen::Vector4d::Zero();
    return place(shape_alone(table, count), scale, rotation, translation);
}

Solid combined_shapes(TableReader& table, std::size_t& count) {
    std::vector<TableReader> shapes = table.tables("shape");
    if (shapes.empty()) {
        table.fail("",
                   "no shape; expected [[shape]] with one of its kinds, as ball = { radius = 1 }");
    }
    count += shapes.size();
    if (count > kMaxShapes) {
        table.fail("shape", "more than " + std::to_string(kMaxShapes) + " shapes");
    }
    std::optional<Solid> all;
    for (TableReader& shape : shapes) {
        if (!all && (shape.has("op") || shape.has("smooth"))) {
            shape.fail(
                shape.has("op") ? "op" : "smooth",
                "the first shape has nothing before it to be combined with; expected neither "
                "\"op\" nor \"smooth\"");
        }
        const std::size_t op = shape.choice("op", {"union", "intersection", "difference"}, 0);
        const double smooth = shape.number("smooth", 0);
        if (smooth < 0) {
            shape.fail("smooth", "\"smooth\" is below 0; expected a length (m)");
        }
        const Solid next = placed_shape(shape, count);
        shape.finish(owners_text);
        all = !all      ? next
              : op == 0 ? unite(*all, next, smooth)
              : op == 1 ? intersect(*all, next, smooth)
                        : subtract(*all, next, smooth);
    }
    return *all;
}

// What stands in "file" anywhere within a node.
void add_files(const toml::node& node,
               const std::filesystem::path& folder,
               std::vector<std::filesystem::path>& files) {
    if (const toml::table* table = node.as_table()) {
        for (const auto& [key, value] : *table) {
            if (const auto file = value.value<std::string>(); file && key == "file") {
                files.push_back(folder / *file);
            }
            add_files(value, folder, files);
        }
    } else if (const toml::array* array = node.as_array()) {
        for (const toml::node& element : *array) {
            add_files(element, folder, files);
        }
    }
}

}  // namespace

bool is_shape_file(const std::filesystem::path& path) {
    return format_of(path, "") == ".toml";
}

Solid parse_solid(std::string_view text, const std::string& name) {
    const toml::table parsed = parse_toml(text, name);
    TableReader table(parsed, "the file", name);
    std::size_t count = 0;
    (void)table.has("shape");
    table.finish(owners_text);
    return combined_shapes(table, count);
}

Solid read_solid(const std::filesystem::path& path) {
    return parse_solid(read_text(path, kKindOfFile), path.string());
}

std::vector<std::filesystem::path> files_of_shapes(const std::filesystem::path& path) {
    std::vector<std::filesystem::path> files;
    add_files(parse_toml(read_text(path, kKindOfFile), path.string()), path.parent_path(), files);
    return files;
}

}  // namespace pent::mesher

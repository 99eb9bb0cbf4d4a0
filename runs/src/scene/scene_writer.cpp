#include "simulator_names.h"

#include <pent/real_text.h>
#include <pent/runs/scene_file.h>
#include <pent/simulator/scene_schema.h>
#include <pent/simulator/words.h>

#include <cassert>
#include <cmath>
#include <concepts>
#include <optional>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

namespace pent::runs {

namespace {

// Shortest text that reads back as the same double; TOML wants a digit on both sides of the point.
std::string number(double value) {
    assert(std::isfinite(value));
    char digits[32];
    const auto [end, error] = real_to_chars(digits, digits + sizeof digits, value);
    std::string text(digits, end);
    if (text.find_first_of(".e") == std::string::npos) {
        text += ".0";
    }
    return text;
}

std::string vector(const Eigen::VectorXd& values) {
    std::string text = "[";
    for (Eigen::Index i = 0; i < values.size(); ++i) {
        text += (i > 0 ? ", " : "") + number(values[i]);
    }
    return text + "]";
}

std::string in_quotes(std::string_view value) {
    constexpr std::string_view kHex = "0123456789abcdef";
    std::string text = "\"";
    for (const char c : value) {
        const auto code = static_cast<unsigned char>(c);
        if (c == '"' || c == '\\') {
            text += '\\';
            text += c;
        } else if (code < 0x20 || code == 0x7f) {
            text += "\\u00";
            text += kHex[code / 16];
            text += kHex[code % 16];
        } else {
            text += c;
        }
    }
    return text + "\"";
}

template <typename List, typename Write>
std::string list(const List& entries, const Write& write) {
    std::string text = "[";
    for (const auto& entry : entries) {
        text += (text.size() > 1 ? ", " : "") + write(entry);
    }
    return text + "]";
}

template <typename Part>
std::string record(const Part& part);

// Texts of values, but for those that are lists or tables.
std::string value_text(double value) {
    return number(value);
}
std::string value_text(bool value) {
    return value ? "true" : "false";
}
std::string value_text(const std::string& value) {
    return in_quotes(value);
}
std::string value_text(const Eigen::VectorXd& value) {
    return vector(value);
}
std::string value_text(const std::optional<Eigen::VectorXd>& value) {
    return vector(*value);
}
std::string value_text(const Plane& plane) {
    return in_quotes(plane_name(plane));
}

template <std::integral Value>
std::string value_text(Value value) {
    return std::to_string(value);
}
template <typename Value>
requires std::is_enum_v<Value> std::string value_text(Value value) {
    return in_quotes(simulator::word_of(value));
}
template <typename Part>
requires std::is_class_v<Part> std::string value_text(const Part& part) {
    return record(part);
}
template <typename Part>
std::string value_text(const std::vector<Part>& parts) {
    return list(parts, [](const Part& part) { return value_text(part); });
}

std::string value_text(const Selection& selection) {
    return std::visit(
        [&](const auto& kind) {
            const std::string table = record(kind);
            const bool is_inline = std::holds_alternative<RegionSelection>(selection);
            const std::string_view name = simulator::kSelectionNames[selection.index()];
            return is_inline ? table : "{ " + std::string(name) + " = " + table + " }";
        },
        selection);
}

std::string value_text(const std::vector<Selection>& select) {
    for (const Selection& selection : select) {
        if (std::holds_alternative<EverythingSelection>(selection)) {
            return in_quotes(
                simulator::kSelectionNames[selection.index()]);  // whatever else there is
        }
    }
    return list(select, [](const Selection& selection) { return value_text(selection); });
}

std::string value_text(const std::vector<Motion>& motion) {
    return motion.empty() ? in_quotes(simulator::kFixed)
                          : list(motion, [](const Motion& one) { return record(one); });
}

bool is_absent(double value) {
    return !std::isfinite(value);
}
bool is_absent(const std::string& value) {
    return value.empty();
}
bool is_absent(const Eigen::VectorXd& value) {
    return value.size() == 0;
}
bool is_absent(const std::optional<Eigen::VectorXd>& value) {
    return !value;
}
template <typename Value>
bool is_absent(const Value& /*value*/) {
    return false;
}

// A visitor of the schema: appends key and value, of a block a line each, else with commas between.
struct PartWriter {
    using Field = simulator::Field;

    std::string& text;
    int dimension = 0;  // of a block; 0 within a line

    template <typename Value>
    void operator()(const Field& field, const Value& value) const {
        if (field.does_apply && !(field.may_lack && is_absent(value))) {
            put(field.key, value_text(value));
        }
    }
    void operator()(const Field& /*field*/, const simulator::Lame& lame) const {
        put(simulator::kMu.key, number(lame.mu));
        put(simulator::kLambda.key, number(lame.lambda));
    }
    void operator()(const Field& field, const Material& material) const {
        if (dimension > 0) {  // a comment needs a line of its own
            const YoungPoisson young = young_from_lame(dimension, material.lame);
            text +=
                "# young = " + number(young.young) + ", poisson = " + number(young.poisson) + "\n";
        }
        put(field.key, record(material));
    }
    void operator()(const Field& /*field*/, const ObstacleShape& shape) const {
        std::visit([&](const auto& one) { put(one.kName, record(one)); }, shape);
    }

private:
    void put(std::string_view key, const std::string& value) const {
        text += (dimension == 0 && !text.empty() ? ", " : "") + std::string(key) + " = " + value
                + (dimension == 0 ? "" : "\n");
    }
};

template <typename Part>
std::string record(const Part& part) {
    std::string text;
    simulator::fields(part, PartWriter{text});
    return "{ " + text + " }";
}

template <typename Part>
std::string block(const std::string& head, const Part& part, int dimension) {
    std::string text = head + "\n";
    simulator::fields(part, PartWriter{text, dimension});
    return text;
}

struct BlockWriter {
    std::string& text;
    int dimension;

    template <typename Part>
    void operator()(const std::string& name, const std::vector<Part>& parts) const {
        for (const Part& part : parts) {
            text += "\n" + block("[[" + name + "]]", part, dimension);
        }
    }
    template <typename Part>
    void operator()(const std::string& name, const std::optional<Part>& part) const {
        if (part) {
            (*this)(name, *part);
        }
    }
    template <typename Part>
    void operator()(const std::string& name, const Part& part) const {
        text += "\n" + block("[" + name + "]", part, dimension);
    }
};

}  // namespace

std::string scene_text(const Scene& scene) {
    std::string text = block("[scene]", scene, scene.dimension);
    blocks(scene, BlockWriter{text, scene.dimension});
    return text;
}

}  // namespace pent::runs

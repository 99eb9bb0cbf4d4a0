#include "scene/part_reader.h"

#include <pent/error.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <variant>

namespace pent::runs {

namespace {

// A vector that is not zero, made unit length.
Eigen::VectorXd read_direction(TableReader& table, std::string_view key, int dimension) {
    const Eigen::VectorXd direction = table.vector(key, dimension, {});
    if (!(direction.norm() > 0)) {
        table.fail(key, "\"" + std::string(key) + "\" is zero; expected a direction");
    }
    // One that is a unit vector to rounding stays as it is, so that a scene written out and read
    // again is the same to the last bit.
    return std::abs(direction.norm() - 1) < 1e-14 ? direction : direction.normalized();
}

// Puts the kind of this number into the selection, and reads it.
template <std::size_t... Kind>
void read_kind(std::index_sequence<Kind...> /*kinds*/,
               std::size_t chosen,
               TableReader& table,
               const PartReader& reader,
               Selection& selection) {
    const auto read = [&](auto& part) { read_part(table, part, reader.dimension); };
    (void)((Kind == chosen && (read(selection.emplace<Kind>()), true)) || ...);
}

constexpr std::size_t kKinds = std::variant_size_v<Selection>;
constexpr auto kEverything = std::prev(std::end(simulator::kSelectionNames));

Selection read_selection(TableReader& table, const PartReader& reader) {
    const std::vector<std::string> names(std::begin(simulator::kSelectionNames), kEverything);
    const std::string kind = table.one_of(names);
    table.finish([&](const std::string& /*key*/) { return "expected \"" + kind + "\" alone"; });
    const auto chosen =
        static_cast<std::size_t>(std::find(names.begin(), names.end(), kind) - names.begin());
    Selection selection;
    const bool is_inline = kind == "region";
    TableReader inner = is_inline ? table : table.table(kind);
    read_kind(std::make_index_sequence<kKinds>(), chosen, inner, reader, selection);
    return selection;
}

}  // namespace

void PartReader::operator()(const Field& field, Eigen::VectorXd& value) const {
    if (field.is_direction && table.has(field.key)) {
        value = read_direction(table, field.key, dimension);
        return;
    }
    std::optional<Eigen::VectorXd> fallback;
    if (!field.is_required) {
        fallback = value.size() == dimension ? value : Eigen::VectorXd::Zero(dimension);
    }
    value = table.vector(field.key, dimension, fallback);
    const auto bad = std::find_if(value.begin(), value.end(),
                                  [&](double entry) { return !is_between(field.range, entry); });
    if (bad != value.end()) {
        table.fail(field.key, "\"" + std::string(field.key) + "\" has the entry " + readable(*bad)
                                  + "; expected " + text_of(field.range));
    }
}

void PartReader::operator()(const Field& field, std::optional<Eigen::VectorXd>& value) const {
    if (table.has(field.key)) {
        value = table.vector(field.key, dimension, {});
    }
}

void PartReader::operator()(const Field& field, Plane& plane) const {
    const std::string axes = std::string("xyzw").substr(0, static_cast<std::size_t>(dimension));
    const std::string name = table.text(field.key);
    const auto from = name.size() == 2 ? axes.find(name[0]) : std::string::npos;
    const auto to = name.size() == 2 ? axes.find(name[1]) : std::string::npos;
    if (from == std::string::npos || to == std::string::npos || from == to) {
        table.fail(field.key, "\"" + std::string(field.key) + "\" is \"" + name
                                  + "\"; expected two different axes of " + axes + ", as in \""
                                  + (dimension == 4 ? "xw" : "xz")
                                  + "\", which takes the first towards the second");
    }
    plane = {static_cast<int>(from), static_cast<int>(to)};
}

// One pair of numbers or the other.
void PartReader::operator()(const Field& /*field*/, simulator::Lame& lame) const {
    using namespace simulator;
    if (table.has(kMu.key) || table.has(kLambda.key)) {
        constexpr std::string_view kReason =
            "does not go together with mu and lambda; give one pair or the other";
        table.refuse(kYoung.key, kReason);
        table.refuse(kPoisson.key, kReason);
        Range above = kLambda.range;
        lame.mu = table.number(kMu.key, {}, kMu.range);
        above.low = -2 * lame.mu / dimension;
        lame.lambda = table.number(kLambda.key, {}, above);
        return;
    }
    const double young = table.number(kYoung.key, kYoung.fallback, kYoung.range);
    const double poisson = table.number(kPoisson.key, kPoisson.fallback, kPoisson.range);
    try {
        lame = lame_from_young(dimension, young, poisson);
    } catch (const Error& error) {
        table.fail(kPoisson.key, error.what());
    }
}

void PartReader::operator()(const Field& field, std::vector<Selection>& select) const {
    if (table.is_text(field.key)) {
        static_cast<void>(table.choice(field.key, {*kEverything}, 0));
        select.emplace_back(EverythingSelection{});
        return;
    }
    for (TableReader& entry : table.tables(field.key)) {
        select.push_back(read_selection(entry, *this));
    }
}

void PartReader::operator()(const Field& field, std::vector<Motion>& motion) const {
    if (table.is_text(field.key)) {
        static_cast<void>(table.choice(field.key, {simulator::kFixed}, 0));
        return;
    }
    for (TableReader& entry : table.tables(field.key)) {
        read_part(entry, motion.emplace_back(), dimension);
    }
}

// Its key is the name of the shape.
void PartReader::read_shape(ObstacleShape& shape) const {
    const std::vector<ObstacleShape> shapes = all_shapes(dimension);
    std::vector<std::string> names;
    for (const ObstacleShape& one : shapes) {
        names.emplace_back(name_of<Eigen::Dynamic>(one));
    }
    const std::string kind = table.one_of(names);
    shape = shapes[static_cast<std::size_t>(std::find(names.begin(), names.end(), kind)
                                            - names.begin())];
    TableReader inner = table.table(kind);
    std::visit([&](auto& one) { read_part(inner, one, dimension); }, shape);
}

}  // namespace pent::runs

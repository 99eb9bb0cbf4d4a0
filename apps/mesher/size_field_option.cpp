// SPDX-License-Identifier: GPL-3.0-or-later

#include "common/values.h"
#include "mesh_options.h"

#include <pent/error.h>

#include <charconv>
#include <cmath>
#include <string>
#include <string_view>
#include <system_error>

namespace pent::apps {

namespace {

[[noreturn]] void refuse(const std::string& text) {
    throw Error(
        "--size-field: found \"" + text
        + "\"; expected a hyperplane, as in w=0 or 1,0,0,1=0.5, or a point, as in 0,0,0.5,0");
}

double number_in(std::string_view word, const std::string& whole) {
    double number = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(number)) {
        refuse(whole);
    }
    return number;
}

Eigen::Vector4d four_in(std::string_view words, const std::string& whole) {
    Eigen::Vector4d numbers;
    for (int axis = 0; axis < 4; ++axis) {
        const std::size_t comma = words.find(',');
        if ((comma == std::string_view::npos) != (axis == 3)) {
            refuse(whole);
        }
        numbers[axis] = number_in(words.substr(0, comma), whole);
        words.remove_prefix(axis == 3 ? 0 : comma + 1);
    }
    return numbers;
}

// The normal of a hyperplane: the name of an axis, or four numbers.
Eigen::Vector4d normal_in(std::string_view words, const std::string& whole) {
    constexpr std::string_view kAxes = "xyzw";
    if (words.size() == 1 && kAxes.find(words[0]) != std::string_view::npos) {
        return Eigen::Vector4d::Unit(static_cast<Eigen::Index>(kAxes.find(words[0])));
    }
    const Eigen::Vector4d normal = four_in(words, whole);
    if (normal.isZero(0)) {
        refuse(whole);
    }
    return normal;
}

}  // namespace

void add_size_field_options(CLI::App& cli, MeshArguments& arguments, CLI::Option* edge) {
    const auto group = "Resolution";
    CLI::Option* field =
        cli.add_option("--size-field", arguments.size_field,
                       "Of a shape: edges of that length at this hyperplane (w=0, or a,b,c,d=e) or "
                       "point (x,y,z,w), longer ones away from it (m)")
            ->type_name("PLACE")
            ->needs(edge)
            ->group(group);
    cli.add_option("--size-growth", arguments.request.sizes.growth,
                   "How much longer edges may be for each meter of distance (m)")
        ->check(nonnegative_number())
        ->capture_default_str()
        ->needs(field)
        ->group(group);
    cli.add_option("--longest-edge", arguments.request.sizes.longest,
                   "The longest that edges may become (m); default: half of the thinnest part")
        ->check(positive_number())
        ->needs(field)
        ->group(group);
}

void complete_size_field(MeshArguments& arguments) {
    const std::string& text = arguments.size_field;
    const std::size_t equals = text.find('=');
    mesher::SizeField& sizes = arguments.request.sizes;
    if (text.empty()) {
        return;
    }
    if (equals == std::string::npos) {
        sizes.point = four_in(text, text);
    } else {
        const std::string_view words = text;
        sizes.plane = Hyperplane<4>{normal_in(words.substr(0, equals), text),
                                    number_in(words.substr(equals + 1), text)};
    }
}

}  // namespace pent::apps

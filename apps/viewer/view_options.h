#pragma once

#include <pent/viewer/coloring.h>
#include <pent/viewer/section.h>

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace pent::apps {

/// What pent-slice and pent-render have in common on their command lines, as written there.
struct ViewArguments {
    std::string input;
    std::vector<std::string> w;
    std::string normal;
    std::vector<std::string> offsets;
    std::vector<std::string> rotations;
    std::string frames;
    viewer::ColorBy color = viewer::ColorBy::Body;
};

void add_view_options(CLI::App& cli, ViewArguments& arguments);

/// The hyperplanes meant. Throws an Error that says what was found and what was expected.
[[nodiscard]] viewer::SectionOptions to_sections(const ViewArguments& arguments);

/// Numbers with commas between. Throws an Error that begins with `what`.
[[nodiscard]] std::vector<double> to_numbers(const std::string& text, const std::string& what);

}  // namespace pent::apps

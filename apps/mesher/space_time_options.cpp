// SPDX-License-Identifier: GPL-3.0-or-later

#include "common/values.h"
#include "mesh_options.h"

#include <pent/error.h>

#include <charconv>
#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

namespace pent::apps {

namespace {

// What has no meaning for a moving mesh, and would be left unheeded without a word.
void refuse_other_options(const CLI::App& cli) {
    for (const char* name : {"--repair",
                             "--wrap-distance",
                             "--surface-triangles",
                             "--edge-length",
                             "--size-field",
                             "--target-pentachora",
                             "--generator",
                             "--radius-edge-ratio",
                             "--subdivide-surface",
                             "--subdivide",
                             "--quadratic",
                             "--curved",
                             "--thickness",
                             "--extrude",
                             "--layers",
                             "--grade",
                             "--layer-heights",
                             "--round",
                             "--profile",
                             "--one-sided",
                             "--edge-directions",
                             "--unextruded",
                             "--format",
                             "--level",
                             "--labels",
                             "--spacing",
                             "--sphere",
                             "--ball",
                             "--box"}) {
        if (cli.count(name) > 0) {
            throw Error(std::string(name)
                        + ": without meaning for a moving mesh; leave it out, or --space-time");
        }
    }
    if (cli["--dim"]->count() > 0 && cli["--dim"]->as<int>() != 4) {
        throw Error("--dim 3: a space-time mesh has four dimensions; leave it out");
    }
}

// Runs have times and regions, and other series are one body.
void refuse_options_of_the_other(const CLI::App& cli, const std::filesystem::path& input) {
    std::error_code ignored;
    if (!std::filesystem::exists(input, ignored)) {
        return;  // whoever reads it says so
    }
    const bool is_run = std::filesystem::is_directory(input, ignored);
    const std::vector<const char*> unheeded =
        is_run ? std::vector{"--time-step", "--region-array"} : std::vector{"--body"};
    for (const char* name : unheeded) {
        if (cli.count(name) > 0) {
            throw Error(std::string(name) + ": without meaning for " + input.string() + ", "
                        + (is_run ? "a run" : "which is one body") + "; leave it out");
        }
    }
}

int layers_of_a_step(const std::string& text) {
    int count = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), count);
    if (text == "auto") {
        return 0;
    }
    if (error != std::errc() || end != text.data() + text.size() || count < 1 || count > 65536) {
        throw Error("--refine-time: found \"" + text
                    + "\"; expected auto or a whole number from 1 to 65536");
    }
    return count;
}

}  // namespace

void add_space_time_options(CLI::App& cli, MeshArguments& arguments) {
    SpaceTimeArguments& moving = arguments.space_time;
    const auto group = "Space-time";
    CLI::Option* space_time =
        cli.add_flag(
               "--space-time", moving.is_asked_for,
               "The input is a moving mesh (.pvd, .series, numbered .vtu or .vtk files, a run "
               "folder of three dimensions): what it sweeps")
            ->group(group);
    const auto goes_with = [&](CLI::Option* option) {
        return option->needs(space_time)->group(group);
    };
    goes_with(cli.add_option(
                     "--time-scale", moving.options.time_scale,
                     "How many meters along w a second is: the time t is at w = this times t (m/s)")
                  ->check(positive_number())
                  ->capture_default_str());
    goes_with(cli.add_option("--refine-time", moving.refine_time,
                             "Layers for each step from frame to frame: a number, or auto for as "
                             "many as it takes")
                  ->type_name("N|auto")
                  ->capture_default_str());
    goes_with(cli.add_option("--every", moving.series.every, "Only every K-th frame")
                  ->check(whole_number(1, 1'000'000))
                  ->type_name("K"));
    goes_with(cli.add_option("--time-step", moving.time_step,
                             "Time from one numbered file to the next (s)")
                  ->check(positive_number()));
    goes_with(
        cli.add_option("--body", moving.series.body, "Which body, of a run folder that has several")
            ->type_name("NAME"));
    goes_with(cli.add_flag("--slabs", moving.has_slabs,
                           "A file for each step from frame to frame: NAME_000000.pent and so on"));
    goes_with(cli.add_flag("--bisection", moving.options.is_bisection_ready,
                           "Cells with tags in an order in which bisection keeps them conforming"));
}

void complete_space_time(const CLI::App& cli, MeshArguments& arguments) {
    SpaceTimeArguments& moving = arguments.space_time;
    if (!moving.is_asked_for) {
        return;
    }
    refuse_other_options(cli);
    refuse_options_of_the_other(cli, arguments.input);
    moving.series.scale = arguments.request.scale;
    moving.series.region_array = arguments.request.region_array;
    if (cli.count("--time-step") > 0) {
        moving.series.time_step = moving.time_step;
    }
    moving.options.refine_time = layers_of_a_step(moving.refine_time);
    moving.options.order = arguments.request.extrusion.order;
    moving.options.alternate = !arguments.lean;
}

}  // namespace pent::apps

#pragma once

#include <pent/mesher/make_body.h>
#include <pent/mesher/space_time.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

namespace pent::apps {

/// What the command line says of moving meshes.
struct SpaceTimeArguments {
    bool is_asked_for = false;
    bool has_slabs = false;  ///< A file for each step from frame to frame.
    std::string refine_time = "1";
    double time_step = 0;  ///< s.
    mesher::SeriesOptions series;
    mesher::SpaceTimeOptions options;
};

/// What the command line of pent-mesh says; what is not a field of the request yet becomes one in
/// complete().
struct MeshArguments {
    mesher::BodyRequest request;
    SpaceTimeArguments space_time;
    std::filesystem::path output;
    int dim = 4;
    bool ascii = false;
    bool show_quality = false;
    std::filesystem::path histogram;  ///< An SVG file; empty for none.
    double time_limit = 900;          ///< s, for all.
    double step_limit = 300;          ///< s, for each step that may run away.
    double memory_limit = 0;          ///< MiB; 0: the machine's.

    bool yes = false;  ///< Not to be asked about large bodies.

    std::filesystem::path input;
    std::string size_field;  ///< A hyperplane or a point.
    double level = 0;
    std::vector<double> spacing;  ///< m.
    double unit = 1;              ///< m.
    double scale = 1;
    std::vector<double> translation;  ///< m.
    int sphere = 0;
    int ball = 0;
    std::vector<int> box;
    std::vector<double> size = {1};
    mesher::CubeCut cut = mesher::CubeCut::Paths;
    std::vector<double> direction;
    double thickness = 0;
    bool one_sided = false;
    bool lean = false;
    bool subdivide_surface = false;
};

/// Adds every option of pent-mesh but the common ones.
void add_options(CLI::App& cli, MeshArguments& arguments);

/// Adds those of sizes that differ from place to place, which add_options() calls.
/// @param edge  The option for the shortest edges.
void add_size_field_options(CLI::App& cli, MeshArguments& arguments, CLI::Option* edge);

/// Fills the request's size field, which complete() calls. Throws an Error for what is neither a
/// hyperplane nor a point.
void complete_size_field(MeshArguments& arguments);

/// Adds those of moving meshes, which add_options() calls.
void add_space_time_options(CLI::App& cli, MeshArguments& arguments);

/// Fills what make_space_time() needs, after the request. Throws an Error for options that have no
/// meaning for a moving mesh.
void complete_space_time(const CLI::App& cli, MeshArguments& arguments);

/// Fills the request from the other fields, after parsing. Throws an Error if the output is no
/// .pent file.
void complete(const CLI::App& cli, MeshArguments& arguments);

}  // namespace pent::apps

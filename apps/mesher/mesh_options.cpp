// SPDX-License-Identifier: GPL-3.0-or-later

#include "mesh_options.h"

#include "common/values.h"

#include <pent/counted.h>
#include <pent/error.h>
#include <pent/input_path.h>

#include <algorithm>
#include <cmath>
#include <system_error>
#include <utility>

namespace pent::apps {

namespace {

using mesher::CubeCut;
using mesher::Generator;
using mesher::Repair;
using mesher::VertexOrder;

constexpr std::int64_t kMostCells = std::int64_t{1} << 31;

// Makes an option take one word of a few; the first one is what it is by default.
template <typename Value>
CLI::Option* choose(CLI::Option* option,
                    const std::vector<std::pair<std::string, Value>>& choices) {
    std::vector<std::string> words;
    std::string text;
    for (const auto& [word, value] : choices) {
        words.push_back(word);
        text += (text.empty() ? "" : "|") + word;
    }
    return option->transform(CLI::Transformer(choices))
        ->transform(one_of(words))  // before the one above
        ->option_text(text + " [" + choices.front().first + "]");
}

std::vector<CLI::Option*> add_shapes(CLI::Option_group& input, MeshArguments& arguments) {
    CLI::Option* sphere =
        input.add_option("--sphere", arguments.sphere, "A sphere: a surface of 20 N^2 triangles")
            ->check(whole_number(1, 1000))
            ->type_name("N");
    CLI::Option* ball =
        input.add_option("--ball", arguments.ball, "A ball: 20 N^2 tetrahedra around its center")
            ->check(whole_number(1, 1000))
            ->type_name("N");
    CLI::Option* box =
        input
            .add_option(
                "--box", arguments.box,
                "A box of so many tesseracts along x,y,z,w, or cubes along x,y,z; it is not "
                "extruded")
            ->delimiter(',')
            ->expected(3, 4)
            ->type_name("X,Y,Z[,W]");
    return {sphere, ball, box};
}

// How a file is to be read, and where the body goes.
void add_placement(CLI::App& cli,
                   MeshArguments& arguments,
                   const std::vector<CLI::Option*>& shapes) {
    const auto group = "Input";
    CLI::Option* format =
        cli.add_option("--format", arguments.request.format,
                       "Read the input as this, whatever its name; needed for standard input")
            ->transform(one_of({"obj", "off", "ply", "stl", "mesh", "msh", "vtk", "vtu", "tobj"}))
            ->option_text("obj|off|ply|stl|mesh|msh|vtk|vtu|tobj")
            ->group(group);
    CLI::Option* unit =
        choose<double>(cli.add_option("--unit", arguments.unit, "Unit of the file's coordinates"),
                       {{"m", 1}, {"cm", 0.01}, {"mm", 0.001}})
            ->group(group);
    CLI::Option* scale =
        cli.add_option("--scale", arguments.scale, "Multiply the file's coordinates by this")
            ->check(positive_number())
            ->group(group);
    CLI::Option* regions =
        cli.add_option("--region-array", arguments.request.region_array,
                       "Of VTK: the array of the cells with their labels; default: region, "
                       "material, attribute or another of docs/mesher.md, in any letters")
            ->type_name("NAME")
            ->group(group);
    for (CLI::Option* shape : shapes) {
        format->excludes(shape);
        regions->excludes(shape);
        unit->excludes(shape);
        scale->excludes(shape);
    }
    cli.add_option("--translate", arguments.translation, "Move the body by x,y,z or x,y,z,w (m)")
        ->delimiter(',')
        ->expected(3, 4)
        ->type_name("X,Y,Z[,W]")
        ->group(group);
}

void add_input(CLI::App& cli, MeshArguments& arguments) {
    CLI::Option_group* input = cli.add_option_group("Input", "One of these");
    input
        ->add_option(
            "input", arguments.input,
            "A surface (.obj .off .ply .stl .gltf .glb), tetrahedra (.node/.ele .mesh "
            ".msh .vtk .vtu .tobj), a four-dimensional shape (.toml) or its boundary (.4off .off "
            ".g4tf .g4b .4do .obj .pent); - for standard input")
        ->type_name("FILE");
    const std::vector<CLI::Option*> shapes = add_shapes(*input, arguments);
    input->require_option(1);
    CLI::Option* file = input->get_option("input");
    add_placement(cli, arguments, shapes);
    cli.add_option("--size", arguments.size,
                   "Radius of a sphere or ball, edge or edges x,y,z,w of a box (m)")
        ->delimiter(',')
        ->expected(1, 4)
        ->check(positive_number())
        ->excludes(file)
        ->default_str("1");
    choose<CubeCut>(cli.add_option("--cut", arguments.cut,
                                   "Tesseracts into 24 pentachora (paths) or into 16 (corners)"),
                    {{"paths", CubeCut::Paths}, {"corners", CubeCut::Corners}})
        ->needs(shapes.back());
}

void add_image(CLI::App& cli, MeshArguments& arguments) {
    const auto group = "Image";
    CLI::Option* level = cli.add_option("--level", arguments.level,
                                        "The body is where the image is above this value")
                             ->group(group);
    cli.add_flag("--labels", arguments.request.image.is_labels,
                 "The image has whole numbers: 0 outside, others name regions of the body")
        ->excludes(level)
        ->group(group);
    cli.add_option("--spacing", arguments.spacing,
                   "Distance between samples along x,y,z,w (m); default: as in the file")
        ->delimiter(',')
        ->expected(4)
        ->check(positive_number())
        ->type_name("X,Y,Z,W")
        ->group(group);
}

void add_surface(CLI::App& cli, mesher::BodyRequest& request) {
    choose<Repair>(
        cli.add_option(
            "--repair", request.repair.repair,
            "How far a surface that is not clean may be mended: auto, light (stitch, fill "
            "holes, cut out self-intersections), wrap (a new surface around it) or none"),
        {{"auto", Repair::Auto},
         {"light", Repair::Light},
         {"wrap", Repair::Wrap},
         {"none", Repair::None}})
        ->group("Surface");
    cli.add_option("--wrap-distance", request.repair.wrap_distance,
                   "Largest distance of a wrap from the surface, over its diagonal")
        ->check(number(1e-4, 1.0))
        ->capture_default_str()
        ->group("Surface");
}

void add_resolution(CLI::App& cli, MeshArguments& arguments) {
    mesher::BodyRequest& request = arguments.request;
    const auto group = "Resolution";
    CLI::Option* triangles = cli.add_option("--surface-triangles", request.surface_triangles,
                                            "Refine or coarsen the surface to this many triangles")
                                 ->check(whole_number(4, kMostCells))
                                 ->group(group);
    CLI::Option* edge = cli.add_option("--edge-length", request.edge_length,
                                       "Aim at edges of this length (m), on the surface and inside")
                            ->check(positive_number())
                            ->excludes(triangles)
                            ->group(group);
    add_size_field_options(cli, arguments, edge);
    cli.add_option("--target-pentachora", request.target_cells,
                   "Aim at this many pentachora, within 2%")
        ->check(whole_number(100, kMostCells))
        ->excludes(edge)
        ->group(group);
    choose<Generator>(
        cli.add_option("--generator", request.tetrahedra.generator,
                       "What fills the surface: auto (TetGen, else Mesh_3), tetgen or mesh3"),
        {{"auto", Generator::Auto}, {"tetgen", Generator::TetGen}, {"mesh3", Generator::Mesh3}})
        ->group(group);
    cli.add_option("--radius-edge-ratio", request.tetrahedra.radius_edge_ratio,
                   "TetGen: bound for circumradius over shortest edge; lower gives more cells")
        ->check(number(1.05, 10.0))
        ->capture_default_str()
        ->group(group);
    cli.add_flag("--subdivide-surface", arguments.subdivide_surface,
                 "TetGen: cut the surface's triangles where that makes better cells")
        ->group(group);
    cli.add_option("--subdivide", request.subdivide,
                   "Cut every edge of the body in K parts: K^4 times the pentachora")
        ->check(whole_number(1, 64))
        ->type_name("K")
        ->group(group);
    cli.add_flag(
           "--quadratic", request.is_quadratic,
           "Cut every edge in 2, and write which cells belong together: for quadratic elements")
        ->group(group);
    cli.add_flag("--curved", request.is_curved,
                 "With --quadratic: middles of edges on the surface of a shape, image, sphere or"
                 " ball (with --dim 3)")
        ->group(group);
}

void add_extrusion(CLI::App& cli, MeshArguments& arguments) {
    mesher::ExtrusionRequest& extrusion = arguments.request.extrusion;
    const auto group = "Extrusion";
    CLI::Option* thickness =
        cli.add_option(
               "--thickness", arguments.thickness,
               "How thick the body is along w (m); with --one-sided below 0 for towards -w; "
               "default: 0.2 of the largest side, with --round all of it")
            ->group(group);
    CLI::Option* direction =
        cli.add_option("--extrude", arguments.direction,
                       "The whole extrusion as a vector x,y,z,w (m), which may lean")
            ->delimiter(',')
            ->expected(3, 4)
            ->type_name("X,Y,Z,W")
            ->excludes(thickness)
            ->group(group);
    CLI::Option* layers =
        cli.add_option("--layers", extrusion.layers,
                       "Layers of pentachora; default: as many as give the best shapes")
            ->check(whole_number(1, 1'000'000))
            ->group(group);
    CLI::Option* grade =
        cli.add_option("--grade", extrusion.grade,
                       "Each layer this many times as high as its neighbor towards w = 0")
            ->check(number(1.0, 100.0))
            ->capture_default_str()
            ->group(group);
    cli.add_option("--layer-heights", extrusion.layer_heights,
                   "Instead: heights of the layers from w = 0 outward (m), to both sides of it; "
                   "thickness, profile and the like are shared out in proportion")
        ->delimiter(',')
        ->check(positive_number())
        ->type_name("H,H,...")
        ->excludes(layers)
        ->excludes(grade)
        ->group(group);
    CLI::Option* round = cli.add_flag("--round", extrusion.round,
                                      "Shrink to a point at both ends: a ball becomes a hyperball")
                             ->excludes(direction)
                             ->group(group);
    cli.add_option(
           "--profile", extrusion.profile,
           "File of layers, on each line `w scale [x y z [xy xz xw yz yw zw]]` (m, degrees)")
        ->type_name("FILE")
        ->excludes(thickness)
        ->excludes(direction)
        ->excludes(round)
        ->group(group);
    cli.add_flag("--one-sided", arguments.one_sided,
                 "Extrude from w = 0 instead of to both sides of it")
        ->group(group);
    CLI::Option* order =
        choose<VertexOrder>(
            cli.add_option(
                "--order", extrusion.order,
                "How prisms are cut: as vertices are numbered (index), along the longest side "
                "(sweep) or for the best cells (quality)"),
            {{"index", VertexOrder::Index},
             {"sweep", VertexOrder::Sweep},
             {"quality", VertexOrder::Quality}})
            ->group(group);
    cli.add_option("--edge-directions", extrusion.edge_directions,
                   "Instead of an order: a file with a directed edge of the base on each line, "
                   "`from to`, counted from 0")
        ->type_name("FILE")
        ->excludes(order)
        ->group(group);
    cli.add_flag("--unextruded", extrusion.is_kept,
                 "Write the base and its layers, a small file that is extruded whenever it is read")
        ->group(group);
    cli.add_flag("--lean", arguments.lean, "The same order in all layers, instead of alternating")
        ->group(group);
}

decltype(mesher::BodyRequest::input) input_of(const MeshArguments& arguments) {
    if (arguments.box.empty() && arguments.size.size() > 1) {
        throw Error("--size: found " + std::to_string(arguments.size.size())
                    + " numbers; expected one, the radius");
    }
    if (arguments.sphere > 0) {
        return mesher::SphereShape{arguments.sphere, arguments.size[0]};
    }
    if (arguments.ball > 0) {
        return mesher::BallShape{arguments.ball, arguments.size[0]};
    }
    if (arguments.box.empty()) {
        return arguments.input;
    }
    if (arguments.size.size() != 1 && arguments.size.size() != arguments.box.size()) {
        throw Error("--size: found " + std::to_string(arguments.size.size())
                    + " numbers; expected one, or one for each of the "
                    + counted(arguments.box.size(), "axis", "axes") + " of --box");
    }
    mesher::BoxShape box{arguments.box, {}, arguments.cut};
    for (std::size_t axis = 0; axis < arguments.box.size(); ++axis) {
        box.size.push_back(arguments.size[std::min(axis, arguments.size.size() - 1)]);
    }
    return box;
}

// Devices and pipes take what comes.
void require_pent_file(const std::filesystem::path& output) {
    std::error_code ignored;
    const std::filesystem::file_status status = std::filesystem::status(output, ignored);
    const bool is_device = std::filesystem::exists(status)
                           && !std::filesystem::is_regular_file(status)
                           && !std::filesystem::is_directory(status);
    if (!is_device && format_of(output, "") != ".pent") {
        std::filesystem::path wanted = output;
        throw Error(output.string()
                    + ": a mesh is a .pent file; expected a name that ends in it, as -o "
                    + wanted.replace_extension(".pent").string());
    }
}

}  // namespace

void add_options(CLI::App& cli, MeshArguments& arguments) {
    add_input(cli, arguments);
    cli.add_option("-o,--output", arguments.output, "Where the mesh goes, a .pent file")
        ->required()
        ->type_name("FILE");
    choose<int>(
        cli.add_option(
            "--dim", arguments.dim,
            "Dimension of the mesh: 4; or 3 for tetrahedra as they are, the inside of a surface,"
            " or a flat triangle mesh extruded along z"),
        {{"4", 4}, {"3", 3}});
    cli.add_flag("--ascii", arguments.ascii, "Write text instead of binary");
    cli.add_flag("--quality", arguments.show_quality, "Print percentiles and a histogram");
    cli.add_option("--histogram", arguments.histogram, "Draw the histogram into this SVG file")
        ->type_name("FILE");
    cli.add_option("--time-limit", arguments.time_limit, "Give up after this long (s)")
        ->check(positive_number())
        ->capture_default_str();
    cli.add_option("--step-limit", arguments.step_limit,
                   "End a step of mending or filling after this long (s), and try the next way")
        ->check(number(1.0, 1e9))
        ->capture_default_str();
    cli.add_option("--memory-limit", arguments.memory_limit,
                   "Use no more memory than this (MiB); default: the machine's")
        ->check(number(1.0, 1e9));
    cli.add_flag("--yes", arguments.yes,
                 "Go ahead without asking where millions of cells, or minutes, are to be expected");
    add_image(cli, arguments);
    add_surface(cli, arguments.request);
    add_resolution(cli, arguments);
    add_extrusion(cli, arguments);
    add_space_time_options(cli, arguments);
}

void complete(const CLI::App& cli, MeshArguments& arguments) {
    mesher::BodyRequest& request = arguments.request;
    require_pent_file(arguments.output);
    request.input = input_of(arguments);
    request.scale = arguments.scale * arguments.unit;
    request.translation = Eigen::Map<const Eigen::VectorXd>(
        arguments.translation.data(), static_cast<Eigen::Index>(arguments.translation.size()));
    if (cli.count("--level") > 0) {
        request.image.level = arguments.level;
    }
    if (!arguments.spacing.empty()) {
        request.image.spacing = Eigen::Vector4d(arguments.spacing.data());
    }
    request.tetrahedra.keep_surface = !arguments.subdivide_surface;
    if (cli.count("--thickness") > 0) {
        request.extrusion.thickness = arguments.thickness;
    }
    if (!arguments.direction.empty()) {
        request.extrusion.direction = Eigen::Map<const Eigen::VectorXd>(
            arguments.direction.data(), static_cast<Eigen::Index>(arguments.direction.size()));
    }
    request.extrusion.anchor = arguments.one_sided ? mesher::Anchor::Start : mesher::Anchor::Middle;
    request.extrusion.alternate = !arguments.lean;
    mesher::StepLimits limits{.seconds = arguments.step_limit};
    if (arguments.memory_limit > 0) {
        limits.memory_mib = std::llround(arguments.memory_limit);
    }
    request.limit_steps(limits);
    complete_size_field(arguments);
    complete_space_time(cli, arguments);
}

}  // namespace pent::apps

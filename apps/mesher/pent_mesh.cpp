// pent-mesh: surface or tet mesh to pentachoral mesh.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#include "common/heartbeat.h"
#include "common/program.h"
#include "common/progress.h"
#include "expected_size.h"
#include "mesh_options.h"
#include "mesh_text.h"
#include "space_time_body.h"
#include "watchdog.h"

#include <pent/counted.h>
#include <pent/error.h>
#include <pent/formatted.h>
#include <pent/mesher/make_body.h>
#include <pent/mesher/moving_mesh.h>
#include <pent/mesher/read_solid.h>
#include <pent/mesher/tetgen_files.h>
#include <pent/output_file.h>
#include <pent/pent_file.h>

#include <cmath>
#include <filesystem>
#include <new>
#include <string>
#include <system_error>
#include <vector>

namespace {

using pent::counted;
using pent::formatted;
using pent::apps::MeshArguments;
using pent::apps::NamedFile;
using pent::apps::Program;
using pent::mesher::BodyReport;
using pent::mesher::ExpectedSize;
using pent::mesher::Repair;

void say_surface(const Program& program, const BodyReport& report) {
    if (report.repair != Repair::None) {
        program.say("found      " + pent::mesher::describe(report.surface_read));
        program.say(formatted("mended     %s: now within %.3g m of what was read",
                              report.repair == Repair::Light ? "lightly" : "by a wrap",
                              report.repair_distance));
    }
    if (report.merged_points + report.flipped_triangles > 0) {
        program.say("corrected  " + counted(report.merged_points, "point", "points") + " merged, "
                    + counted(report.flipped_triangles, "triangle", "triangles") + " turned over");
    }
    if (report.surface.triangles > 0) {
        const std::string cavities =
            report.cavities == 0
                ? ""
                : ", " + counted(report.cavities, "of them a cavity", "of them cavities");
        program.say("surface    " + counted(report.surface.points, "point", "points") + ", "
                    + counted(report.surface.triangles, "triangle", "triangles")
                    + formatted(", area %.6g m^2, ", report.surface_area)
                    + counted(report.components, "component", "components") + cavities);
    }
    if (!report.failures.empty()) {
        program.say("fell back  because " + report.failures);
    }
}

void say_boundary(const Program& program, const pent::mesher::BoundaryReport& boundary) {
    if (boundary.tetrahedra == 0) {
        return;
    }
    program.say("boundary   " + counted(boundary.tetrahedra, "tetrahedron", "tetrahedra") + ", "
                + counted(boundary.patches, "smooth part", "smooth parts"));
    if (boundary.is_mended()) {
        program.say("mended     " + pent::mesher::describe(boundary));
    }
}

void say_cells(const Program& program, const BodyReport& report) {
    if (!report.cut.empty()) {
        program.say("cut        " + report.cut);
    }
    if (report.curved_cells > 0) {
        program.say(pent::apps::straight_line(report.curved_cells));
    }
    if (!report.region_array.empty()) {
        program.say("regions    of the array \"" + report.region_array + "\"");
    }
    if (!report.left_out.empty()) {
        program.say("left out   " + report.left_out + ": no part of a body");
    }
}

void say_base(const Program& program, const BodyReport& report, int dim) {
    if (report.layers == 0) {
        return;
    }
    program.say("base       "
                + pent::apps::size_text(report.base_vertices, report.base_cells, dim - 1)
                + formatted(" (%s), %.6g m^%d, mean edge %.4g m", report.generator.c_str(),
                            report.base_volume, dim - 1, report.base_edge));
    // Beyond what rounding makes of equal ones.
    const bool is_graded = report.highest_layer > report.lowest_layer * (1 + 1e-9);
    program.say(
        formatted("extrusion  %.6g m along %c, ", report.direction[dim - 1], "xyzw"[dim - 1])
        + counted(report.layers, "layer", "layers")
        + (is_graded ? formatted(", the thinnest %.4g m, the thickest %.4g m", report.lowest_layer,
                                 report.highest_layer)
                     : ""));
}

template <int Dim>
void say_body(const Program& program, const pent::mesher::Body<Dim>& body) {
    const BodyReport& report = body.report;
    const pent::mesher::Proof& proof = report.proof;
    if (report.beveled > 0) {
        program.say("beveled    "
                    + counted(report.beveled, "simplex of the boundary crosses",
                              "simplices of the boundary cross")
                    + " a ridge; shorter edges follow it");
    }
    if (report.thin_parts.edges > 0) {
        const pent::mesher::ThinParts& thin = report.thin_parts;
        program.say(
            "thin       " + counted(thin.edges, "edge goes", "edges go")
            + formatted(" right through a wall or a gap, the thinnest %.3g m "
                        "at (%.4g, %.4g, %.4g, %.4g): walls have holes, gaps are closed; edges of "
                        "at most %.3g m follow it",
                        thin.width, thin.place[0], thin.place[1], thin.place[2], thin.place[3],
                        thin.width));
    }
    if (report.curve.moved + report.curve.limited > 0) {
        program.say("curved     "
                    + counted(report.curve.moved, "middle of an edge", "middles of edges")
                    + formatted(", by up to %.4g m", report.curve.farthest));
    }
    if (report.curve.limited > 0) {
        program.say(
            "limited    " + counted(report.curve.limited, "middle of an edge", "middles of edges")
            + ", where a curved boundary would fold cells on the surface: nearer to the edge, or on"
              " it; shorter edges leave fewer");
    }
    program.say("body       " + pent::apps::size_text(body.mesh.vertex_count(), proof.cells, Dim)
                + formatted(", %.10g m^%d", proof.volume, Dim));
    program.say(pent::apps::box_line<Dim>(body.mesh.positions));
    program.say(
        pent::apps::proof_line(proof.interior_facets, proof.boundary_facets)
        + formatted(", volume as expected to %.1e",
                    std::abs(proof.volume - proof.expected_volume) / proof.expected_volume));
    if (const std::string names = pent::apps::carried_names(body.mesh, body.extras);
        !names.empty()) {
        program.say("carried    " + names);
    }
    program.say("quality    " + pent::apps::quality_line(report.quality));
}

void say_stages(const Program& program, const BodyReport& report) {
    std::string stages = "time      ";
    for (const pent::mesher::Stage& stage : report.stages) {
        stages += formatted(" %s %.3f s", stage.name.c_str(), stage.seconds);
    }
    program.say(stages);
}

nlohmann::ordered_json thin_json(const pent::mesher::ThinParts& thin) {
    if (thin.edges == 0) {
        return nullptr;
    }
    return {{"edges", thin.edges},
            {"width", thin.width},
            {"place", std::vector<double>(thin.place.begin(), thin.place.end())}};
}

template <int Dim>
nlohmann::ordered_json to_json(const pent::mesher::Body<Dim>& body) {
    const BodyReport& report = body.report;
    nlohmann::ordered_json json;
    json["surface"] = {{"points", report.surface.points},
                       {"triangles", report.surface.triangles},
                       {"area", report.surface_area},
                       {"components", report.components},
                       {"cavities", report.cavities},
                       {"found", pent::mesher::describe(report.surface_read)},
                       {"repair", pent::mesher::name_of(report.repair)},
                       {"repair_distance", report.repair_distance},
                       {"merged_points", report.merged_points},
                       {"flipped_triangles", report.flipped_triangles}};
    const pent::mesher::BoundaryReport& boundary = report.boundary;
    json["boundary"] = {
        {"tetrahedra", boundary.tetrahedra}, {"merged_points", boundary.merged_points},
        {"degenerate", boundary.degenerate}, {"repeated", boundary.repeated},
        {"turned", boundary.turned},         {"open", boundary.open},
        {"holes", boundary.holes},           {"largest_hole", boundary.largest_hole},
        {"inner", boundary.inner},           {"patches", boundary.patches}};
    json["cells"] = {{"cut", report.cut},
                     {"left_out", report.left_out},
                     {"curved", report.curved_cells},
                     {"region_array", report.region_array},
                     {"carried", pent::apps::carried_names(body.mesh, body.extras)}};
    json["base"] = {{"generator", report.generator}, {"failures", report.failures},
                    {"fillings", report.fillings},   {"vertices", report.base_vertices},
                    {"cells", report.base_cells},    {"volume", report.base_volume},
                    {"mean_edge", report.base_edge}};
    json["extrusion"] = {
        {"direction", std::vector<double>(report.direction.data(),
                                          report.direction.data() + report.direction.size())},
        {"layers", report.layers},
        {"thinnest_layer", report.lowest_layer},
        {"thickest_layer", report.highest_layer}};
    json["mesh"] = {{"vertices", body.mesh.vertex_count()},
                    {"cells", report.proof.cells},
                    {"interior_facets", report.proof.interior_facets},
                    {"boundary_facets", report.proof.boundary_facets},
                    {"beveled", report.beveled},
                    {"thin", thin_json(report.thin_parts)},
                    {"curved", report.curve.moved},
                    {"limited", report.curve.limited},
                    {"volume", report.proof.volume},
                    {"expected_volume", report.proof.expected_volume},
                    {"boundary_volume", report.proof.boundary_volume},
                    {"volume_tolerance", report.proof.tolerance},
                    {"box", pent::apps::box_json<Dim>(body.mesh.positions)}};
    json["quality"] = pent::apps::to_json(report.quality);
    for (const pent::mesher::Stage& stage : report.stages) {
        nlohmann::ordered_json& seconds = json["stage_seconds"][stage.name];
        seconds = (seconds.is_null() ? 0.0 : seconds.get<double>()) + stage.seconds;
    }
    return json;
}

template <int Dim>
pent::mesher::Body<Dim> make(Program& program,
                             const MeshArguments& arguments,
                             pent::apps::Heartbeat& heartbeat) {
    const pent::apps::Watchdog watchdog(program, arguments.time_limit);
    pent::mesher::BodyRequest request = arguments.request;
    request.on_stage = [&](const std::string& stage) { heartbeat.begin(stage); };
    request.on_size = [&](const ExpectedSize& size) {
        pent::apps::ask_about_size(program, arguments.yes, size, Dim);
    };
    if constexpr (Dim == 4) {
        return pent::mesher::make_body(request);
    } else {
        return pent::mesher::make_solid(request);
    }
}

template <int Dim>
void write(const Program& program,
           const MeshArguments& arguments,
           const pent::mesher::Body<Dim>& body) {
    const auto encoding = arguments.ascii ? pent::Encoding::Ascii : pent::Encoding::Binary;
    pent::apps::make_folder_for(arguments.output);
    const pent::WriteOptions options{.encoding = encoding,
                                     .created_by = program.name_and_version()};
    if (body.extrusion) {
        pent::write_extrusion<Dim>(arguments.output, *body.extrusion, options);
    } else {
        pent::write_mesh(arguments.output, body.mesh, options, body.extras);
    }
    if (!arguments.histogram.empty()) {
        pent::apps::make_folder_for(arguments.histogram);
        pent::write_text(
            arguments.histogram,
            pent::mesher::quality_svg(body.report.quality, arguments.output.filename().string()));
    }
}

template <int Dim>
void make_and_write(Program& program, const MeshArguments& arguments) {
    pent::mesher::Body<Dim> body;
    {
        pent::apps::Heartbeat heartbeat(program.common().quiet);
        body = make<Dim>(program, arguments, heartbeat);
        heartbeat.begin("write");
        write<Dim>(program, arguments, body);
    }
    say_surface(program, body.report);
    say_boundary(program, body.report.boundary);
    say_cells(program, body.report);
    say_base(program, body.report, Dim);
    say_body<Dim>(program, body);
    if (arguments.show_quality) {
        program.say(pent::mesher::quality_text(body.report.quality));
    }
    say_stages(program, body.report);
    program.report().update(to_json<Dim>(body));
    program.report()["output"] = arguments.output.string();
    program.say("finished: " + arguments.output.string());
}

// Files that are read; of TetGen's pair both.
std::vector<NamedFile> inputs_of(const MeshArguments& arguments) {
    std::vector<NamedFile> inputs = {
        {"--profile", arguments.request.extrusion.profile},
        {"--edge-directions", arguments.request.extrusion.edge_directions}};
    if (arguments.input != "-") {
        std::error_code ignored;
        const bool is_folder = std::filesystem::is_directory(arguments.input, ignored);
        inputs.push_back({"the input", arguments.input, is_folder});
    }
    inputs.push_back({"its other half", pent::mesher::other_tetgen_file(arguments.input)});
    return inputs;
}

// Files that the input names, which are read as well.
std::vector<NamedFile> inputs_named_by(const MeshArguments& arguments) {
    std::vector<std::filesystem::path> paths;
    if (arguments.space_time.is_asked_for) {
        paths = pent::mesher::frame_files(arguments.input, arguments.space_time.series);
    } else if (pent::mesher::is_shape_file(arguments.input)) {
        paths = pent::mesher::files_of_shapes(arguments.input);
    }
    std::vector<NamedFile> inputs;
    for (const std::filesystem::path& path : paths) {
        inputs.push_back({"a file that the input names", path});
    }
    return inputs;
}

}  // namespace

int main(int argc, char** argv) {
    Program program("pent-mesh",
                    "Makes a pentachoral mesh of a closed surface: fills it with tetrahedra and "
                    "extrudes them along w; or of a four-dimensional shape described in a file, or "
                    "given by its boundary. "
                    "With --dim 3 the tetrahedra are the mesh.",
                    "pent-mesh octopus.obj -o octopus.pent --thickness 0.5");
    MeshArguments arguments;
    pent::apps::add_options(program.options(), arguments);
    return program.run(argc, argv, [&] {
        pent::apps::complete(program.options(), arguments);
        const std::vector<NamedFile> outputs = {{"-o", arguments.output},
                                                {"--histogram", arguments.histogram}};
        program.require_apart(inputs_of(arguments), outputs);
        program.require_apart(inputs_named_by(arguments), outputs);
        pent::apps::limit_memory(arguments.memory_limit);
        try {
            if (arguments.space_time.is_asked_for) {
                pent::apps::make_and_write_space_time(program, arguments);
            } else {
                arguments.dim == 4 ? make_and_write<4>(program, arguments)
                                   : make_and_write<3>(program, arguments);
            }
        } catch (const std::bad_alloc&) {
            throw pent::Error(
                "out of memory; ask for fewer cells or a coarser surface, or raise --memory-limit");
        }
        return pent::apps::Verdict::Finished;
    });
}

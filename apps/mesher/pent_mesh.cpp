// pent-mesh: surface or tet mesh to pentachoral mesh.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#include "common/program.h"
#include "mesh_text.h"

#include <pent/mesher/make_body.h>
#include <pent/pent_file.h>

#include <cmath>
#include <map>

namespace {

using pent::mesher::BodyReport;
using pent::mesher::BodyRequest;

struct Arguments {
    BodyRequest request;
    std::filesystem::path output;
    int dim = 4;
    std::vector<double> direction;
    double thickness = 0;
    bool one_sided = false;
    bool lean = false;
    bool ascii = false;
    bool show_quality = false;
};

using pent::apps::text;
using Long = long long;  // NOLINT(google-runtime-int): printf's type

void add_options(CLI::App& cli, Arguments& arguments) {
    BodyRequest& request = arguments.request;
    cli.add_option("input", request.input, "Surface: .obj, .ply, .stl, .off, .gltf or .glb")
        ->required()
        ->type_name("FILE");
    cli.add_option("-o,--output", arguments.output, "Where the mesh goes, a .pent file")
        ->required()
        ->type_name("FILE");
    cli.add_option("--dim", arguments.dim,
                   "Dimension of the mesh: 4, or 3 to extrude a flat triangle mesh along z")
        ->check(CLI::IsMember({3, 4}))
        ->capture_default_str();

    cli.add_option("--surface-triangles", request.surface_triangles,
                   "Refine or coarsen the surface to this many triangles")
        ->check(CLI::Range(std::int64_t{4}, std::int64_t{1} << 31))
        ->group("Resolution");
    cli.add_option("--edge-length", request.tetrahedra.edge_length,
                   "Aim at tetrahedra with edges of this length (m) inside the body")
        ->check(CLI::PositiveNumber)
        ->group("Resolution");
    cli.add_option("--radius-edge-ratio", request.tetrahedra.radius_edge_ratio,
                   "Bound for circumradius over shortest edge; lower gives more tetrahedra")
        ->check(CLI::Range(1.05, 10.0))
        ->capture_default_str()
        ->group("Resolution");

    CLI::Option* thickness =
        cli.add_option("--thickness", arguments.thickness,
                       "Extrusion along w (m), negative for -w; default: 0.2 of the largest side")
            ->group("Extrusion");
    cli.add_option("--extrude", arguments.direction, "The whole extrusion as a vector x,y,z,w (m)")
        ->delimiter(',')
        ->expected(3, 4)
        ->excludes(thickness)
        ->group("Extrusion");
    cli.add_option("--layers", request.extrusion.layers,
                   "Layers of pentachora; default: as many as give the best shapes")
        ->check(CLI::Range(1, 1'000'000))
        ->group("Extrusion");
    cli.add_flag("--one-sided", arguments.one_sided,
                 "Extrude from w = 0 instead of to both sides of it")
        ->group("Extrusion");
    cli.add_option("--order", request.extrusion.order, "Vertex order: index or sweep")
        ->transform(CLI::CheckedTransformer(
            std::map<std::string, pent::mesher::VertexOrder>{
                {"index", pent::mesher::VertexOrder::Index},
                {"sweep", pent::mesher::VertexOrder::Sweep}},
            CLI::ignore_case))
        ->default_str("index")
        ->group("Extrusion");
    cli.add_flag("--lean", arguments.lean, "Keep the same order in all layers, do not alternate it")
        ->group("Extrusion");

    cli.add_flag("--ascii", arguments.ascii, "Write text instead of binary");
    cli.add_flag("--quality", arguments.show_quality, "Print the quality histogram");
}

std::string surface_line(const BodyReport& report) {
    return text("surface    %lld points, %lld triangles, area %.6g m^2, %lld component%s%s",
                static_cast<Long>(report.surface.points),
                static_cast<Long>(report.surface.triangles), report.surface_area,
                static_cast<Long>(report.components), report.components == 1 ? "" : "s",
                report.cavities > 0
                    ? text(", %lld of them cavities", static_cast<Long>(report.cavities)).c_str()
                    : "");
}

std::string mended_line(const BodyReport& report) {
    return text("mended     %lld points merged, %lld triangles turned over",
                static_cast<Long>(report.merged_points),
                static_cast<Long>(report.flipped_triangles));
}

void say_summary(const pent::apps::Program& program,
                 const BodyReport& report,
                 const Arguments& arguments,
                 std::int64_t vertices) {
    const int dim = arguments.dim;
    if (report.merged_points + report.flipped_triangles > 0) {
        program.say(mended_line(report));
    }
    if (dim == 4) {
        program.say(surface_line(report));
    }
    program.say(text("base       %lld vertices, %lld %s (%s), %.6g m^%d, mean edge %.4g m",
                     static_cast<Long>(report.base_vertices), static_cast<Long>(report.base_cells),
                     pent::cell_name_plural(dim - 1).data(), report.generator.c_str(),
                     report.base_volume, dim - 1, report.base_edge));
    program.say(text("extrusion  %.6g m along %c, %d layer%s", report.direction[dim - 1],
                     "xyzw"[dim - 1], report.layers, report.layers == 1 ? "" : "s"));
    program.say(text("body       %lld vertices, %lld %s, %.10g m^%d", static_cast<Long>(vertices),
                     static_cast<Long>(report.proof.cells), pent::cell_name_plural(dim).data(),
                     report.proof.volume, dim));
    program.say(
        text("proved     %lld inner facets match, boundary of %lld facets closed, "
             "volume as expected to %.1e",
             static_cast<Long>(report.proof.interior_facets),
             static_cast<Long>(report.proof.boundary_facets),
             std::abs(report.proof.volume - report.proof.expected_volume)
                 / report.proof.expected_volume));
    program.say("quality    " + pent::apps::quality_line(report.quality));
    if (arguments.show_quality) {
        program.say(pent::mesher::quality_text(report.quality));
    }
    std::string stages = "time      ";
    for (const pent::mesher::Stage& stage : report.stages) {
        stages += text(" %s %.3f s", stage.name.c_str(), stage.seconds);
    }
    program.say(stages);
}

nlohmann::ordered_json to_json(const BodyReport& report, std::int64_t vertices) {
    nlohmann::ordered_json json;
    json["surface"] = {{"points", report.surface.points},
                       {"triangles", report.surface.triangles},
                       {"area", report.surface_area},
                       {"components", report.components},
                       {"cavities", report.cavities},
                       {"merged_points", report.merged_points},
                       {"flipped_triangles", report.flipped_triangles}};
    json["base"] = {{"generator", report.generator},
                    {"vertices", report.base_vertices},
                    {"cells", report.base_cells},
                    {"volume", report.base_volume},
                    {"mean_edge", report.base_edge}};
    json["extrusion"] = {
        {"direction", std::vector<double>(report.direction.begin(), report.direction.end())},
        {"layers", report.layers}};
    json["mesh"] = {{"vertices", vertices},
                    {"cells", report.proof.cells},
                    {"interior_facets", report.proof.interior_facets},
                    {"boundary_facets", report.proof.boundary_facets},
                    {"volume", report.proof.volume},
                    {"expected_volume", report.proof.expected_volume},
                    {"boundary_volume", report.proof.boundary_volume},
                    {"volume_tolerance", report.proof.tolerance}};
    json["quality"] = pent::apps::to_json(report.quality);
    for (const pent::mesher::Stage& stage : report.stages) {
        json["stage_seconds"][stage.name] = stage.seconds;
    }
    return json;
}

template <int Dim>
void write_body(pent::apps::Program& program,
                const pent::mesher::Body<Dim>& body,
                const Arguments& arguments) {
    const auto encoding = arguments.ascii ? pent::Encoding::Ascii : pent::Encoding::Binary;
    pent::write_mesh(arguments.output, body.mesh,
                     {.encoding = encoding, .created_by = program.name_and_version()});
    say_summary(program, body.report, arguments, body.mesh.vertex_count());
    program.report().update(to_json(body.report, body.mesh.vertex_count()));
    program.report()["output"] = arguments.output.string();
    program.say("finished: " + arguments.output.string());
}

void complete_request(Arguments& arguments, const CLI::App& cli) {
    pent::mesher::ExtrusionRequest& extrusion = arguments.request.extrusion;
    if (cli.count("--thickness") > 0) {
        extrusion.thickness = arguments.thickness;
    }
    if (!arguments.direction.empty()) {
        extrusion.direction = Eigen::Map<const Eigen::VectorXd>(
            arguments.direction.data(), static_cast<Eigen::Index>(arguments.direction.size()));
    }
    extrusion.anchor =
        arguments.one_sided ? pent::mesher::Anchor::Start : pent::mesher::Anchor::Middle;
    extrusion.alternate = !arguments.lean;
}

}  // namespace

int main(int argc, char** argv) {
    pent::apps::Program program("pent-mesh",
                                "Makes a pentachoral mesh from a closed surface: fills it with "
                                "tetrahedra and extrudes them "
                                "along w.",
                                "pent-mesh octopus.obj -o octopus.pent --thickness 0.5");
    Arguments arguments;
    add_options(program.options(), arguments);
    return program.run(argc, argv, [&] {
        complete_request(arguments, program.options());
        if (arguments.dim == 4) {
            write_body<4>(program, pent::mesher::make_body(arguments.request), arguments);
        } else {
            write_body<3>(program, pent::mesher::make_body_from_plane(arguments.request),
                          arguments);
        }
        return pent::apps::Verdict::Finished;
    });
}

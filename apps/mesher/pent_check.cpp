// pent-check: validates a .pent file, or proves the decomposition tables or the eigensystems.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#include "common/heartbeat.h"
#include "common/program.h"
#include "eigen_table.h"
#include "mesh_text.h"

#include <pent/counted.h>
#include <pent/error.h>
#include <pent/formatted.h>
#include <pent/mesher/cut_simplex.h>
#include <pent/mesher/decomposition.h>
#include <pent/mesher/halve_simplex.h>
#include <pent/mesher/links.h>
#include <pent/mesher/prove.h>
#include <pent/pent_file.h>

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace {

using pent::counted;
using pent::formatted;
using pent::apps::Program;
using Long = long long;  // NOLINT(google-runtime-int): printf's type

std::string searched(const pent::mesher::DecompositionProof& proof, std::int64_t count) {
    return proof.is_searched ? std::to_string(count) : "-";
}

void prove_tables(Program& program) {
    program.say(
        "Cutting the prism over a simplex into simplices without added points, by enumeration\n"
        "in integers. Edges of the base are directed; a direction names the diagonal above it.\n");
    program.say(
        "  base      directions      without cycles        with cycles         neighbors\n"
        "  vertices         all     all  filled unique     all  impossible  3-cycle   agree");
    for (int n = 2; n <= 6; ++n) {
        const pent::mesher::DecompositionProof proof = pent::mesher::prove_decompositions(n);
        const std::int64_t cyclic = proof.orientations - proof.acyclic;
        program.say(
            formatted("  %8d  %10lld  %6lld  %6lld %6s  %6lld  %10s  %7lld  %lld of %lld", n,
                      static_cast<Long>(proof.orientations), static_cast<Long>(proof.acyclic),
                      static_cast<Long>(proof.filled), searched(proof, proof.unique).c_str(),
                      static_cast<Long>(cyclic), searched(proof, proof.impossible).c_str(),
                      static_cast<Long>(proof.with_triangle), static_cast<Long>(proof.agreeing),
                      static_cast<Long>(proof.neighbors)));
        nlohmann::ordered_json row = {{"base_vertices", n},
                                      {"orientations", proof.orientations},
                                      {"acyclic", proof.acyclic},
                                      {"filled", proof.filled},
                                      {"cyclic", cyclic},
                                      {"cyclic_with_3_cycle", proof.with_triangle},
                                      {"neighbor_orders", proof.neighbors},
                                      {"neighbor_orders_agreeing", proof.agreeing},
                                      {"holds", proof.holds()}};
        if (proof.is_searched) {
            row["unique"] = proof.unique;
            row["impossible"] = proof.impossible;
        }
        program.report()["decompositions"].push_back(row);
        if (!proof.holds()) {
            // GCOVR_EXCL_START: it holds; this is for mistakes of ours
            throw pent::Error("the decomposition of prisms over " + std::to_string(n)
                              + " vertices does not hold; see the table");
            // GCOVR_EXCL_STOP
        }
    }
    program.say(
        "\n  filled      the path decomposition fills the prism and has exactly the cuts asked "
        "for\n"
        "  unique      no other set of simplices does (every subset tried)\n"
        "  impossible  no set of simplices does (every subset tried)\n"
        "  3-cycle     contain a directed 3-cycle: the prism over it is a face and impossible\n"
        "  agree       two base simplices with a common facet cut the prism over it alike,\n"
        "              for every order of all their vertices\n");
}

void prove_stuffing_tables(Program& program) {
    program.say(
        "Cutting a simplex by a surface, for every pattern of corners inside, on and outside of "
        "it.\n\n"
        "  dimension  patterns  filled    pieces  positive     sides     agree");
    for (int dim = 2; dim <= 4; ++dim) {
        const pent::mesher::StuffingProof proof = pent::mesher::prove_stuffing(dim);
        program.say(formatted("  %9d  %8lld  %6lld  %8lld  %8lld  %8lld  %8lld", dim,
                              static_cast<Long>(proof.patterns), static_cast<Long>(proof.filled),
                              static_cast<Long>(proof.pieces), static_cast<Long>(proof.positive),
                              static_cast<Long>(proof.sides), static_cast<Long>(proof.agreeing)));
        program.report()["stuffing"].push_back({{"dimension", dim},
                                                {"patterns", proof.patterns},
                                                {"filled", proof.filled},
                                                {"pieces", proof.pieces},
                                                {"positive", proof.positive},
                                                {"sides", proof.sides},
                                                {"sides_agreeing", proof.agreeing},
                                                {"holds", proof.holds()}});
        if (!proof.holds()) {
            // GCOVR_EXCL_START: it holds; this is for mistakes of ours
            throw pent::Error("the pieces of cut simplices of dimension " + std::to_string(dim)
                              + " do not hold; see the table");
            // GCOVR_EXCL_STOP
        }
    }
    program.say(
        "\n  filled      the pieces fill the part inside, every facet shared or on its boundary\n"
        "  positive    pieces that are not turned over wherever the cuts are on their edges\n"
        "  agree       sides that are cut as simplices of their own, so that neighbors agree\n");
}

void prove_halving_tables(Program& program) {
    program.say(
        "Halving edges of a simplex of the lattice, for every set of edges, as between cells of "
        "two sizes.\n\n"
        "  dimension  patterns  filled    pieces  positive     sides     agree  mean ratio");
    for (int dim = 2; dim <= 4; ++dim) {
        const pent::mesher::HalvingProof proof = pent::mesher::prove_halving(dim);
        program.say(formatted("  %9d  %8lld  %6lld  %8lld  %8lld  %8lld  %8lld  %10.3f", dim,
                              static_cast<Long>(proof.patterns), static_cast<Long>(proof.filled),
                              static_cast<Long>(proof.pieces), static_cast<Long>(proof.positive),
                              static_cast<Long>(proof.sides), static_cast<Long>(proof.agreeing),
                              proof.least_mean_ratio));
        program.report()["halving"].push_back({{"dimension", dim},
                                               {"patterns", proof.patterns},
                                               {"filled", proof.filled},
                                               {"pieces", proof.pieces},
                                               {"positive", proof.positive},
                                               {"sides", proof.sides},
                                               {"sides_agreeing", proof.agreeing},
                                               {"least_mean_ratio", proof.least_mean_ratio},
                                               {"holds", proof.holds()}});
        if (!proof.holds()) {
            // GCOVR_EXCL_START: it holds; this is for mistakes of ours
            throw pent::Error("the pieces of halved simplices of dimension " + std::to_string(dim)
                              + " do not hold; see the table");
            // GCOVR_EXCL_STOP
        }
    }
    program.say(
        "\n  filled      the pieces fill the simplex, every facet shared or on a side of it\n"
        "  positive    pieces that are neither flat nor turned over\n"
        "  agree       sides that are cut as simplices of their own, so that neighbors agree\n"
        "  mean ratio  the least of all pieces\n\n"
        "finished: all proved");
}

template <int Dim>
struct Checked {
    pent::MeshFile<Dim> file;
    pent::mesher::Proof proof;
    pent::mesher::LinkReport links;
    pent::mesher::QualityReport quality;
};

template <int Dim>
Checked<Dim> check(const std::filesystem::path& path, bool quiet) {
    pent::apps::Heartbeat heartbeat(quiet);
    Checked<Dim> checked;
    heartbeat.begin("read");
    checked.file = pent::read_mesh<Dim>(path);
    heartbeat.begin("facets");
    checked.proof = pent::mesher::prove(checked.file.mesh);
    if (!checked.proof.holds()) {
        throw pent::Error(path.string() + ": " + pent::mesher::describe_faults(checked.proof, Dim));
    }
    heartbeat.begin("links");
    checked.links = pent::mesher::check_links(checked.file.mesh);
    heartbeat.begin("quality");
    checked.quality = pent::mesher::measure_quality(checked.file.mesh);
    return checked;
}

// How many cells or facets have each label: "0 on 10 cells, 2 on 1 cell"; the numbers in a report.
std::string say_counts(const std::vector<std::uint16_t>& labels,
                       const std::string& one,
                       const std::string& many,
                       nlohmann::ordered_json& report) {
    std::map<std::uint16_t, std::int64_t> counts;
    for (const std::uint16_t label : labels) {
        ++counts[label];
    }
    std::string text;
    report = nlohmann::ordered_json::object();
    for (const auto& [label, count] : counts) {
        text +=
            (text.empty() ? "" : ", ") + std::to_string(label) + " on " + counted(count, one, many);
        report[std::to_string(label)] = count;
    }
    return text;
}

// What cells have, where not all are alike.
template <int Dim>
void say_cells(Program& program, const pent::SimplexMesh<Dim>& mesh) {
    nlohmann::ordered_json& report = program.report()["cells"];
    const std::string regions = say_counts(mesh.regions, "cell", "cells", report["regions"]);
    if (report["regions"].size() > 1 || (!regions.empty() && !report["regions"].contains("0"))) {
        program.say("regions    " + regions);
    }
    std::int64_t with_fibers = 0;
    for (Eigen::Index cell = 0; cell < mesh.fibers.cols(); ++cell) {
        with_fibers += mesh.fibers.col(cell).isZero(0) ? 0 : 1;
    }
    report["with_fibers"] = with_fibers;
    if (mesh.fibers.cols() > 0) {
        program.say("fibers     in " + counted(with_fibers, "cell", "cells"));
    }
    report["is_quadratic"] = !mesh.parents.empty();
    if (!mesh.parents.empty()) {
        program.say("quadratic  " + std::to_string(mesh.cell_count() >> Dim)
                    + " cells of which these are the children");
    }
}

// What a file has beside its mesh, said and in the report.
template <int Dim>
void say_extras(Program& program, const pent::MeshExtras<Dim>& extras) {
    nlohmann::ordered_json report = {{"vertex_fields", nlohmann::ordered_json::array()},
                                     {"cell_fields", nlohmann::ordered_json::array()},
                                     {"has_bisection_tags", !extras.bisection_tags.empty()}};
    std::string fields;
    for (const pent::VertexField& field : extras.vertex_fields) {
        fields += (fields.empty() ? "" : ", ") + field.name;
        report["vertex_fields"].push_back(field.name);
    }
    for (const pent::VertexField& field : extras.cell_fields) {
        fields += (fields.empty() ? "" : ", ") + field.name + " of cells";
        report["cell_fields"].push_back(field.name);
    }
    if (!fields.empty()) {
        program.say("quantities " + fields);
    }
    if (!extras.bisection_tags.empty()) {
        program.say("tags       for bisection");
    }
    const std::string labels = say_counts(extras.labels, "facet", "facets", report["labels"]);
    if (!labels.empty()) {
        program.say("labels     " + labels);
    }
    program.report()["extras"] = std::move(report);
}

template <int Dim>
void check_mesh(Program& program, const std::filesystem::path& path) {
    const auto [file, proof, links, quality] = check<Dim>(path, program.common().quiet);
    program.say(formatted("file       dimension %d, %s, by %s, crc32c %08x", Dim,
                          file.info.encoding == pent::Encoding::Ascii ? "ascii" : "binary",
                          file.info.created_by.c_str(), file.info.crc32c));
    program.say("mesh       " + pent::apps::size_text(file.mesh.vertex_count(), proof.cells, Dim)
                + formatted(", %.10g m^%d", proof.volume, Dim));
    program.say(pent::apps::box_line<Dim>(file.mesh.positions));
    program.say(
        "facets     " + counted(proof.interior_facets, "inner one matches", "inner ones match")
        + ", boundary of " + std::to_string(proof.boundary_facets) + " is closed and oriented");
    program.say(
        "manifold   a sphere around "
        + counted(links.boundary_vertices - links.faulty, "boundary vertex", "boundary vertices")
        + ", none around " + std::to_string(links.faulty));
    program.say("quality    " + pent::apps::quality_line(quality));
    say_cells<Dim>(program, file.mesh);
    say_extras<Dim>(program, file.extras);
    program.report()["file"] = {
        {"encoding", file.info.encoding == pent::Encoding::Ascii ? "ascii" : "binary"},
        {"created_by", file.info.created_by},
        {"crc32c", formatted("%08x", file.info.crc32c)}};
    program.report()["mesh"] = {{"dimension", Dim},
                                {"vertices", file.mesh.vertex_count()},
                                {"cells", proof.cells},
                                {"interior_facets", proof.interior_facets},
                                {"boundary_facets", proof.boundary_facets},
                                {"volume", proof.volume},
                                {"boundary_volume", proof.boundary_volume},
                                {"boundary_vertices", links.boundary_vertices},
                                {"faulty_links", links.faulty},
                                {"unused_vertices", links.unused_vertices},
                                {"box", pent::apps::box_json<Dim>(file.mesh.positions)}};
    program.report()["quality"] = pent::apps::to_json(quality);
    if (links.faulty + links.unused_vertices > 0) {
        throw pent::Error(
            path.string() + ": " + counted(links.unused_vertices, "vertex", "vertices")
            + " without a cell, and the boundary is not a manifold at "
            + counted(links.faulty, "vertex", "vertices")
            + " (first: " + std::to_string(links.first_faulty)
            + "); parts that touch in a point or an edge must be joined or moved apart");
    }
    program.say("finished: " + path.string() + " is sound");
}

// What a frame has of every vertex.
template <int Dim>
std::vector<std::string> quantities_of(const pent::Frame<Dim>& frame) {
    std::vector<std::string> names = {"position"};
    if (frame.velocities.cols() > 0) {
        names.emplace_back("velocity");
    }
    if (frame.contact_forces.cols() > 0) {
        names.emplace_back("contact_force");
    }
    for (const pent::VertexField& field : frame.fields) {
        names.push_back(field.name);
    }
    return names;
}

template <int Dim>
void check_frame(Program& program, const std::filesystem::path& path) {
    const pent::Frame<Dim> frame = pent::read_frame<Dim>(path);
    program.say(formatted("frame      %lld of %s, step %lld, %.6g s, ",
                          static_cast<Long>(frame.frame), frame.mesh_name.c_str(),
                          static_cast<Long>(frame.step), frame.time)
                + counted(frame.positions.cols(), "vertex", "vertices"));
    program.say(pent::apps::box_line<Dim>(frame.positions));
    const std::vector<std::string> quantities = quantities_of(frame);
    std::string list;
    for (const std::string& name : quantities) {
        list += (list.empty() ? "" : ", ") + name;
    }
    program.say("of vertices " + list);
    program.report()["frame"] = {
        {"dimension", Dim},         {"mesh", frame.mesh_name},
        {"frame", frame.frame},     {"step", frame.step},
        {"time", frame.time},       {"vertices", frame.positions.cols()},
        {"quantities", quantities}, {"box", pent::apps::box_json<Dim>(frame.positions)}};
    program.say("finished: " + path.string() + " is sound");
}

template <int Dim>
void check_file(Program& program, const std::filesystem::path& path, bool is_frame) {
    is_frame ? check_frame<Dim>(program, path) : check_mesh<Dim>(program, path);
}

void check_file(Program& program, const std::filesystem::path& path) {
    const pent::FileInfo info = pent::read_info(path);
    switch (info.dimension) {
        case 2:
            return check_file<2>(program, path, info.is_frame);
        case 3:
            return check_file<3>(program, path, info.is_frame);
        default:
            return check_file<4>(program, path, info.is_frame);
    }
}

void check_or_prove(Program& program, const std::filesystem::path& path) {
    if (path.empty()) {
        prove_tables(program);
        prove_stuffing_tables(program);
        prove_halving_tables(program);
    } else {
        check_file(program, path);
    }
}

}  // namespace

// NOLINTNEXTLINE(bugprone-exception-escape): an option that excludes one that is there
int main(int argc, char** argv) {
    Program program(
        "pent-check",
        "Validates a .pent file. Without one it proves, by trying all cases, that prisms "
        "and the simplices of shapes are cut so that neighbors fit together.",
        "pent-check octopus.pent");
    std::filesystem::path path;
    bool eigen = false;
    CLI::Option* file = program.options()
                            .add_option("file", path, "A mesh or frame to validate")
                            ->type_name("FILE");
    program.options()
        .add_flag("--eigen", eigen,
                  "Prove the eigensystems of the elastic energies, in dimensions 2 to 100")
        ->excludes(file);
    return program.run(argc, argv, [&] {
        program.require_apart({{"the input", path}}, {});
        if (eigen) {
            prove_eigensystems(program);  // GCOVR_EXCL_LINE: takes longer than a test may
        } else {
            check_or_prove(program, path);
        }
        return pent::apps::Verdict::Finished;
    });
}

// SPDX-License-Identifier: GPL-3.0-or-later

#include "mesh_text.h"

#include <pent/counted.h>
#include <pent/formatted.h>
#include <pent/mesher/quantity_names.h>

#include <vector>

namespace pent::apps {

namespace {

nlohmann::ordered_json to_json(const mesher::Spread& spread) {
    return {{"min", spread.min},           {"p1", spread.percentile_1},
            {"p5", spread.percentile_5},   {"median", spread.median},
            {"mean", spread.mean},         {"p95", spread.percentile_95},
            {"p99", spread.percentile_99}, {"max", spread.max}};
}

}  // namespace

template <int Dim>
std::string box_line(const Positions<Dim>& positions) {
    const Eigen::Matrix<double, Dim, 1> low = positions.rowwise().minCoeff();
    const Eigen::Matrix<double, Dim, 1> high = positions.rowwise().maxCoeff();
    std::string line = "box       ";
    for (int axis = 0; axis < Dim; ++axis) {
        line += formatted("%s %c %.6g to %.6g", axis == 0 ? "" : ",", "xyzw"[axis], low[axis],
                          high[axis]);
    }
    return line + " m";
}

template <int Dim>
nlohmann::ordered_json box_json(const Positions<Dim>& positions) {
    const Eigen::Matrix<double, Dim, 1> low = positions.rowwise().minCoeff();
    const Eigen::Matrix<double, Dim, 1> high = positions.rowwise().maxCoeff();
    return {{"low", std::vector<double>(low.data(), low.data() + Dim)},
            {"high", std::vector<double>(high.data(), high.data() + Dim)}};
}

template std::string box_line<2>(const Positions<2>&);
template std::string box_line<3>(const Positions<3>&);
template std::string box_line<4>(const Positions<4>&);
template nlohmann::ordered_json box_json<2>(const Positions<2>&);
template nlohmann::ordered_json box_json<3>(const Positions<3>&);
template nlohmann::ordered_json box_json<4>(const Positions<4>&);

template <int Dim>
std::string carried_names(const SimplexMesh<Dim>& mesh, const MeshExtras<Dim>& extras) {
    std::string names;
    for (const std::string& name : mesher::quantity_names(mesh, extras)) {
        names += (names.empty() ? "" : ", ") + name;
    }
    return names;
}

template std::string carried_names<3>(const SimplexMesh<3>&, const MeshExtras<3>&);
template std::string carried_names<4>(const SimplexMesh<4>&, const MeshExtras<4>&);

std::string size_text(std::int64_t vertices, std::int64_t cells, int dim) {
    return counted(vertices, "vertex", "vertices") + ", "
           + counted(cells, cell_name(dim), cell_name_plural(dim));
}

std::string proof_line(std::int64_t inner, std::int64_t boundary) {
    return "proved     " + counted(inner, "inner facet matches", "inner facets match")
           + ", boundary of " + counted(boundary, "facet", "facets") + " closed";
}

std::string straight_line(std::int64_t cells) {
    return "straight   " + counted(cells, "cell", "cells")
           + " of higher order, by their corners alone";
}

std::string quality_line(const mesher::QualityReport& report) {
    return formatted("mean ratio min %.3f mean %.3f, condition of Dm mean %.3g max %.3g",
                     report.mean_ratio.min, report.mean_ratio.mean, report.condition.mean,
                     report.condition.max);
}

nlohmann::ordered_json to_json(const mesher::QualityReport& report) {
    return {{"mean_ratio", to_json(report.mean_ratio)},
            {"condition", to_json(report.condition)},
            {"smallest_angle_degrees", to_json(report.smallest_angle)},
            {"largest_angle_degrees", to_json(report.largest_angle)},
            {"histogram", report.histogram},
            {"worst_cells", report.worst_cells}};
}

}  // namespace pent::apps

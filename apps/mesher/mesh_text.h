#pragma once

#include <pent/mesher/quality.h>
#include <pent/pent_file.h>
#include <pent/simplex_mesh.h>

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

namespace pent::apps {

/// "box        x -1 to 1, y 0 to 2, z 0 to 1 m": the box around all vertices.
template <int Dim>
[[nodiscard]] std::string box_line(const Positions<Dim>& positions);

/// The same, as {"low": [...], "high": [...]}.
template <int Dim>
[[nodiscard]] nlohmann::ordered_json box_json(const Positions<Dim>& positions);

/// "5 vertices, 1 tetrahedron".
[[nodiscard]] std::string size_text(std::int64_t vertices, std::int64_t cells, int dim);

/// "proved     4 inner facets match, boundary of 6 facets closed".
[[nodiscard]] std::string proof_line(std::int64_t inner, std::int64_t boundary);

/// "straight   5 cells of higher order, ...": of how many cells the corners alone were taken.
[[nodiscard]] std::string straight_line(std::int64_t cells);

/// The names of what a body has of its vertices and cells beside regions, with commas; empty if
/// there is nothing.
template <int Dim>
[[nodiscard]] std::string carried_names(const SimplexMesh<Dim>& mesh,
                                        const MeshExtras<Dim>& extras);

/// One line with the figures that matter most.
[[nodiscard]] std::string quality_line(const mesher::QualityReport& report);

[[nodiscard]] nlohmann::ordered_json to_json(const mesher::QualityReport& report);

}  // namespace pent::apps

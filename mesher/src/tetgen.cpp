#include "../tetgen_worker/protocol.h"
#include "generators.h"
#include "isolated.h"
#include "worker_process.h"

#include <pent/error.h>
#include <pent/formatted.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdio>
#include <map>
#include <set>
#include <vector>

namespace pent::mesher {

namespace {

struct Answer {
    Positions<3> points;
    Simplices<4> tets;
    std::vector<double> regions;  // one a tet
};

// TetGen's switches, see its manual. p: fill a surface; q: bound circumradius over shortest edge;
// Y: keep the surface's triangles; a: bound the volume of tetrahedra.
std::string switches(const TetrahedraOptions& options) {
    std::string text = "pq" + formatted("%.6g", options.radius_edge_ratio);
    if (options.keep_surface) {
        text += "Y";
    }
    if (options.edge_length > 0) {
        text += "a" + formatted("%.6g", std::pow(options.edge_length, 3) / (6 * std::sqrt(2.0)));
    }
    return text;
}

std::string explain(const ProcessResult& result, const TetrahedraOptions& options) {
    using namespace pent::tetgen;
    if (result.signal != 0) {
        return explain_signal(result.signal, options.limits);
    }
    switch (result.exit_code) {
        case kOutOfMemory:
        case kTetgenThrew + 1:
            return explain_out_of_memory(options.limits);
        case kTetgenThrew + 2:
            return "met an internal error of TetGen";
        case kTetgenThrew + 3:
            return "found that the surface intersects itself";
        case kTetgenThrew + 4:
            return "found a feature too small for double precision";
        case kTetgenThrew + 5:
            return "found two facets too close to each other";
        case kTetgenThrew + 10:
            return "refused the surface";
        case kCannotWrite:
            return "cannot write its answer; make room in the folder for temporary files";
        default:
            return "failed with code " + std::to_string(result.exit_code);
    }
}

template <typename T>
bool write_block(std::FILE* file, const T* data, Eigen::Index count) {
    return std::fwrite(data, sizeof(T), static_cast<std::size_t>(count), file)
           == static_cast<std::size_t>(count);
}

template <typename T>
bool read_block(std::FILE* file, T* data, Eigen::Index count) {
    return std::fread(data, sizeof(T), static_cast<std::size_t>(count), file)
           == static_cast<std::size_t>(count);
}

void write_request(std::FILE* file, const Surface& surface) {
    const tetgen::Header header{tetgen::kRequestTag,
                                static_cast<std::uint32_t>(surface.point_count()),
                                static_cast<std::uint32_t>(surface.triangle_count())};
    if (!write_block(file, &header, 1)
        || !write_block(file, surface.points.data(), surface.points.size())
        || !write_block(file, surface.triangles.data(), surface.triangles.size())
        || std::fflush(file) != 0) {
        throw Error("cannot write a temporary file; make room in the folder for temporary files");
    }
    std::rewind(file);
}

Answer read_answer(std::FILE* file) {
    std::rewind(file);
    tetgen::Header header;
    Answer answer;
    bool is_whole = read_block(file, &header, 1) && header.tag == tetgen::kAnswerTag;
    if (is_whole) {
        answer.points.resize(3, header.points);
        answer.tets.resize(4, header.cells);
        answer.regions.resize(header.cells);
        is_whole = read_block(file, answer.points.data(), answer.points.size())
                   && read_block(file, answer.tets.data(), answer.tets.size())
                   && read_block(file, answer.regions.data(), header.cells);
    }
    if (!is_whole) {
        throw Error("pent-tetgen: its answer cannot be read; is it of this version?");
    }
    return answer;
}

double volume(const Answer& answer, Eigen::Index tet) {
    return cell_volume<3>(answer.points, answer.tets, tet);
}

// A facet of a tet; its corners ascend.
struct Facet {
    std::array<std::uint32_t, 3> corners;
    Eigen::Index tet;
};

// Facets of two tets follow one another.
std::vector<Facet> sorted_facets(const Simplices<4>& tets) {
    std::vector<Facet> facets;
    facets.reserve(static_cast<std::size_t>(4 * tets.cols()));
    for (Eigen::Index tet = 0; tet < tets.cols(); ++tet) {
        for (int k = 0; k < 4; ++k) {
            Facet facet{{tets((k + 1) % 4, tet), tets((k + 2) % 4, tet), tets((k + 3) % 4, tet)},
                        tet};
            std::sort(facet.corners.begin(), facet.corners.end());
            facets.push_back(facet);
        }
    }
    std::sort(facets.begin(), facets.end(),
              [](const Facet& a, const Facet& b) { return a.corners < b.corners; });
    return facets;
}

// TetGen fills cavities, too, as regions of their own. Only the surface divides regions from one
// another and from the outside, and whoever crosses it enters the body or leaves it: regions at the
// outside are in the body, their neighbors are not, the neighbors of these are again, and so on.
std::map<double, bool> regions_inside(const Answer& answer) {
    const std::set<double> regions(answer.regions.begin(), answer.regions.end());
    if (regions.size() == 1) {
        return {{*regions.begin(), true}};
    }
    std::map<double, bool> inside;
    std::map<double, std::set<double>> behind;
    const std::vector<Facet> facets = sorted_facets(answer.tets);
    for (std::size_t i = 0; i < facets.size(); ++i) {
        const double region = answer.regions[facets[i].tet];
        if (i + 1 == facets.size() || facets[i].corners != facets[i + 1].corners) {
            inside[region] = true;  // there is no tet behind this facet
            continue;
        }
        ++i;
        if (const double other = answer.regions[facets[i].tet]; other != region) {
            behind[region].insert(other);
            behind[other].insert(region);
        }
    }
    std::vector<double> open;
    for (const auto& [region, is_inside] : inside) {
        open.push_back(region);
    }
    while (!open.empty()) {
        const double region = open.back();
        open.pop_back();
        for (const double other : behind[region]) {
            if (inside.try_emplace(other, !inside.at(region)).second) {
                open.push_back(other);
            }
        }
    }
    return inside;
}

// The tets in the body, positively oriented; points only cavities use are left out.
SimplexMesh<3> body(const Answer& answer) {
    const std::map<double, bool> inside = regions_inside(answer);
    std::vector<Eigen::Index> kept;
    std::vector<std::uint32_t> vertex_of(answer.points.cols(), 0);  // at first whether it has one
    for (Eigen::Index t = 0; t < answer.tets.cols(); ++t) {
        if (inside.at(answer.regions[t])) {
            kept.push_back(t);
            for (int i = 0; i < 4; ++i) {
                vertex_of[answer.tets(i, t)] = 1;
            }
        }
    }
    SimplexMesh<3> mesh;
    std::uint32_t points = 0;
    for (std::uint32_t& entry : vertex_of) {
        points += entry;
        entry = points - entry;  // how many points that are kept come before
    }
    mesh.positions.resize(3, points);
    mesh.cells.resize(4, static_cast<Eigen::Index>(kept.size()));
    for (std::size_t i = 0; i < kept.size(); ++i) {
        for (int corner = 0; corner < 4; ++corner) {
            const std::uint32_t old = answer.tets(corner, kept[i]);
            mesh.cells(corner, static_cast<Eigen::Index>(i)) = vertex_of[old];
            mesh.positions.col(vertex_of[old]) = answer.points.col(old);
        }
        if (volume(answer, kept[i]) < 0) {
            std::swap(mesh.cells(2, static_cast<Eigen::Index>(i)),
                      mesh.cells(3, static_cast<Eigen::Index>(i)));
        }
    }
    return mesh;
}

}  // namespace

Tetrahedra fill_with_tetgen(const Surface& surface, const TetrahedraOptions& options) {
    const std::filesystem::path worker =
        options.worker.empty() ? find_helper("pent-tetgen") : options.worker;
    const File request = temporary_file();
    const File reply = temporary_file();
    write_request(request.get(), surface);
    const std::string wanted = switches(options);
    // A: number the regions; Q: quiet; S: bound the number of added points.
    const ProcessResult result = run_process(
        worker,
        {wanted + "AQS" + std::to_string(options.max_added_points),
         std::to_string(options.limits.memory_mib), std::to_string(whole_seconds(options.limits))},
        request.get(), reply.get());
    if (result.signal != 0 || result.exit_code != tetgen::kDone) {
        throw Error("TetGen " + wanted + " " + explain(result, options));
    }
    Tetrahedra tetrahedra;
    tetrahedra.mesh = body(read_answer(reply.get()));
    tetrahedra.generator = "TetGen " + wanted;
    return tetrahedra;
}

}  // namespace pent::mesher

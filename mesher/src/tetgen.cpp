#include "../tetgen_worker/protocol.h"
#include "generators.h"
#include "isolated.h"
#include "worker_process.h"

#include <pent/error.h>
#include <pent/formatted.h>
#include <pent/mesher/orient.h>

#include <cassert>
#include <cmath>
#include <cstdio>
#include <map>
#include <vector>

namespace pent::mesher {

namespace {

struct Answer {
    Positions<3> points;
    Simplices<4> tets;
    std::vector<double> regions;  // one a tet
};

// p: a surface; A: number the regions; Q: quiet; see TetGen's manual.
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

// TetGen fills cavities too, as regions of their own. The largest tet of each region tells whether
// the region is in the body.
std::map<double, bool> regions_inside(const Answer& answer, const Surface& surface) {
    std::map<double, Eigen::Index> largest;
    for (Eigen::Index t = 0; t < answer.tets.cols(); ++t) {
        const auto [place, is_new] = largest.try_emplace(answer.regions[t], t);
        if (!is_new && std::abs(volume(answer, t)) > std::abs(volume(answer, place->second))) {
            place->second = t;
        }
    }
    std::map<double, bool> inside;
    for (const auto& [region, tet] : largest) {
        Eigen::Vector3d center = Eigen::Vector3d::Zero();
        for (int i = 0; i < 4; ++i) {
            center += answer.points.col(answer.tets(i, tet)) / 4;
        }
        inside[region] = winding_number(surface, center) > 0.5;
    }
    return inside;
}

// The tets in the body, positively oriented; points only cavities use are left out.
SimplexMesh<3> body(const Answer& answer, const Surface& surface) {
    const std::map<double, bool> inside = regions_inside(answer, surface);
    std::vector<Eigen::Index> kept;
    std::vector<std::uint32_t> name(answer.points.cols(), 0);
    for (Eigen::Index t = 0; t < answer.tets.cols(); ++t) {
        if (inside.at(answer.regions[t])) {
            kept.push_back(t);
            for (int i = 0; i < 4; ++i) {
                name[answer.tets(i, t)] = 1;
            }
        }
    }
    SimplexMesh<3> mesh;
    std::uint32_t points = 0;
    for (std::uint32_t& entry : name) {
        points += entry;
        entry = points - entry;  // how many kept ones come before
    }
    mesh.positions.resize(3, points);
    mesh.cells.resize(4, static_cast<Eigen::Index>(kept.size()));
    for (std::size_t i = 0; i < kept.size(); ++i) {
        for (int corner = 0; corner < 4; ++corner) {
            const std::uint32_t old = answer.tets(corner, kept[i]);
            mesh.cells(corner, static_cast<Eigen::Index>(i)) = name[old];
            mesh.positions.col(name[old]) = answer.points.col(old);
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
    const ProcessResult result = run_process(
        worker,
        {wanted + "AQS" + std::to_string(options.max_added_points),
         std::to_string(options.limits.memory_mib), std::to_string(whole_seconds(options.limits))},
        request.get(), reply.get());
    if (result.signal != 0 || result.exit_code != tetgen::kDone) {
        throw Error("TetGen " + wanted + " " + explain(result, options));
    }
    Tetrahedra tetrahedra;
    tetrahedra.mesh = body(read_answer(reply.get()), surface);
    tetrahedra.generator = "TetGen " + wanted;
    return tetrahedra;
}

}  // namespace pent::mesher

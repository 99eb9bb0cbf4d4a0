#include "pent/viewer/attributes.h"

#include <pent/geometry.h>
#include <pent/parallel.h>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <vector>

namespace pent::viewer {

namespace {

template <int Dim>
using Vector = Eigen::Matrix<double, Dim, 1>;

template <int Dim>
using Square = Eigen::Matrix<double, Dim, Dim>;

// Outward normals of facets, as long as the facets are large, and how long these are.
template <int Dim>
struct FacetNormals {
    Eigen::Matrix<double, Dim, Eigen::Dynamic> normals;
    Eigen::VectorXd lengths;
};

template <int Dim>
FacetNormals<Dim> facet_normals(const Boundary<Dim>& boundary, const Positions<Dim>& positions) {
    FacetNormals<Dim> all;
    all.normals.resize(Dim, boundary.facets.cols());
    all.lengths.resize(boundary.facets.cols());
    parallel_for(boundary.facets.cols(), kLightChunk, [&](Eigen::Index f) {
        Square<Dim> corners;
        for (int k = 0; k < Dim; ++k) {
            corners.col(k) = positions.col(boundary.facets(k, f));
        }
        all.normals.col(f) = facet_normal<Dim>(corners);
        all.lengths[f] = all.normals.col(f).norm();
    });
    return all;
}

// Unit normals at vertices as a facet sees them: the sums over those facets around a vertex that
// are within the crease angle of it. The triangles of a facet ask for few of them many times.
template <int Dim>
class SmoothNormals {
public:
    SmoothNormals(const Boundary<Dim>& boundary,
                  const FacetNormals<Dim>& all,
                  std::uint32_t facet,
                  double crease_cosine)
        : boundary_(boundary), all_(all), facet_(facet), crease_cosine_(crease_cosine) {}

    Vector<Dim> at(std::uint32_t vertex) {
        const std::size_t known = std::min(asked_, vertices_.size());
        for (std::size_t i = 0; i < known; ++i) {
            if (vertices_[i] == vertex) {
                return normals_[i];
            }
        }
        const std::size_t place = asked_++ % vertices_.size();
        vertices_[place] = vertex;
        normals_[place] = sum_at(vertex).stableNormalized();
        return normals_[place];
    }

private:
    Vector<Dim> sum_at(std::uint32_t vertex) const {
        const auto own = all_.normals.col(facet_);
        const double least = crease_cosine_ * all_.lengths[facet_];
        Vector<Dim> sum = Vector<Dim>::Zero();
        for (std::uint32_t i = boundary_.vertex_begin[vertex];
             i < boundary_.vertex_begin[vertex + 1]; ++i) {
            const std::uint32_t facet = boundary_.vertex_facets[i];
            const auto other = all_.normals.col(facet);
            if (other.dot(own) >= least * all_.lengths[facet]) {
                sum += other;
            }
        }
        return sum;
    }

    const Boundary<Dim>& boundary_;
    const FacetNormals<Dim>& all_;
    std::uint32_t facet_;
    double crease_cosine_;
    std::array<std::uint32_t, 8> vertices_{};
    std::array<Vector<Dim>, 8> normals_;
    std::size_t asked_ = 0;
};

// Where triangles of another facet begin, and behind the last.
std::vector<Eigen::Index> begin_of_facets(const std::vector<std::uint32_t>& facets) {
    std::vector<Eigen::Index> begin;
    for (std::size_t t = 0; t < facets.size(); ++t) {
        if (t == 0 || facets[t] != facets[t - 1]) {
            begin.push_back(static_cast<Eigen::Index>(t));
        }
    }
    begin.push_back(static_cast<Eigen::Index>(facets.size()));
    return begin;
}

}  // namespace

template <int Dim>
Eigen::VectorXd vertex_speed(const Frame<Dim>& frame) {
    if (frame.velocities.cols() == 0) {
        return Eigen::VectorXd::Zero(frame.positions.cols());
    }
    return lengths(frame.velocities);
}

template <int Dim>
Eigen::VectorXd vertex_force(const Frame<Dim>& frame) {
    return lengths(frame.contact_forces);
}

template <int Dim>
Eigen::VectorXd vertex_strain(const SimplexMesh<Dim>& rest, const Positions<Dim>& positions) {
    // Coordinates of a motion in closed form are a few roundings off, and each edge has two ends.
    const double farthest =
        std::max(rest.positions.cwiseAbs().maxCoeff(), positions.cwiseAbs().maxCoeff());
    const double rounding = 16 * std::numeric_limits<double>::epsilon() * farthest;
    Eigen::MatrixXd strains(1, rest.cell_count());
    parallel_for(rest.cell_count(), kLightChunk, [&](Eigen::Index c) {
        const Square<Dim> at_rest = edge_matrix<Dim>(rest.positions, rest.cells, c);
        const Square<Dim> inverse = at_rest.inverse();
        const Square<Dim> F = edge_matrix<Dim>(positions, rest.cells, c) * inverse;
        const double strain = (F.transpose() * F - Square<Dim>::Identity()).norm() / 2;
        strains(0, c) = strain > rounding * inverse.norm() ? strain : 0;
    });
    return vertex_means(rest, strains).transpose();
}

template <int Dim>
Eigen::MatrixXd vertex_means(const SimplexMesh<Dim>& mesh, const Eigen::MatrixXd& values) {
    Eigen::VectorXd volumes(mesh.cell_count());
    parallel_for(mesh.cell_count(), kLightChunk, [&](Eigen::Index c) {
        volumes[c] = std::abs(edge_matrix<Dim>(mesh.positions, mesh.cells, c).determinant());
    });
    Eigen::MatrixXd means = Eigen::MatrixXd::Zero(values.rows(), mesh.vertex_count());
    Eigen::VectorXd weight = Eigen::VectorXd::Zero(mesh.vertex_count());
    for (Eigen::Index c = 0; c < mesh.cell_count(); ++c) {
        for (int k = 0; k <= Dim; ++k) {
            means.col(mesh.cells(k, c)) += volumes[c] * values.col(c);
            weight[mesh.cells(k, c)] += volumes[c];
        }
    }
    for (Eigen::Index v = 0; v < mesh.vertex_count(); ++v) {
        if (weight[v] > 0) {
            means.col(v) /= weight[v];
        }
    }
    return means;
}

template <int Dim>
Eigen::VectorXd vertex_w(const Positions<Dim>& positions) {
    if constexpr (Dim == 4) {
        return positions.row(3).transpose();
    } else {
        return Eigen::VectorXd::Zero(positions.cols());
    }
}

template <int Dim>
Positions<3> corner_normals(const Surface& surface,
                            const Boundary<Dim>& boundary,
                            const Positions<Dim>& positions,
                            const Eigen::Matrix<double, 3, Dim>& axes,
                            double crease) {
    const FacetNormals<Dim> all = facet_normals(boundary, positions);
    const std::vector<Eigen::Index> begin = begin_of_facets(surface.facets);
    const double crease_cosine = std::cos(crease);
    Positions<3> result(3, 3 * surface.triangle_count());
    const auto shade = [&](Eigen::Index t, SmoothNormals<Dim>& smooth) {
        const Eigen::Vector3<std::uint32_t> triangle = surface.triangles.col(t);
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t v = triangle[k];
            const double s = surface.weights[v];
            const Eigen::Vector3d seen =
                axes
                * ((1.0 - s) * smooth.at(surface.ends(0, v)) + s * smooth.at(surface.ends(1, v)));
            result.col(3 * t + k) = seen.stableNormalized();
        }
        const Eigen::Vector3d p = surface.positions.col(triangle[0]);
        const Eigen::Vector3d flat = (surface.positions.col(triangle[1]) - p)
                                         .cross(surface.positions.col(triangle[2]) - p)
                                         .stableNormalized();
        for (int k = 0; k < 3; ++k) {
            if (result.col(3 * t + k).dot(flat) <= 0) {  // vanished, or turned away by a deep fold
                result.col(3 * t + k) = flat;
            }
        }
    };
    const auto facets = static_cast<Eigen::Index>(begin.size()) - 1;
    parallel_for(facets, kLightChunk, [&](Eigen::Index i) {
        const auto at = static_cast<std::size_t>(i);
        SmoothNormals<Dim> smooth(
            boundary, all, surface.facets[static_cast<std::size_t>(begin[at])], crease_cosine);
        for (Eigen::Index t = begin[at]; t < begin[at + 1]; ++t) {
            shade(t, smooth);
        }
    });
    return result;
}

Positions<3> corner_normals(const TriangleMesh& mesh, double crease) {
    Surface surface;
    surface.positions = mesh.positions;
    surface.triangles = mesh.triangles;
    surface.ends.resize(2, mesh.vertex_count());
    for (Eigen::Index v = 0; v < mesh.vertex_count(); ++v) {
        surface.ends.col(v).setConstant(static_cast<std::uint32_t>(v));
    }
    surface.weights.setZero(mesh.vertex_count());
    surface.facets.resize(static_cast<std::size_t>(mesh.triangle_count()));
    std::iota(surface.facets.begin(), surface.facets.end(), 0U);
    return corner_normals<3>(surface, index_boundary<3>(mesh.triangles, mesh.vertex_count()),
                             mesh.positions, Eigen::Matrix3d::Identity(), crease);
}

template Eigen::VectorXd vertex_speed<3>(const Frame<3>& frame);
template Eigen::VectorXd vertex_speed<4>(const Frame<4>& frame);
template Eigen::VectorXd vertex_force<3>(const Frame<3>& frame);
template Eigen::VectorXd vertex_force<4>(const Frame<4>& frame);
template Eigen::VectorXd vertex_strain<3>(const SimplexMesh<3>&, const Positions<3>&);
template Eigen::VectorXd vertex_strain<4>(const SimplexMesh<4>&, const Positions<4>&);
template Eigen::MatrixXd vertex_means<3>(const SimplexMesh<3>&, const Eigen::MatrixXd&);
template Eigen::MatrixXd vertex_means<4>(const SimplexMesh<4>&, const Eigen::MatrixXd&);
template Eigen::VectorXd vertex_w<3>(const Positions<3>& positions);
template Eigen::VectorXd vertex_w<4>(const Positions<4>& positions);
template Positions<3> corner_normals<3>(const Surface&,
                                        const Boundary<3>&,
                                        const Positions<3>&,
                                        const Eigen::Matrix<double, 3, 3>&,
                                        double);
template Positions<3> corner_normals<4>(const Surface&,
                                        const Boundary<4>&,
                                        const Positions<4>&,
                                        const Eigen::Matrix<double, 3, 4>&,
                                        double);

}  // namespace pent::viewer

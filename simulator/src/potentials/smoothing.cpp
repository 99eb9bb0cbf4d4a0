#include "potentials/smoothing.h"

#include <pent/dimensions.h>
#include <pent/geometry.h>

#include <Eigen/LU>

#include <algorithm>

namespace pent::simulator {

namespace {

template <int Dim>
constexpr int kEdges = Dim*(Dim + 1) / 2;

// A cell at one of its edges.
struct Side {
    std::uint32_t low;
    std::uint32_t high;
    Eigen::Index cell;

    [[nodiscard]] bool is_at_edge_of(const Side& other) const {
        return low == other.low && high == other.high;
    }
    bool operator<(const Side& other) const {
        if (low != other.low) {
            return low < other.low;
        }
        return high != other.high ? high < other.high : cell < other.cell;
    }
};

template <int Dim>
std::vector<Side> sorted_sides(const Simplices<Dim + 1>& cells,
                               Eigen::Index begin,
                               Eigen::Index end) {
    std::vector<Side> sides;
    sides.reserve(static_cast<std::size_t>((end - begin) * kEdges<Dim>));
    for (Eigen::Index cell = begin; cell < end; ++cell) {
        for (int a = 0; a <= Dim; ++a) {
            for (int b = a + 1; b <= Dim; ++b) {
                const auto [low, high] = std::minmax(cells(a, cell), cells(b, cell));
                sides.push_back({low, high, cell});
            }
        }
    }
    std::sort(sides.begin(), sides.end());
    return sides;
}

// Gradients at rest of the shape functions of a cell, a column each, times its volume.
template <int Dim>
struct WeighedCell {
    Eigen::Matrix<double, Dim, Dim + 1> gradients;
    double volume;

    WeighedCell(const Positions<Dim>& rest, const Simplices<Dim + 1>& cells, Eigen::Index cell)
        : volume(cell_volume<Dim>(rest, cells, cell)) {
        gradients.template rightCols<Dim>() =
            volume * edge_matrix<Dim>(rest, cells, cell).inverse().transpose();
        gradients.col(0) = -gradients.template rightCols<Dim>().rowwise().sum();
    }
};

}  // namespace

template <int Dim>
SmoothingDomains<Dim> smoothing_domains(const Positions<Dim>& rest,
                                        const Simplices<Dim + 1>& cells,
                                        Eigen::Index begin,
                                        Eigen::Index end) {
    using Vector = Eigen::Matrix<double, Dim, 1>;
    std::vector<WeighedCell<Dim>> weighed;
    weighed.reserve(static_cast<std::size_t>(end - begin));
    for (Eigen::Index cell = begin; cell < end; ++cell) {
        weighed.emplace_back(rest, cells, cell);
    }
    const std::vector<Side> sides = sorted_sides<Dim>(cells, begin, end);
    SmoothingDomains<Dim> domains;
    std::vector<Vector> gradients;
    std::vector<std::uint32_t> corners;
    for (auto first = sides.begin(); first != sides.end();) {
        const auto last = std::find_if(
            first, sides.end(), [&](const Side& side) { return !side.is_at_edge_of(*first); });
        corners.clear();
        for (auto side = first; side != last; ++side) {
            corners.insert(corners.end(), cells.col(side->cell).begin(),
                           cells.col(side->cell).end());
        }
        std::sort(corners.begin(), corners.end());
        corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
        const std::size_t at = gradients.size();
        gradients.resize(at + corners.size(), Vector::Zero());
        double volume = 0;
        for (auto side = first; side != last; ++side) {
            const WeighedCell<Dim>& cell = weighed[static_cast<std::size_t>(side->cell - begin)];
            volume += cell.volume;
            for (int a = 0; a <= Dim; ++a) {
                const auto place =
                    std::lower_bound(corners.begin(), corners.end(), cells(a, side->cell));
                gradients[at + static_cast<std::size_t>(place - corners.begin())] +=
                    cell.gradients.col(a);
            }
        }
        for (std::size_t i = at; i < gradients.size(); ++i) {
            gradients[i] /= volume;
        }
        domains.corners.insert(domains.corners.end(), corners.begin(), corners.end());
        domains.start.push_back(static_cast<std::int64_t>(domains.corners.size()));
        domains.volumes.push_back(volume / kEdges<Dim>);
        first = last;
    }
    domains.gradients.resize(Dim, static_cast<Eigen::Index>(gradients.size()));
    for (std::size_t i = 0; i < gradients.size(); ++i) {
        domains.gradients.col(static_cast<Eigen::Index>(i)) = gradients[i];
    }
    return domains;
}

#define PENT_INSTANTIATE(Dim)                         \
    template SmoothingDomains<Dim> smoothing_domains( \
        const Positions<Dim>&, const Simplices<Dim + 1>&, Eigen::Index, Eigen::Index);
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator

#include <pent/mesher/edge_order.h>
#include <pent/mesher/quality.h>

#include <algorithm>
#include <array>
#include <numeric>

namespace pent::mesher {

namespace {

// Ranks with room between them: a vertex moves by taking a number between two of its neighbors.
using Ranks = std::vector<double>;

template <int Dim>
class Improvement {
public:
    Improvement(const SimplexMesh<Dim>& mesh,
                const std::vector<std::uint32_t>& ranks,
                const Eigen::Matrix<double, Dim + 1, 1>& slab)
        : mesh_(mesh), slab_(slab), ranks_(ranks.begin(), ranks.end()), cells_of_(ranks.size()) {
        for (std::uint32_t cell = 0; cell < mesh.cell_count(); ++cell) {
            for (int i = 0; i <= Dim; ++i) {
                cells_of_[mesh.cells(i, cell)].push_back(cell);
            }
        }
    }

    // Whether any vertex moved.
    bool sweep() {
        std::vector<double> worst(ranks_.size());
        for (std::uint32_t v = 0; v < ranks_.size(); ++v) {
            worst[v] = worst_around(v);
        }
        std::vector<std::uint32_t> order(ranks_.size());
        std::iota(order.begin(), order.end(), 0U);
        std::stable_sort(order.begin(), order.end(),
                         [&](std::uint32_t a, std::uint32_t b) { return worst[a] < worst[b]; });
        bool is_moved = false;
        for (const std::uint32_t v : order) {
            is_moved = move(v) || is_moved;
        }
        renumber();
        return is_moved;
    }

    [[nodiscard]] std::vector<std::uint32_t> ranks() const {
        return {ranks_.begin(), ranks_.end()};
    }

private:
    // The lowest mean ratio among the simplices of the prism over a cell.
    [[nodiscard]] double worst_in(std::uint32_t cell) const {
        std::array<std::uint32_t, Dim + 1> order{};
        std::copy_n(mesh_.cells.col(cell).data(), Dim + 1, order.begin());
        std::sort(order.begin(), order.end(),
                  [&](std::uint32_t a, std::uint32_t b) { return ranks_[a] < ranks_[b]; });
        double worst = 1;
        for (int k = 0; k <= Dim; ++k) {
            Eigen::Matrix<double, Dim + 1, Dim + 2> corners;
            corners.setZero();
            for (int i = 0; i <= k; ++i) {
                corners.col(i).template head<Dim>() = mesh_.positions.col(order[i]);
            }
            for (int i = k; i <= Dim; ++i) {
                corners.col(i + 1).template head<Dim>() = mesh_.positions.col(order[i]);
                corners.col(i + 1) += slab_;
            }
            if (simplex_volume<Dim + 1>(corners) < 0) {
                corners.col(0).swap(corners.col(1));
            }
            worst = std::min(worst, mean_ratio<Dim + 1>(corners));
        }
        return worst;
    }

    [[nodiscard]] double worst_around(std::uint32_t v) const {
        double worst = 1;
        for (const std::uint32_t cell : cells_of_[v]) {
            worst = std::min(worst, worst_in(cell));
        }
        return worst;
    }

    // Ranks of the neighbors of a vertex, ascending.
    [[nodiscard]] std::vector<double> ranks_around(std::uint32_t v) const {
        std::vector<double> ranks;
        for (const std::uint32_t cell : cells_of_[v]) {
            for (int i = 0; i <= Dim; ++i) {
                if (mesh_.cells(i, cell) != v) {
                    ranks.push_back(ranks_[mesh_.cells(i, cell)]);
                }
            }
        }
        std::sort(ranks.begin(), ranks.end());
        ranks.erase(std::unique(ranks.begin(), ranks.end()), ranks.end());
        return ranks;
    }

    bool move(std::uint32_t v) {
        const std::vector<double> around = ranks_around(v);
        if (around.empty()) {
            return false;
        }
        const double before = ranks_[v];
        double best_rank = before;
        double best = worst_around(v);
        const double start = best;
        for (std::size_t i = 0; i <= around.size(); ++i) {
            const double below = i == 0 ? around.front() - 1 : around[i - 1];
            const double above = i == around.size() ? around.back() + 1 : around[i];
            ranks_[v] = (below + above) / 2;
            const double worst = worst_around(v);
            if (worst > best * (1 + 1e-9)) {  // not for rounding alone
                best = worst;
                best_rank = ranks_[v];
            }
        }
        ranks_[v] = best_rank;
        return best > start;
    }

    // Whole numbers again. Vertices of equal rank are no neighbors: their order is free.
    void renumber() {
        std::vector<std::uint32_t> order(ranks_.size());
        std::iota(order.begin(), order.end(), 0U);
        std::stable_sort(order.begin(), order.end(),
                         [&](std::uint32_t a, std::uint32_t b) { return ranks_[a] < ranks_[b]; });
        for (std::size_t i = 0; i < order.size(); ++i) {
            ranks_[order[i]] = static_cast<double>(i);
        }
    }

    const SimplexMesh<Dim>& mesh_;
    Eigen::Matrix<double, Dim + 1, 1> slab_;
    Ranks ranks_;
    std::vector<std::vector<std::uint32_t>> cells_of_;
};

}  // namespace

template <int Dim>
std::vector<std::uint32_t> improve_ranks(const SimplexMesh<Dim>& mesh,
                                         std::vector<std::uint32_t> ranks,
                                         const Eigen::Matrix<double, Dim + 1, 1>& slab,
                                         int sweeps) {
    Improvement<Dim> improvement(mesh, ranks, slab);
    for (int i = 0; i < sweeps && improvement.sweep(); ++i) {
    }
    return improvement.ranks();
}

template std::vector<std::uint32_t> improve_ranks<2>(const SimplexMesh<2>&,
                                                     std::vector<std::uint32_t>,
                                                     const Eigen::Matrix<double, 3, 1>&,
                                                     int);
template std::vector<std::uint32_t> improve_ranks<3>(const SimplexMesh<3>&,
                                                     std::vector<std::uint32_t>,
                                                     const Eigen::Matrix<double, 4, 1>&,
                                                     int);

}  // namespace pent::mesher

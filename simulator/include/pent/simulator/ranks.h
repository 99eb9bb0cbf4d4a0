#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace pent::simulator {

/// Processes that take the steps of one scene together, each with elements and rows of its own.
///
/// What follows is all that the simulator needs of a message-passing library. Every method is
/// collective: all ranks call it, in the same order, with matching arguments, and wait for one
/// another. Results that do not depend on the rank are the same to the bit on all of them, so that
/// all take the same branches. A program on its own has no ranks.

/// Halo exchange: copies columns of an array from the ranks that own them to the ghosts that others
/// have of them.
class GhostExchange {
public:
    GhostExchange() = default;
    virtual ~GhostExchange() = default;
    GhostExchange(const GhostExchange&) = delete;
    GhostExchange& operator=(const GhostExchange&) = delete;
    GhostExchange(GhostExchange&&) = delete;
    GhostExchange& operator=(GhostExchange&&) = delete;

    /// @param values  Column-major, `rows` numbers a column.
    virtual void update(double* values, int rows) = 0;
    virtual void update(float* values, int rows) = 0;
};

/// The ghosts of a rank, in columns of an array: one entry a ghost.
struct Ghosts {
    std::uint32_t own_columns = 0;       ///< Columns of this rank, which come first.
    std::vector<std::uint32_t> columns;  ///< The column of the ghost on this rank.
    std::vector<std::uint32_t> owners;   ///< The rank that owns it, another than this one.
    std::vector<std::uint32_t> places;   ///< Its column on that rank.
};

/// A symmetric positive definite matrix of square blocks, its rows spread over the ranks: those of
/// rank 0 first, then those of rank 1 and so on.
struct SpreadMatrix {
    int block_size = 0;
    std::int64_t first_row = 0;           ///< Number of the first block row of this rank.
    std::vector<std::int64_t> row_start;  ///< Of block rows: rows of this rank + 1 entries.
    std::vector<std::int64_t> columns;    ///< Counted over all ranks, increasing within a row.
    std::vector<double> values;           ///< Block after block, each row-major.
    /// Near null space: a column for each motion that costs next to no energy, in the rows of this
    /// rank. They may be linearly dependent, for a body that is thin or small.
    Eigen::MatrixXd near_kernel;

    [[nodiscard]] std::int64_t rows() const {
        return static_cast<std::int64_t>(row_start.size()) - 1;
    }
};

/// z = B r with B near A^-1 for a spread matrix; B is linear, symmetric and positive definite.
class SpreadSolver {
public:
    SpreadSolver() = default;
    virtual ~SpreadSolver() = default;
    SpreadSolver(const SpreadSolver&) = delete;
    SpreadSolver& operator=(const SpreadSolver&) = delete;
    SpreadSolver(SpreadSolver&&) = delete;
    SpreadSolver& operator=(SpreadSolver&&) = delete;

    /// @param r  Rows of this rank. Returns as many.
    [[nodiscard]] virtual Eigen::VectorXd solve(const Eigen::VectorXd& r) = 0;
};

/// What ranks have sent one another since the last Ranks::take_traffic().
struct RankTraffic {
    std::int64_t messages = 0;    ///< Messages from one rank to another, of all ranks.
    std::int64_t bytes = 0;       ///< In these.
    std::int64_t reductions = 0;  ///< Collective operations over all ranks, as sums.
};

class Ranks {
public:
    Ranks() = default;
    virtual ~Ranks() = default;
    Ranks(const Ranks&) = delete;
    Ranks& operator=(const Ranks&) = delete;
    Ranks(Ranks&&) = delete;
    Ranks& operator=(Ranks&&) = delete;

    [[nodiscard]] virtual int count() const = 0;
    [[nodiscard]] virtual int rank() const = 0;  ///< In [0, count()).

    /// The numbers of rank 0, those of rank 1 and so on, one after the other.
    ///
    /// @param sizes  How many each rank gives.
    [[nodiscard]] virtual std::vector<double> gather(std::span<const double> own,
                                                     std::span<const std::int64_t> sizes) const = 0;

    [[nodiscard]] virtual std::unique_ptr<GhostExchange> make_exchange(
        const Ghosts& ghosts) const = 0;

    [[nodiscard]] virtual std::unique_ptr<SpreadSolver> make_solver(
        const SpreadMatrix& matrix) const = 0;

    /// Traffic of all ranks together since the last call.
    [[nodiscard]] virtual RankTraffic take_traffic() const = 0;
};

/// Throws an Error on all ranks unless they give the same checksum: "rank 2 has WHAT than rank 0;
/// ADVICE".
///
/// @param ranks  Null for none.
void refuse_others(const Ranks* ranks,
                   std::uint32_t checksum,
                   const std::string& what,
                   const std::string& advice);

/// Whether it is so on any rank.
[[nodiscard]] bool any(const Ranks& ranks, bool is_so);

/// Does work that may fail on one rank and not on another, as reading and writing files. Where it
/// fails on any rank all throw an Error, that of the first one that failed.
///
/// @param ranks  Null for none: the work is done, and throws what it throws.
void agree(const Ranks* ranks, const std::function<void()>& work);

}  // namespace pent::simulator

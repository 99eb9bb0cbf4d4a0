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
/// What follows is all that the simulator asks of them. Every method is called by all ranks, in the
/// same order, with arguments that belong together; they wait for one another. What does not depend
/// on the rank comes out the same to the bit on all of them, so that all take the same way through
/// the code. A program on its own has no ranks.

/// Copies columns of an array from the ranks that own them to where others have ghosts of them.
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

/// Where the columns of ghosts are: one entry a ghost.
struct Ghosts {
    std::uint32_t own_columns = 0;       ///< Of this rank, in front.
    std::vector<std::uint32_t> columns;  ///< Here.
    std::vector<std::uint32_t> owners;   ///< The rank that owns it, another than this one.
    std::vector<std::uint32_t> places;   ///< Its column there.
};

/// A symmetric positive definite matrix of square blocks, its rows spread over the ranks: those of
/// rank 0 first, then those of rank 1 and so on.
struct SpreadMatrix {
    int block_size = 0;
    std::int64_t first_row = 0;           ///< Blocks in front of those of this rank.
    std::vector<std::int64_t> row_start;  ///< Of block rows: rows of this rank + 1 entries.
    std::vector<std::int64_t> columns;    ///< Counted over all ranks, increasing within a row.
    std::vector<double> values;           ///< Block after block, each by rows.
    /// A column for each motion that costs next to no energy: rows of this rank. Of a body that is
    /// thin or small they may depend on one another.
    Eigen::MatrixXd near_kernel;

    [[nodiscard]] std::int64_t rows() const {
        return static_cast<std::int64_t>(row_start.size()) - 1;
    }
};

/// z near A^-1 r for a spread matrix; linear, symmetric and positive definite in r.
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

/// What ranks have told one another since they were last asked.
struct RankTraffic {
    std::int64_t messages = 0;    ///< Sent from one rank to another, by all.
    std::int64_t bytes = 0;       ///< In these.
    std::int64_t reductions = 0;  ///< Sums and the like over all ranks.
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

    /// Of all ranks together.
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

/// Does some work of this rank alone: reading, writing, anything that may fail on one rank and not
/// on another. Where it fails on any, all throw an Error, that of the first of them.
///
/// @param ranks  Null for none: the work is done, and what it throws comes through.
void agree(const Ranks* ranks, const std::function<void()>& work);

}  // namespace pent::simulator

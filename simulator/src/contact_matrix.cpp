#include "contact_matrix.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <span>

namespace pent::simulator {

namespace {

// Rows are cut into at most this many chunks, each with a table of all columns.
constexpr std::size_t kMostChunks = 64;
constexpr std::size_t kLeastRows = 32;

/// Contacts counted through: those whose Hessian is w_i w_j K, and those that have a whole one.
template <int Dim>
class Terms {
public:
    explicit Terms(const ContactTerms<Dim>& terms) : terms_(terms) {}

    [[nodiscard]] std::size_t size() const { return weighted() + terms_.moving.size(); }
    [[nodiscard]] std::span<const std::uint32_t> vertices(std::size_t which) const {
        if (which >= weighted()) {
            const LocalHessian<Dim>& local = moving(which);
            return {local.vertices.data(), static_cast<std::size_t>(local.count)};
        }
        return contact(which).vertices;
    }
    [[nodiscard]] bool is_weighted(std::size_t which) const { return which < weighted(); }
    [[nodiscard]] const contact::Contact<Dim>& contact(std::size_t which) const {
        const auto& pairs = terms_.state.pairs;
        const std::size_t plain = terms_.moving.empty() ? pairs.size() : 0;
        return which < plain ? pairs[which] : terms_.state.friction.pairs[which - plain];
    }
    [[nodiscard]] const LocalHessian<Dim>& moving(std::size_t which) const {
        return terms_.moving[which - weighted()];
    }

private:
    [[nodiscard]] std::size_t weighted() const {
        return (terms_.moving.empty() ? terms_.state.pairs.size() : 0)
               + terms_.state.friction.pairs.size();
    }

    const ContactTerms<Dim>& terms_;
};

/// Corner `corner` of contact `contact` is at a row.
struct Incidence {
    std::uint32_t contact = 0;
    std::uint32_t corner = 0;
};

/// The rows that have contacts, ascending, and those of each in the order of the contacts.
struct Incidences {
    std::vector<std::uint32_t> rows;
    std::vector<std::uint32_t> begin;  // rows.size() + 1 entries
    std::vector<Incidence> list;
};

template <int Dim>
Incidences list_by_rows(const Numbering& numbering, const Terms<Dim>& contacts) {
    std::vector<std::uint32_t> next(numbering.free_count() + std::size_t{1}, 0);
    const auto for_each = [&](const auto& visit) {
        for (std::uint32_t c = 0; c < contacts.size(); ++c) {
            const std::span<const std::uint32_t> vertices = contacts.vertices(c);
            for (std::uint32_t i = 0; i < vertices.size(); ++i) {
                if (vertices[i] == contact::kFixedPoint) {
                    continue;
                }
                const std::uint32_t row = numbering.unknown_of_vertex[vertices[i]];
                if (row < numbering.free_count()) {
                    visit(row, Incidence{c, i});
                }
            }
        }
    };
    for_each([&](std::uint32_t row, const Incidence& /*at*/) { ++next[row + 1]; });
    Incidences incidences;
    for (std::uint32_t row = 0; row < numbering.free_count(); ++row) {
        if (next[row + 1] > 0) {
            incidences.rows.push_back(row);
            incidences.begin.push_back(next[row]);
        }
        next[row + 1] += next[row];
    }
    incidences.begin.push_back(next.back());
    incidences.list.resize(next.back());
    for_each([&](std::uint32_t row, const Incidence& at) { incidences.list[next[row]++] = at; });
    return incidences;
}

/// Blocks of some rows that the fixed pattern does not have.
template <int Dim, typename Scalar>
struct Leftover {
    std::vector<std::uint32_t> counts;  // one a row
    std::vector<std::uint32_t> columns;
    std::vector<Eigen::Matrix<Scalar, Dim, Dim>> blocks;
};

/// Sums the blocks of one row after the other.
template <int Dim, typename Scalar>
class RowSum {
public:
    RowSum(const Numbering& numbering,
           const Terms<Dim>& contacts,
           double scale,
           const Positions<Dim>& held_shift,
           BlockMatrix<Dim, Scalar>& matrix,
           BlockVector<Dim>& right)
        : numbering_(numbering),
          contacts_(contacts),
          scale_(scale),
          held_shift_(held_shift),
          matrix_(matrix),
          right_(right),
          slots_(numbering.free_count(), 0) {}

    void add_row(std::uint32_t row,
                 const Incidence* begin,
                 const Incidence* end,
                 Leftover<Dim, Scalar>& leftover) {
        const BlockPattern& pattern = matrix_.pattern();
        const std::int64_t first = pattern.row_start[row];
        columns_.assign(pattern.columns.begin() + first,
                        pattern.columns.begin() + pattern.row_start[row + 1]);
        const std::size_t fixed = columns_.size();
        sums_.assign(fixed, Block::Zero());
        for (std::uint32_t slot = 0; slot < fixed; ++slot) {
            slots_[columns_[slot]] = slot + 1;
        }
        for (const Incidence* at = begin; at != end; ++at) {
            add(row, *at);
        }
        for (std::size_t slot = 0; slot < fixed; ++slot) {
            matrix_.block(first + static_cast<std::int64_t>(slot)) +=
                sums_[slot].template cast<Scalar>();
        }
        take_leftover(fixed, leftover);
        for (const std::uint32_t column : columns_) {
            slots_[column] = 0;
        }
    }

private:
    using Block = Eigen::Matrix<double, Dim, Dim>;

    void add(std::uint32_t row, const Incidence& at) {
        if (!contacts_.is_weighted(at.contact)) {
            add_moving(row, at);
            return;
        }
        const contact::Contact<Dim>& contact = contacts_.contact(at.contact);
        const Block weighted = (scale_ * contact.weights[at.corner]) * contact.response.hessian;
        for (std::uint32_t j = 0; j <= Dim; ++j) {
            add_block(row, contact.vertices[j], contact.weights[j] * weighted);
        }
    }

    void add_moving(std::uint32_t row, const Incidence& at) {
        const LocalHessian<Dim>& local = contacts_.moving(at.contact);
        for (int j = 0; j < local.count; ++j) {
            const std::uint32_t vertex = local.vertices[static_cast<std::size_t>(j)];
            if (vertex != contact::kFixedPoint) {
                add_block(row, vertex,
                          scale_
                              * local.matrix.template block<Dim, Dim>(
                                  Dim * static_cast<int>(at.corner), Dim * j));
            }
        }
    }

    void add_block(std::uint32_t row, std::uint32_t vertex, const Block& block) {
        const std::uint32_t column = numbering_.unknown_of_vertex[vertex];
        if (column >= numbering_.free_count()) {
            right_.col(row) -= block * held_shift_.col(vertex);
        } else if (column >= row) {
            sums_[slot_of(column)] += block;
        }
    }

    std::size_t slot_of(std::uint32_t column) {
        if (slots_[column] == 0) {
            columns_.push_back(column);
            sums_.push_back(Block::Zero());
            slots_[column] = static_cast<std::uint32_t>(columns_.size());
        }
        return slots_[column] - 1;
    }

    void take_leftover(std::size_t fixed, Leftover<Dim, Scalar>& leftover) {
        order_.resize(columns_.size() - fixed);
        std::iota(order_.begin(), order_.end(), fixed);
        std::sort(order_.begin(), order_.end(),
                  [&](std::size_t a, std::size_t b) { return columns_[a] < columns_[b]; });
        leftover.counts.push_back(static_cast<std::uint32_t>(order_.size()));
        for (const std::size_t slot : order_) {
            leftover.columns.push_back(columns_[slot]);
            leftover.blocks.push_back(sums_[slot].template cast<Scalar>());
        }
    }

    const Numbering& numbering_;
    const Terms<Dim>& contacts_;
    double scale_;
    const Positions<Dim>& held_shift_;
    BlockMatrix<Dim, Scalar>& matrix_;
    BlockVector<Dim>& right_;
    std::vector<std::uint32_t> slots_;  // of columns, one more than the place in sums_; 0 for none
    std::vector<std::uint32_t> columns_;
    std::vector<Block> sums_;
    std::vector<std::size_t> order_;
};

// Puts what is left over of all rows into one matrix.
template <int Dim, typename Scalar>
std::unique_ptr<CouplingMatrix<Dim, Scalar>> join(std::uint32_t unknowns,
                                                  const std::vector<std::uint32_t>& rows,
                                                  const std::vector<Leftover<Dim, Scalar>>& parts) {
    std::vector<std::uint32_t> counts(unknowns, 0);
    std::size_t at = 0;
    std::size_t total = 0;
    for (const auto& part : parts) {
        for (const std::uint32_t count : part.counts) {
            counts[rows[at++]] = count;
            total += count;
        }
    }
    if (total == 0) {
        return nullptr;
    }
    BlockPattern pattern;
    pattern.columns.reserve(total + unknowns);
    pattern.row_start.reserve(unknowns + std::size_t{1});
    pattern.row_start.push_back(0);
    auto part = parts.begin();
    std::size_t next = 0;
    for (std::uint32_t row = 0; row < unknowns; ++row) {
        pattern.columns.push_back(row);  // a diagonal of zeros, as products want it
        for (std::uint32_t k = 0; k < counts[row]; ++k) {
            while (next == part->columns.size()) {
                ++part;
                next = 0;
            }
            pattern.columns.push_back(part->columns[next++]);
        }
        pattern.row_start.push_back(static_cast<std::int64_t>(pattern.columns.size()));
    }
    color_rows(pattern);
    auto coupling = std::make_unique<CouplingMatrix<Dim, Scalar>>(std::move(pattern));
    part = parts.begin();
    next = 0;
    for (std::uint32_t row = 0; row < unknowns; ++row) {
        for (std::uint32_t k = 1; k <= counts[row]; ++k) {
            while (next == part->blocks.size()) {
                ++part;
                next = 0;
            }
            coupling->matrix.block(coupling->pattern.row_start[row] + k) = part->blocks[next++];
        }
    }
    return coupling;
}

}  // namespace

template <int Dim, typename Scalar>
std::unique_ptr<CouplingMatrix<Dim, Scalar>> add_contact_hessian(const Workers& workers,
                                                                 const Numbering& numbering,
                                                                 const ContactTerms<Dim>& contacts,
                                                                 double scale,
                                                                 const Positions<Dim>& held_shift,
                                                                 BlockMatrix<Dim, Scalar>& matrix,
                                                                 BlockVector<Dim>& right) {
    const ContactState<Dim>& state = contacts.state;
    for (const auto* list : {&state.obstacles, &state.friction.obstacles}) {
        for (const contact::ObstacleContact<Dim>& contact : *list) {
            const std::uint32_t row = numbering.unknown_of_vertex[contact.vertex];
            matrix.diagonal(row) += (scale * contact.response.hessian).template cast<Scalar>();
        }
    }
    const Terms<Dim> terms(contacts);
    if (terms.size() == 0) {
        return nullptr;
    }
    const Incidences incidences = list_by_rows(numbering, terms);
    const std::size_t rows = incidences.rows.size();
    const std::size_t size = std::max(kLeastRows, (rows + kMostChunks - 1) / kMostChunks);
    std::vector<Leftover<Dim, Scalar>> parts((rows + size - 1) / size);
    workers.for_each(static_cast<int>(parts.size()), [&](int chunk) {
        RowSum<Dim, Scalar> sum(numbering, terms, scale, held_shift, matrix, right);
        const std::size_t begin = static_cast<std::size_t>(chunk) * size;
        for (std::size_t i = begin; i < std::min(begin + size, rows); ++i) {
            sum.add_row(incidences.rows[i], incidences.list.data() + incidences.begin[i],
                        incidences.list.data() + incidences.begin[i + 1],
                        parts[static_cast<std::size_t>(chunk)]);
        }
    });
    return join<Dim, Scalar>(numbering.free_count(), incidences.rows, parts);
}

#define PENT_INSTANTIATE(Dim, Scalar)                                                              \
    template std::unique_ptr<CouplingMatrix<Dim, Scalar>> add_contact_hessian<Dim, Scalar>(        \
        const Workers&, const Numbering&, const ContactTerms<Dim>&, double, const Positions<Dim>&, \
        BlockMatrix<Dim, Scalar>&, BlockVector<Dim>&);
PENT_INSTANTIATE(3, float)
PENT_INSTANTIATE(3, double)
PENT_INSTANTIATE(4, float)
PENT_INSTANTIATE(4, double)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator

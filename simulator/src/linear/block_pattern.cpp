#include "linear/block_pattern.h"

#include <pent/dimensions.h>

#include <algorithm>
#include <cassert>
#include <iterator>
#include <numeric>

namespace pent::simulator {

std::int64_t BlockPattern::find(std::uint32_t row, std::uint32_t column) const {
    const auto first = columns.begin() + row_start[row];
    const auto last = columns.begin() + row_start[row + 1];
    const auto at = std::lower_bound(first, last, column);
    assert(at != last && *at == column);
    return at - columns.begin();
}

void color_rows(BlockPattern& pattern, std::int64_t columns) {
    pattern.chunks = static_cast<int>((pattern.rows() + BlockPattern::kChunkRows - 1)
                                      / BlockPattern::kChunkRows);
    pattern.coloring = color_chunks(pattern.chunks, columns, [&](int chunk, const auto& touch) {
        const std::int64_t begin = chunk * BlockPattern::kChunkRows;
        const std::int64_t end = std::min(begin + BlockPattern::kChunkRows, pattern.rows());
        const auto row_start = [&](std::int64_t row) {
            return pattern.row_start[static_cast<std::size_t>(row)];
        };
        for (std::int64_t k = row_start(begin); k < row_start(end); ++k) {
            touch(pattern.columns[static_cast<std::size_t>(k)]);
        }
    });
}

std::vector<std::uint32_t> ghost_columns(const BlockPattern& pattern,
                                         const BlockPattern* coupling) {
    std::vector<std::uint32_t> ghosts;
    for (const BlockPattern* part : {&pattern, coupling}) {
        if (part != nullptr) {
            std::copy_if(part->columns.begin(), part->columns.end(), std::back_inserter(ghosts),
                         [&](std::uint32_t column) { return column >= pattern.rows(); });
        }
    }
    std::sort(ghosts.begin(), ghosts.end());
    ghosts.erase(std::unique(ghosts.begin(), ghosts.end()), ghosts.end());
    return ghosts;
}

namespace {

// @param for_each_pair  Calls its argument with each pair of vertices that share an element, in
//                       both orders; repetitions are allowed.
template <typename ForEachPair>
BlockPattern make_pattern_of(const DofMap& dofs, const ForEachPair& for_each_pair) {
    const std::uint32_t rows = dofs.row_count();
    BlockPattern pattern;
    pattern.is_cut.assign(rows, false);
    const auto for_each_block = [&](const auto& visit) {
        for_each_pair([&](std::uint32_t a, std::uint32_t b) {
            const std::uint32_t row = dofs.index_of(a);
            const std::uint32_t column = dofs.index_of(b);
            if (row >= column || row >= rows) {
                return;
            }
            if (column < dofs.count()) {
                visit(row, column);
            } else {
                pattern.is_cut[row] = true;
            }
        });
    };
    std::vector<std::int64_t> start(rows + std::size_t{1}, 0);
    for_each_block([&](std::uint32_t row, std::uint32_t /*column*/) { ++start[row + 1]; });
    std::partial_sum(start.begin(), start.end(), start.begin());
    std::vector<std::uint32_t> found(static_cast<std::size_t>(start.back()));
    std::vector<std::int64_t> next(start.begin(), start.end() - 1);
    for_each_block([&](std::uint32_t row, std::uint32_t column) {
        found[static_cast<std::size_t>(next[row]++)] = column;
    });
    pattern.row_start.push_back(0);
    for (std::uint32_t row = 0; row < rows; ++row) {
        const auto first = found.begin() + start[row];
        const auto last = found.begin() + start[row + 1];
        std::sort(first, last);
        pattern.columns.push_back(row);
        pattern.columns.insert(pattern.columns.end(), first, std::unique(first, last));
        pattern.row_start.push_back(static_cast<std::int64_t>(pattern.columns.size()));
    }
    pattern.columns.shrink_to_fit();
    color_rows(pattern, dofs.count());
    return pattern;
}

}  // namespace

template <int Dim>
BlockPattern make_pattern(const Simplices<Dim + 1>& cells, const DofMap& dofs) {
    return make_pattern_of(dofs, [&](const auto& visit) {
        for (Eigen::Index cell = 0; cell < cells.cols(); ++cell) {
            for (int a = 0; a <= Dim; ++a) {
                for (int b = 0; b <= Dim; ++b) {
                    visit(cells(a, cell), cells(b, cell));
                }
            }
        }
    });
}

BlockPattern make_pattern(const std::vector<const CornerLists*>& lists, const DofMap& dofs) {
    return make_pattern_of(dofs, [&](const auto& visit) {
        for (const CornerLists* list : lists) {
            const auto corner = [&](std::int64_t at) {
                return list->corners[static_cast<std::size_t>(at)];
            };
            for (std::size_t element = 0; element + 1 < list->start.size(); ++element) {
                const std::int64_t begin = list->start[element];
                const std::int64_t end = list->start[element + 1];
                for (std::int64_t a = begin; a < end; ++a) {
                    for (std::int64_t b = begin; b < end; ++b) {
                        visit(corner(a), corner(b));
                    }
                }
            }
        }
    });
}

#define PENT_INSTANTIATE(Dim) \
    template BlockPattern make_pattern<Dim>(const Simplices<Dim + 1>&, const DofMap&);
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator

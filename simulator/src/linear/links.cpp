#include "linear/links.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace pent::simulator {

namespace {

// @param for_each_pair  Calls its argument with every linked pair, in one order or both.
template <typename ForEachPair>
Links link(std::size_t nodes, const ForEachPair& for_each_pair) {
    std::vector<std::int64_t> start(nodes + 1, 0);
    for_each_pair([&](std::uint32_t a, std::uint32_t b) {
        ++start[a + 1];
        ++start[b + 1];
    });
    std::partial_sum(start.begin(), start.end(), start.begin());
    std::vector<std::uint32_t> found(static_cast<std::size_t>(start.back()));
    std::vector<std::int64_t> next(start.begin(), start.end() - 1);
    for_each_pair([&](std::uint32_t a, std::uint32_t b) {
        found[static_cast<std::size_t>(next[a]++)] = b;
        found[static_cast<std::size_t>(next[b]++)] = a;
    });
    Links links;
    for (std::size_t node = 0; node < nodes; ++node) {
        const auto first = found.begin() + start[node];
        const auto last = found.begin() + start[node + 1];
        std::sort(first, last);
        links.targets.insert(links.targets.end(), first, std::unique(first, last));
        links.start.push_back(static_cast<std::int64_t>(links.targets.size()));
    }
    return links;
}

}  // namespace

Links link_dofs(const BlockPattern& pattern) {
    return link(static_cast<std::size_t>(pattern.rows()), [&](const auto& visit) {
        for (std::uint32_t row = 0; row < pattern.rows(); ++row) {
            for (std::int64_t k = pattern.row_start[row] + 1; k < pattern.row_start[row + 1]; ++k) {
                const std::uint32_t column = pattern.columns[static_cast<std::size_t>(k)];
                if (column < pattern.rows()) {
                    visit(row, column);
                }
            }
        }
    });
}

Links join(const Links& a, const Links& b) {
    return link(a.size(), [&](const auto& visit) {
        for (const Links* links : {&a, &b}) {
            for (std::uint32_t node = 0; node < links->size(); ++node) {
                links->for_each(node, [&](std::uint32_t other) { visit(node, other); });
            }
        }
    });
}

Links link_parts(const Links& nodes, const std::vector<std::uint32_t>& part_of, std::size_t parts) {
    return link(parts, [&](const auto& visit) {
        for (std::uint32_t node = 0; node < nodes.size(); ++node) {
            nodes.for_each(node, [&](std::uint32_t other) {
                if (part_of[node] < part_of[other]) {
                    visit(part_of[node], part_of[other]);
                }
            });
        }
    });
}

std::vector<std::uint32_t> color_nodes(const Links& links) {
    constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
    std::vector<std::uint32_t> colors(links.size(), kNone);
    std::vector<std::uint32_t> taken_by;  // the last node beside which a color was seen
    for (std::uint32_t node = 0; node < links.size(); ++node) {
        links.for_each(node, [&](std::uint32_t other) {
            if (colors[other] != kNone) {
                taken_by[colors[other]] = node;
            }
        });
        colors[node] = static_cast<std::uint32_t>(
            std::find_if(taken_by.begin(), taken_by.end(),
                         [&](std::uint32_t taker) { return taker != node; })
            - taken_by.begin());
        if (colors[node] == taken_by.size()) {
            taken_by.push_back(kNone);
        }
    }
    return colors;
}

}  // namespace pent::simulator

#include "model/partition.h"

#include <pent/dimensions.h>
#include <pent/error.h>

#include <algorithm>
#include <numeric>
#include <string>
#include <utility>

namespace pent::simulator {

namespace {

template <int Dim>
struct Column {
    Eigen::Matrix<double, Dim, 1> middle = Eigen::Matrix<double, Dim, 1>::Zero();
    std::int64_t vertices = 0;
    std::uint32_t number = 0;
};

template <int Dim>
class Bisection {
public:
    explicit Bisection(std::vector<Column<Dim>> columns)
        : columns_(std::move(columns)), part_of_(columns_.size(), 0) {}

    std::vector<std::uint32_t> operator()(std::size_t parts) {
        cut(0, columns_.size(), 0, parts);
        return std::move(part_of_);
    }

private:
    // Gives columns [begin, end) to so many parts from the first one on, of which each gets one.
    void cut(std::size_t begin, std::size_t end, std::size_t first_part, std::size_t parts) {
        if (parts == 1) {
            for (std::size_t i = begin; i < end; ++i) {
                part_of_[columns_[i].number] = static_cast<std::uint32_t>(first_part);
            }
            return;
        }
        sort_along_longest(begin, end);
        const std::size_t lower = parts / 2;
        std::int64_t total = 0;
        for (std::size_t i = begin; i < end; ++i) {
            total += columns_[i].vertices;
        }
        const std::int64_t wanted = total * static_cast<std::int64_t>(lower)  //
                                    / static_cast<std::int64_t>(parts);
        std::size_t middle = begin + lower;
        std::int64_t below = 0;
        for (std::size_t i = begin; i < middle; ++i) {
            below += columns_[i].vertices;
        }
        while (middle < end - (parts - lower)
               && 2 * below + columns_[middle].vertices <= 2 * wanted) {
            below += columns_[middle++].vertices;
        }
        cut(begin, middle, first_part, lower);
        cut(middle, end, first_part + lower, parts - lower);
    }

    void sort_along_longest(std::size_t begin, std::size_t end) {
        Eigen::Array<double, Dim, 1> low = columns_[begin].middle;
        Eigen::Array<double, Dim, 1> high = low;
        for (std::size_t i = begin; i < end; ++i) {
            low = low.min(columns_[i].middle.array());
            high = high.max(columns_[i].middle.array());
        }
        Eigen::Index axis = 0;
        (high - low).maxCoeff(&axis);
        std::sort(columns_.begin() + static_cast<std::ptrdiff_t>(begin),
                  columns_.begin() + static_cast<std::ptrdiff_t>(end),
                  [&](const Column<Dim>& a, const Column<Dim>& b) {
                      return std::pair(a.middle[axis], a.number)
                             < std::pair(b.middle[axis], b.number);
                  });
    }

    std::vector<Column<Dim>> columns_;
    std::vector<std::uint32_t> part_of_;
};

}  // namespace

template <int Dim>
std::vector<std::uint32_t> partition_columns(const Positions<Dim>& rest,
                                             const Columns& columns,
                                             int parts) {
    const auto most = std::max_element(columns.columns.begin(), columns.columns.end());
    std::vector<Column<Dim>> all(most == columns.columns.end() ? 0 : *most + std::size_t{1});
    if (all.size() < static_cast<std::size_t>(parts)) {
        throw Error("the bodies have " + std::to_string(all.size())
                    + " columns of vertices, which are kept together; expected at least one for"
                      " each of the "
                    + std::to_string(parts) + " ranks: start fewer");
    }
    for (std::size_t vertex = 0; vertex < columns.columns.size(); ++vertex) {
        Column<Dim>& column = all[columns.columns[vertex]];
        column.number = columns.columns[vertex];
        column.middle += rest.col(static_cast<Eigen::Index>(vertex));
        ++column.vertices;
    }
    for (Column<Dim>& column : all) {
        column.middle /= static_cast<double>(column.vertices);
    }
    const std::vector<std::uint32_t> part_of =
        Bisection<Dim>(std::move(all))(static_cast<std::size_t>(parts));
    std::vector<std::uint32_t> owners;
    owners.reserve(columns.columns.size());
    for (const std::uint32_t column : columns.columns) {
        owners.push_back(part_of[column]);
    }
    return owners;
}

#define PENT_INSTANTIATE(Dim)                                                         \
    template std::vector<std::uint32_t> partition_columns<Dim>(const Positions<Dim>&, \
                                                               const Columns&, int);
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator

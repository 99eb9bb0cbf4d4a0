#include "orientation.h"

#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

namespace pent::contact {

namespace {

// A sum of doubles as it is, without rounding: an expansion of parts that do not overlap, by
// increasing size and none of them 0, so that the last one has the sign of all.
template <std::size_t Capacity>
class Expansion {  // NOLINT(cppcoreguidelines-pro-type-member-init): parts are set as they come
public:
    // Carries the rounding of every sum along.
    void add(double number) {
        std::size_t count = 0;
        for (const double part : parts()) {
            const double sum = number + part;
            const double of_part = sum - number;
            const double lost = (number - (sum - of_part)) + (part - of_part);
            number = sum;
            if (lost != 0) {
                parts_[count++] = lost;
            }
        }
        if (number != 0) {
            parts_[count++] = number;
        }
        count_ = count;
    }

    void add_product(double a, double b) {
        add(std::fma(a, b, -(a * b)));
        add(a * b);
    }

    [[nodiscard]] std::span<const double> parts() const { return {parts_.data(), count_}; }
    [[nodiscard]] int sign() const { return count_ == 0 ? 0 : parts_[count_ - 1] > 0 ? 1 : -1; }

private:
    std::array<double, Capacity> parts_;
    std::size_t count_ = 0;
};

// By column and row.
template <int N>
using Differences = std::array<std::array<Expansion<2>, N>, N>;

// How many parts a determinant of differences may have.
constexpr std::size_t capacity(int size) {
    return size == 1 ? 2 : 4 * static_cast<std::size_t>(size) * capacity(size - 1);
}

// The determinant of some columns and as many of the last rows, by Laplace's rule along the first
// of these.
template <int Size, int N>
Expansion<capacity(Size)> determinant(const Differences<N>& entries,
                                      const std::array<std::size_t, Size>& columns) {
    if constexpr (Size == 1) {
        return entries[columns[0]][N - 1];
    } else {
        Expansion<capacity(Size)> sum;
        for (std::size_t k = 0; k < Size; ++k) {
            const std::span<const double> entry = entries[columns[k]][N - Size].parts();
            if (entry.empty()) {
                continue;
            }
            std::array<std::size_t, Size - 1> others{};
            std::remove_copy(columns.begin(), columns.end(), others.begin(), columns[k]);
            const auto minor = determinant<Size - 1, N>(entries, others);
            for (const double a : entry) {
                for (const double b : minor.parts()) {
                    sum.add_product(k % 2 == 0 ? a : -a, b);
                }
            }
        }
        return sum;
    }
}

}  // namespace

template <int N>
int orientation(const Eigen::Matrix<double, N, N + 1>& points) {
    // Far more than N! products of N factors, and the differences in them, are off by, relative to
    // the product of the lengths of the columns.
    constexpr double kErrors = 64 * std::numeric_limits<double>::epsilon();
    const Eigen::Matrix<double, N, N> edges =
        points.template rightCols<N>().colwise() - points.col(0);
    const double rounded = edges.determinant();
    const double size = edges.colwise().squaredNorm().prod();
    if (rounded * rounded > kErrors * kErrors * size) {
        return rounded > 0 ? 1 : -1;
    }
    // On lattices most of what is left is plain to see.
    if ((edges.array() == 0).rowwise().all().any() || (edges.array() == 0).colwise().all().any()) {
        return 0;
    }
    Differences<N> differences;
    std::array<std::size_t, N> columns{};
    for (std::size_t k = 0; k < N; ++k) {
        columns[k] = k;
        for (std::size_t axis = 0; axis < N; ++axis) {
            const auto row = static_cast<Eigen::Index>(axis);
            differences[k][axis].add(points(row, static_cast<Eigen::Index>(k) + 1));
            differences[k][axis].add(-points(row, 0));
        }
    }
    return determinant<N, N>(differences, columns).sign();
}

template int orientation<1>(const Eigen::Matrix<double, 1, 2>&);
template int orientation<2>(const Eigen::Matrix<double, 2, 3>&);
template int orientation<3>(const Eigen::Matrix<double, 3, 4>&);
template int orientation<4>(const Eigen::Matrix<double, 4, 5>&);

}  // namespace pent::contact

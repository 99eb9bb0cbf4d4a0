#include "spectra.h"

#include "filter.h"
#include "lanes.h"

#include <pent/dimensions.h>

#include <algorithm>

namespace pent::contact {

namespace {

// Orthonormal columns whose sums are 0: a basis of differences of points, without translations.
template <int Dim>
Eigen::Matrix<double, Dim + 1, Dim> differences() {
    Eigen::Matrix<double, Dim + 1, Dim> columns = Eigen::Matrix<double, Dim + 1, Dim>::Zero();
    for (int k = 0; k < Dim; ++k) {
        columns.col(k).head(k + 1).setOnes();
        columns(k + 1, k) = -(k + 1);
        columns.col(k).normalize();
    }
    return columns;
}

}  // namespace

template <int Dim>
ReducedMatrix<Dim, Dim * Dim> without_translations(const StencilMatrix<Dim>& matrix) {
    static const Eigen::Matrix<double, Dim + 1, Dim> weights = differences<Dim>();
    ReducedMatrix<Dim, Dim * Dim> reduced;
    reduced.basis.setZero();
    reduced.inner.setZero();
    Eigen::Matrix<double, Dim*(Dim + 1), Dim* Dim> half =
        Eigen::Matrix<double, Dim*(Dim + 1), Dim * Dim>::Zero();
    for (int k = 0; k < Dim; ++k) {
        for (int i = 0; i <= k + 1; ++i) {
            reduced.basis.template block<Dim, Dim>(Dim * i, Dim * k)
                .diagonal()
                .setConstant(weights(i, k));
            half.template middleCols<Dim>(Dim * k) +=
                weights(i, k) * matrix.template middleCols<Dim>(Dim * i);
        }
    }
    for (int k = 0; k < Dim; ++k) {
        for (int i = 0; i <= k + 1; ++i) {
            reduced.inner.template middleRows<Dim>(Dim * k) +=
                weights(i, k) * half.template middleRows<Dim>(Dim * i);
        }
    }
    return reduced;
}

template <int Dim, int Size>
void Spectra<Dim, Size>::add(const ReducedMatrix<Dim, Size>& matrix,
                             SpectralHessian<Dim>& hessian) {
    const auto lane = static_cast<std::size_t>(count_);
    hessians_[lane] = &hessian;
    bases_[lane] = matrix.basis;
    for (int i = 0; i < Size; ++i) {
        for (int j = i; j < Size; ++j) {
            matrices_[static_cast<std::size_t>(kSpectra * (Size * i + j)) + lane] =
                matrix.inner(i, j);
        }
    }
    if (++count_ == kSpectra) {
        finish();
    }
}

template <int Dim, int Size>
void Spectra<Dim, Size>::finish() {
    if (count_ == 0) {
        return;
    }
    for (std::size_t first = 0; first < matrices_.size(); first += kSpectra) {
        std::fill_n(matrices_.data() + first + count_, kSpectra - count_, 0);
    }
    lanes_kernels<Dim>().find_spectra(Size, matrices_.data(), vectors_.data());
    for (int lane = 0; lane < count_; ++lane) {
        store(lane);
    }
    count_ = 0;
}

template <int Dim, int Size>
void Spectra<Dim, Size>::store(int lane) {
    std::array<double, Size> values;
    std::array<int, Size> kept;
    int rank = 0;
    for (int k = 0; k < Size; ++k) {
        values[static_cast<std::size_t>(k)] = filtered(
            matrices_[static_cast<std::size_t>(kSpectra * (Size + 1) * k + lane)], filter_);
        if (values[static_cast<std::size_t>(k)] != 0) {
            kept[static_cast<std::size_t>(rank++)] = k;
        }
    }
    if (rank > most_) {
        std::stable_sort(kept.begin(), kept.begin() + rank, [&](int a, int b) {
            return values[static_cast<std::size_t>(a)] > values[static_cast<std::size_t>(b)];
        });
        rank = most_;
    }
    SpectralHessian<Dim>& hessian = *hessians_[static_cast<std::size_t>(lane)];
    hessian.rank = rank;
    double* of_values = numbers_ + hessian.begin;
    double* of_vectors = of_values + rank;
    for (int n = 0; n < rank; ++n) {
        const int k = kept[static_cast<std::size_t>(n)];
        of_values[n] = values[static_cast<std::size_t>(k)];
        Eigen::Matrix<double, Size, 1> inner;
        for (int i = 0; i < Size; ++i) {
            inner[i] = vectors_[static_cast<std::size_t>(kSpectra * (Size * k + i) + lane)];
        }
        const StencilVector<Dim> vector = bases_[static_cast<std::size_t>(lane)].lazyProduct(inner);
        for (int i = 0; i < hessian.count; ++i) {
            std::copy_n(vector.data() + Dim * i, Dim, of_vectors + Dim * (rank * i + n));
        }
    }
}

#define PENT_INSTANTIATE(Dim)                                                               \
    template ReducedMatrix<Dim, Dim * Dim> without_translations(const StencilMatrix<Dim>&); \
    template class Spectra<Dim, 2 * Dim - 1>;                                               \
    template class Spectra<Dim, Dim * Dim>;
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::contact

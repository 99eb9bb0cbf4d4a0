#pragma once

#include "spectra_lanes.h"

#include <pent/contact/filter.h>
#include <pent/contact/stencil.h>

#include <Eigen/Core>

#include <array>

namespace pent::contact {

/// A symmetric matrix of a stencil that is 0 but in a few dimensions: basis inner basis^T.
template <int Dim, int Size>
struct ReducedMatrix {
    Eigen::Matrix<double, Dim*(Dim + 1), Size> basis;  ///< Orthonormal columns, and some of zeros.
    Eigen::Matrix<double, Size, Size> inner;           ///< 0 where a column of the basis is.

    [[nodiscard]] StencilMatrix<Dim> matrix() const {
        return basis.lazyProduct(inner).eval().lazyProduct(basis.transpose());
    }
};

/// Reduces a matrix of an energy that is invariant under translations: those are taken out.
template <int Dim>
[[nodiscard]] ReducedMatrix<Dim, Dim * Dim> without_translations(const StencilMatrix<Dim>& matrix);

/// Finds the filtered eigenvalues of such matrices that are not 0, and their eigenvectors.
/// Several are done at once: what is added is there after finish().
template <int Dim, int Size>
class Spectra {
public:
    /// @param most     Of the eigenvalues of a matrix that are kept: the largest.
    /// @param numbers  To write to, where the Hessians have their room.
    Spectra(Filter filter, int most, double* numbers)
        : filter_(filter), most_(most), numbers_(numbers) {}

    /// @param hessian  Of these vertices, the first of the stencil; its rank is set. Its room is
    ///                 for most (1 + Dim count) numbers. It has to outlive finish().
    void add(const ReducedMatrix<Dim, Size>& matrix, SpectralHessian<Dim>& hessian);
    void finish();

private:
    void store(int lane);

    Filter filter_;
    int most_;
    double* numbers_;
    int count_ = 0;
    std::array<SpectralHessian<Dim>*, kSpectra> hessians_;
    std::array<Eigen::Matrix<double, Dim*(Dim + 1), Size>, kSpectra> bases_;
    alignas(64) std::array<double, static_cast<std::size_t>(Size) * Size * kSpectra> matrices_;
    alignas(64) std::array<double, static_cast<std::size_t>(Size) * Size * kSpectra> vectors_;
};

}  // namespace pent::contact

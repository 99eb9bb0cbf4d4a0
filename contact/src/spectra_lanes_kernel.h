#pragma once

#include "spectra_lanes.h"

#include <pent/register_bytes.h>
#include <pent/simd.h>

// Included once for each instruction set, by a file that is compiled for it.

namespace pent::contact {
namespace {

using Doubles = Pack<double, kRegisterBytes / static_cast<int>(sizeof(double))>;

// Below this part of the largest number of a matrix, an entry off its diagonal counts as 0.
constexpr double kNegligible = 1e-15;

// Six or seven sweeps are enough; more happen only where numbers are not finite.
constexpr int kMaxSweeps = 40;

// The inverse of a smaller largest number would overflow.
constexpr double kTiny = 1e-300;

// As many matrices as a register has lanes, diagonalized by rotations in the planes of two axes,
// one after the other (Jacobi's method, [golub2013] 8.5). A lane whose number is 0 already is
// rotated by nothing, which changes signs of zeros at most: no matrix depends on those beside it.
class Diagonalization {
public:
    Diagonalization(int size, double* matrices, double* vectors)
        : size_(size), matrices_(matrices), vectors_(vectors) {}

    void run() const {
        const Doubles scale = set_up();
        bool is_any = true;
        for (int sweep = 0; is_any && sweep < kMaxSweeps; ++sweep) {
            is_any = false;
            for (int p = 0; p < size_; ++p) {
                for (int q = p + 1; q < size_; ++q) {
                    is_any = annihilate(p, q) || is_any;
                }
            }
        }
        for (int i = 0; i < size_; ++i) {
            (Doubles::load(number(i, i)) * scale).store(number(i, i));
        }
    }

private:
    [[nodiscard, gnu::always_inline]] double* number(int row, int column) const {
        return matrices_ + kSpectra * (size_ * row + column);
    }
    [[nodiscard, gnu::always_inline]] double* vector(int i, int component) const {
        return vectors_ + kSpectra * (size_ * i + component);
    }

    // Divides by the largest numbers, which are returned, so that no square overflows.
    [[nodiscard, gnu::always_inline]] Doubles set_up() const {
        Doubles most(0.0);
        for (int i = 0; i < size_; ++i) {
            for (int j = i; j < size_; ++j) {
                most = max(abs(Doubles::load(number(i, j))), most);
            }
        }
        const Doubles scale = select(most > Doubles(kTiny), most, Doubles(1.0));
        const Doubles inverse = Doubles(1.0) / scale;
        for (int i = 0; i < size_; ++i) {
            for (int j = i; j < size_; ++j) {
                (Doubles::load(number(i, j)) * inverse).store(number(i, j));
            }
            for (int j = 0; j < size_; ++j) {
                Doubles(i == j ? 1.0 : 0.0).store(vector(i, j));
            }
        }
        return scale;
    }

    // Turns axes p < q so that what couples them is 0. Returns whether it was not in some lane.
    [[nodiscard, gnu::always_inline]] bool annihilate(int p, int q) const {
        const Doubles coupling = Doubles::load(number(p, q));
        const auto is_on = abs(coupling) > Doubles(kNegligible);
        if (!any(is_on)) {
            return false;
        }
        const Doubles zero(0.0);
        const Doubles one(1.0);
        const Doubles first = Doubles::load(number(p, p));
        const Doubles second = Doubles::load(number(q, q));
        const Doubles difference = second - first;
        const Doubles twice = coupling + coupling;
        const Doubles along = abs(difference) + sqrt(difference * difference + twice * twice);
        const Doubles across = select(difference < zero, -twice, twice);
        const Doubles inverse = one / sqrt(along * along + twice * twice);
        const Doubles cosine = select(is_on, along * inverse, one);
        const Doubles sine = select(is_on, across * inverse, zero);
        const Doubles shift = select(is_on, across / along, zero) * coupling;
        (first - shift).store(number(p, p));
        (second + shift).store(number(q, q));
        select(is_on, zero, coupling).store(number(p, q));
        for (int k = 0; k < p; ++k) {
            turn(cosine, sine, number(k, p), number(k, q));
        }
        for (int k = p + 1; k < q; ++k) {
            turn(cosine, sine, number(p, k), number(k, q));
        }
        for (int k = q + 1; k < size_; ++k) {
            turn(cosine, sine, number(p, k), number(q, k));
        }
        for (int k = 0; k < size_; ++k) {
            turn(cosine, sine, vector(p, k), vector(q, k));
        }
        return true;
    }

    [[gnu::always_inline]] static void turn(const Doubles& cosine,
                                            const Doubles& sine,
                                            double* a,
                                            double* b) {
        const Doubles x = Doubles::load(a);
        const Doubles y = Doubles::load(b);
        (cosine * x - sine * y).store(a);
        (sine * x + cosine * y).store(b);
    }

    int size_;
    double* matrices_;
    double* vectors_;
};

void find_spectra(int size, double* matrices, double* vectors) {
    for (int first = 0; first < kSpectra; first += Doubles::kCount) {
        Diagonalization(size, matrices + first, vectors + first).run();
    }
}

}  // namespace
}  // namespace pent::contact

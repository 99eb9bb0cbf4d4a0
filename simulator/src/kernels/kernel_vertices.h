#pragma once

#include "kernels/kernel_lanes.h"
#include "kernels/kernel_transpose.h"
#include "linear/block_order.h"

#include <pent/pack.h>

#include <cstdint>

// The Dim numbers of a vertex, and products of Dim x Dim blocks with them.

namespace pent::simulator {
namespace {  // NOLINT(google-build-namespaces): see kernel_lanes.h

// The compiler's vector types, as packs have no shuffles. Where registers hold less than four
// numbers the compiler splits them.
template <typename Number>
using FourOf = typename Pack<Number, 4>::Vector;
using Four = FourOf<double>;

// A vertex number by number: in the scalar kernels, and in 3D, where there is no vector of three.
template <int Dim, typename Number = double>
struct OneByOne {
    Number at[Dim];

    Number& operator[](int i) { return at[i]; }
    Number operator[](int i) const { return at[i]; }
    OneByOne& operator+=(const OneByOne& other) {
        for (int i = 0; i < Dim; ++i) {
            at[i] += other.at[i];
        }
        return *this;
    }
    OneByOne& operator-=(const OneByOne& other) {
        for (int i = 0; i < Dim; ++i) {
            at[i] -= other.at[i];
        }
        return *this;
    }
    friend OneByOne operator+(OneByOne a, const OneByOne& b) { return a += b; }
    friend OneByOne operator-(OneByOne a, const OneByOne& b) { return a -= b; }
    friend OneByOne operator*(OneByOne a, const OneByOne& b) {
        for (int i = 0; i < Dim; ++i) {
            a.at[i] *= b.at[i];
        }
        return a;
    }
    friend OneByOne operator*(OneByOne a, Number factor) {
        for (Number& number : a.at) {
            number *= factor;
        }
        return a;
    }
};

template <int Dim, bool IsVectorized, typename Number = double>
struct VertexOf {
    using Type = OneByOne<Dim, Number>;
};
template <typename Number>
struct VertexOf<4, true, Number> {
    using Type = FourOf<Number>;
};

template <typename Scalar>
Four load_four(const Scalar* from) {
    return Pack<double, 4>::load(from).lanes;
}

template <typename Scalar>
void load(const Scalar* from, Four& to) {
    to = load_four(from);
}
inline void load(const float* from, FourOf<float>& to) {
    to = Pack<float, 4>::load(from).lanes;
}
template <int Dim, typename Number, typename Scalar>
void load(const Scalar* from, OneByOne<Dim, Number>& to) {
    for (int i = 0; i < Dim; ++i) {
        to.at[i] = static_cast<Number>(from[i]);
    }
}
template <typename Vertex, typename Scalar>
Vertex loaded(const Scalar* from) {
    Vertex vertex;
    load(from, vertex);
    return vertex;
}

template <typename Vertex>
void store(const Vertex& vertex, double* to) {
    __builtin_memcpy(to, &vertex, sizeof vertex);
}

// As many vertices as are transposed to lanes, or back, at once: four where a register holds four
// numbers. Where none does, vectors of four would be split for it, which takes twice as long as
// going number by number.
template <int Dim, bool IsVectorized>
struct VertexTile {
    static constexpr bool kIsWhole = IsVectorized && Dim == 4 && kRegisterBytes >= sizeof(Four);
    static constexpr int kCount = kIsWhole ? 4 : 1;
    using Vertex = typename VertexOf<Dim, kIsWhole>::Type;

    Vertex at[kCount];

    // From lanes: from[axis][lane], where `lane` is a multiple of kCount.
    template <int Lanes>
    void load(const double (&from)[Dim][Lanes], int lane) {
        if constexpr (kCount > 1) {
            for (int axis = 0; axis < Dim; ++axis) {
                at[axis] = load_four(from[axis] + lane);
            }
            pent::transpose<kCount>(at);
        } else {
            for (int axis = 0; axis < Dim; ++axis) {
                at[0][axis] = from[axis][lane];
            }
        }
    }

    // To lanes; overwrites the vertices in between.
    template <int Lanes>
    void store(double (&to)[Dim][Lanes], int lane) {
        if constexpr (kCount > 1) {
            pent::transpose<kCount>(at);
            for (int axis = 0; axis < Dim; ++axis) {
                simulator::store(at[axis], to[axis] + lane);
            }
        } else {
            for (int axis = 0; axis < Dim; ++axis) {
                to[axis][lane] = at[0][axis];
            }
        }
    }
};

// The factors of transposed blocks: part k has number j ^ k of a vector at j, see block_order.h.
template <typename Vector>
struct Permuted {
    Vector at[4];
};
template <typename Vector>
Permuted<Vector> permuted(const Vector& x) {
    return {{x, __builtin_shufflevector(x, x, 1, 0, 3, 2),
             __builtin_shufflevector(x, x, 2, 3, 0, 1), __builtin_shufflevector(x, x, 3, 2, 1, 0)}};
}

// The XOR diagonals of a block, see block_order.h.
struct Diagonals {
    Four at[4];
};
template <typename Scalar>
Diagonals diagonals_of(const Scalar* block) {
    return {{load_four(block), load_four(block + 4), load_four(block + 8), load_four(block + 12)}};
}

// Sums up products by diagonals into rows: number j of part k belongs to row j ^ k.
inline Four rows_of(const Diagonals& products) {
    const Four& second = products.at[2];
    const Four& third = products.at[3];
    const Four even = products.at[0] + __builtin_shufflevector(second, second, 2, 3, 0, 1);
    const Four odd = products.at[1] + __builtin_shufflevector(third, third, 2, 3, 0, 1);
    return even + __builtin_shufflevector(odd, odd, 1, 0, 3, 2);
}

// A x for a block.
template <typename Scalar>
Four block_times(const Scalar* block, const Four& x) {
    const Diagonals of = diagonals_of(block);
    return rows_of({{of.at[0] * x, of.at[1] * x, of.at[2] * x, of.at[3] * x}});
}
template <int Dim, typename Scalar>
OneByOne<Dim> block_times(const Scalar* block, const OneByOne<Dim>& x) {
    OneByOne<Dim> sum = {};
    for (int j = 0; j < Dim; ++j) {
        for (int i = 0; i < Dim; ++i) {
            sum[i] += static_cast<double>(block[block_entry<Dim>(i, j)]) * x[j];
        }
    }
    return sum;
}

// A^T x.
template <typename Scalar>
Four transposed_times(const Scalar* block, const Four& x) {
    const Diagonals of = diagonals_of(block);
    const auto by = permuted(x);
    return (of.at[0] * by.at[0] + of.at[2] * by.at[2])
           + (of.at[1] * by.at[1] + of.at[3] * by.at[3]);
}
template <int Dim, typename Scalar>
OneByOne<Dim> transposed_times(const Scalar* block, const OneByOne<Dim>& x) {
    OneByOne<Dim> sums = {};
    for (int j = 0; j < Dim; ++j) {
        for (int i = 0; i < Dim; ++i) {
            sums[j] += static_cast<double>(block[block_entry<Dim>(i, j)]) * x[i];
        }
    }
    return sums;
}

}  // namespace
}  // namespace pent::simulator

#pragma once

#include "kernels/kernel_lanes.h"
#include "kernels/kernel_transpose.h"

#include <pent/pack.h>

#include <cstdint>

// The Dim numbers of a vertex, and what blocks of Dim x Dim do to them.

namespace pent::simulator {
namespace {  // NOLINT(google-build-namespaces): see kernel_lanes.h

// Written with the vector types of the compiler, for packs have no shuffles; a machine without
// vectors of four gets pairs.
using Four = Pack<double, 4>::Vector;

// Where there are no vectors, or not of three.
template <int Dim>
struct OneByOne {
    double at[Dim];

    double& operator[](int i) { return at[i]; }
    double operator[](int i) const { return at[i]; }
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
    friend OneByOne operator*(OneByOne a, double factor) {
        for (double& number : a.at) {
            number *= factor;
        }
        return a;
    }
};

template <int Dim, bool IsVectorized>
struct VertexOf {
    using Type = OneByOne<Dim>;
};
template <>
struct VertexOf<4, true> {
    using Type = Four;
};

template <typename Scalar>
Four load_four(const Scalar* from) {
    return Pack<double, 4>::load(from).lanes;
}

template <typename Scalar>
void load(const Scalar* from, Four& to) {
    to = load_four(from);
}
template <int Dim, typename Scalar>
void load(const Scalar* from, OneByOne<Dim>& to) {
    for (int i = 0; i < Dim; ++i) {
        to.at[i] = static_cast<double>(from[i]);
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

// As many vertices as are turned into lanes, or out of them, at once: number by number where no
// register has four, which would be taken apart for it and take twice as long.
template <int Dim, bool IsVectorized>
struct VertexTile {
    static constexpr bool kIsWhole = IsVectorized && Dim == 4 && kRegisterBytes >= sizeof(Four);
    static constexpr int kCount = kIsWhole ? 4 : 1;
    using Vertex = typename VertexOf<Dim, kIsWhole>::Type;

    Vertex at[kCount];

    // From lanes: from[axis][lane], the first lane being a multiple of kCount.
    template <int Lanes>
    void load(const double (&from)[Dim][Lanes], int lane) {
        if constexpr (kCount > 1) {
            for (int axis = 0; axis < Dim; ++axis) {
                at[axis] = load_four(from[axis] + lane);
            }
            transpose(at);
        } else {
            for (int axis = 0; axis < Dim; ++axis) {
                at[0][axis] = from[axis][lane];
            }
        }
    }

    // To lanes; the vertices are no more.
    template <int Lanes>
    void store(double (&to)[Dim][Lanes], int lane) {
        if constexpr (kCount > 1) {
            transpose(at);
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

// Sums of the entries of four vectors.
inline Four sums_of(const Four& a, const Four& b, const Four& c, const Four& d) {
    const Four ab =
        __builtin_shufflevector(a, b, 0, 4, 2, 6) + __builtin_shufflevector(a, b, 1, 5, 3, 7);
    const Four cd =
        __builtin_shufflevector(c, d, 0, 4, 2, 6) + __builtin_shufflevector(c, d, 1, 5, 3, 7);
    return __builtin_shufflevector(ab, cd, 0, 1, 4, 5)
           + __builtin_shufflevector(ab, cd, 2, 3, 6, 7);
}

// A column-major block by its diagonals, entry j of diagonal k being that in row j ^ k of column j.
struct Diagonals {
    Four at[4];
};

template <typename Scalar>
Diagonals diagonals_of(const Scalar* block) {
    const Four c0 = load_four(block);
    const Four c1 = load_four(block + 4);
    const Four c2 = load_four(block + 8);
    const Four c3 = load_four(block + 12);
    const Four even_01 = __builtin_shufflevector(c0, c1, 0, 5, 2, 7);
    const Four odd_01 = __builtin_shufflevector(c0, c1, 1, 4, 3, 6);
    const Four even_23 = __builtin_shufflevector(c2, c3, 0, 5, 2, 7);
    const Four odd_23 = __builtin_shufflevector(c2, c3, 1, 4, 3, 6);
    return {{__builtin_shufflevector(even_01, even_23, 0, 1, 6, 7),
             __builtin_shufflevector(odd_01, odd_23, 0, 1, 6, 7),
             __builtin_shufflevector(even_01, even_23, 2, 3, 4, 5),
             __builtin_shufflevector(odd_01, odd_23, 2, 3, 4, 5)}};
}

// A x for a column-major block.
template <typename Scalar>
Four block_times(const Scalar* block, const Four& x) {
    return (load_four(block) * x[0] + load_four(block + 4) * x[1])
           + (load_four(block + 8) * x[2] + load_four(block + 12) * x[3]);
}
template <int Dim, typename Scalar>
OneByOne<Dim> block_times(const Scalar* block, const OneByOne<Dim>& x) {
    OneByOne<Dim> sum = {};
    for (int j = 0; j < Dim; ++j) {
        sum += loaded<OneByOne<Dim>>(block + j * Dim) * x[j];
    }
    return sum;
}

// A^T x.
template <typename Scalar>
Four transposed_times(const Scalar* block, const Four& x) {
    return sums_of(load_four(block) * x, load_four(block + 4) * x, load_four(block + 8) * x,
                   load_four(block + 12) * x);
}
template <int Dim, typename Scalar>
OneByOne<Dim> transposed_times(const Scalar* block, const OneByOne<Dim>& x) {
    OneByOne<Dim> sums = {};
    for (int j = 0; j < Dim; ++j) {
        for (int i = 0; i < Dim; ++i) {
            sums[j] += static_cast<double>(block[j * Dim + i]) * x[i];
        }
    }
    return sums;
}

}  // namespace
}  // namespace pent::simulator

#pragma once

#include "near_lanes.h"

#include <pent/simd.h>

#include <cstddef>

// Included once for each instruction set, by a file that is compiled for it.

namespace pent::contact {
namespace {

#if defined(__AVX512F__)
constexpr int kRegisterLanes = 16;
#elif defined(__AVX__)
constexpr int kRegisterLanes = 8;
#else
constexpr int kRegisterLanes = 4;
#endif

// Lines that are tried: after these few pairs are left that are not near.
constexpr int kApproaches = 4;

using Floats = Pack<float, kRegisterLanes>;

// Of the largest coordinate: what rounding adds to a gap, at most. Coordinates lack three roundings
// of 2^-24, and a sum of four products of twice as much some ten: 2e-6 in all.
constexpr float kRounding = 4e-6F;

// The same of the distance, for the length of a line.
constexpr float kRelativeRounding = 1e-5F;

// Squares of lengths below would be lost in float.
constexpr float kLeastLength = 1e-15F;

// Some simplices side by side, or one in all lanes.
template <int Dim, int Count>
struct Simplex {
    Floats corners[Count][Dim];  // NOLINT(modernize-avoid-c-arrays): as all here, of plain numbers
    Floats low[Dim];             // NOLINT(modernize-avoid-c-arrays)
    Floats high[Dim];            // NOLINT(modernize-avoid-c-arrays)
    Floats middle[Dim];          // NOLINT(modernize-avoid-c-arrays)

    [[gnu::always_inline]] void set_bounds() {
        for (int axis = 0; axis < Dim; ++axis) {
            low[axis] = high[axis] = middle[axis] = corners[0][axis];
            for (int corner = 1; corner < Count; ++corner) {
                low[axis] = min(low[axis], corners[corner][axis]);
                high[axis] = max(high[axis], corners[corner][axis]);
                middle[axis] += corners[corner][axis];
            }
            middle[axis] *= Floats(1.0F / Count);
        }
    }
};

// Lanes of a patch from `lane` on, moved.
template <int Dim, int Count>
[[gnu::always_inline]] inline void load(const LanesView& patch,
                                        int lane,
                                        const float* shift,
                                        Simplex<Dim, Count>& simplex) {
    for (int corner = 0; corner < Count; ++corner) {
        for (int axis = 0; axis < Dim; ++axis) {
            simplex.corners[corner][axis] =
                Floats::load(patch.corners + (corner * Dim + axis) * kLanes + lane)
                + Floats(shift[axis]);
        }
    }
    simplex.set_bounds();
}

// One lane of a patch in all lanes.
template <int Dim, int Count>
[[gnu::always_inline]] inline void spread(const LanesView& patch,
                                          int lane,
                                          Simplex<Dim, Count>& simplex) {
    for (int corner = 0; corner < Count; ++corner) {
        for (int axis = 0; axis < Dim; ++axis) {
            simplex.corners[corner][axis] =
                Floats(patch.corners[(corner * Dim + axis) * kLanes + lane]);
        }
    }
    simplex.set_bounds();
}

template <int Dim>
[[gnu::always_inline]] inline Floats dot(const Floats* a, const Floats* b) {
    Floats sum = a[0] * b[0];
    for (int axis = 1; axis < Dim; ++axis) {
        sum = multiply_add(a[axis], b[axis], sum);
    }
    return sum;
}

// The corner that is least, or most, along a line, and how far along.
template <int Dim>
struct Support {
    Floats corner[Dim];  // NOLINT(modernize-avoid-c-arrays)
    Floats along;

    template <int Count>
    [[gnu::always_inline]] void set(const Floats* line,
                                    const Simplex<Dim, Count>& simplex,
                                    bool is_least) {
        along = dot<Dim>(line, simplex.corners[0]);
        for (int axis = 0; axis < Dim; ++axis) {
            corner[axis] = simplex.corners[0][axis];
        }
        for (int next = 1; next < Count; ++next) {
            const Floats of_next = dot<Dim>(line, simplex.corners[next]);
            const auto is_better = is_least ? of_next < along : of_next > along;
            along = select(is_better, of_next, along);
            for (int axis = 0; axis < Dim; ++axis) {
                corner[axis] = select(is_better, simplex.corners[next][axis], corner[axis]);
            }
        }
    }
};

// Simplices of one and of another patch, at the start and at the end of their paths.
template <int Dim, int K, int L, bool IsStill>
struct Pairs {
    Simplex<Dim, K> first[2];   // NOLINT(modernize-avoid-c-arrays)
    Simplex<Dim, L> second[2];  // NOLINT(modernize-avoid-c-arrays)

    // Boxes that are apart along an axis at both ends are at all times. `distance` is that of
    // different simplices.
    [[nodiscard, gnu::always_inline]] Mask<float, kRegisterLanes> are_boxes_apart(
        const Floats& distance) const {
        Floats sum(0.0F);
        for (int axis = 0; axis < Dim; ++axis) {
            Floats above = second[0].low[axis] - first[0].high[axis];
            Floats below = first[0].low[axis] - second[0].high[axis];
            if constexpr (!IsStill) {
                above = min(above, second[1].low[axis] - first[1].high[axis]);
                below = min(below, first[1].low[axis] - second[1].high[axis]);
            }
            const Floats gap = max(max(above, below), Floats(0.0F));
            sum = multiply_add(gap, gap, sum);
        }
        return sum > distance * distance;
    }

    // Whether a line is found along which they are apart at both ends, hence at all times: from
    // that through their middles on the nearest point of the hull of all differences of corners is
    // approached [gilbert1966], and given up where it is nearer than the distance, or soon.
    [[nodiscard, gnu::always_inline]] Mask<float, kRegisterLanes> are_apart_along_a_line(
        const Floats& distance, Mask<float, kRegisterLanes> are_apart) const {
        constexpr int kEnds = IsStill ? 1 : 2;
        Floats line[Dim];  // NOLINT(modernize-avoid-c-arrays)
        for (int axis = 0; axis < Dim; ++axis) {
            line[axis] = second[0].middle[axis] - first[0].middle[axis];
            if constexpr (!IsStill) {
                line[axis] += second[1].middle[axis] - first[1].middle[axis];
                line[axis] *= Floats(0.5F);
            }
        }
        for (int approach = 0; approach < kApproaches; ++approach) {
            const Floats squared = dot<Dim>(line, line);
            Floats least;
            Floats toward[Dim];  // NOLINT(modernize-avoid-c-arrays): to the support
            for (int end = 0; end < kEnds; ++end) {
                Support<Dim> of_first;
                Support<Dim> of_second;
                of_first.set(line, first[end], false);
                of_second.set(line, second[end], true);
                const Floats gap = of_second.along - of_first.along;
                const auto is_better = end == 0 ? gap == gap : gap < least;
                least = end == 0 ? gap : select(is_better, gap, least);
                for (int axis = 0; axis < Dim; ++axis) {
                    const Floats next = of_second.corner[axis] - of_first.corner[axis] - line[axis];
                    toward[axis] = end == 0 ? next : select(is_better, next, toward[axis]);
                }
            }
            are_apart = are_apart || least > distance * sqrt(squared);
            if (pent::all(are_apart || squared < distance * distance)) {
                break;
            }
            const Floats way = dot<Dim>(toward, toward);
            const Floats part =
                -dot<Dim>(line, toward) / max(way, Floats(kLeastLength * kLeastLength));
            const Floats step = min(max(part, Floats(0.0F)), Floats(1.0F));
            for (int axis = 0; axis < Dim; ++axis) {
                line[axis] = multiply_add(step, toward[axis], line[axis]);
            }
        }
        return are_apart;
    }
};

// Coordinates of the origin of the second patch as seen from that of the first, and the largest
// there is in either.
template <int Dim>
float shift_between(const LanesView& first, const LanesView& second, float* shift) {
    float most = 0;
    for (int axis = 0; axis < Dim; ++axis) {
        shift[axis] = static_cast<float>(second.origin[axis] - first.origin[axis]);
        const float size = shift[axis] < 0 ? -shift[axis] : shift[axis];
        most = size > most ? size : most;
    }
    return most + first.extent + second.extent;
}

template <int Dim, int K, int L, bool IsStill>
void find_near(const LanesOnPaths& patches, double distance, std::uint16_t* near) {
    float shift[2][Dim];  // NOLINT(modernize-avoid-c-arrays)
    float size = shift_between<Dim>(patches.first_start, patches.second_start, shift[0]);
    if constexpr (!IsStill) {
        const float end = shift_between<Dim>(patches.first_end, patches.second_end, shift[1]);
        size = end > size ? end : size;
    }
    const float limit = static_cast<float>(distance) * (1 + kRelativeRounding) + kRounding * size;
    const int count = patches.second_start.count;
    const std::uint32_t all = (1U << count) - 1;
    const bool is_told = limit > kLeastLength;
    for (int i = 0; i < kLanes; ++i) {
        near[i] = static_cast<std::uint16_t>(is_told || i >= patches.first_start.count ? 0U : all);
    }
    if (!is_told) {
        return;
    }
    Pairs<Dim, K, L, IsStill> pairs;
    for (int lane = 0; lane < count; lane += kRegisterLanes) {
        load<Dim, L>(patches.second_start, lane, shift[0], pairs.second[0]);
        if constexpr (!IsStill) {
            load<Dim, L>(patches.second_end, lane, shift[1], pairs.second[1]);
        }
        for (int i = 0; i < patches.first_start.count; ++i) {
            spread<Dim, K>(patches.first_start, i, pairs.first[0]);
            if constexpr (!IsStill) {
                spread<Dim, K>(patches.first_end, i, pairs.first[1]);
            }
            auto are_apart = pairs.are_boxes_apart(Floats(limit));
            if (pent::all(are_apart)) {
                continue;
            }
            are_apart = pairs.are_apart_along_a_line(Floats(limit), are_apart);
            near[i] |= static_cast<std::uint16_t>((bits(!are_apart) << lane) & all);
        }
    }
}

template <int Dim, int K, int L>
void find_near_lanes(const LanesOnPaths& patches, double distance, std::uint16_t* near) {
    const bool is_still = patches.first_start.corners == patches.first_end.corners
                          && patches.second_start.corners == patches.second_end.corners;
    if (is_still) {
        find_near<Dim, K, L, true>(patches, distance, near);
    } else {
        find_near<Dim, K, L, false>(patches, distance, near);
    }
}

template <int Dim>
constexpr NearLanesKernels<Dim> kNearLanesKernels{find_near_lanes<Dim, 1, Dim>,
                                                  find_near_lanes<Dim, 2, Dim - 1>};

}  // namespace
}  // namespace pent::contact

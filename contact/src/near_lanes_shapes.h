#pragma once

#include "near_lanes.h"

#include <pent/register_bytes.h>
#include <pent/simd.h>

#include <cstdint>

// The shapes in which patches are looked at, side by side: boxes, extents along a line, and pairs
// of simplices. Included once for each instruction set, by near_lanes_kernel.h.

namespace pent::contact {
namespace {

constexpr int kRegisterLanes = kRegisterBytes / static_cast<int>(sizeof(float));

// How many lines are tried as separating axes of two simplices: after these few pairs are left that
// are not near.
constexpr int kApproaches = 4;

using Floats = Pack<float, kRegisterLanes>;
using Truths = Mask<float, kRegisterLanes>;
using Numbers = Truths::Vector;

// Squares of shorter lengths would be lost in float.
constexpr float kMinLength = 1e-15F;

// Lanes of a patch, one in each lane of a register.
struct Chosen {
    const std::int32_t* lanes;

    // Picks the numbers in the chosen lanes out of kLanes.
    [[nodiscard, gnu::always_inline]] Floats of(const float* numbers) const {
#if defined(__AVX512F__)
        const __m512i which = _mm512_loadu_si512(lanes);
        return Floats(reinterpret_cast<Floats::Vector>(
            _mm512_maskz_permutexvar_ps(0xffff, which, _mm512_loadu_ps(numbers))));
#elif defined(__AVX2__)
        const __m256i which = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(lanes));
        const __m256 low = _mm256_permutevar8x32_ps(_mm256_loadu_ps(numbers), which);
        const __m256 high =
            _mm256_permutevar8x32_ps(_mm256_loadu_ps(numbers + kRegisterLanes), which);
        const __m256 is_high = _mm256_castsi256_ps(_mm256_slli_epi32(which, 28));
        return Floats(reinterpret_cast<Floats::Vector>(_mm256_blendv_ps(low, high, is_high)));
#else
        float chosen[kRegisterLanes];  // NOLINT(modernize-avoid-c-arrays)
        for (int i = 0; i < kRegisterLanes; ++i) {
            chosen[i] = numbers[lanes[i]];
        }
        return Floats::load(chosen);
#endif
    }
};

template <int Dim>
struct LaneBox {
    float low[Dim];   // NOLINT(modernize-avoid-c-arrays): as all here, of plain numbers
    float high[Dim];  // NOLINT(modernize-avoid-c-arrays)
};

// The boxes around all simplices of a patch, side by side.
template <int Dim>
struct Boxes {
    float low[Dim][kLanes];   // NOLINT(modernize-avoid-c-arrays)
    float high[Dim][kLanes];  // NOLINT(modernize-avoid-c-arrays)

    [[nodiscard, gnu::always_inline]] LaneBox<Dim> operator[](int i) const {
        LaneBox<Dim> box;
        for (int axis = 0; axis < Dim; ++axis) {
            box.low[axis] = low[axis][i];
            box.high[axis] = high[axis][i];
        }
        return box;
    }

    // Sets them from a patch, moved by a shift.
    template <int Count>
    [[gnu::always_inline]] void set(const LanesView& patch, const float* shift) {
        for (int axis = 0; axis < Dim; ++axis) {
            for (int lane = 0; lane < kLanes; lane += kRegisterLanes) {
                Floats least = Floats::load(patch.corners + axis * kLanes + lane);
                Floats most = least;
                for (int corner = 1; corner < Count; ++corner) {
                    const Floats next =
                        Floats::load(patch.corners + (corner * Dim + axis) * kLanes + lane);
                    least = min(least, next);
                    most = max(most, next);
                }
                (least + Floats(shift[axis])).store(low[axis] + lane);
                (most + Floats(shift[axis])).store(high[axis] + lane);
            }
        }
    }
};

// Bit i: whether box i may come within a distance of a box, both at all ends of their paths. Boxes
// that are apart along an axis at both ends are at all times.
template <int Dim, int Ends>
[[gnu::always_inline]] inline std::uint32_t near_boxes(const LaneBox<Dim>* box,
                                                       const Boxes<Dim>* boxes,
                                                       int count,
                                                       const Floats& squared_distance) {
    std::uint32_t near = 0;
    for (int lane = 0; lane < count; lane += kRegisterLanes) {
        Floats sum(0.0F);
        for (int axis = 0; axis < Dim; ++axis) {
            Floats above = Floats::load(boxes[0].low[axis] + lane) - Floats(box[0].high[axis]);
            Floats below = Floats(box[0].low[axis]) - Floats::load(boxes[0].high[axis] + lane);
            if constexpr (Ends == 2) {
                above =
                    min(above, Floats::load(boxes[1].low[axis] + lane) - Floats(box[1].high[axis]));
                below =
                    min(below, Floats(box[1].low[axis]) - Floats::load(boxes[1].high[axis] + lane));
            }
            const Floats gap = max(max(above, below), Floats(0.0F));
            sum = multiply_add(gap, gap, sum);
        }
        near |= bits(!(sum > squared_distance)) << lane;
    }
    return near & ((1U << count) - 1);
}

// Some simplices side by side.
template <int Dim, int Count>
struct Simplex {
    Floats corners[Count][Dim];  // NOLINT(modernize-avoid-c-arrays)

    // Sets them to those in chosen lanes of a patch, moved by a shift.
    [[gnu::always_inline]] void set(const LanesView& patch,
                                    const Chosen& chosen,
                                    const float* shift) {
        for (int corner = 0; corner < Count; ++corner) {
            for (int axis = 0; axis < Dim; ++axis) {
                corners[corner][axis] =
                    chosen.of(patch.corners + (corner * Dim + axis) * kLanes) + Floats(shift[axis]);
            }
        }
    }

    [[nodiscard, gnu::always_inline]] Floats middle(int axis) const {
        Floats sum = corners[0][axis];
        for (int corner = 1; corner < Count; ++corner) {
            sum += corners[corner][axis];
        }
        return sum * Floats(1.0F / Count);
    }
};

// How far the simplices of a patch reach along a line.
template <int Dim, int Count>
struct Reach {
    float of_lane[kLanes];  // NOLINT(modernize-avoid-c-arrays)
    float most;

    [[gnu::always_inline]] void set(const LanesView& patch, const float* line, float shift) {
        float left[kLanes];  // NOLINT(modernize-avoid-c-arrays)
        for (int lane = 0; lane < kLanes; lane += kRegisterLanes) {
            Floats reach;
            for (int corner = 0; corner < Count; ++corner) {
                Floats along(shift);
                for (int axis = 0; axis < Dim; ++axis) {
                    along = multiply_add(
                        Floats(line[axis]),
                        Floats::load(patch.corners + (corner * Dim + axis) * kLanes + lane), along);
                }
                reach = corner == 0 ? along : max(along, reach);
            }
            reach.store(of_lane + lane);
            reach.store(left + lane);
        }
        for (int half = kLanes / 2; half > 0; half /= 2) {
            for (int i = 0; i < half; ++i) {
                left[i] = left[i] > left[i + half] ? left[i] : left[i + half];
            }
        }
        most = left[0];
    }
};

template <int Dim>
[[gnu::always_inline]] inline float dot(const float* a, const float* b) {
    float sum = 0;
    for (int axis = 0; axis < Dim; ++axis) {
        sum += a[axis] * b[axis];
    }
    return sum;
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

// Simplices of one and of another patch, different ones in each lane, at the start and at the end
// of their paths.
template <int Dim, int K, int L, bool IsStill>
struct Pairs {
    Simplex<Dim, K> first[2];   // NOLINT(modernize-avoid-c-arrays)
    Simplex<Dim, L> second[2];  // NOLINT(modernize-avoid-c-arrays)

    // Whether a separating line is found, along which they are apart at both ends, hence at all
    // times. It begins through their middles; from there the nearest point of the hull of all
    // differences of corners is approached [gilbert1966]. The search is given up where that is
    // nearer than the distance, or after a few approaches.
    [[nodiscard, gnu::always_inline]] Truths are_apart(const Floats& distance) const {
        constexpr int kEnds = IsStill ? 1 : 2;
        Floats line[Dim];  // NOLINT(modernize-avoid-c-arrays)
        for (int axis = 0; axis < Dim; ++axis) {
            line[axis] = second[0].middle(axis) - first[0].middle(axis);
            if constexpr (!IsStill) {
                line[axis] += second[1].middle(axis) - first[1].middle(axis);
                line[axis] *= Floats(0.5F);
            }
        }
        Truths are_apart = distance < Floats(0.0F);
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
            if (approach == kApproaches - 1
                || pent::all(are_apart || squared < distance * distance)) {
                break;
            }
            const Floats toward_squared = dot<Dim>(toward, toward);
            const Floats part =
                -dot<Dim>(line, toward) / max(toward_squared, Floats(kMinLength * kMinLength));
            const Floats step = min(max(part, Floats(0.0F)), Floats(1.0F));
            for (int axis = 0; axis < Dim; ++axis) {
                line[axis] = multiply_add(step, toward[axis], line[axis]);
            }
        }
        return are_apart;
    }
};

}  // namespace
}  // namespace pent::contact

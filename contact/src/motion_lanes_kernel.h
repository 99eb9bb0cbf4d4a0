#pragma once

#include "motion_lanes.h"

#include <pent/simd.h>

// Included once for each instruction set, by a file that is compiled for it.

namespace pent::contact {
namespace {

// Lanes hold the axes of one patch, or numbers of four patches.
using Four = Pack<double, 4>;
constexpr int kFour = 4;

// The sum of each row.
[[nodiscard, gnu::always_inline]] inline Four sums(Four* rows) {
    transpose<kFour>(rows);
    return (rows[0] + rows[1]) + (rows[2] + rows[3]);
}

// By axes, squares of half of what the maps A and B of two patches differ by, and of how far their
// centers are from where the mean of both maps takes them. With a and b where they take the origin,
// and X and Y the earlier centers, the latter is a - b + (A - B) (X + Y) / 2.
struct Parting {
    Four turn;
    Four shift;

    [[gnu::always_inline]] Parting(const double* a, const double* b, const Four& centers) {
        Four shifted = Four::load(a) - Four::load(b);
        turn = Four(0.0);
        for (int axis = 0; axis < MotionRows::kAxes; ++axis) {
            const int column = MotionRows::kAxes * (1 + axis);
            const Four half = Four(0.5) * (Four::load(a + column) - Four::load(b + column));
            turn = multiply_add(half, half, turn);
            shifted = multiply_add(half, Four(centers.lanes[axis]), shifted);
        }
        shift = shifted * shifted;
    }
};

// Four patches after four; those left over are the last one again.
void bound_motions(const double* first,
                   const MotionRows& others,
                   const std::uint32_t* which,
                   int count,
                   PatchBound* bounds) {
    const Four center = Four::load(first + MotionRows::kEarlierCenter);
    const double* const sizes = first + MotionRows::kSizes;
    const auto size = static_cast<std::uint64_t>(MotionRows::size(others.places));
    for (int begin = 0; begin < count; begin += kFour) {
        const double* rows[kFour];  // NOLINT(modernize-avoid-c-arrays): plain numbers, as below
        for (int k = 0; k < kFour; ++k) {
            const std::uint32_t patch = which[begin + k < count ? begin + k : count - 1];
            rows[k] = others.numbers + patch * size;
        }
        Four turn(0.0);
        Four shift(0.0);
        for (int place = 0; place < others.places; ++place) {
            const int at = MotionRows::kPlaces + place * MotionRows::kPlaceSize;
            Four turns[kFour];   // NOLINT(modernize-avoid-c-arrays)
            Four shifts[kFour];  // NOLINT(modernize-avoid-c-arrays)
            for (int k = 0; k < kFour; ++k) {
                const Parting parting(first + at, rows[k] + at,
                                      center + Four::load(rows[k] + MotionRows::kEarlierCenter));
                turns[k] = parting.turn;
                shifts[k] = parting.shift;
            }
            turn = max(sums(turns), turn);
            shift = max(sums(shifts), shift);
        }
        turn = sqrt(turn);
        shift = sqrt(shift);
        Four of_others[kFour];  // NOLINT(modernize-avoid-c-arrays)
        for (int k = 0; k < kFour; ++k) {
            of_others[k] = Four::load(rows[k] + MotionRows::kSizes);
        }
        transpose<kFour>(of_others);
        const auto& [least_stretch, radius, deviation, unused] = of_others;
        double stretch[kFour];  // NOLINT(modernize-avoid-c-arrays)
        double lack[kFour];     // NOLINT(modernize-avoid-c-arrays)
        (max(Four(sizes[0]), least_stretch) - turn).store(stretch);
        (shift + turn * (Four(sizes[1]) + radius) + (Four(sizes[2]) + deviation)).store(lack);
        for (int k = 0; k < kFour && begin + k < count; ++k) {
            bounds[begin + k].stretch = stretch[k];
            bounds[begin + k].lack = lack[k];
        }
    }
}

}  // namespace
}  // namespace pent::contact

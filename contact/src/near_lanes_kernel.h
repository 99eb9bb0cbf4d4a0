#pragma once

#include "near_lanes_shapes.h"

// Included once for each instruction set, by a file that is compiled for it.

namespace pent::contact {
namespace {

// Of the largest coordinate: what rounding adds to a gap, at most. Coordinates lack three roundings
// of 2^-24, and a sum of four products of twice as much, or two where the shift has its own, some
// ten: 2e-6 in all.
constexpr float kRounding = 4e-6F;

// The same of the distance, for the length of a line.
constexpr float kRelativeRounding = 1e-5F;

// Two patches, and where the second is as seen from the origin of the first, at the start and at
// the end.
template <int Dim, int K, int L, bool IsStill>
class PatchPair {
public:
    explicit PatchPair(const LanesOnPaths& patches)
        : first_{patches.first_start, patches.first_end},
          second_{patches.second_start, patches.second_end} {
        for (int end = 0; end < kEnds; ++end) {
            set_shift(end);
        }
    }

    // The largest coordinate.
    [[nodiscard]] float size() const { return size_; }

    // Whether all of the first are apart from all of the second, at both ends, along the line
    // through the middles of the boxes around them.
    [[nodiscard]] bool are_apart(float distance) {
        float line[Dim];  // NOLINT(modernize-avoid-c-arrays)
        float back[Dim];  // NOLINT(modernize-avoid-c-arrays)
        for (int axis = 0; axis < Dim; ++axis) {
            line[axis] = 0;
            for (int end = 0; end < kEnds; ++end) {
                line[axis] += second_[end].low[axis] + second_[end].high[axis]
                              - first_[end].low[axis] - first_[end].high[axis]
                              + 2 * shift_[end][axis];
            }
            back[axis] = -line[axis];
        }
        enough_ = distance * __builtin_sqrtf(dot<Dim>(line, line));
        bool are_apart = true;
        for (int end = 0; end < kEnds; ++end) {
            of_first_[end].set(first_[end], line, 0);
            of_second_[end].set(second_[end], back, dot<Dim>(back, shift_[end]));
            are_apart = are_apart && -(of_first_[end].most + of_second_[end].most) > enough_;
        }
        return are_apart;
    }

    // After are_apart(), whose line tells of single simplices, too. Most of the first are not even
    // near the box around all of the second. Returns whether any are near; so does what follows.
    bool find_near_boxes(float distance, std::uint16_t* near) const {
        const Floats squared_distance(distance * distance);
        Boxes<Dim> first[kEnds];     // NOLINT(modernize-avoid-c-arrays)
        LaneBox<Dim> around[kEnds];  // NOLINT(modernize-avoid-c-arrays): the second
        for (int end = 0; end < kEnds; ++end) {
            first[end].template set<K>(first_[end], kNoShift);
            for (int axis = 0; axis < Dim; ++axis) {
                around[end].low[axis] = second_[end].low[axis] + shift_[end][axis];
                around[end].high[axis] = second_[end].high[axis] + shift_[end][axis];
            }
        }
        float all_of_second[2] = {};  // NOLINT(modernize-avoid-c-arrays)
        for (int end = 0; end < kEnds; ++end) {
            all_of_second[end] = of_second_[end].most;
        }
        unsigned left = near_boxes<Dim, kEnds>(around, first, first_[0].count, squared_distance)
                        & near_along_line(of_first_, all_of_second);
        if (left == 0) {
            return false;
        }
        Boxes<Dim> second[kEnds];  // NOLINT(modernize-avoid-c-arrays)
        for (int end = 0; end < kEnds; ++end) {
            second[end].template set<L>(second_[end], shift_[end]);
        }
        bool is_any = false;
        for (; left != 0; left &= left - 1) {
            const int i = __builtin_ctz(left);
            LaneBox<Dim> box[kEnds];  // NOLINT(modernize-avoid-c-arrays)
            float reach[2] = {};      // NOLINT(modernize-avoid-c-arrays)
            for (int end = 0; end < kEnds; ++end) {
                box[end] = first[end][i];
                reach[end] = of_first_[end].of_lane[i];
            }
            near[i] = static_cast<std::uint16_t>(
                near_boxes<Dim, kEnds>(box, second, second_[0].count, squared_distance)
                & near_along_line(of_second_, reach) & ~sharing(i));
            is_any = is_any || near[i] != 0;
        }
        return is_any;
    }

    // Takes out pairs that are apart along a line. Lines take much longer than boxes, and few boxes
    // are near each other: so what is left is gathered from all lanes, until every lane has a pair.
    bool keep_near_simplices(float distance, std::uint16_t* near) const {
        constexpr int kPairs = kLanes * kLanes;
        std::int32_t of_first[kPairs + kRegisterLanes];   // NOLINT(modernize-avoid-c-arrays)
        std::int32_t of_second[kPairs + kRegisterLanes];  // NOLINT(modernize-avoid-c-arrays)
        int count = 0;
        for (int i = 0; i < first_[0].count; ++i) {
            for (unsigned left = near[i]; left != 0; left &= left - 1) {
                of_first[count] = i;
                of_second[count++] = __builtin_ctz(left);
            }
            near[i] = 0;
        }
        for (int lane = 0; lane < kRegisterLanes; ++lane) {
            of_first[count + lane] = of_second[count + lane] = 0;  // in lanes that are left over
        }
        bool is_any = false;
        for (int begin = 0; begin < count; begin += kRegisterLanes) {
            const auto pairs = gather(of_first + begin, of_second + begin);
            unsigned left = bits(!pairs.are_apart(Floats(distance)));
            if (count - begin < kRegisterLanes) {
                left &= (1U << (count - begin)) - 1;
            }
            for (; left != 0; left &= left - 1) {
                const int pair = begin + __builtin_ctz(left);
                near[of_first[pair]] |= static_cast<std::uint16_t>(1U << of_second[pair]);
                is_any = true;
            }
        }
        return is_any;
    }

    // Bit j: whether simplex j of the second has a vertex of simplex i of the first.
    [[nodiscard]] std::uint32_t sharing(int i) const {
        std::uint32_t sharing = 0;
        for (int lane = 0; lane < kLanes; lane += kRegisterLanes) {
            Truths is_same{Numbers{}};
            for (int b = 0; b < L; ++b) {
                Numbers of_second;
                __builtin_memcpy(&of_second, second_[0].vertices + b * kLanes + lane,
                                 sizeof of_second);
                for (int a = 0; a < K; ++a) {
                    const std::int32_t of_first = first_[0].vertices[a * kLanes + i];
                    is_same = is_same || Truths{of_second == of_first};
                }
            }
            sharing |= bits(is_same) << lane;
        }
        return sharing;
    }

private:
    static constexpr int kEnds = IsStill ? 1 : 2;
    static constexpr float kNoShift[Dim] = {};  // NOLINT(modernize-avoid-c-arrays)

    void set_shift(int end) {
        float most = 0;
        for (int axis = 0; axis < Dim; ++axis) {
            const auto shift =
                static_cast<float>(second_[end].origin[axis] - first_[end].origin[axis]);
            const float size = shift < 0 ? -shift : shift;
            most = size > most ? size : most;
            shift_[end][axis] = shift;
        }
        most += first_[end].extent + second_[end].extent;
        size_ = most > size_ ? most : size_;
    }

    [[nodiscard, gnu::always_inline]] Pairs<Dim, K, L, IsStill> gather(
        const std::int32_t* of_first, const std::int32_t* of_second) const {
        Pairs<Dim, K, L, IsStill> pairs;
        for (int end = 0; end < kEnds; ++end) {
            pairs.first[end].set(first_[end], Chosen{of_first}, kNoShift);
            pairs.second[end].set(second_[end], Chosen{of_second}, shift_[end]);
        }
        return pairs;
    }

    // Bit i: whether simplex i of a patch, reaching so far, is not apart along the line from what
    // reaches so far from the other side, each at both ends.
    template <int Count>
    [[nodiscard]] std::uint32_t near_along_line(const Reach<Dim, Count>* reaches,
                                                const float* others) const {
        std::uint32_t near = 0;
        for (int lane = 0; lane < kLanes; lane += kRegisterLanes) {
            Floats least = Floats::load(reaches[0].of_lane + lane) + Floats(others[0]);
            if constexpr (!IsStill) {
                least = max(least, Floats::load(reaches[1].of_lane + lane) + Floats(others[1]));
            }
            near |= bits(!(-least > Floats(enough_))) << lane;
        }
        return near;
    }

    LanesView first_[2];       // NOLINT(modernize-avoid-c-arrays)
    LanesView second_[2];      // NOLINT(modernize-avoid-c-arrays)
    float shift_[kEnds][Dim];  // NOLINT(modernize-avoid-c-arrays)
    float size_ = 0;

    // How far the first reach along the line and the second back, and what is apart along it.
    Reach<Dim, K> of_first_[kEnds];   // NOLINT(modernize-avoid-c-arrays)
    Reach<Dim, L> of_second_[kEnds];  // NOLINT(modernize-avoid-c-arrays)
    float enough_ = 0;
};

template <int Dim, int K, int L, bool IsStill>
bool find_near(const LanesOnPaths& patches, double distance, std::uint16_t* near) {
    PatchPair<Dim, K, L, IsStill> pair(patches);
    const float limit =
        static_cast<float>(distance) * (1 + kRelativeRounding) + kRounding * pair.size();
    const bool is_told = limit > kMinLength;
    if (is_told && pair.are_apart(limit)) {
        return false;
    }
    const std::uint32_t all = (1U << patches.second_start.count) - 1;
    for (int i = 0; i < kLanes; ++i) {
        near[i] = static_cast<std::uint16_t>(
            is_told || i >= patches.first_start.count ? 0U : all & ~pair.sharing(i));
    }
    return !is_told || (pair.find_near_boxes(limit, near) && pair.keep_near_simplices(limit, near));
}

template <int Dim, int K, int L>
bool find_near_lanes(const LanesOnPaths& patches, double distance, std::uint16_t* near) {
    const bool is_still = patches.first_start.corners == patches.first_end.corners
                          && patches.second_start.corners == patches.second_end.corners;
    return is_still ? find_near<Dim, K, L, true>(patches, distance, near)
                    : find_near<Dim, K, L, false>(patches, distance, near);
}

}  // namespace
}  // namespace pent::contact

#pragma once

#include <cstddef>
#include <new>
#include <utility>

namespace pent::simulator {

/// Memory aligned to a cache line. Large arrays are aligned to huge pages, and the system is asked
/// for these: they are traversed over and over, and some are allocated anew in every step, which
/// with small pages costs many TLB misses and page faults.
[[nodiscard]] void* allocate_lines(std::size_t bytes);
/// @param bytes  As it was asked for.
void free_lines(void* memory, std::size_t bytes);

/// Allocator for arrays that kernels stream through. Aligned to cache lines, so that a 4 x 4 block
/// of floats is in one; and resize() leaves numbers uninitialized, to be filled by all threads.
template <typename Value>
struct LineAllocator {
    using value_type = Value;  // NOLINT(readability-identifier-naming): required name

    LineAllocator() = default;
    template <typename Other>
    explicit LineAllocator(const LineAllocator<Other>& /*other*/) {}

    [[nodiscard]] Value* allocate(std::size_t count) {
        return static_cast<Value*>(allocate_lines(count * sizeof(Value)));
    }
    void deallocate(Value* memory, std::size_t count) { free_lines(memory, count * sizeof(Value)); }
    template <typename Other>
    void construct(Other* at) noexcept {
        ::new (static_cast<void*>(at)) Other;
    }
    template <typename Other, typename... From>
    void construct(Other* at, From&&... from) {
        ::new (static_cast<void*>(at)) Other(std::forward<From>(from)...);
    }
    template <typename Other>
    bool operator==(const LineAllocator<Other>& /*other*/) const {
        return true;
    }
};

}  // namespace pent::simulator

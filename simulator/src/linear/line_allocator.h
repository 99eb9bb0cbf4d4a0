#pragma once

#include <cstddef>
#include <new>
#include <utility>

namespace pent::simulator {

/// Memory that starts at a cache line. Much of it is in large pages, where the system has them to
/// give: it is gone through from end to end over and over, and every step asks for some of it anew.
[[nodiscard]] void* allocate_lines(std::size_t bytes);
/// @param bytes  As it was asked for.
void free_lines(void* memory, std::size_t bytes);

/// Starts arrays at cache lines, so that no 4 x 4 block of floats lies across two, and leaves
/// numbers that nothing is said of as they are: who fills them does so with all threads.
template <typename Value>
struct LineAllocator {
    using value_type = Value;  // NOLINT(readability-identifier-naming): as allocators must

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

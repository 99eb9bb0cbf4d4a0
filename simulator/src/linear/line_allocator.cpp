#include "linear/line_allocator.h"

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace pent::simulator {

namespace {

constexpr std::size_t kLine = 64;
constexpr std::size_t kPage = std::size_t{2} << 20;  // a huge one
constexpr std::size_t kMuch = 4 * kPage;

constexpr std::align_val_t alignment_of(std::size_t bytes) {
    return std::align_val_t{bytes < kMuch ? kLine : kPage};
}

}  // namespace

void* allocate_lines(std::size_t bytes) {
    void* memory = ::operator new(bytes, alignment_of(bytes));
#if defined(__linux__)
    if (bytes >= kMuch) {
        ::madvise(memory, bytes, MADV_HUGEPAGE);  // a hint: where it fails pages are small
    }
#endif
    return memory;
}

void free_lines(void* memory, std::size_t bytes) {
    ::operator delete(memory, alignment_of(bytes));
}

}  // namespace pent::simulator

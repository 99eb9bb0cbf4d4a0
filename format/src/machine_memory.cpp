#include <pent/machine_memory.h>

#include <unistd.h>

namespace pent {

std::int64_t machine_memory() {
    return std::int64_t{::sysconf(_SC_PHYS_PAGES)} * std::int64_t{::sysconf(_SC_PAGESIZE)};
}

}  // namespace pent

#include "potentials/contact_team.h"

#include <cstring>

namespace pent::simulator {

namespace {

// How many doubles it takes to hold so many bytes.
std::int64_t numbers_for(std::size_t bytes) {
    return static_cast<std::int64_t>((bytes + sizeof(double) - 1) / sizeof(double));
}

}  // namespace

std::size_t ContactTeam::count() const {
    return static_cast<std::size_t>(ranks_->count());
}

std::size_t ContactTeam::rank() const {
    return static_cast<std::size_t>(ranks_->rank());
}

// Ranks exchange doubles alone: bytes travel as these, which nobody computes with.
std::vector<std::vector<std::byte>> ContactTeam::gather(std::span<const std::byte> own) const {
    const auto own_size = static_cast<double>(own.size());
    const std::vector<double> sizes =
        ranks_->gather({&own_size, 1}, std::vector<std::int64_t>(count(), 1));
    std::vector<std::int64_t> numbers;
    for (const double size : sizes) {
        numbers.push_back(numbers_for(static_cast<std::size_t>(size)));
    }
    std::vector<double> packed(static_cast<std::size_t>(numbers[rank()]), 0);
    if (!own.empty()) {
        std::memcpy(packed.data(), own.data(), own.size());
    }
    const std::vector<double> all = ranks_->gather(packed, numbers);
    std::vector<std::vector<std::byte>> lists;
    const double* next = all.data();
    for (std::size_t i = 0; i < sizes.size(); ++i) {
        const auto* bytes = reinterpret_cast<const std::byte*>(next);
        lists.emplace_back(bytes, bytes + static_cast<std::size_t>(sizes[i]));
        next += numbers[i];
    }
    return lists;
}

}  // namespace pent::simulator

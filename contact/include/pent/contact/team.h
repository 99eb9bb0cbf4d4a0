#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace pent::contact {

/// Processes that look for contacts of one scene together. Each has all of the scene, looks at
/// pieces of the work, and tells the others what it found: all have the same then, and to the bit
/// what one alone finds.
class Team {
public:
    Team() = default;
    virtual ~Team() = default;
    Team(const Team&) = delete;
    Team& operator=(const Team&) = delete;
    Team(Team&&) = delete;
    Team& operator=(Team&&) = delete;

    [[nodiscard]] virtual std::size_t count() const = 0;
    [[nodiscard]] virtual std::size_t rank() const = 0;  ///< In [0, count()).

    /// What each has given, by rank. All call it, in the same order, and wait for one another.
    [[nodiscard]] virtual std::vector<std::vector<std::byte>> gather(
        std::span<const std::byte> own) const = 0;
};

}  // namespace pent::contact

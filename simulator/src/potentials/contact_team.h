#pragma once

#include <pent/contact/team.h>
#include <pent/simulator/ranks.h>

namespace pent::simulator {

/// Ranks that look for contacts together.
class ContactTeam final : public contact::Team {
public:
    /// @param ranks  Must outlive this.
    explicit ContactTeam(const Ranks& ranks) : ranks_(&ranks) {}

    [[nodiscard]] std::size_t count() const override;
    [[nodiscard]] std::size_t rank() const override;
    [[nodiscard]] std::vector<std::vector<std::byte>> gather(
        std::span<const std::byte> own) const override;

private:
    const Ranks* ranks_;
};

}  // namespace pent::simulator

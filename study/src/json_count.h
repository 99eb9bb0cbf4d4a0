#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>

namespace pent::study {

/// A count in a report: whole and not negative. Throws nlohmann's exception for any other value,
/// which would be rounded or overflow.
[[nodiscard]] inline std::int64_t count_of(const nlohmann::json& json) {
    return static_cast<std::int64_t>(json.get_ref<const nlohmann::json::number_unsigned_t&>());
}

}  // namespace pent::study

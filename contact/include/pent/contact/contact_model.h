#pragma once

#include <cstdint>

namespace pent::contact {

/// How what touches is pushed apart; docs/contact.md and docs/barrier.md have the models.
enum class ContactModel : std::uint8_t {
    Penalty,  ///< Soft and fast; bodies can pass through each other.
    Barrier,  ///< Nothing ever crosses.
};

}  // namespace pent::contact

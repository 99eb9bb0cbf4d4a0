#pragma once

#include <pent/contact/filter.h>

#include <cmath>

namespace pent::contact {

/// An eigenvalue as the filter leaves it.
[[nodiscard]] inline double filtered(double eigenvalue, Filter filter) {
    switch (filter) {
        case Filter::Clamp:
            return eigenvalue > 0 ? eigenvalue : 0;
        case Filter::Absolute:
            return std::abs(eigenvalue);
        case Filter::None:
            break;
    }
    return eigenvalue;
}

}  // namespace pent::contact

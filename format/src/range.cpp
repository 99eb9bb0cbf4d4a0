#include "pent/range.h"

#include <cmath>
#include <sstream>

namespace pent {

std::string readable(double value) {
    std::ostringstream text;
    text << value;
    return text.str();
}

bool is_between(const Range& range, double value) {
    const bool above = range.low_included ? value >= range.low : value > range.low;
    const bool below = range.high_included ? value <= range.high : value < range.high;
    return above && below && std::isfinite(value);
}

bool is_of_size(const Range& range, double value) {
    return value == 0 || (std::abs(value) >= range.smallest && std::abs(value) <= range.largest);
}

std::string expected_in(const Range& range, double value) {
    if (!is_between(range, value)) {
        return text_of(range);
    }
    return is_of_size(range, value)
               ? ""
               : (is_between(range, 0) ? "0 or a size from " : "a size from ")
                     + readable(range.smallest) + " to " + readable(range.largest);
}

std::string text_of(const Range& range) {
    const bool has_low = std::isfinite(range.low);
    const bool has_high = std::isfinite(range.high);
    std::string text = "a number";
    if (has_low) {
        text += (range.low_included ? " of at least " : " above ") + readable(range.low);
    }
    if (has_high) {
        text += has_low ? " and" : "";
        text += (range.high_included ? " at most " : " below ") + readable(range.high);
    }
    return text;
}

}  // namespace pent

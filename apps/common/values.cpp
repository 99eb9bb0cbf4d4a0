#include "values.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <limits>
#include <sstream>

namespace pent::apps {

namespace {

// As one reads a bound: 0.0001, 1000000000.
std::string text_of(double value) {
    std::ostringstream text;
    text << std::setprecision(std::numeric_limits<double>::digits10) << value;
    return text.str();
}

// Accepts what is read as a Value, as the option itself will read it, and is `right`.
template <typename Value, typename Right>
CLI::Validator check_of(const std::string& wanted, const std::string& help, const Right& right) {
    return {[=](const std::string& word) {
                Value value = 0;
                const bool is_right = CLI::detail::lexical_cast(word, value) && right(value);
                return is_right ? "" : "found \"" + word + "\"; expected " + wanted;
            },
            help};
}

std::string between(const std::string& low, const std::string& high) {
    return "from " + low + " to " + high;
}

}  // namespace

CLI::Validator whole_number(std::int64_t low, std::int64_t high) {
    const std::string bounds = between(std::to_string(low), std::to_string(high));
    return check_of<std::int64_t>("a whole number " + bounds, bounds, [=](std::int64_t value) {
        return low <= value && value <= high;
    });
}

CLI::Validator number(double low, double high) {
    const std::string bounds = between(text_of(low), text_of(high));
    return check_of<double>("a number " + bounds, bounds,
                            [=](double value) { return low <= value && value <= high; });
}

CLI::Validator positive_number() {
    return check_of<double>("a number above 0", "above 0",
                            [](double value) { return value > 0 && std::isfinite(value); });
}

CLI::Validator nonnegative_number() {
    return check_of<double>("a number of at least 0", "of at least 0",
                            [](double value) { return value >= 0 && std::isfinite(value); });
}

CLI::Validator one_of(const std::vector<std::string>& words) {
    std::string all;
    for (const std::string& word : words) {
        all += (all.empty() ? "" : &word == &words.back() ? " or " : ", ") + word;
    }
    return {[=](std::string& given) {
                const auto found =
                    std::find_if(words.begin(), words.end(), [&](const std::string& word) {
                        return CLI::detail::to_lower(word) == CLI::detail::to_lower(given);
                    });
                if (found == words.end()) {
                    return "found \"" + given + "\"; expected " + all;
                }
                given = *found;
                return std::string();
            },
            ""};
}

}  // namespace pent::apps

#include <pent/formatted.h>

#include <algorithm>
#include <cstdarg>
#include <cstdio>

namespace pent {

std::string formatted(const char* format, ...) {
    std::va_list values;
    va_start(values, format);
    std::va_list again;
    va_copy(again, values);
    std::string text(256, '\0');  // long enough for nearly all
    const int length = std::vsnprintf(text.data(), text.size() + 1, format, values);
    va_end(values);
    const bool fits = length <= static_cast<int>(text.size());
    text.resize(static_cast<std::size_t>(std::max(length, 0)));
    if (!fits) {
        std::vsnprintf(text.data(), text.size() + 1, format, again);
    }
    va_end(again);
    return text;
}

}  // namespace pent

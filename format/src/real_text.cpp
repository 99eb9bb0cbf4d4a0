#include "pent/real_text.h"

#include "portable_chars.h"

namespace pent {

namespace {

template <typename Real>
std::to_chars_result write(char* first, char* last, Real value) {
#ifdef __cpp_lib_to_chars
    return std::to_chars(first, last, value);
#else
    return portable_to_chars(first, last, value);
#endif
}

template <typename Real>
std::from_chars_result read(const char* first, const char* last, Real& value) {
#ifdef __cpp_lib_to_chars
    return std::from_chars(first, last, value);
#else
    return portable_from_chars(first, last, value);
#endif
}

}  // namespace

std::to_chars_result real_to_chars(char* first, char* last, float value) {
    return write(first, last, value);
}

std::to_chars_result real_to_chars(char* first, char* last, double value) {
    return write(first, last, value);
}

std::from_chars_result real_from_chars(const char* first, const char* last, float& value) {
    return read(first, last, value);
}

std::from_chars_result real_from_chars(const char* first, const char* last, double& value) {
    return read(first, last, value);
}

}  // namespace pent

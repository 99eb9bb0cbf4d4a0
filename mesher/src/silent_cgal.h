#pragma once

#include <CGAL/assertions.h>

namespace pent::mesher {

/// While it lives, CGAL does not print the exceptions that it throws.
class SilentCgal {
public:
    SilentCgal() : before_(CGAL::set_error_handler(say_nothing)) {}
    ~SilentCgal() { CGAL::set_error_handler(before_); }
    SilentCgal(const SilentCgal&) = delete;
    SilentCgal& operator=(const SilentCgal&) = delete;
    SilentCgal(SilentCgal&&) = delete;
    SilentCgal& operator=(SilentCgal&&) = delete;

private:
    static void say_nothing(const char*, const char*, const char*, int, const char*) {}
    CGAL::Failure_function before_;
};

}  // namespace pent::mesher

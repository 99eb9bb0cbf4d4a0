// Linked into every program of a build that counts which lines run (-Wl,--wrap): the counters are
// written by exit(), and some of our processes end by _exit() instead.

#include <sys/resource.h>

extern "C" {

// NOLINTBEGIN(bugprone-reserved-identifier): names of libgcov and of the linker
void __gcov_dump();
[[noreturn]] void __real__exit(int code);
[[noreturn]] void __wrap__exit(int code);
[[noreturn]] void __wrap__Exit(int code);

// A limit on the size of files that a test has set would cut the counters off. This comes before
// libgcov's own destructor.
[[gnu::destructor]] static void lift_limit_on_files() {
    const rlimit none = {RLIM_INFINITY, RLIM_INFINITY};
    ::setrlimit(RLIMIT_FSIZE, &none);
}

void __wrap__exit(int code) {
    lift_limit_on_files();
    __gcov_dump();
    __real__exit(code);
}

void __wrap__Exit(int code) {
    __wrap__exit(code);
}
// NOLINTEND(bugprone-reserved-identifier)
}

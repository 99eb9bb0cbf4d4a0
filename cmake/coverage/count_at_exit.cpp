// Linked into every program of a build that counts which lines run (-Wl,--wrap): the counters are
// written by exit(), and some of our processes end by _exit() instead.

#include <cstdio>
#include <sys/resource.h>

extern "C" {

// NOLINTBEGIN(bugprone-reserved-identifier,readability-identifier-naming): names of libgcov and of
// the linker
void __gcov_dump();
[[noreturn]] void __real__exit(int code);
[[noreturn]] void __wrap__exit(int code);
[[noreturn]] void __wrap__Exit(int code);

// Before libgcov's own destructor: a limit on the size of files that a test has set would cut the
// counters off, and tests read what programs say, so libgcov may not complain where it has no right
// to write.
[[gnu::destructor]] static void prepare_to_count() {
    const rlimit none = {RLIM_INFINITY, RLIM_INFINITY};
    ::setrlimit(RLIMIT_FSIZE, &none);
    static_cast<void>(std::freopen("/dev/null", "w", stderr));
}

void __wrap__exit(int code) {
    prepare_to_count();
    __gcov_dump();
    __real__exit(code);
}

void __wrap__Exit(int code) {
    __wrap__exit(code);
}
// NOLINTEND(bugprone-reserved-identifier,readability-identifier-naming)
}

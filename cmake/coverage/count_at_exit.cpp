// Linked into every program of a build that counts which lines run (-Wl,--wrap): the counters are
// written by exit(), and some of our processes end by _exit() instead.

extern "C" {

// NOLINTBEGIN(bugprone-reserved-identifier): names of libgcov and of the linker
void __gcov_dump();
[[noreturn]] void __real__exit(int code);
[[noreturn]] void __wrap__exit(int code);
[[noreturn]] void __wrap__Exit(int code);

void __wrap__exit(int code) {
    __gcov_dump();
    __real__exit(code);
}

void __wrap__Exit(int code) {
    __wrap__exit(code);
}
// NOLINTEND(bugprone-reserved-identifier)
}

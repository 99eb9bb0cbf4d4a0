// Writes a small run folder, for tests of programs that are not in C++.

#include "runs.h"

int main(int argc, char** argv) {
    if (argc != 2) {
        return 2;
    }
    pent::viewer::test::write_run(argv[1], "body", {0, 3});
    return 0;
}

// Prints docs/stability.md: what became of every case, float and double side by side.

#include "extremes.h"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <iterator>

namespace {

using namespace pent::stability;
using pent::simulator::Precision;

// The worst of the motions of a case.
std::string worst(const Case& one, Precision precision) {
    Outcome worst;
    for (const Motion motion : kMotions) {
        const Outcome outcome = run(one.extreme, motion, precision);
        if (outcome.kind > worst.kind
            || (outcome.kind == worst.kind && outcome.error > worst.error)) {
            worst = outcome;
        }
    }
    return text(worst);
}

template <typename Row>
void row(const std::string& group, const std::string& name, const char* box, const Row& cell) {
    std::cout << "| " << group << " | " << name << " | " << box << " | " << cell(Precision::Float)
              << " | " << cell(Precision::Double) << " |\n";
}

}  // namespace

// write_report INTRODUCTION: the text above the tables comes from a file.
int main(int argc, char** argv) {
    if (argc != 2) {
        std::fprintf(stderr, "write_report: expected the file with the introduction\n");
        return 2;
    }
    std::ifstream introduction(argv[1]);
    std::cout << introduction.rdbuf();
    std::cout
        << "\n## Numbers\n\n| | value | box | float | double |\n| --- | --- | --- | --- | --- |\n";
    std::string group;
    for (const Case& one : cases()) {
        row(one.group == group ? "" : one.group, one.name, one.is_inside ? "in" : "out",
            [&](Precision precision) { return worst(one, precision); });
        group = one.group;
    }
    std::cout
        << "\n## Starts\n\n| | start | box | float | double |\n| --- | --- | --- | --- | --- |\n";
    for (const Start& start : starts()) {
        row("", start.name, start.comes_back ? "in" : "out",
            [&](Precision precision) { return text(run(start, precision)); });
    }
    std::cout
        << "\n## Contact\n\n| | bodies | box | float | double |\n| --- | --- | --- | --- | --- |\n";
    for (const Touch& touch : touches()) {
        row("", touch.name, "out",
            [&](Precision precision) { return text(run(touch, precision)); });
    }
    return 0;
}

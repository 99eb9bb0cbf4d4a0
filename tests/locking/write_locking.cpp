// Prints the locking tables of docs/accuracy.md, of the beams that the tests judge.

#include "beams.h"

#include <pent/formatted.h>

#include <iostream>

namespace {

using namespace pent::locking;
using pent::simulator::ElementKind;

constexpr std::pair<const char*, ElementKind> kKinds[] = {{"linear", ElementKind::Linear},
                                                          {"smoothed", ElementKind::Smoothed},
                                                          {"quadratic", ElementKind::Quadratic}};

template <int Dim>
void row(const char* name, ElementKind elements, int cells, Cut cut) {
    const pent::SimplexMesh<Dim> mesh = beam<Dim>(cells, cut);
    constexpr const char* kCuts[] = {"", ", distorted", ", TetGen"};
    std::cout << "| " << name << " | " << cells << kCuts[static_cast<int>(cut)] << " | "
              << mesh.vertex_count();
    for (const Load load : {Load::Bending, Load::Diagonal, Load::Twist}) {
        const char* separator = " | ";
        for (const double share : kShares) {
            std::cout << separator
                      << pent::formatted("%.1f", 100 * give<Dim>(mesh, elements, share, load));
            separator = " / ";
        }
    }
    std::cout << " |" << std::endl;
}

template <int Dim>
void table(const char* ratios) {
    std::cout << "| elements in " << Dim << "D | cells thick | vertices | bending, " << ratios
              << " | diagonal bending | twist |\n| --- | --- | --- | --- | --- | --- |\n";
    for (const auto& [name, elements] : kKinds) {
        for (const int cells : {1, 2, 4}) {
            if (cells > 1 || elements != ElementKind::Quadratic) {  // which need two at least
                row<Dim>(name, elements, cells, Cut::Structured);
            }
        }
        row<Dim>(name, elements, 4, Cut::Distorted);
        row<Dim>(name, elements, 4, Cut::TetGen);
    }
}

}  // namespace

int main() {
    table<4>("nu = 0 / 0.28 / 0.32 / 0.33 / 0.3333");
    std::cout << "\n";
    table<3>("nu = 0 / 0.42 / 0.48 / 0.495 / 0.49995");
    return 0;
}

#include "shaken_beam.h"

#include <random>

namespace pent::simulator::bench {

ShakenBeam::ShakenBeam(SimplexMesh<4> box, ElementKind kind)
    : mesh(std::move(box)), material{.lame = lame_from_young(4, 1e7, 0.28)} {
    const std::vector<bool> is_held(mesh.columns.size(), false);
    dofs = number_dofs<4>(mesh.cells, is_held, {mesh.columns, mesh.layers});
    const std::vector<CellRange> ranges = {{0, mesh.cell_count(), material}};
    ElementLayout<4> layout = lay_out_elements<4>(mesh.positions, mesh.cells, ranges, dofs, kind);
    pattern = std::move(layout.pattern);
    elements = std::make_unique<Elements<4>>(std::move(layout.elements));
    std::mt19937 random(1);
    std::normal_distribution<double> normal(0, 0.01);
    positions = mesh.positions.unaryExpr([&](double x) { return x + normal(random); });
}

}  // namespace pent::simulator::bench

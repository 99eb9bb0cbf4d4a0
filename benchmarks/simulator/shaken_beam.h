#pragma once

#include "potentials/element_layout.h"

#include <pent/simulator/scene.h>

#include <memory>

namespace pent::simulator::bench {

/// A free box of E = 1e7 Pa, nu = 0.28 and 1000 kg/m^4, every vertex moved by a tenth of an edge of
/// 0.1 m: about half of the elements have negative eigenvalues to clamp.
struct ShakenBeam {
    SimplexMesh<4> mesh;
    Material material;
    DofMap dofs;
    BlockPattern pattern;
    std::unique_ptr<Elements<4>> elements;
    Positions<4> positions;

    explicit ShakenBeam(SimplexMesh<4> box, ElementKind kind = ElementKind::Linear);

    /// Sets the matrix to h^2 K, h = 1/30 s, as a step does.
    template <typename Scalar>
    void assemble(const Workers& workers,
                  const Kernels<4>& kernels,
                  BlockMatrix<4, Scalar>& matrix) const {
        matrix.set_zero(workers);
        elements->add_hessian(workers, kernels, positions,
                              target_in(matrix, 1.0 / 900, Filter::Clamp));
    }
};

}  // namespace pent::simulator::bench

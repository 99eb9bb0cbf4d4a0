#pragma once

#include "potentials/elements.h"

#include <pent/simulator/solver_options.h>

#include <vector>

namespace pent::simulator {

/// Elastic elements and the pattern of the matrix they fill.
template <int Dim>
struct ElementLayout {
    BlockPattern pattern;
    Elements<Dim> elements;
};

/// Lays out elements that the cells alone make; parameters as for the constructors of Elements.
///
/// @param kind  Not Quadratic.
template <int Dim>
[[nodiscard]] ElementLayout<Dim> lay_out_elements(const Positions<Dim>& rest,
                                                  const Simplices<Dim + 1>& cells,
                                                  const std::vector<CellRange>& ranges,
                                                  const DofMap& dofs,
                                                  ElementKind kind,
                                                  const ActiveStrain<Dim>* strain = nullptr,
                                                  const Grips* grips = nullptr);

/// Lays out quadratic elements.
template <int Dim>
[[nodiscard]] ElementLayout<Dim> lay_out_elements(const Positions<Dim>& rest,
                                                  const QuadraticCells<Dim>& quadratic,
                                                  const DofMap& dofs,
                                                  const ActiveStrain<Dim>* strain = nullptr,
                                                  const Grips* grips = nullptr);

}  // namespace pent::simulator

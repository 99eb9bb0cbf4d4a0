#include "potentials/element_layout.h"

#include "potentials/smoothing.h"

#include <pent/dimensions.h>

#include <cassert>
#include <utility>

namespace pent::simulator {

template <int Dim>
ElementLayout<Dim> lay_out_elements(const Positions<Dim>& rest,
                                    const Simplices<Dim + 1>& cells,
                                    const std::vector<CellRange>& ranges,
                                    const DofMap& dofs,
                                    ElementKind kind,
                                    const ActiveStrain<Dim>* strain,
                                    const Grips* grips) {
    assert(kind != ElementKind::Quadratic);
    if (kind == ElementKind::Linear) {
        BlockPattern pattern = make_pattern<Dim>(cells, dofs);
        Elements<Dim> elements(rest, cells, ranges, dofs, pattern, strain, grips);
        return {std::move(pattern), std::move(elements)};
    }
    std::vector<SmoothingDomains<Dim>> domains;
    for (const CellRange& range : ranges) {
        domains.push_back(smoothing_domains<Dim>(rest, cells, range.begin, range.end));
    }
    std::vector<const CornerLists*> lists;
    for (const SmoothingDomains<Dim>& of_body : domains) {
        lists.push_back(&of_body);
    }
    BlockPattern pattern = make_pattern(lists, dofs);
    Elements<Dim> elements(domains, ranges, dofs, pattern, grips);
    return {std::move(pattern), std::move(elements)};
}

template <int Dim>
ElementLayout<Dim> lay_out_elements(const Positions<Dim>& rest,
                                    const QuadraticCells<Dim>& quadratic,
                                    const DofMap& dofs,
                                    const ActiveStrain<Dim>* strain,
                                    const Grips* grips) {
    CornerLists nodes;
    nodes.corners.assign(quadratic.nodes.data(), quadratic.nodes.data() + quadratic.nodes.size());
    for (Eigen::Index simplex = 1; simplex <= quadratic.nodes.cols(); ++simplex) {
        nodes.start.push_back(simplex * kQuadraticNodes<Dim>);
    }
    BlockPattern pattern = make_pattern({&nodes}, dofs);
    Elements<Dim> elements(rest, quadratic, dofs, pattern, strain, grips);
    return {std::move(pattern), std::move(elements)};
}

#define PENT_INSTANTIATE(Dim)                                                               \
    template ElementLayout<Dim> lay_out_elements(                                           \
        const Positions<Dim>&, const Simplices<Dim + 1>&, const std::vector<CellRange>&,    \
        const DofMap&, ElementKind, const ActiveStrain<Dim>*, const Grips*);                \
    template ElementLayout<Dim> lay_out_elements(const Positions<Dim>&,                     \
                                                 const QuadraticCells<Dim>&, const DofMap&, \
                                                 const ActiveStrain<Dim>*, const Grips*);
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator

#include "pent/contact/surface.h"

#include <pent/contact/boundary_surface.h>
#include <pent/dimensions.h>
#include <pent/facets.h>

#include <algorithm>
#include <array>
#include <utility>

namespace pent::contact {

namespace {

// All faces with Count corners of the facets, each once, corners and faces ascending.
template <int Dim, int Count>
Simplices<Count> faces_of(const Simplices<Dim>& facets) {
    std::vector<std::array<std::uint32_t, Count>> faces;
    for (Eigen::Index f = 0; f < facets.cols(); ++f) {
        std::array<std::uint32_t, Dim> corners{};
        std::copy_n(facets.col(f).data(), Dim, corners.begin());
        std::sort(corners.begin(), corners.end());
        std::array<bool, Dim> is_chosen{};
        std::fill_n(is_chosen.begin(), Count, true);
        do {
            std::array<std::uint32_t, Count> face{};
            for (int i = 0, at = 0; i < Dim; ++i) {
                if (is_chosen[i]) {
                    face[at++] = corners[i];
                }
            }
            faces.push_back(face);
        } while (std::prev_permutation(is_chosen.begin(), is_chosen.end()));
    }
    std::sort(faces.begin(), faces.end());
    faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
    Simplices<Count> result(Count, static_cast<Eigen::Index>(faces.size()));
    for (std::size_t i = 0; i < faces.size(); ++i) {
        std::copy(faces[i].begin(), faces[i].end(),
                  result.col(static_cast<Eigen::Index>(i)).data());
    }
    return result;
}

template <int Dim>
void list_facets_at_vertices(Surface<Dim>& surface) {
    const std::uint32_t* begin = surface.vertices.data();
    const std::uint32_t* end = begin + surface.vertices.size();
    const auto place = [&](std::uint32_t vertex) {
        return std::lower_bound(begin, end, vertex) - begin;
    };
    surface.facet_begin.assign(static_cast<std::size_t>(end - begin) + 1, 0);
    for (Eigen::Index i = 0; i < surface.facets.size(); ++i) {
        ++surface.facet_begin[place(surface.facets.data()[i]) + 1];
    }
    for (std::size_t i = 1; i < surface.facet_begin.size(); ++i) {
        surface.facet_begin[i] += surface.facet_begin[i - 1];
    }
    surface.facet_of.resize(surface.facets.size());
    std::vector<std::uint32_t> next(surface.facet_begin.begin(), surface.facet_begin.end() - 1);
    for (Eigen::Index i = 0; i < surface.facets.size(); ++i) {
        surface.facet_of[next[place(surface.facets.data()[i])]++] =
            static_cast<std::uint32_t>(i / Dim);
    }
}

}  // namespace

template <int Dim>
Surface<Dim> make_surface(const Simplices<Dim + 1>& cells,
                          Eigen::Index vertices,
                          std::uint32_t first_vertex) {
    return surface_of<Dim>(match_facets<Dim>(cells, vertices).boundary, first_vertex);
}

template <int Dim>
Surface<Dim> surface_of(Simplices<Dim> boundary, std::uint32_t first_vertex) {
    Surface<Dim> surface;
    surface.first_vertex = first_vertex;
    surface.facets = std::move(boundary);
    surface.facets.array() += first_vertex;
    surface.vertices = faces_of<Dim, 1>(surface.facets);
    surface.edges = faces_of<Dim, 2>(surface.facets);
    surface.ridges = faces_of<Dim, Dim - 1>(surface.facets);
    list_facets_at_vertices(surface);
    return surface;
}

template <int Dim>
double mean_edge_length(const Surface<Dim>& surface, const PositionsView<Dim>& positions) {
    double sum = 0;
    for (Eigen::Index i = 0; i < surface.edges.cols(); ++i) {
        sum += (positions.col(surface.edges(1, i)) - positions.col(surface.edges(0, i))).norm();
    }
    return surface.edges.cols() == 0 ? 0 : sum / static_cast<double>(surface.edges.cols());
}

#define PENT_INSTANTIATE(Dim)                                                        \
    template Surface<Dim> make_surface<Dim>(const Simplices<Dim + 1>&, Eigen::Index, \
                                            std::uint32_t);                          \
    template Surface<Dim> surface_of<Dim>(Simplices<Dim>, std::uint32_t);            \
    template double mean_edge_length<Dim>(const Surface<Dim>&, const PositionsView<Dim>&);
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::contact

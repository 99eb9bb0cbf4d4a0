#pragma once

#include "candidate.h"
#include "patches.h"

#include <pent/contact/box_tree.h>
#include <pent/contact/surface.h>

#include <array>
#include <cstdint>
#include <vector>

namespace pent::contact {

/// Finds which pairs of one body are near now, in less than looking at all whose boxes overlap:
/// most of these are neighbors, which are near each other at rest and stay as they are.
///
/// The surface is divided into patches. Of two patches that come near, all pairs are listed that
/// were within a listed distance, larger than that of contact, at some earlier positions: a
/// reference. How both patches have moved since then, as affine maps and what these lack, bounds
/// how near all others can be now, however far and strongly the body has been bent before
/// (PatchBound). Where the bound fails pairs are looked at one by one; when that has cost what
/// new lists would, the positions of that time become a reference. There are a few at a time: the
/// one that the fewest lists are of goes.
///
/// What is found is the same whatever was asked before.
template <int Dim>
class SelfProximity {
public:
    /// Surface and rest positions, of all vertices of the scene, must outlive this.
    ///
    /// @param distance  Of contact, m. Pairs nearer than it at rest are never contacts.
    SelfProximity(const Surface<Dim>& surface, const Positions<Dim>& rest, double distance);

    /// Sets both lists to the pairs nearer than the distance of contact now that are not nearer at
    /// rest, and maybe others of these: vertices and facets, and mixed pairs whose closest points
    /// are inside both. Ascending, of unknown distance. Parallel.
    void find(const PositionsView<Dim>& positions, CandidatePairs& pairs);

    /// Trees fit so far.
    [[nodiscard]] std::int64_t refit() const { return refit_; }
    [[nodiscard]] std::int64_t bytes() const;

private:
    static constexpr std::size_t kReferences = 3;

    // Simplices of one kind. Trees have the topology of the body at rest.
    struct Tree {
        BoxTree simplices;
        std::vector<BoxTree::Range> patch_ranges;
        std::vector<Box> patch_boxes;
        BoxTree patches;
    };

    // Positions at which pairs were listed, and how patches have moved since.
    struct Reference {
        std::uint32_t serial = 0;  // 0 if there is none
        Positions<Dim> positions;
        std::array<Patches<Dim>, Dim> patches;  // by corners, less one
    };

    // What is known of a patch and another: pairs [begin, end) of the row, in a reference.
    struct Known {
        std::uint32_t second = 0;
        std::uint32_t serial = 0;
        std::uint32_t begin = 0;
        std::uint32_t end = 0;
    };

    // What is known of a patch and others, by these, and which of them are near now.
    struct Row {
        std::vector<Known> known;
        std::vector<Candidate> pairs;
        std::vector<std::uint32_t> near;     // ascending
        std::vector<std::uint32_t> unknown;  // of these, those that no bound tells anything of
    };

    template <int K, int L>
    class Search;
    using Found = std::vector<CandidateList>;

    template <int Count>
    void add_tree(const Simplices<Count>& simplices);
    template <int Count>
    void fit_tree(const Simplices<Count>& simplices, const PositionsView<Dim>& positions);
    void fit_patches(const PositionsView<Dim>& positions);
    [[nodiscard]] const Reference* reference(std::uint32_t serial) const;
    [[nodiscard]] std::array<std::size_t, kReferences> count_lists() const;
    [[nodiscard]] Reference* wanted_reference(std::size_t unknown);
    void take_reference(const PositionsView<Dim>& positions, Reference& place);

    const Surface<Dim>& surface_;
    const Positions<Dim>& rest_;
    double distance_;         // of contact, m
    double listed_distance_;  // m
    std::array<Tree, Dim> trees_;
    std::array<Patches<Dim>, Dim> patches_at_rest_;  // whose vertices all references share
    std::array<Reference, kReferences> references_;
    std::uint32_t newest_ = 0;  // serial
    std::size_t owed_ = 0;      // pairs of patches looked at without a list since the newest
    std::vector<Row> points_;   // by patches of vertices
    std::vector<Row> mixed_;    // by patches of edges
    std::int64_t refit_ = 0;
};

}  // namespace pent::contact

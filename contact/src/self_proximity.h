#pragma once

#include "candidate.h"
#include "patches.h"
#include "paths.h"
#include "shared_work.h"
#include "surface_patches.h"

#include <pent/contact/surface.h>

#include <array>
#include <cstdint>
#include <vector>

namespace pent::contact {

/// Finds which pairs of one body are near now, or come near each other on their way, at less cost
/// than a look at all whose boxes overlap: most of these are neighbors, which are near each other
/// at rest and stay as they are.
///
/// The surface is divided into patches. For two patches that come near, all pairs are listed that
/// are within a listed distance, larger than what is asked for. How both patches have moved from
/// search to search, as affine maps and deviations from these, bounds how near all others can be,
/// however far and strongly the body is bent (PatchBound). The bound weakens with each search;
/// where it fails the pairs of these patches are listed anew, or looked at one by one where it
/// would fail again at once.
///
/// What is found does not depend on what was asked before, but for pairs that come near at no time.
template <int Dim>
class SelfProximity {
public:
    /// Surface and rest positions, of all vertices of the scene, must outlive this.
    ///
    /// @param distance           That is asked for, at least, m. 0 of who asks once: nothing is
    ///                           listed, as there is no next time for which that would be of use.
    /// @param is_rest_left_out  Whether pairs nearer than it at rest are never contacts.
    /// @param shared            Of a team each finds the pairs of some patches.
    SelfProximity(const Surface<Dim>& surface,
                  const Positions<Dim>& rest,
                  double distance,
                  bool is_rest_left_out,
                  const SharedWork& shared = {});

    /// The pairs nearer than the distance now that are not nearer at rest, and maybe others of
    /// these: vertices and facets, and mixed pairs whose closest points are inside both. Ascending,
    /// of unknown distance, and of no body: that is for who asks to say. Parallel.
    [[nodiscard]] CandidatePairs find(const PositionsView<Dim>& positions);

    /// The pairs that may come within the activation distance while their vertices are near their
    /// paths. Parallel.
    ///
    /// @param paths                With their inflation.
    /// @param activation_distance  m.
    /// @param measured             Up to this distances at the end are measured, m.
    [[nodiscard]] CandidatePairs find(const Paths<Dim>& paths,
                                      double activation_distance,
                                      double measured);

    /// Trees fit so far.
    [[nodiscard]] std::int64_t refit() const { return on_paths_.refit(); }
    [[nodiscard]] std::int64_t bytes() const;

private:
    // All patches at some moment, and how they have moved, by corners, less one.
    using Places = std::array<PatchPlaces<Dim>, Dim>;
    using Motions = std::array<PatchMotions<Dim>, Dim>;

    // What is known of a patch and another one: pairs [begin, end) of the row are all that were
    // within the listed distance; the bound tells how near all others may have come since.
    struct Known {
        std::uint32_t second = 0;
        std::uint32_t search = 0;  // number of the last search in which their boxes met
        std::uint32_t begin = 0;
        std::uint32_t end = 0;
        float stretch = 1;
        float lack = 0;  // m

        [[nodiscard]] PatchBound bound() const;
        void set_bound(const PatchBound& bound);
    };

    // What is known of a patch and others, ascending by these. Some pairs may be in no list any
    // more.
    struct Row {
        std::vector<Known> known;
        std::vector<Candidate> pairs;
        std::vector<std::uint32_t> unknown;  // patches that are near and have no list that holds
    };

    // The paths that are searched, and how near counts as near, m.
    struct Asked {
        const Paths<Dim>& paths;
        double activation_distance = 0;
    };

    template <typename Test, int K, int L>
    class Search;

    [[nodiscard]] Places place(const PositionsView<Dim>& positions) const;
    void move(const Asked& asked);
    template <typename Points, typename Mixed>
    void search(const Asked& asked, Points& points, Mixed& mixed);

    const Surface<Dim>& surface_;
    const Positions<Dim>& rest_;
    double distance_;         // m
    double listed_distance_;  // m
    bool is_rest_left_out_;
    SharedWork shared_;
    std::vector<Box> boxes_;  // of all vertices of the scene
    SurfacePatches<Dim> on_paths_;
    std::array<Patches<Dim>, Dim> patches_;  // by corners, less one
    std::uint32_t search_ = 0;               // how many there have been
    Places places_;                          // where the paths of the last search began
    Motions since_;                          // since the search before; none in the first
    Motions ahead_;                          // along the paths; not set where these are still
    std::vector<Row> points_;                // by patches of vertices
    std::vector<Row> mixed_;                 // by patches of edges
};

}  // namespace pent::contact

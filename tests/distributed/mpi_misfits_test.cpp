#include "mpi_scenes.h"
#include "support/messages.h"
#include "support/misfits.h"

#include <algorithm>
#include <array>
#include <vector>

// Meshes whose cells do not fit together, or do not make up the elements of a scene.

namespace pent {
namespace {

using test::expect_contains;
using test::Outcome;
using test::said;

class MpiMisfits : public test::MpiScenes {
protected:
    // A bar of mesh.pent that is held by its left end and falls.
    template <int Dim>
    static std::string falling() {
        const std::string last = Dim == 4 ? ", 0" : "";
        return "[scene]\ndimension = " + std::to_string(Dim) + "\ngravity = [0, -9.8, 0" + last
               + "]\nframes = 4\n\n[[body]]\nname = \"bar\"\nmesh = \"mesh.pent\"\n"
                 "material = { young = 1e5 }\n\n[[constraint]]\nbody = \"bar\"\n"
                 "select = { half_space = { normal = [1, 0, 0"
               + last
               + "], offset = 1e-6 } }\n\n[solver]\ntolerance = 1e-8\nnewton_tolerance = 1e-7\n"
                 "precision = \"double\"\n";
    }

    // All say the same line and write nothing.
    void expect_refused(const std::string& scene,
                        std::initializer_list<std::string> words,
                        std::initializer_list<int> on = {1, 2, 3, 4}) const {
        const Outcome alone = simulate(0, scene, "refused");
        EXPECT_EQ(alone.exit_code, 1);
        expect_contains(alone.err, words);
        for (const int ranks : on) {
            const Outcome own = simulate(ranks, scene, "refused");
            EXPECT_EQ(own.exit_code, 1) << ranks;
            EXPECT_EQ(said(own), said(alone)) << ranks;
        }
        EXPECT_FALSE(std::filesystem::exists(frame("refused", "bar", 0)));
    }

    // A warning, and frames that are those of pent-sim.
    template <int Dim>
    void expect_warned(const std::string& scene,
                       const std::string& body,
                       const std::string& words) const {
        const std::string alone = scene + "_alone";
        ASSERT_EQ(simulate(0, scene, alone).exit_code, 0);
        const std::vector<std::string> warnings = report(alone).warnings;
        ASSERT_FALSE(warnings.empty());
        expect_contains(warnings[0], {"its cells do not fit together", words});
        for (int ranks = 1; ranks <= 4; ++ranks) {
            const std::string run = scene + "_on_" + std::to_string(ranks);
            const Outcome own = simulate(ranks, scene, run);
            ASSERT_EQ(own.exit_code, 0) << own.err;
            expect_contains(own.out, {"warning: " + warnings[0]});
            EXPECT_EQ(report(run).warnings, warnings);
            expect_near<Dim>(run, alone, body, 1, 1e-6);
            expect_near<Dim>(run, alone, body, 4, 1e-5);
            const std::string file = "/meshes/" + body + ".pent";
            EXPECT_EQ(read_info(path(run + file)).crc32c, read_info(path(alone + file)).crc32c);
        }
    }

    template <int Dim>
    void expect_as_alone(const std::string& scene,
                         const SimplexMesh<Dim>& mesh,
                         const std::string& what) const {
        static_cast<void>(write_mesh(folder_ / "mesh.pent", mesh));
        const std::string words = what + ", first at ";
        write(scene, falling<Dim>());
        expect_warned<Dim>(scene, "bar", words);
        write("touching", falling<Dim>() + "\n[contact]\ndistance = 0.02\nstiffness = 1000\n");
        expect_refused("touching", {words, "contact needs a closed surface"});
    }

    // Facets within ranks and between them; none of the faults at the end where rank 0 begins.
    template <int Dim>
    void expect_all_as_alone() const {
        std::array<int, Dim> count{};
        count.fill(2);
        count[0] = 6;
        std::array<double, Dim> size{};
        size.fill(0.5);
        size[0] = 1.5;
        const SimplexMesh<Dim> bar = test::kuhn_box<Dim>(count, size);
        std::vector<Eigen::Index> cells;
        for (Eigen::Index cell = 0; cell < bar.cell_count(); cell += 7) {
            if (bar.positions.row(0)(bar.cells.col(cell)).minCoeff() > 0.7) {
                cells.push_back(cell);
            }
        }
        expect_as_alone<Dim>("twice", test::with_cells_twice(bar, cells),
                             " of its facets have more than two cells");
        const FacetMatch<Dim> match = match_facets<Dim>(bar.cells, bar.vertex_count());
        std::vector<Eigen::Index> facets;
        for (Eigen::Index facet = 0; facet < match.boundary.cols(); facet += 3) {
            if (bar.positions.row(0)(match.boundary.col(facet)).minCoeff() > 0.7) {
                facets.push_back(facet);
            }
        }
        expect_as_alone<Dim>(
            "one_sided", test::with_cells_on_one_side(bar, facets),
            std::to_string(facets.size()) + " of its facets have both cells on one side");
    }
};

TEST_F(MpiMisfits, InThreeDimensionsAreThoseOfPentSim) {
    expect_all_as_alone<3>();
}

TEST_F(MpiMisfits, InFourDimensionsAreThoseOfPentSim) {
    expect_all_as_alone<4>();
}

TEST_F(MpiMisfits, OfBaseAndLayersAreThoseOfPentSim) {
    Extrusion<4> made = extrusion();
    const Eigen::Index cells = made.base.cell_count();
    made.base = test::with_cells_twice(made.base, {cells / 2});
    made.base.regions.push_back(3);
    made.ordered.cells.conservativeResize(Eigen::NoChange, cells + 1);
    made.ordered.cells.rightCols(1) = made.ordered.cells.col(cells / 2);
    made.ordered.is_odd.push_back(made.ordered.is_odd[static_cast<std::size_t>(cells / 2)]);
    static_cast<void>(write_extrusion<4>(path("base.pent"), made));
    std::string scene = twins("base");
    write("touching", scene);
    expect_refused("touching", {"more than two cells", "contact needs a closed surface"});
    const std::size_t contact = scene.find("[contact]");
    scene.erase(contact, scene.find("[solver]") - contact);
    write("apart", scene + "newton_tolerance = 1e-8\n");
    expect_warned<4>("apart", "a", "more than two cells");
}

TEST_F(MpiMisfits, ThatMakeNoQuadraticElementsAreThoseOfPentSim) {
    write("quadratic", falling<4>() + "elements = \"quadratic\"\n");
    const auto refuses = [&](const SimplexMesh<4>& mesh, std::initializer_list<std::string> words) {
        static_cast<void>(write_mesh(path("mesh.pent"), mesh));
        expect_refused("quadratic", words, {3});
    };
    const SimplexMesh<4> good = test::quadratic_kuhn_box<4>({3, 1, 1, 1}, {1.5, 0.5, 0.5, 0.5});
    SimplexMesh<4> mesh = good;
    mesh.parents.clear();
    refuses(mesh, {"cell 0 and 15 more that do not make up one simplex"});
    mesh = good;
    mesh.parents.back() = 4000;
    refuses(mesh, {"parent ", " with 15 cells"});
    mesh = good;
    mesh.parents.pop_back();
    mesh.cells.conservativeResize(Eigen::NoChange, mesh.cell_count() - 1);
    refuses(mesh, {"no multiple of 16"});
    static_cast<void>(write_extrusion<4>(path("mesh.pent"), extrusion()));
    expect_refused("quadratic", {"expected cells that are the children of quadratic ones"}, {1, 3});
}

}  // namespace
}  // namespace pent

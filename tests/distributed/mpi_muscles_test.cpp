#include "mpi_scenes.h"
#include "support/fork.h"

// Muscles whose fibers are found by distances along the body, of which no rank has all of the way.

namespace pent {
namespace {

using test::Outcome;

class MpiMuscles : public test::MpiScenes {
protected:
    // A fork that is held at the end of one arm, where its fibers begin.
    static std::string scene_of(const std::string& mesh, int dimension, bool has_elements) {
        const auto vector = [&](const std::string& x, const std::string& y,
                                const std::string& rest) {
            return "[" + x + ", " + y + ", " + rest + (dimension == 4 ? ", " + rest : "") + "]";
        };
        const std::string end = "{ box = { low = " + vector("5.9", "-1", "-1")
                                + ", high = " + vector("7", "1.1", "9") + " } }";
        return "[scene]\ndimension = " + std::to_string(dimension)
               + "\nframes = 4\nframes_per_second = 50\ngravity = " + vector("0", "-9.8", "0")
               + "\n[[body]]\nname = \"fork\"\nmesh = \"" + mesh
               + ".pent\"\nmaterial = { young = 1e6 }\n"
                 "[[constraint]]\nbody = \"fork\"\nselect = "
               + end
               + "\n[[activation]]\nbody = \"fork\"\nselect = \"everything\"\nstretch = 0.8\n"
                 "fibers = \"distance\"\naway_from = "
               + end
               + "\npreserves_volume = true\nsignal = \"sine\"\nfrequency = 2\nphase = 0.1\n"
                 "distance_wave = 0.1\n"
                 "[output]\nvertex = [\"energy_density\"]\n"
                 "[solver]\nintegrator = \"newton_euler\"\ntolerance = 1e-8\n"
                 "newton_tolerance = 1e-8\nprecision = \"double\"\n"
               + (has_elements ? "elements = \"quadratic\"\n" : "");
    }

    // The energy of the first frame is what fibers make of bodies at rest: before any solver.
    template <int Dim>
    void expect_same_muscle(const std::string& run, const std::string& alone) const {
        const auto own = read_frame<Dim>(frame(run, "fork", 0)).fields.at(0).values;
        const auto other = read_frame<Dim>(frame(alone, "fork", 0)).fields.at(0).values;
        ASSERT_GT(other.maxCoeff(), 1);
        EXPECT_LT((own - other).norm(), 1e-11 * other.norm()) << run;
        expect_near<Dim>(run, alone, "fork", 1, 1e-6);
        expect_near<Dim>(run, alone, "fork", 4, 1e-5);
    }
};

TEST_F(MpiMuscles, ByDistancesGoWherePentSimGoes) {
    static_cast<void>(write_mesh(path("three.pent"), test::fork<3>()));
    static_cast<void>(write_mesh(path("four.pent"), test::fork<4>()));
    write("three", scene_of("three", 3, false));
    write("four", scene_of("four", 4, false));
    for (const std::string scene : {"three", "four"}) {
        for (const int ranks : {0, 1, 2, 3, 4}) {
            const std::string run = scene + std::to_string(ranks);
            const Outcome outcome = simulate(ranks, scene, run);
            ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
            if (ranks > 0 && scene == "three") {
                expect_same_muscle<3>(run, "three0");
            } else if (ranks > 0) {
                expect_same_muscle<4>(run, "four0");
            }
        }
    }
}

TEST_F(MpiMuscles, AreTheSameToTheBitForAnyThreadsRunAfterRun) {
    static_cast<void>(write_mesh(path("fork.pent"), test::fork<4>()));
    write("fork", scene_of("fork", 4, false));
    for (const std::string threads : {"1", "2", "3"}) {
        ASSERT_EQ(simulate(3, "fork", "by" + threads, "--threads " + threads).exit_code, 0);
        expect_same_bytes("by" + threads, "by1", "fork");
    }
}

TEST_F(MpiMuscles, OfQuadraticElementsGoWherePentSimGoes) {
    static_cast<void>(
        write_mesh(path("parents.pent"), test::quadratic_kuhn_box<4>({6, 1, 1, 1}, {6, 1, 1, 1})));
    write("quadratic", scene_of("parents", 4, true));
    ASSERT_EQ(simulate(0, "quadratic", "alone").exit_code, 0);
    for (const int ranks : {2, 4}) {
        const std::string run = "of" + std::to_string(ranks);
        const Outcome outcome = simulate(ranks, "quadratic", run);
        ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
        expect_same_muscle<4>(run, "alone");
    }
}

// In the words of pent-sim.
TEST_F(MpiMuscles, ThatNoWayLeadsToAreRefused) {
    SimplexMesh<4> pieces = test::fork<4>();
    std::vector<Eigen::Index> kept;  // without what joins the arms
    for (Eigen::Index cell = 0; cell < pieces.cell_count(); ++cell) {
        bool is_arm = true;
        for (const std::uint32_t vertex : pieces.cells.col(cell)) {
            is_arm = is_arm && pieces.positions(0, vertex) > 0.5;
        }
        if (is_arm) {
            kept.push_back(cell);
        }
    }
    pieces.cells = pieces.cells(Eigen::all, kept).eval();
    std::vector<std::uint32_t> numbers(static_cast<std::size_t>(pieces.vertex_count()), 0);
    std::vector<Eigen::Index> vertices;
    for (std::uint32_t vertex = 0; vertex < numbers.size(); ++vertex) {
        if ((pieces.cells.array() == vertex).any()) {
            numbers[vertex] = static_cast<std::uint32_t>(vertices.size());
            vertices.push_back(vertex);
        }
    }
    pieces.positions = pieces.positions(Eigen::all, vertices).eval();
    for (std::uint32_t& vertex : pieces.cells.reshaped()) {
        vertex = numbers[vertex];
    }
    static_cast<void>(write_mesh(path("pieces.pent"), pieces));
    write("pieces", scene_of("pieces", 4, false));
    const auto said = [](const Outcome& outcome) {
        EXPECT_EQ(outcome.exit_code, 1);
        return outcome.err.substr(outcome.err.find(": "));
    };
    const std::string alone = said(simulate(0, "pieces", "run"));
    EXPECT_NE(alone.find("no way within the body leads"), std::string::npos) << alone;
    for (const int ranks : {1, 2, 3}) {
        EXPECT_EQ(said(simulate(ranks, "pieces", "run")), alone);
    }
}

}  // namespace
}  // namespace pent

#include "mpi_scenes.h"
#include "support/messages.h"

#include <initializer_list>
#include <sstream>

// What --explain tells on ranks of which none has a whole mesh.

namespace pent {
namespace {

using test::expect_contains;
using test::Outcome;

class MpiExplain : public test::MpiScenes {
protected:
    [[nodiscard]] std::string explain(int ranks, const std::string& scene) const {
        const std::string arguments = " --explain --threads 1 " + path(scene + ".toml");
        const Outcome told =
            ranks == 0 ? test::run_program("pent-sim" + arguments)
                       : test::run_program("pent-sim-mpi" + arguments, test::mpirun(ranks));
        EXPECT_EQ(told.exit_code, 0) << told.err;
        return told.out;
    }

    // The text without what is of ranks, memory, times and iterations.
    static std::string lasting(const std::string& text) {
        constexpr std::size_t kCosts = 42;  // behind name, on or off, and unknowns
        constexpr std::size_t kReason = 66;
        std::istringstream lines(text);
        std::string all;
        for (std::string line; std::getline(lines, line);) {
            if (line.rfind("working ", 0) == 0) {  // a slow machine says what takes so long
                continue;
            }
            if (line.rfind("note: ", 0) == 0) {
                all += line;
            } else if (line.rfind("all: ", 0) == 0) {
                all += line.substr(0, line.find(','));
            } else if (line.rfind("ranks ", 0) != 0) {
                std::string why = line.substr(kReason);
                if (line.rfind("linear solver", 0) == 0) {
                    why.resize(why.find(": "));
                }
                all += line.substr(0, kCosts) + " " + why;
            }
            all += "\n";
        }
        return all;
    }

    void expect_same_on_ranks(const std::string& scene,
                              std::initializer_list<std::string> words) const {
        const std::string alone = lasting(explain(0, scene));
        expect_contains(alone, words);
        for (const int ranks : {1, 2, 4}) {
            std::string own = lasting(explain(ranks, scene));
            own.erase(own.find("\n\n"), 1);  // the line of ranks
            EXPECT_EQ(own, alone) << ranks;
        }
    }
};

TEST_F(MpiExplain, TellsWhatRanksHaveAndSay) {
    expect_contains(explain(3, "bar"),
                    {"ranks", "ghosts", "MB in memory", "messages", "all wait for all"});
    EXPECT_EQ(explain(0, "bar").find("ghosts"), std::string::npos);
}

// Numbers of meshes, of what labels select and of boundaries, whatever files they are in.
TEST_F(MpiExplain, IsThatOfPentSimButForCosts) {
    write_extrusion_and_mesh();
    for (const std::string mesh : {"base", "whole"}) {
        std::string scene = twins(mesh);
        scene.replace(scene.find("stiffness = 1000"), 16, "stiffness = 1e-3");
        write(mesh, scene + R"(
[[obstacle]]
half_space = { normal = [0, 1, 0, 0], offset = -0.5 }
stiffness = 1e-3

[[activation]]
body = "a"
select = { region = 7 }
stretch = 0.9
fibers = "distance"
away_from = { region = 3 }

[[attachment]]
body = "b"
select = { region = 7 }
stiffness = 10
)");
        expect_same_on_ranks(mesh, {"all together", "fibers distance", "2 to 3 cells", "lock",
                                    "may go deeper than a tenth of its thickness"});
    }
}

TEST_F(MpiExplain, KnowsOfParentsThatNobodyUses) {
    static_cast<void>(write_mesh(path("bar.pent"),
                                 test::quadratic_kuhn_box<4>({3, 1, 1, 1}, {1.5, 0.5, 0.5, 0.5})));
    expect_same_on_ranks("bar", {"every mesh was made for quadratic elements"});
    write("quadratic", std::string(kBar) + "elements = \"quadratic\"\n");
    expect_same_on_ranks("quadratic", {"quadratic, filter"});
}

TEST_F(MpiExplain, WarnsOfCellsThatDoNotFit) {
    SimplexMesh<4> mesh = read_mesh<4>(path("bar.pent")).mesh;
    mesh.cells.conservativeResize(Eigen::NoChange, mesh.cell_count() + 1);
    mesh.cells.rightCols(1) = mesh.cells.col(0);
    static_cast<void>(write_mesh(path("bar.pent"), mesh));
    expect_same_on_ranks("bar", {"its cells do not fit together"});
}

}  // namespace
}  // namespace pent

#include "model/body_dofs.h"

#include "scenes.h"
#include "step/rank_agreement.h"
#include "thread_ranks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

// Which vertices of bodies are solved for, found vertex by vertex.

namespace pent::simulator {
namespace {

using test::bar;
using test::hold;

// Three bars beside each other: the first held at its left end, the second wholly until step 3, the
// third free.
Scene three_bars() {
    Scene scene = test::box_scene<4>();
    scene.bodies.resize(3, scene.bodies[0]);
    for (std::size_t body = 1; body < 3; ++body) {
        scene.bodies[body].name = body == 1 ? "second" : "third";
        scene.bodies[body].place.translate =
            2 * static_cast<double>(body) * Eigen::Vector4d::UnitY();
    }
    scene.constraints = {hold(test::left_end(), test::still(4)),
                         hold(EverythingSelection{}, test::still(4))};
    scene.constraints[1].body = "second";
    scene.constraints[1].to = 2.5 * scene.dt();
    return scene;
}

Bodies<4> make_bars(const Scene& scene) {
    return make_bodies<4>(scene, {bar(2), bar(3), bar(2)});
}

using Vertices = std::set<std::uint32_t>;

// Not held, and of a body that is in.
Vertices free_vertices(const Bodies<4>& bodies,
                       const HeldVertices<4>& held,
                       const std::vector<bool>& is_in) {
    Vertices free;
    for (std::size_t body = 0; body < is_in.size(); ++body) {
        for (Eigen::Index v = bodies.first_vertex[body]; v < bodies.first_vertex[body + 1]; ++v) {
            if (is_in[body] && !held.is_held(static_cast<std::uint32_t>(v))) {
                free.insert(static_cast<std::uint32_t>(v));
            }
        }
    }
    return free;
}

// There and back, for all vertices and all dofs.
void expect_map_of(const DofMap& dofs, const Bodies<4>& bodies, const Vertices& expected) {
    EXPECT_EQ(Vertices(dofs.vertices().begin(), dofs.vertices().end()), expected);
    ASSERT_EQ(dofs.count(), expected.size());  // none twice
    ASSERT_EQ(dofs.vertex_count(), static_cast<std::size_t>(bodies.vertex_count()));
    std::set<std::uint32_t> indices;
    for (std::uint32_t v = 0; v < bodies.vertex_count(); ++v) {
        EXPECT_EQ(dofs.has_dof(v), expected.contains(v)) << v;
        if (dofs.has_dof(v)) {
            EXPECT_EQ(dofs.vertex_of(dofs.dof_of(v)), v);
            EXPECT_EQ(dofs.index_of(v), dofs.dof_of(v));
        } else {
            EXPECT_EQ(dofs.index_of(v), dofs.count() + v);
        }
        indices.insert(dofs.index_of(v));
    }
    EXPECT_EQ(indices.size(), dofs.vertex_count());
    const Positions<4> values = at_dofs<4>(dofs, bodies.rest());
    for (std::uint32_t dof = 0; dof < dofs.count(); ++dof) {
        EXPECT_EQ(values.col(dof), bodies.rest().col(dofs.vertex_of(dof)));
    }
}

// Every set of bodies that are awake, while the second is held and after.
TEST(BodyDofs, AreTheFreeVerticesOfTheBodiesThatAreIn) {
    const Scene scene = three_bars();
    const Bodies<4> bodies = make_bars(scene);
    HeldVertices<4> held(scene, bodies);
    for (const std::uint64_t step : {0U, 5U}) {
        static_cast<void>(held.hold(step, bodies.rest()));
        for (unsigned set = 0; set < 8; ++set) {
            SCOPED_TRACE(set);
            const std::vector<bool> is_in = {(set & 1U) != 0, (set & 2U) != 0, (set & 4U) != 0};
            const Vertices expected = free_vertices(bodies, held, is_in);
            EXPECT_EQ(expected.empty(), set == 0 || (set == 2 && step == 0));
            const DofMap dofs = number_dofs(bodies, held, is_in);
            expect_map_of(dofs, bodies, expected);
            EXPECT_EQ(dofs.row_count(), dofs.count());
            EXPECT_EQ(number_dofs_alike(bodies, held, is_in).vertices(), dofs.vertices());
        }
    }
}

// What a host holds is not solved for, either, and is again when it lets go.
TEST(BodyDofs, AreNotThoseThatAHostHolds) {
    const Scene scene = three_bars();
    const Bodies<4> bodies = make_bars(scene);
    HeldVertices<4> held(scene, bodies);
    const auto third = static_cast<std::uint32_t>(bodies.first_vertex[2]);
    const std::vector<bool> is_in(3, true);
    const Vertices before = free_vertices(bodies, held, is_in);
    static_cast<void>(held.hold_for_host({third, third + 2}, bodies.rest()(Eigen::all, {0, 1})));
    Vertices without = before;
    EXPECT_EQ(without.erase(third) + without.erase(third + 2), 2U);
    expect_map_of(number_dofs(bodies, held, is_in), bodies, without);
    static_cast<void>(held.hold_for_host({}, Positions<4>(4, 0)));
    expect_map_of(number_dofs(bodies, held, is_in), bodies, before);
}

// Rows are the free vertices that a rank owns, and behind them are columns: those of others that it
// may couple. Together the rows are all free vertices, each once.
void expect_maps_of_ranks(int count, const std::vector<bool>& is_in) {
    const Scene scene = three_bars();
    std::vector<DofMap> maps(static_cast<std::size_t>(count));
    std::vector<DofMap> alike(maps.size());
    test::on_ranks(count, [&](const std::shared_ptr<const Ranks>& ranks) {
        const Bodies<4> bodies = share(scene, make_bars(scene), ranks);
        const HeldVertices<4> held(scene, bodies);
        const Vertices free = free_vertices(bodies, held, is_in);
        Vertices own_or_coupled;
        for (const std::uint32_t v : free) {
            const bool is_in_a_cell = (bodies.cells().array() == v).any();
            if (bodies.sharing.owns(v) || is_in_a_cell || bodies.may_couple_anything) {
                own_or_coupled.insert(v);
            }
        }
        const DofMap dofs = number_dofs(bodies, held, is_in);
        expect_map_of(dofs, bodies, own_or_coupled);
        for (std::uint32_t dof = 0; dof < dofs.count(); ++dof) {
            const std::uint32_t vertex = dofs.vertex_of(dof);
            EXPECT_EQ(dof < dofs.row_count(), bodies.sharing.owns(vertex)) << vertex;
            EXPECT_EQ(dofs.is_own(vertex), bodies.sharing.owns(vertex)) << vertex;
        }
        const auto rank = static_cast<std::size_t>(ranks->rank());
        maps[rank] = dofs;
        alike[rank] = number_dofs_alike(bodies, held, is_in);
        expect_map_of(alike[rank], bodies, free);
    });
    Vertices rows;
    std::size_t sum = 0;
    for (std::size_t rank = 0; rank < maps.size(); ++rank) {
        const auto begin = maps[rank].vertices().begin();
        rows.insert(begin, begin + maps[rank].row_count());
        sum += maps[rank].row_count();
        EXPECT_EQ(alike[rank].vertices(), alike[0].vertices());
    }
    EXPECT_EQ(rows, Vertices(alike[0].vertices().begin(), alike[0].vertices().end()));
    EXPECT_EQ(sum, rows.size());
}

// Cut between bodies and through them, so that there are held and sleeping vertices on both sides.
TEST(BodyDofs, OfRanksAreTheirOwnAndThenWhatTheseAreCoupledTo) {
    for (const int count : {2, 3, 5}) {
        for (unsigned set = 1; set < 8; ++set) {
            SCOPED_TRACE(set);
            expect_maps_of_ranks(count, {(set & 1U) != 0, (set & 2U) != 0, (set & 4U) != 0});
        }
    }
}

}  // namespace
}  // namespace pent::simulator

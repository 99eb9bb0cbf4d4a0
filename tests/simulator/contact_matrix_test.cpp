#include "contact_matrix.h"

#include "contact_scenes.h"
#include "elastic_box.h"

#include <gtest/gtest.h>

namespace pent::simulator {
namespace {

// Two shaken cubes face to face, one vertex in five held, and the Hessian of their contacts.
template <int Dim>
struct Pressed {
    World<Dim> world;
    BlockPattern pattern;
    ContactState<Dim> contacts;
    Positions<Dim> shift;

    Pressed() {
        Scene scene = test::two_cubes<Dim>(0.02);
        scene.obstacles = {
            {.shape = HalfSpaceObstacle{.normal = Eigen::VectorXd::Unit(Dim, 0), .offset = 0.01}}};
        scene.constraints = {
            {.body = "a",
             .select = {HalfSpaceSelection{.normal = Eigen::VectorXd::Unit(Dim, 2), .offset = 0.1}},
             .motion = {}}};
        world = make_world<Dim>(scene, {test::cube<Dim>(), test::cube<Dim>()});
        pattern = make_pattern<Dim>(world.cells, world.numbering);
        Positions<Dim> positions = world.rest;
        std::mt19937 random(3);
        std::uniform_real_distribution<double> shake(-0.02, 0.02);
        positions = positions.unaryExpr([&](double x) { return x + shake(random); });
        SceneContacts<Dim> finder(scene, world);
        contacts = finder.find(Workers(1), positions);
        shift = Positions<Dim>::Random(Dim, positions.cols());
    }

    // Sum over contacts of w_i w_j K, over all vertices in their own order.
    [[nodiscard]] Eigen::MatrixXd oracle() const {
        const Eigen::Index size = Dim * world.vertex_count();
        Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(size, size);
        for (const contact::Contact<Dim>& contact : contacts.pairs) {
            for (int i = 0; i <= Dim; ++i) {
                for (int j = 0; j <= Dim; ++j) {
                    sum.block<Dim, Dim>(Dim * contact.vertices[static_cast<std::size_t>(i)],
                                        Dim * contact.vertices[static_cast<std::size_t>(j)]) +=
                        contact.weights[i] * contact.weights[j] * contact.response.hessian;
                }
            }
        }
        for (const contact::ObstacleContact<Dim>& contact : contacts.obstacles) {
            sum.block<Dim, Dim>(Dim * contact.vertex, Dim * contact.vertex) +=
                contact.response.hessian;
        }
        return sum;
    }
};

template <int Dim>
void expect_the_sum_over_contacts() {
    const Pressed<Dim> pressed;
    ASSERT_GT(pressed.contacts.pairs.size(), 20U);
    ASSERT_GT(pressed.contacts.obstacles.size(), 2U);
    const Numbering& numbering = pressed.world.numbering;
    const double scale = 0.37;
    BlockMatrix<Dim, double> matrix(pressed.pattern);
    BlockVector<Dim> right = BlockVector<Dim>::Zero(Dim, pressed.pattern.rows());
    const auto coupling = add_contact_hessian<Dim, double>(
        Workers(2), numbering, {pressed.contacts, {}}, scale, pressed.shift, matrix, right);
    ASSERT_NE(coupling, nullptr);
    const Eigen::MatrixXd full = scale * pressed.oracle();
    const auto dense = test::ElasticBox<Dim>::template dense<double>;
    const Eigen::MatrixXd sum = dense(matrix) + dense(coupling->matrix);
    const double size = full.norm();
    Eigen::VectorXd expected_right = Eigen::VectorXd::Zero(Dim * pressed.pattern.rows());
    for (std::uint32_t row = 0; row < numbering.free_count(); ++row) {
        const Eigen::Index at = Dim * numbering.vertex_of_unknown[row];
        for (std::uint32_t vertex = 0; vertex < pressed.world.vertex_count(); ++vertex) {
            const auto block = full.block<Dim, Dim>(at, Dim * vertex);
            if (numbering.is_free(vertex)) {
                const std::uint32_t column = numbering.unknown_of_vertex[vertex];
                EXPECT_LT((sum.block<Dim, Dim>(Dim * row, Dim * column) - block).norm(),
                          1e-13 * size);
            } else {
                expected_right.segment<Dim>(Dim * row) -= block * pressed.shift.col(vertex);
            }
        }
    }
    EXPECT_LT((right.reshaped() - expected_right).norm(), 1e-12 * size);
    EXPECT_GT(expected_right.norm(), 1e-3 * size);

    // Products include the coupling; the part within bodies is in the first matrix.
    matrix.set_coupling(&coupling->matrix);
    const BlockVector<Dim> x = BlockVector<Dim>::Random(Dim, pressed.pattern.rows());
    BlockVector<Dim> product(Dim, x.cols());
    matrix.multiply(Workers(2), kernels<Dim>(best_isa()), x, product);
    EXPECT_LT((product.reshaped() - sum * x.reshaped()).norm(), 1e-12 * size * x.norm());
}

TEST(ContactHessian, IsTheSumOverContactsLessTheHeldPart) {
    expect_the_sum_over_contacts<3>();
    expect_the_sum_over_contacts<4>();
}

TEST(ContactHessian, LeavesNoCouplingWhereNothingTouches) {
    const Scene scene = test::two_cubes<4>(0.5);
    const World<4> world = make_world<4>(scene, {test::cube<4>(), test::cube<4>()});
    const BlockPattern pattern = make_pattern<4>(world.cells, world.numbering);
    BlockMatrix<4, float> matrix(pattern);
    BlockVector<4> right = BlockVector<4>::Zero(4, pattern.rows());
    SceneContacts<4> finder(scene, world);
    const ContactState<4> contacts = finder.find(Workers(1), world.rest);
    const auto coupling =
        add_contact_hessian<4, float>(Workers(1), world.numbering, {contacts, {}}, 1,
                                      Positions<4>::Zero(4, world.vertex_count()), matrix, right);
    EXPECT_EQ(coupling, nullptr);
}

}  // namespace
}  // namespace pent::simulator

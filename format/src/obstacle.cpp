#include "pent/obstacle.h"

#include <pent/error.h>

#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <type_traits>

namespace pent {

namespace {

void require(bool is_right, const std::string& what, const char* field, const std::string& must) {
    if (!is_right) {
        throw Error(what + ": " + field + " must " + must);
    }
}

// Checks a field of a shape.
struct FieldCheck {
    int dimension;
    const std::string& what;

    void operator()(const char* name, double value, ShapeField kind) const {
        require(std::isfinite(value), what, name, "be finite");
        require(kind != ShapeField::Length || value > 0, what, name, "be above 0");
    }
    template <int Size>
    void operator()(const char* name,
                    const Eigen::Matrix<double, Size, Size>& axes,
                    ShapeField /*kind*/) const {
        require(axes.size() == 0 || (axes.rows() == dimension && is_rotation(axes)), what, name,
                "be " + std::to_string(dimension) + " unit vectors across one another");
    }
    template <int Size>
    void operator()(const char* name,
                    const Eigen::Matrix<double, Size, 1>& value,
                    ShapeField kind) const {
        require(value.size() == dimension && value.allFinite(), what, name,
                "be " + std::to_string(dimension) + " finite numbers");
        require(kind != ShapeField::Length || (value.array() > 0).all(), what, name,
                "be above 0 along every axis");
        const bool is_direction = kind == ShapeField::Direction || kind == ShapeField::UpDirection;
        require(!is_direction || std::abs(value.norm() - 1) <= 1e-9, what, name, "have length 1");
    }
};

// Copies the fields of one shape, in their order, to those of another.
template <typename From, typename To>
To copied(const From& from) {
    std::vector<Eigen::VectorXd> values;
    From::fields(from, [&](const char* /*name*/, const auto& value, ShapeField /*kind*/) {
        if constexpr (std::is_arithmetic_v<std::remove_cvref_t<decltype(value)>>) {
            values.push_back(Eigen::VectorXd::Constant(1, value));
        } else {
            values.emplace_back(value.reshaped());
        }
    });
    To to;
    auto next = values.begin();
    To::fields(to, [&](const char* /*name*/, auto& value, ShapeField kind) {
        if constexpr (std::is_arithmetic_v<std::remove_cvref_t<decltype(value)>>) {
            value = (*next)[0];
        } else if (kind != ShapeField::Axes || next->size() > 0) {
            value = next->reshaped(value.rows(), value.cols());
        }
        ++next;
    });
    return to;
}

template <int Dim>
struct FixedSize {
    template <template <int> class Shape>
    ObstacleShape<Dim> operator()(const Shape<Eigen::Dynamic>& shape) const {
        return copied<Shape<Eigen::Dynamic>, Shape<Dim>>(shape);
    }
};

template <typename... Shapes>
std::vector<std::variant<Shapes...>> one_of_each(const std::variant<Shapes...>* /*list*/) {
    return {Shapes{}...};
}

}  // namespace

template <int Dim>
ObstacleShape<Dim> fixed_size(const ObstacleShape<Eigen::Dynamic>& obstacle) {
    return std::visit(FixedSize<Dim>(), obstacle);
}

std::vector<ObstacleShape<Eigen::Dynamic>> all_shapes(int dimension) {
    auto shapes = one_of_each(static_cast<const ObstacleShape<Eigen::Dynamic>*>(nullptr));
    for (ObstacleShape<Eigen::Dynamic>& shape : shapes) {
        std::visit(
            [&](auto& one) {
                one.fields(one, [&](const char* /*name*/, auto& value, ShapeField kind) {
                    using Value = std::remove_cvref_t<decltype(value)>;
                    if constexpr (std::is_same_v<Value, Eigen::MatrixXd>) {
                        value.setIdentity(dimension, dimension);
                    } else if constexpr (std::is_same_v<Value, Eigen::VectorXd>) {
                        value.setZero(dimension);
                        if (kind == ShapeField::UpDirection) {
                            value[1] = 1;
                        }
                    }
                });
            },
            shape);
    }
    return shapes;
}

bool is_rotation(const Eigen::Ref<const Eigen::MatrixXd>& axes) {
    constexpr double kRounding = 1e-9;
    const Eigen::Index size = axes.rows();
    return axes.cols() == size && axes.allFinite()
           && (axes.transpose() * axes - Eigen::MatrixXd::Identity(size, size))
                      .cwiseAbs()
                      .maxCoeff()
                  <= kRounding
           && axes.determinant() > 0;
}

template <int Dim>
void check(const ObstacleShape<Dim>& obstacle, int dimension, const std::string& what) {
    std::visit(
        [&](const auto& shape) {
            shape.fields(shape, FieldCheck{dimension, what});
        },
        obstacle);
}

template <int Dim>
std::string_view name_of(const ObstacleShape<Dim>& obstacle) {
    return std::visit([](const auto& shape) { return std::string_view(shape.kName); }, obstacle);
}

// Corner i is on the far side along the axes of the bits of i; each order of the axes is a path of
// edges from corner 0 to the last, and a simplex.
template <int Dim>
SimplexMesh<Dim> to_mesh(const Cuboid<Dim>& box) {
    constexpr int kCorners = 1 << Dim;
    SimplexMesh<Dim> mesh;
    mesh.positions.resize(Dim, kCorners);
    for (int corner = 0; corner < kCorners; ++corner) {
        Eigen::Matrix<double, Dim, 1> from_center;
        for (int axis = 0; axis < Dim; ++axis) {
            from_center[axis] = ((corner >> axis & 1) != 0 ? 0.5 : -0.5) * box.sides[axis];
        }
        mesh.positions.col(corner) = box.center + box.axes * from_center;
    }
    std::array<int, Dim> order{};
    std::iota(order.begin(), order.end(), 0);
    mesh.cells.resize(Dim + 1, Dim == 3 ? 6 : 24);
    for (Eigen::Index cell = 0; cell < mesh.cells.cols(); ++cell) {
        std::uint32_t corner = 0;
        bool is_even = true;
        mesh.cells(0, cell) = corner;
        for (int k = 0; k < Dim; ++k) {
            corner |= 1U << order[static_cast<std::size_t>(k)];
            mesh.cells(k + 1, cell) = corner;
            for (int j = 0; j < k; ++j) {
                is_even =
                    is_even
                    != (order[static_cast<std::size_t>(j)] > order[static_cast<std::size_t>(k)]);
            }
        }
        if (!is_even) {  // orders that are odd would make it inside out
            std::swap(mesh.cells(0, cell), mesh.cells(1, cell));
        }
        std::next_permutation(order.begin(), order.end());
    }
    return mesh;
}

template SimplexMesh<3> to_mesh<3>(const Cuboid<3>&);
template SimplexMesh<4> to_mesh<4>(const Cuboid<4>&);
template ObstacleShape<3> fixed_size<3>(const ObstacleShape<Eigen::Dynamic>&);
template ObstacleShape<4> fixed_size<4>(const ObstacleShape<Eigen::Dynamic>&);
#define PENT_INSTANTIATE(Dim)                                                     \
    template void check<Dim>(const ObstacleShape<Dim>&, int, const std::string&); \
    template std::string_view name_of<Dim>(const ObstacleShape<Dim>&);
PENT_INSTANTIATE(3)
PENT_INSTANTIATE(4)
PENT_INSTANTIATE(Eigen::Dynamic)
#undef PENT_INSTANTIATE

}  // namespace pent

#include "fields.h"

#include "half_spaces.h"
#include "image_level.h"
#include "tet_boundary.h"

#include <pent/error.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <muParser.h>
#include <mutex>
#include <vector>

namespace pent::mesher {

namespace {

double value_of(const RoundField& field, const Eigen::Vector4d& p) {
    return p.cwiseProduct(field.axes).norm() - field.radius;
}

double value_of(const CapsuleField& field, const Eigen::Vector4d& p) {
    const double beyond = std::max(std::abs(p[3]) - field.half_length, 0.0);
    return std::hypot(p.head<3>().norm(), beyond) - field.radius;
}

double value_of(const HalfSpacesField& field, const Eigen::Vector4d& p) {
    const HalfSpaces& all = *field.half_spaces;
    return all[all.deciding(p)].value(p);
}

double value_of(const RingField& field, const Eigen::Vector4d& p) {
    const double from_ring = p.head(field.axes).norm() - field.ring_radius;
    return std::hypot(from_ring, p.tail(4 - field.axes).norm()) - field.tube_radius;
}

double value_of(const TigerField& field, const Eigen::Vector4d& p) {
    return std::hypot(p.head<2>().norm() - field.ring_radii[0],
                      p.tail<2>().norm() - field.ring_radii[1])
           - field.tube_radius;
}

double value_of(const DitorusField& field, const Eigen::Vector4d& p) {
    const double from_circle = std::hypot(p.head<2>().norm() - field.ring_radii[0], p[2]);
    return std::hypot(from_circle - field.ring_radii[1], p[3]) - field.tube_radius;
}

double value_of(const ExpressionField& field, const Eigen::Vector4d& p) {
    return field.value(p);
}

double value_of(const BoundaryField& field, const Eigen::Vector4d& p) {
    return field.boundary->value(p);
}

double value_of(const ImageField& field, const Eigen::Vector4d& p) {
    return field.image->value(p);
}

// A parser with its own place for the point: it reads the variables where they are.
struct BoundParser {
    Eigen::Vector4d point = Eigen::Vector4d::Zero();
    mu::Parser parser;
};

std::unique_ptr<BoundParser> bound_parser(const std::string& formula) {
    auto bound = std::make_unique<BoundParser>();
    for (int axis = 0; axis < 4; ++axis) {
        bound->parser.DefineVar(std::string(1, "xyzw"[axis]), &bound->point[axis]);
    }
    bound->parser.SetExpr(formula);
    return bound;
}

}  // namespace

// As many parsers as threads ever asked at once.
class ExpressionField::Parsers {
public:
    explicit Parsers(std::string formula) : formula_(std::move(formula)) {
        try {
            std::unique_ptr<BoundParser> first = bound_parser(formula_);
            first->parser.Eval();
            int results = 0;
            first->parser.Eval(results);
            if (results != 1) {
                throw Error("the expression \"" + formula_ + "\" has " + std::to_string(results)
                            + " results; expected one number");
            }
            free_.push_back(std::move(first));
        } catch (const mu::Parser::exception_type& error) {
            throw Error("the expression \"" + formula_ + "\": " + error.GetMsg()
                        + "; expected a formula in x y z w, as in \"x^2 + y^2 + z^2 + w^2 - 1\"");
        }
    }

    double value(const Eigen::Vector4d& p) {
        std::unique_ptr<BoundParser> bound = take();
        bound->point = p;
        double value = 0;
        try {
            value = bound->parser.Eval();
        } catch (const mu::Parser::exception_type& error) {
            // GCOVR_EXCL_START: functions of the library do not throw
            throw Error("the expression \"" + formula_ + "\": " + error.GetMsg());
            // GCOVR_EXCL_STOP
        }
        const std::lock_guard lock(mutex_);
        free_.push_back(std::move(bound));
        return value;
    }

private:
    std::unique_ptr<BoundParser> take() {
        {
            const std::lock_guard lock(mutex_);
            if (!free_.empty()) {
                std::unique_ptr<BoundParser> bound = std::move(free_.back());
                free_.pop_back();
                return bound;
            }
        }
        return bound_parser(formula_);
    }

    std::string formula_;
    std::mutex mutex_;
    std::vector<std::unique_ptr<BoundParser>> free_;
};

ExpressionField::ExpressionField(const std::string& formula)
    : parsers_(std::make_shared<Parsers>(formula)) {}

double ExpressionField::value(const Eigen::Vector4d& p) const {
    return parsers_->value(p);
}

double field_value(const Field& field, const Eigen::Vector4d& p) {
    return std::visit([&](const auto& kind) { return value_of(kind, p); }, field);
}

int piece_count(const Field& field) {
    if (const auto* polytope = std::get_if<HalfSpacesField>(&field)) {
        return polytope->half_spaces->count();
    }
    const auto* surface = std::get_if<BoundaryField>(&field);
    return surface != nullptr ? surface->boundary->patch_count() : 1;
}

double piece_value(const Field& field, int piece, const Eigen::Vector4d& p) {
    if (const auto* polytope = std::get_if<HalfSpacesField>(&field)) {
        return (*polytope->half_spaces)[piece].value(p);
    }
    const auto* surface = std::get_if<BoundaryField>(&field);
    return surface != nullptr ? surface->boundary->patch_value(piece, p) : field_value(field, p);
}

std::vector<int> pieces_near(const Field& field, const Eigen::Vector4d& p, double margin) {
    const int count = piece_count(field);
    if (count == 1) {
        return {0};
    }
    if (const auto* surface = std::get_if<BoundaryField>(&field)) {
        return surface->boundary->patches_within(p, surface->boundary->distance(p) + margin);
    }
    // The others have one piece.
    const HalfSpaces& all = *std::get<HalfSpacesField>(field).half_spaces;
    return all.pieces_above(p, all[all.deciding(p)].value(p) - margin);
}

ValueRange field_range(const Field& field, const Eigen::Vector4d& center, double radius) {
    if (std::holds_alternative<ExpressionField>(field)) {
        constexpr double kInfinity = std::numeric_limits<double>::infinity();
        return {-kInfinity, kInfinity};
    }
    if (const auto* image = std::get_if<ImageField>(&field)) {
        return image->image->range(center, radius);
    }
    if (const auto* surface = std::get_if<BoundaryField>(&field)) {
        return surface->boundary->range(center, radius);
    }
    const double value = field_value(field, center);
    return {value - radius, value + radius};
}

}  // namespace pent::mesher

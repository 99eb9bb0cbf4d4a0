#include <pent/error.h>
#include <pent/nearest_name.h>
#include <pent/number_bounds.h>
#include <pent/simulator/scene.h>
#include <pent/simulator/scene_checks.h>
#include <pent/simulator/scene_schema.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <type_traits>

namespace pent::simulator {

namespace {

void require(bool holds, const std::string& message) {
    if (!holds) {
        throw Error(message);
    }
}

void check_vector(const Eigen::VectorXd& vector, int dimension, const std::string& what) {
    require(vector.size() == dimension && vector.allFinite(),
            what + " must be " + std::to_string(dimension) + " finite numbers");
}

void check_plane(const Plane& plane, int dimension, const std::string& what) {
    const auto is_axis = [&](int axis) { return axis >= 0 && axis < dimension; };
    require(is_axis(plane.from) && is_axis(plane.to) && plane.from != plane.to,
            what + ": a plane needs two different axes of the scene");
}

// A visitor of the schema: throws for what its range does not have.
struct Checker {
    std::string what;
    int dimension;
    std::string prefix = {};  // of keys, as in "place."

    template <typename Value>
    void operator()(const Field& field, const Value& value) const {
        if (!field.does_apply) {
            return;
        }
        if constexpr (std::is_class_v<Value>) {
            check_part(value, prefix + std::string(field.key) + ".");
        } else if constexpr (std::is_arithmetic_v<Value> && !std::is_same_v<Value, bool>) {
            check_number(field, static_cast<double>(value));
        }
    }
    template <typename Part>
    void operator()(const Field& field, const std::vector<Part>& parts) const {
        for (const Part& part : parts) {
            check_part(part, prefix + std::string(field.key) + ".");
        }
    }
    template <typename Value>
    requires std::is_enum_v<Value>
    void operator()(const Field& /*field*/, const std::vector<Value>& /*words*/) const {}
    void operator()(const Field& field, const Eigen::VectorXd& value) const {
        if (!field.does_apply || (value.size() == 0 && field.may_lack)) {
            return;
        }
        check_vector(value, dimension, at(field));
        require(!field.is_direction || std::abs(value.norm() - 1) < 1e-9,
                at(field) + " must have length 1");
    }
    void operator()(const Field& field, const std::optional<Eigen::VectorXd>& value) const {
        if (value) {
            check_vector(*value, dimension, at(field));
        }
    }
    void operator()(const Field& /*field*/, const std::string& /*text*/) const {}
    void operator()(const Field& /*field*/, const Plane& plane) const {
        check_plane(plane, dimension, what);
    }
    void operator()(const Field& /*field*/, const Lame& /*lame*/) const {}  // of its material
    void operator()(const Field& field, const Material& material) const {
        try {
            check(material, dimension);
        } catch (const Error& error) {
            throw Error(what + ": " + error.what());
        }
        check_part(material, prefix + std::string(field.key) + ".");
    }
    void operator()(const Field& field, const std::vector<Selection>& select) const {
        require(!select.empty() || !field.does_apply, what + ": nothing is selected");
        for (const Selection& selection : select) {
            std::visit([&](const auto& kind) { check_part(kind, ""); }, selection);
        }
    }
    void operator()(const Field& /*field*/, const ObstacleShape& shape) const {
        pent::check<Eigen::Dynamic>(shape, dimension, what);
    }

private:
    [[nodiscard]] std::string at(const Field& field) const {
        return what + ": " + prefix + std::string(field.key);
    }
    void check_number(const Field& field, double value) const {
        if (field.may_lack && std::isinf(value)) {
            return;
        }
        const std::string expected = expected_in(field.range, value);
        require(expected.empty(), at(field) + " is " + readable(value) + "; expected " + expected);
    }
    template <typename Part>
    void check_part(const Part& part, const std::string& keys) const {
        fields(part, Checker{what, dimension, keys});
        if (const auto fault = fault_of(part)) {
            throw Error(what + ": " + fault->message);
        }
    }
};

bool is_name(const std::string& name) {
    constexpr std::size_t kLongest = 100;  // names of files have 255 bytes
    return !name.empty() && name.size() <= kLongest
           && std::all_of(name.begin(), name.end(), [](char c) {
                  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9')
                         || c == '-' || c == '_';
              });
}

std::string name_of_part(std::string_view /*block*/, const Body& body) {
    return "body \"" + body.name + "\"";
}
std::string name_of_part(std::string_view /*block*/, const Constraint& constraint) {
    return "constraint on \"" + constraint.body + "\"";
}
std::string name_of_part(std::string_view /*block*/, const Load& load) {
    return "load on \"" + load.body + "\"";
}
std::string name_of_part(std::string_view /*block*/, const Activation& activation) {
    return "activation of \"" + activation.body + "\"";
}
std::string name_of_part(std::string_view /*block*/, const Attachment& attachment) {
    return "attachment of \"" + attachment.body + "\"";
}
template <typename Part>
std::string name_of_part(std::string_view block, const Part& /*part*/) {
    return std::string(block);
}

// Each block by itself.
struct BlockChecker {
    int dimension;

    template <typename Part>
    void operator()(std::string_view name, const std::vector<Part>& parts) const {
        for (const Part& part : parts) {
            (*this)(name, part);
        }
    }
    template <typename Part>
    void operator()(std::string_view name, const std::optional<Part>& part) const {
        if (part) {
            (*this)(name, *part);
        }
    }
    template <typename Part>
    void operator()(std::string_view name, const Part& part) const {
        const std::string what = name_of_part(name, part);
        fields(part, Checker{what, dimension});
        if (const auto fault = fault_of(part)) {
            throw Error(what + ": " + fault->message);
        }
    }
};

void check_names(const Scene& scene) {
    const auto count = [&](const std::string& name) {
        return std::count_if(scene.bodies.begin(), scene.bodies.end(),
                             [&](const Body& body) { return body.name == name; });
    };
    for (const Body& body : scene.bodies) {
        require(is_name(body.name),
                "the body name \"" + body.name
                    + "\" may have letters, digits, - and _ only, and at most 100 of them");
        require(count(body.name) == 1, "two bodies have the name \"" + body.name + "\"");
        check_regions(body);
    }
    for (const Constraint& constraint : scene.constraints) {
        require(count(constraint.body) > 0,
                "constraint on \"" + constraint.body + "\": no body has this name");
    }
    for (const Load& load : scene.loads) {
        require(count(load.body) > 0, "load on \"" + load.body + "\": no body has this name");
    }
    for (const Activation& activation : scene.activations) {
        require(count(activation.body) > 0,
                "activation of \"" + activation.body + "\": no body has this name");
    }
    for (const Attachment& attachment : scene.attachments) {
        for (const std::string& name : {attachment.body, attachment.target}) {
            require(
                name.empty() || count(name) > 0,
                "attachment of \"" + attachment.body + "\": no body is called \"" + name + "\"");
        }
    }
}

}  // namespace

void check_regions(const Body& body) {
    for (const Region& region : body.regions) {
        const auto has_name = [&](const Region& other) { return other.name == region.name; };
        require(is_name(region.name),
                "body \"" + body.name + "\": the name of the region \"" + region.name
                    + "\" may have letters, digits, - and _ only, and at most 100 of them");
        require(std::count_if(body.regions.begin(), body.regions.end(), has_name) == 1,
                "body \"" + body.name + "\": two regions have the name \"" + region.name + "\"");
    }
}

void check_model(ContactModel model, Integrator integrator) {
    require(model != ContactModel::Barrier || integrator != Integrator::LinearEuler,
            "contact: the barrier model needs a solver that iterates, since one linear solve cannot"
            " keep bodies apart; use integrator = \"newton_euler\", or model = \"penalty\"");
}

void check_pairs(const std::vector<BodyPair>& pairs, const Scene& scene) {
    std::vector<std::string> names;
    for (const Body& body : scene.bodies) {
        names.push_back(body.name);
    }
    for (const BodyPair& pair : pairs) {
        for (const std::string& name : {pair.first, pair.second}) {
            if (std::find(names.begin(), names.end(), name) == names.end()) {
                const std::string nearest = nearest_name(name, names);
                throw Error("contact: no body is called \"" + name + "\""
                            + (nearest.empty() ? "" : "; did you mean \"" + nearest + "\"?"));
            }
        }
    }
}

void check_activations(const Scene& scene) {
    require(scene.activations.empty() || scene.solver.elements != ElementKind::Smoothed,
            "activation: smoothed elements know none; use elements = \"quadratic\" or \"linear\"");
}

void check_sleeping(Integrator integrator) {
    require(integrator != Integrator::Quasistatic,
            "sleep: the quasistatic integrator has no motion that could come to rest; leave [sleep]"
            " out");
}

void check_held(const Body& body, const Scene& scene) {
    const bool is_held =
        std::any_of(scene.constraints.begin(), scene.constraints.end(), [&](const Constraint& c) {
            return c.body == body.name && c.from == 0 && std::isinf(c.to);
        });
    require(is_held || scene.solver.integrator != Integrator::Quasistatic,
            "body \"" + body.name
                + "\" has no constraint that lasts: the quasistatic integrator needs every body"
                  " held all the time");
}

std::uint32_t index_of(const Scene& scene, const std::string& body) {
    const auto found = std::find_if(scene.bodies.begin(), scene.bodies.end(),
                                    [&](const Body& one) { return one.name == body; });
    assert(found != scene.bodies.end());
    return static_cast<std::uint32_t>(found - scene.bodies.begin());
}

std::string plane_name(const Plane& plane) {
    constexpr std::string_view kAxes = "xyzw";
    return {kAxes[static_cast<std::size_t>(plane.from)], kAxes[static_cast<std::size_t>(plane.to)]};
}

void check(const Scene& scene) {
    fields(scene, Checker{"scene", scene.dimension});
    require(!scene.bodies.empty(), "the scene has no body");
    check_names(scene);
    blocks(scene, BlockChecker{scene.dimension});
    if (scene.contact) {
        check_model(scene.contact->model, scene.solver.integrator);
        check_pairs(scene.contact->ignore, scene);
        check_pairs(scene.contact->only, scene);
    }
    if (scene.sleep) {
        check_sleeping(scene.solver.integrator);
    }
    check_activations(scene);
    for (const Body& body : scene.bodies) {
        check_held(body, scene);
    }
}

}  // namespace pent::simulator

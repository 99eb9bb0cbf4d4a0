#include "scene/scene_names.h"

#include <pent/real_text.h>
#include <pent/runs/scene_file.h>

#include <cassert>
#include <cmath>
#include <string>
#include <type_traits>

namespace pent::runs {

namespace {

// Shortest text that reads back as the same double; TOML wants a digit on both sides of the point.
std::string number(double value) {
    assert(std::isfinite(value));
    char digits[32];
    const auto [end, error] = real_to_chars(digits, digits + sizeof digits, value);
    std::string text(digits, end);
    if (text.find_first_of(".e") == std::string::npos) {
        text += ".0";
    }
    return text;
}

std::string vector(const Eigen::VectorXd& values) {
    std::string text = "[";
    for (Eigen::Index i = 0; i < values.size(); ++i) {
        text += (i > 0 ? ", " : "") + number(values[i]);
    }
    return text + "]";
}

std::string in_quotes(std::string_view value) {
    constexpr std::string_view kHex = "0123456789abcdef";
    std::string text = "\"";
    for (const char c : value) {
        const auto code = static_cast<unsigned char>(c);
        if (c == '"' || c == '\\') {
            text += '\\';
            text += c;
        } else if (code < 0x20 || code == 0x7f) {
            text += "\\u00";
            text += kHex[code / 16];
            text += kHex[code % 16];
        } else {
            text += c;
        }
    }
    return text + "\"";
}

std::string line(std::string_view key, const std::string& value) {
    return std::string(key) + " = " + value + "\n";
}

template <typename List, typename Write>
std::string list(const List& entries, const Write& write) {
    std::string text = "[";
    for (const auto& entry : entries) {
        text += (text.size() > 1 ? ", " : "") + write(entry);
    }
    return text + "]";
}

std::string placement(const Placement& place) {
    const std::string turns = list(place.rotate, [](const Turn& turn) {
        return "{ plane = " + in_quotes(plane_name(turn.plane))
               + ", degrees = " + number(turn.degrees) + " }";
    });
    return "{ scale = " + number(place.scale) + ", rotate = " + turns
           + ", translate = " + vector(place.translate) + " }";
}

std::string material(const Material& material) {
    return "{ model = " + in_quotes(word_of(kModels, material.model))
           + ", mu = " + number(material.lame.mu) + ", lambda = " + number(material.lame.lambda)
           + ", density = " + number(material.density) + " }";
}

struct SelectionWriter {
    std::string operator()(const BallSelection& ball) const {
        return "{ ball = { center = " + vector(ball.center) + ", radius = " + number(ball.radius)
               + " } }";
    }
    std::string operator()(const BoxSelection& box) const {
        return "{ box = { low = " + vector(box.low) + ", high = " + vector(box.high) + " } }";
    }
    std::string operator()(const HalfSpaceSelection& half_space) const {
        return "{ half_space = { normal = " + vector(half_space.normal)
               + ", offset = " + number(half_space.offset) + " } }";
    }
    std::string operator()(const LayerSelection& layers) const {
        return "{ layers = { first = " + std::to_string(layers.first)
               + ", last = " + std::to_string(layers.last) + " } }";
    }
    std::string operator()(const RegionSelection& region) const {
        return "{ region = " + std::to_string(region.region) + " }";
    }
    std::string operator()(const EverythingSelection& /*everything*/) const {
        return in_quotes("everything");
    }
};

std::string selections(const std::vector<Selection>& select) {
    for (const Selection& selection : select) {
        if (std::holds_alternative<EverythingSelection>(selection)) {
            return SelectionWriter{}(EverythingSelection{});  // whatever else there is
        }
    }
    return list(select, [](const Selection& selection) {
        return std::visit(SelectionWriter{}, selection);
    });
}

std::string spins(const std::vector<Spin>& rotate) {
    return list(rotate, [](const Spin& spin) {
        return "{ plane = " + in_quotes(plane_name(spin.plane))
               + ", degrees_per_s = " + number(spin.degrees_per_s) + " }";
    });
}

std::string motion(const Motion& motion) {
    return "{ translate = " + vector(motion.translate) + ", rotate = " + spins(motion.rotate)
           + (motion.about ? ", about = " + vector(*motion.about) : "")
           + ", from = " + number(motion.from)
           + (std::isfinite(motion.to) ? ", to = " + number(motion.to) : "") + " }";
}

std::string body_text(const Body& body, int dimension) {
    const YoungPoisson young = young_from_lame(dimension, body.material.lame);
    return "\n[[body]]\n" + line("name", in_quotes(body.name)) + line("mesh", in_quotes(body.mesh))
           + (body.recipe.empty() ? "" : line("recipe", in_quotes(body.recipe)))
           + line("place", placement(body.place)) + "# young = " + number(young.young)
           + ", poisson = " + number(young.poisson) + "\n"
           + line("material", material(body.material))
           + (body.velocity.size() > 0 ? line("velocity", vector(body.velocity)) : "")
           + line("spin", spins(body.spin));
}

std::string shape_text(const ObstacleShape& shape) {
    return std::visit(
        [](const auto& one) {
            std::string fields;
            one.fields(one, [&](const char* name, const auto& value, ShapeField) {
                fields += (fields.empty() ? "" : ", ") + std::string(name) + " = ";
                if constexpr (std::is_same_v<std::remove_cvref_t<decltype(value)>, double>) {
                    fields += number(value);
                } else {
                    fields += vector(value);
                }
            });
            return line(one.kName, "{ " + fields + " }");
        },
        shape);
}

std::string obstacle_text(const Obstacle& obstacle) {
    return "\n[[obstacle]]\n" + shape_text(obstacle.shape)
           + line("distance", number(obstacle.distance))
           + line("stiffness", number(obstacle.stiffness));
}

std::string contact_text(const Contact& contact) {
    return "\n[contact]\n" + line("model", in_quotes(word_of(kContactModels, contact.model)))
           + line("distance", number(contact.distance))
           + line("stiffness", number(contact.stiffness))
           + line("self", contact.self ? "true" : "false")
           + line("filter", in_quotes(word_of(kFilters, contact.filter)))
           + line("separation", number(contact.separation))
           + line("friction", number(contact.friction))
           + line("slip_speed", number(contact.slip_speed));
}

std::string output_text(const Output& output) {
    return "\n[output]\n" + line("contact_forces", output.contact_forces ? "true" : "false")
           + line("contact_pairs", output.contact_pairs ? "true" : "false");
}

std::string solver_text(const SolverOptions& solver) {
    return "\n[solver]\n" + line("integrator", in_quotes(word_of(kIntegrators, solver.integrator)))
           + line("elements", in_quotes(word_of(kElementKinds, solver.elements)))
           + line("filter", in_quotes(word_of(kFilters, solver.filter)))
           + line("linear", in_quotes(word_of(kLinearSolvers, solver.linear)))
           + line("preconditioner", in_quotes(word_of(kPreconditioners, solver.preconditioner)))
           + line("precision", in_quotes(word_of(kPrecisions, solver.precision)))
           + line("tolerance", number(solver.tolerance))
           + line("newton_tolerance", number(solver.newton_tolerance))
           + line("max_iterations", std::to_string(solver.max_iterations))
           + line("max_halvings", std::to_string(solver.max_halvings));
}

}  // namespace

std::string scene_text(const Scene& scene) {
    std::string text = "[scene]\n";
    text += line("dimension", std::to_string(scene.dimension));
    text += line("gravity", vector(scene.gravity));
    text += line("frames", std::to_string(scene.frames));
    text += line("frames_per_second", number(scene.frames_per_second));
    text += line("steps_per_frame", std::to_string(scene.steps_per_frame));
    for (const Body& body : scene.bodies) {
        text += body_text(body, scene.dimension);
    }
    for (const Constraint& constraint : scene.constraints) {
        text += "\n[[constraint]]\n" + line("body", in_quotes(constraint.body))
                + line("select", selections(constraint.select))
                + line("motion", constraint.motion.empty() ? in_quotes("fixed")
                                                           : list(constraint.motion, motion));
    }
    for (const Obstacle& obstacle : scene.obstacles) {
        text += obstacle_text(obstacle);
    }
    if (scene.contact) {
        text += contact_text(*scene.contact);
    }
    if (scene.damping) {
        text += "\n[damping]\n" + line("mass", number(scene.damping->mass))
                + line("stiffness", number(scene.damping->stiffness));
    }
    if (scene.sleep) {
        text += "\n[sleep]\n" + line("speed", number(scene.sleep->speed))
                + line("time", number(scene.sleep->time));
    }
    return text + solver_text(scene.solver) + output_text(scene.output);
}

}  // namespace pent::runs

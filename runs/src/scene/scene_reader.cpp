#include "scene/contact_reader.h"
#include "scene/scene_names.h"

#include <pent/error.h>
#include <pent/read_text.h>
#include <pent/runs/scene_file.h>
#include <pent/simulator/scene_checks.h>
#include <pent/toml_table.h>

#include <algorithm>
#include <cmath>

namespace pent::runs {

namespace {

Eigen::VectorXd zero(int dimension) {
    return Eigen::VectorXd::Zero(dimension);
}

Plane read_plane(TableReader& reader, int dimension) {
    const std::string axes = std::string("xyzw").substr(0, static_cast<std::size_t>(dimension));
    const std::string name = reader.text("plane");
    const auto from = name.size() == 2 ? axes.find(name[0]) : std::string::npos;
    const auto to = name.size() == 2 ? axes.find(name[1]) : std::string::npos;
    if (from == std::string::npos || to == std::string::npos || from == to) {
        reader.fail("plane", "\"plane\" is \"" + name + "\"; expected two different axes of " + axes
                                 + ", as in \"" + (dimension == 4 ? "xw" : "xz")
                                 + "\", which takes the first towards the second");
    }
    return {static_cast<int>(from), static_cast<int>(to)};
}

std::vector<Spin> read_spins(std::vector<TableReader> tables, int dimension) {
    std::vector<Spin> spins;
    for (TableReader& spin : tables) {
        const Plane plane = read_plane(spin, dimension);
        spins.push_back({plane, spin.number("degrees_per_s", {}, kAngle)});
        spin.finish();
    }
    return spins;
}

Placement read_placement(TableReader reader, int dimension) {
    Placement place;
    place.scale = reader.number("scale", 1, kPositive);
    for (TableReader& turn : reader.tables("rotate")) {
        const Plane plane = read_plane(turn, dimension);
        place.rotate.push_back({plane, turn.number("degrees", {}, kAngle)});
        turn.finish();
    }
    place.translate = reader.vector("translate", dimension, zero(dimension));
    reader.finish();
    return place;
}

Material read_material(TableReader reader, int dimension) {
    Material material;
    material.model = kModels[reader.choice("model", names_of(kModels), 0)].value;
    material.density = reader.number("density", 1000, kPositive);
    if (reader.has("mu") || reader.has("lambda")) {
        constexpr std::string_view kReason =
            "does not go together with mu and lambda; give one pair or the other";
        reader.refuse("young", kReason);
        reader.refuse("poisson", kReason);
        // What follows from young and poisson, both within bounds, is within these; it is written
        // out as mu and lambda.
        Range range{.low = 0, .low_included = false, .smallest = 1e-70, .largest = 1e70};
        material.lame.mu = reader.number("mu", {}, range);
        range.low = -2 * material.lame.mu / dimension;
        material.lame.lambda = reader.number("lambda", {}, range);
    } else {
        const double young = reader.number("young", 1e5, kPositive);
        const double poisson = reader.number("poisson", 0.28, kAnyNumber);
        try {
            material.lame = lame_from_young(dimension, young, poisson);
        } catch (const Error& error) {
            reader.fail("poisson", error.what());
        }
    }
    reader.finish();
    return material;
}

Body read_body(TableReader& reader, int dimension, const std::filesystem::path& folder) {
    Body body;
    body.name = reader.text("name");
    body.mesh = (folder / reader.text("mesh")).lexically_normal().string();
    body.source = reader.place("mesh");
    if (reader.has("recipe")) {
        body.recipe = reader.text("recipe");
    }
    body.place.translate = zero(dimension);
    if (reader.has("place")) {
        body.place = read_placement(reader.table("place"), dimension);
    }
    body.material.lame = lame_from_young(dimension, 1e5, 0.28);
    if (reader.has("material")) {
        body.material = read_material(reader.table("material"), dimension);
    }
    body.velocity = reader.vector("velocity", dimension, zero(dimension));
    body.spin = read_spins(reader.tables("spin"), dimension);
    reader.finish();
    try {
        Scene probe;
        probe.dimension = dimension;
        probe.gravity = zero(dimension);
        probe.bodies = {body};
        check(probe);
    } catch (const Error& error) {
        reader.fail("name", error.what());
    }
    return body;
}

Selection read_ball(TableReader reader, int dimension) {
    BallSelection ball;
    ball.center = reader.vector("center", dimension, {});
    ball.radius = reader.number("radius", {}, kPositive);
    reader.finish();
    return ball;
}

Selection read_box(TableReader reader, int dimension) {
    BoxSelection box;
    box.low = reader.vector("low", dimension, {});
    box.high = reader.vector("high", dimension, {});
    if ((box.low.array() > box.high.array()).any()) {
        reader.fail("low", "\"low\" is above \"high\" along an axis; expected the lower corner");
    }
    reader.finish();
    return box;
}

Selection read_half_space(TableReader reader, int dimension) {
    HalfSpaceSelection half_space;
    half_space.normal = read_direction(reader, "normal", dimension);
    half_space.offset = reader.number("offset", 0, kAnyNumber);
    reader.finish();
    return half_space;
}

Selection read_layers(TableReader reader) {
    constexpr std::int64_t kMost = std::numeric_limits<std::uint32_t>::max();
    LayerSelection layers;
    layers.first = static_cast<std::uint32_t>(reader.integer("first", {}, 0, kMost));
    layers.last = static_cast<std::uint32_t>(reader.integer("last", layers.first, 0, kMost));
    if (layers.last < layers.first) {
        reader.fail("last", "\"last\" is before \"first\"");
    }
    reader.finish();
    return layers;
}

Selection read_selection(TableReader& reader, int dimension) {
    const std::string kind = reader.one_of({"ball", "box", "half_space", "layers", "region"});
    reader.finish();
    if (kind == "ball") {
        return read_ball(reader.table("ball"), dimension);
    }
    if (kind == "box") {
        return read_box(reader.table("box"), dimension);
    }
    if (kind == "half_space") {
        return read_half_space(reader.table("half_space"), dimension);
    }
    if (kind == "layers") {
        return read_layers(reader.table("layers"));
    }
    return RegionSelection{static_cast<std::uint16_t>(reader.integer("region", {}, 0, 65535))};
}

Motion read_motion(TableReader& reader, int dimension) {
    Motion motion;
    motion.translate = reader.vector("translate", dimension, zero(dimension));
    motion.rotate = read_spins(reader.tables("rotate"), dimension);
    if (reader.has("about")) {
        motion.about = reader.vector("about", dimension, {});
    }
    motion.from = reader.number("from", 0, kNotNegative);
    if (reader.has("to")) {
        motion.to = reader.number("to", {}, {.low = motion.from, .low_included = false});
    }
    reader.finish();
    return motion;
}

Constraint read_constraint(TableReader& reader, const Scene& scene) {
    Constraint constraint;
    constraint.body = reader.text("body");
    std::vector<std::string> names;
    for (const Body& body : scene.bodies) {
        names.push_back(body.name);
    }
    if (std::find(names.begin(), names.end(), constraint.body) == names.end()) {
        reader.fail("body", "no body is called \"" + constraint.body + "\""
                                + did_you_mean(constraint.body, names));
    }
    constraint.source = reader.place("select");
    if (reader.is_text("select")) {
        static_cast<void>(reader.choice("select", {"everything"}, 0));
        constraint.select.emplace_back(EverythingSelection{});
    } else {
        for (TableReader& selection : reader.tables("select")) {
            constraint.select.push_back(read_selection(selection, scene.dimension));
        }
    }
    if (reader.is_text("motion")) {
        static_cast<void>(reader.choice("motion", {"fixed"}, 0));
    } else {
        for (TableReader& motion : reader.tables("motion")) {
            constraint.motion.push_back(read_motion(motion, scene.dimension));
        }
    }
    reader.finish();
    if (constraint.select.empty()) {
        reader.fail("select", reader.name() + " needs \"select\" (a table, a list of tables, or"
                                              " \"everything\")");
    }
    return constraint;
}

Output read_output(TableReader reader) {
    Output output;
    output.contact_forces = reader.flag("contact_forces", output.contact_forces);
    output.contact_pairs = reader.flag("contact_pairs", output.contact_pairs);
    reader.finish();
    return output;
}

SolverOptions read_solver(TableReader reader) {
    SolverOptions solver = preset(kPresets[reader.choice("preset", names_of(kPresets), 1)].value);
    solver.integrator = kIntegrators[reader.choice("integrator", names_of(kIntegrators),
                                                   place_of(kIntegrators, solver.integrator))]
                            .value;
    solver.elements = kElementKinds[reader.choice("elements", names_of(kElementKinds),
                                                  place_of(kElementKinds, solver.elements))]
                          .value;
    solver.filter =
        kFilters[reader.choice("filter", names_of(kFilters), place_of(kFilters, solver.filter))]
            .value;
    solver.linear = kLinearSolvers[reader.choice("linear", names_of(kLinearSolvers),
                                                 place_of(kLinearSolvers, solver.linear))]
                        .value;
    solver.preconditioner =
        kPreconditioners[reader.choice("preconditioner", names_of(kPreconditioners),
                                       place_of(kPreconditioners, solver.preconditioner))]
            .value;
    solver.precision = kPrecisions[reader.choice("precision", names_of(kPrecisions),
                                                 place_of(kPrecisions, solver.precision))]
                           .value;
    constexpr Range kFraction{.low = 0, .low_included = false, .high = 1, .high_included = false};
    solver.tolerance = reader.number("tolerance", solver.tolerance, kFraction);
    solver.newton_tolerance = reader.number("newton_tolerance", solver.newton_tolerance, kFraction);
    solver.max_iterations =
        static_cast<int>(reader.integer("max_iterations", solver.max_iterations, 1, 1'000'000));
    solver.max_halvings =
        static_cast<int>(reader.integer("max_halvings", solver.max_halvings, 0, 20));
    reader.finish();
    return solver;
}

void read_head(TableReader reader, Scene& scene) {
    scene.dimension = static_cast<int>(reader.integer("dimension", 4, 3, 4));
    scene.gravity = reader.vector("gravity", scene.dimension, zero(scene.dimension));
    scene.frames = static_cast<int>(reader.integer("frames", scene.frames, 1, 999'999));
    scene.frames_per_second = reader.number(
        "frames_per_second", scene.frames_per_second,
        {.low = 0, .low_included = false, .smallest = kLeastRate, .largest = kMostRate});
    scene.steps_per_frame =
        static_cast<int>(reader.integer("steps_per_frame", scene.steps_per_frame, 1, 1'000'000));
    reader.finish();
}

void read_optional_blocks(TableReader& reader, Scene& scene) {
    if (reader.has("contact")) {
        scene.contact = read_contact(reader.table("contact"));
    }
    if (reader.has("damping")) {
        TableReader damping = reader.table("damping");
        scene.damping = Damping{.mass = damping.number("mass", 0, kNotNegative),
                                .stiffness = damping.number("stiffness", 0, kNotNegative)};
        damping.finish();
    }
    if (reader.has("sleep")) {
        TableReader sleep = reader.table("sleep");
        const Sleep standard;
        scene.sleep =
            Sleep{.speed = sleep.number("speed", standard.speed, kPositive),
                  .time = sleep.number("time", standard.time,
                                       {.low = 0, .low_included = false, .largest = kLongestTime})};
        sleep.finish();
    }
    if (reader.has("output")) {
        scene.output = read_output(reader.table("output"));
    }
}

// What several blocks decide together is said at the one that asks for it.
void check_together(TableReader& reader, const Scene& scene) {
    const auto check_at = [](const TableReader& block, std::string_view key, const auto& action) {
        try {
            action();
        } catch (const Error& error) {
            block.fail(key, error.what());
        }
    };
    if (scene.contact) {
        check_at(reader.table("contact"), "model",
                 [&] { check_model(scene.contact->model, scene.solver.integrator); });
    }
    if (scene.sleep) {
        check_at(reader, "sleep", [&] { check_sleeping(scene.solver.integrator); });
    }
    const std::vector<TableReader> bodies = reader.tables("body");
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        check_at(bodies[i], "name", [&] { check_held(scene.bodies[i], scene); });
    }
}

}  // namespace

Scene parse_scene(std::string_view text,
                  const std::string& name,
                  const std::filesystem::path& folder) {
    const toml::table table = parse_toml(text, name);
    TableReader reader(table, "the scene", name);
    Scene scene;
    scene.gravity = zero(scene.dimension);
    if (reader.has("scene")) {
        read_head(reader.table("scene"), scene);
    }
    for (TableReader& body : reader.tables("body")) {
        scene.bodies.push_back(read_body(body, scene.dimension, folder));
        for (std::size_t i = 0; i + 1 < scene.bodies.size(); ++i) {
            if (scene.bodies[i].name == scene.bodies.back().name) {
                body.fail("name", "two bodies have the name \"" + scene.bodies[i].name + "\"");
            }
        }
    }
    for (TableReader& constraint : reader.tables("constraint")) {
        scene.constraints.push_back(read_constraint(constraint, scene));
    }
    for (TableReader& obstacle : reader.tables("obstacle")) {
        scene.obstacles.push_back(read_obstacle(obstacle, scene.dimension));
    }
    scene.solver = preset(Preset::Balanced);
    if (reader.has("solver")) {
        scene.solver = read_solver(reader.table("solver"));
    }
    read_optional_blocks(reader, scene);
    reader.finish();
    if (scene.bodies.empty()) {
        reader.fail("", "the scene has no [[body]]");
    }
    check_together(reader, scene);
    check(scene);
    return scene;
}

Scene read_scene(const std::filesystem::path& path) {
    return parse_scene(read_text(path, "a scene file (TOML)"), path.string(), path.parent_path());
}

}  // namespace pent::runs

#include "off_law.h"

#include "folders.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace pent::scene_fuzz {

namespace {

// A part of the model, whether a scene has it, and the counts that are zero in every step without,
// which has no such energy then.
struct Part {
    const char* name;
    bool (*is_on)(const Json& scene);
    std::vector<const char*> counts;
    const char* energy = nullptr;
    bool helps_refused_steps = false;  // linear_euler comes back by Newton's method
};

bool has_contact(const Json& scene) {
    return scene.contains("contact");
}

bool has_obstacle(const Json& scene) {
    return scene.contains("obstacle");
}

template <typename Has>
bool has_load(const Json& scene, const Has& has) {
    const Json loads = scene.value("load", Json::array());
    return std::any_of(loads.begin(), loads.end(), has);
}

bool has_barrier(const Json& scene) {
    return value_at(scene, "contact.model") == "barrier";
}

bool has_pairs(const Json& scene) {
    return has_contact(scene)
           && (scene["body"].size() > 1 || value_at(scene, "contact.self") == true
               || has_barrier(scene));
}

// Whether any entry of a list of a scene, which may lack it, is such a one.
template <typename Is>
bool any_of(const Json& scene, const char* list, const Is& is) {
    const Json entries = scene.value(list, Json::array());
    return std::any_of(entries.begin(), entries.end(), is);
}

const std::vector<Part>& parts() {
    static const std::vector<Part> kParts = {
        {"contact",
         has_pairs,
         {"contact.point_facet", "contact.mixed", "contact.self", "contact.searches",
          "contact.candidates", "contact.trees_built", "contact.trees_refit"},
         "contact"},
        {"contact within bodies",
         [](const Json& scene) { return value_at(scene, "contact.self") == true; },
         {"contact.self"}},
        {"a barrier", has_barrier, {"contact.ccd_seconds", "contact.stiffness"}},
        {"an obstacle", has_obstacle, {"contact.obstacle", "contact.obstacle_tests"}, "obstacle"},
        {"contact and obstacles",
         [](const Json& scene) { return has_contact(scene) || has_obstacle(scene); },
         {"contact.seconds", "contact.deepest"}},
        {"friction",
         [](const Json& scene) {
             const bool has_rough =
                 any_of(scene, "body", [](const Json& body) { return body.contains("friction"); });
             return (has_contact(scene) && (has_rough || value_at(scene, "contact.friction") > 0))
                    || (has_obstacle(scene) && has_rough);  // each with a coefficient of its own
         },
         {"contact.friction"}},
        {"an attachment",
         [](const Json& scene) { return scene.contains("attachment"); },
         {},
         "attachment"},
        {"an activation",
         [](const Json& scene) {
             return any_of(scene, "activation", [](const Json&) { return true; });
         },
         {"activation_work"}},
        {"damping by stiffness",
         [](const Json& scene) {
             return scene.contains("damping") && value_at(scene, "damping.stiffness") > 0
                    && value_at(scene, "solver.integrator") != "linear_euler";
         },
         {"damping_hessians"}},
        {"sleep", [](const Json& scene) { return scene.contains("sleep"); }, {"asleep"}},
        {"Newton's method",
         [](const Json& scene) { return value_at(scene, "solver.integrator") != "linear_euler"; },
         {"newton_iterations", "unbalanced"},
         nullptr,
         true},
        {"a force",
         [](const Json& scene) {
             return has_load(scene, [](const Json& load) { return load.contains("force"); });
         },
         {},
         "force"},
        {"pressure",
         [](const Json& scene) {
             return has_load(scene,
                             [](const Json& load) { return load.value("pressure", 0.0) != 0; });
         },
         {},
         "pressure"},
        {"gravity",
         [](const Json& scene) {
             for (const Json& entry : value_at(scene, "scene.gravity")) {
                 if (entry != 0) {
                     return true;
                 }
             }
             return false;
         },
         {},
         "gravity"},
    };
    return kParts;
}

// A folder of the run, and whether the scene has what writes it.
std::string extra_folder(const Json& scene, const std::filesystem::path& run) {
    const bool has_checkpoint =
        scene.contains("sleep") || value_at(scene, "solver.integrator") == "bdf2"
        || value_at(scene, "contact.model") == "barrier"
        || any_of(scene, "constraint", [](const Json& one) { return one["from"] > 0; })
        || any_of(scene, "attachment", [](const Json& one) { return one.contains("break_force"); });
    if (!has_checkpoint && std::filesystem::exists(run / "checkpoint")) {
        return "checkpoint/ is there without bdf2, sleep and a barrier";
    }
    for (const auto& [key, file] : {std::pair("output.contact_pairs", "contacts"),
                                    std::pair("output.balance", "balance.csv")}) {
        if ((value_at(scene, key) == true) != std::filesystem::exists(run / file)) {
            return std::string(file) + " is there, or not, against " + key;
        }
    }
    return "";
}

}  // namespace

std::string work_of_what_is_off(const Json& written, const std::filesystem::path& run) {
    const Json report = read_report(run);
    for (const Part& part : parts()) {
        if (part.is_on(written)) {
            continue;
        }
        for (const Json& step : report["steps"]) {
            if (part.helps_refused_steps && step.value("refused", 0) > 0) {
                continue;
            }
            if (part.energy && step["energies"].contains(part.energy)) {
                return std::string("step ") + step["step"].dump() + " has the energy of "
                       + part.energy + " without " + part.name;
            }
            for (const char* count : part.counts) {
                if (value_at(step, count) != 0) {
                    return std::string(count) + " of step " + step["step"].dump() + " is "
                           + value_at(step, count).dump() + " without " + part.name;
                }
            }
        }
    }
    return extra_folder(written, run);
}

}  // namespace pent::scene_fuzz

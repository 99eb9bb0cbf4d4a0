#include "known.h"

#include "folders.h"

#include <set>

namespace pent::scene_fuzz {

namespace {

bool is_every_body_held(const Json& scene) {
    std::set<Json> held;
    for (const Json& constraint : scene.value("constraint", Json::array())) {
        held.insert(constraint.value("body", Json()));
    }
    return held.size() == scene.at("body").size();
}

}  // namespace

std::string known_defect(const Json& scene, const Finding& finding) {
    const bool is_resumed =
        finding.law == "stops" || finding.law == "stop" || finding.law == "kill";
    if (is_resumed && value_at(scene, "contact.model") == "barrier") {
        return "a resumed run forgets the stiffness that its barrier had";
    }
    if (finding.law == "crossing" && is_every_body_held(scene)) {
        return "where no vertex is free nothing looks whether held ones cross";
    }
    if (scene.contains("sleep") && !scene.value("obstacle", Json::array()).empty()) {
        return "contacts of obstacles with sleeping bodies go to rows that there are not";
    }
    return "";
}

}  // namespace pent::scene_fuzz

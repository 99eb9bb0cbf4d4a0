#include "known.h"

#include "folders.h"

namespace pent::scene_fuzz {

std::string known_defect(const Json& scene, const Finding& finding) {
    const bool is_resumed =
        finding.law == "stops" || finding.law == "stop" || finding.law == "kill";
    if (is_resumed && value_at(scene, "contact.model") == "barrier") {
        return "a resumed run forgets the stiffness that its barrier had";
    }
    if (scene.contains("sleep") && !scene.value("obstacle", Json::array()).empty()) {
        return "contacts of obstacles with sleeping bodies go to rows that there are not";
    }
    return "";
}

}  // namespace pent::scene_fuzz

#include <pent/simulator/seen_pairs.h>

#include <algorithm>
#include <string>

namespace pent::simulator {

SeenPairs::SeenPairs(const Scene& scene)
    : do_all_(scene.contact->only.empty()), do_selves_(scene.contact->self) {
    const auto places_of = [&](const std::string& a, const std::string& b) {
        return std::minmax({index_of(scene, a), index_of(scene, b)});
    };
    for (const BodyPair& pair : scene.contact->ignore) {
        apart_.push_back(places_of(pair.first, pair.second));
    }
    for (const BodyPair& pair : scene.contact->only) {
        only_.push_back(places_of(pair.first, pair.second));
    }
    for (const Attachment& tie : scene.attachments) {
        if (!tie.contact && !tie.target.empty()) {
            apart_.push_back(places_of(tie.body, tie.target));
        }
    }
    std::sort(apart_.begin(), apart_.end());
    std::sort(only_.begin(), only_.end());
}

bool SeenPairs::may_touch(std::size_t a, std::size_t b) const {
    const std::pair<std::size_t, std::size_t> both = std::minmax(a, b);
    const auto is_among = [&](const Pairs& pairs) {
        return std::binary_search(pairs.begin(), pairs.end(), both);
    };
    return (a != b || do_selves_) && !is_among(apart_) && (do_all_ || is_among(only_));
}

}  // namespace pent::simulator

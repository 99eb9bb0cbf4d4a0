#include "framing.h"

#include <algorithm>

namespace pent::viewer {

void Framing::add(const Positions<3>& points) {
    tile_fit_.add(points);
    sheet_fit_.add(points);
    for (const auto& point : points.colwise()) {
        box_.extend(point);
    }
}

void Framing::add_round(const Positions<3>& points, double radius) {
    const auto is_known = [&](const Round& round) {
        return round.points.cols() == points.cols() && round.points == points;
    };
    if (std::none_of(rounds_.begin(), rounds_.end(), is_known)) {
        rounds_.push_back({points, radius});
    }
}

void Framing::settle() {
    if (!box_.isEmpty()) {
        reach_ = box_.diagonal().norm();
        for (const Round& round : rounds_) {
            if (round.radius <= reach_) {
                add(round.points);
            }
        }
    }
    tile_camera_ = tile_fit_.camera();
    sheet_camera_ = sheet_fit_.camera();
}

}  // namespace pent::viewer

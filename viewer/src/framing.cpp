#include "framing.h"

namespace pent::viewer {

void Framing::Extent::add(const Positions<3>& points) {
    tile_fit.add(points);
    sheet_fit.add(points);
    for (const auto& point : points.colwise()) {
        box.extend(point);
    }
}

void Framing::Extent::add(const Extent& other) {
    tile_fit.add(other.tile_fit);
    sheet_fit.add(other.sheet_fit);
    box.extend(other.box);
}

void Framing::add(const Positions<3>& points) {
    all_.add(points);
}

void Framing::add_round(const Positions<3>& points, double radius) {
    rounds_.try_emplace(radius, nothing_).first->second.add(points);
}

void Framing::settle() {
    if (!all_.box.isEmpty()) {
        reach_ = all_.box.diagonal().norm();
        for (const auto& [radius, extent] : rounds_) {
            if (radius <= reach_) {
                all_.add(extent);
            }
        }
    }
    tile_camera_ = all_.tile_fit.camera();
    sheet_camera_ = all_.sheet_fit.camera();
}

}  // namespace pent::viewer

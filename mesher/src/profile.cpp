#include <pent/counted.h>
#include <pent/error.h>
#include <pent/geometry.h>
#include <pent/mesher/profile.h>
#include <pent/text_reader.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numbers>
#include <string>

namespace pent::mesher {

namespace {

constexpr std::array<std::array<int, 2>, 6> kPlanes = {
    {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};

Layer<4> read_layer(TextReader& text) {
    std::array<double, 11> values{};  // w, scale, x y z, six angles
    std::size_t count = 0;
    for (std::string_view word = text.word(); !word.empty(); word = text.word()) {
        if (count == values.size()) {
            text.fail("more than 11 numbers; expected w scale [x y z [xy xz xw yz yw zw]]");
        }
        values[count++] = text.number(word, "a number of a layer");
    }
    if (count != 2 && count != 5 && count != 11) {
        text.fail(counted(count, "number", "numbers")
                  + "; expected w scale [x y z [xy xz xw yz yw zw]]");
    }
    if (values[1] < 0) {
        text.fail("scale " + std::to_string(values[1]) + "; expected 0 or more");
    }
    Eigen::Matrix4d R = Eigen::Matrix4d::Identity();
    for (std::size_t plane = 0; plane < kPlanes.size(); ++plane) {
        const double angle = values[5 + plane] * std::numbers::pi / 180;
        R = plane_rotation<4>(kPlanes[plane][0], kPlanes[plane][1], angle) * R;
    }
    Layer<4> layer;
    layer.linear = values[1] * R.leftCols<3>();
    layer.offset << values[2], values[3], values[4], values[0];
    return layer;
}

}  // namespace

std::vector<Layer<4>> read_profile(const std::filesystem::path& path) {
    TextReader text(path);
    std::vector<Layer<4>> layers;
    while (text.next_line()) {
        if (layers.size() > 1 && layers.back().is_point()) {
            text.fail("a layer behind a point; only the first and the last may have scale 0");
        }
        layers.push_back(read_layer(text));
    }
    if (layers.size() < 2) {
        text.fail(counted(layers.size(), "layer", "layers") + "; expected 2 or more");
    }
    if (layers.size() == 2 && layers[0].is_point() && layers[1].is_point()) {
        text.fail("two points and nothing between them");
    }
    return layers;
}

std::vector<Layer<4>> round_layers(double radius, const std::vector<double>& places) {
    assert(places.size() >= 3);
    std::vector<Layer<4>> layers(places.size());
    for (std::size_t l = 0; l < places.size(); ++l) {
        const double angle = std::numbers::pi * places[l];
        const bool is_end = l == 0 || l + 1 == places.size();
        layers[l].linear.setZero();
        layers[l].linear.topRows<3>().setIdentity();
        layers[l].linear *= is_end ? 0 : std::cos(angle);
        layers[l].offset << 0, 0, 0, radius * std::sin(angle);
    }
    return layers;
}

double path_length(const std::vector<Layer<4>>& layers) {
    double length = 0;
    for (std::size_t l = 1; l < layers.size(); ++l) {
        length += (layers[l].offset - layers[l - 1].offset).norm();
    }
    return length;
}

double slice_on_path(const std::vector<Layer<4>>& layers) {
    const double length = path_length(layers);
    if (length == 0) {
        return 0;
    }
    double passed = 0;
    for (std::size_t l = 1; l < layers.size(); ++l) {
        const double from = layers[l - 1].offset[3];
        const double to = layers[l].offset[3];
        const double step = (layers[l].offset - layers[l - 1].offset).norm();
        if (from == 0) {
            return passed / length;
        }
        if (from * to < 0) {
            return (passed + step * (from / (from - to))) / length;
        }
        passed += step;
    }
    return std::abs(layers.back().offset[3]) < std::abs(layers.front().offset[3]) ? 1 : 0;
}

std::vector<Layer<4>> relayer(const std::vector<Layer<4>>& layers,
                              const std::vector<double>& places) {
    const double length = path_length(layers);
    std::vector<Layer<4>> result;
    std::size_t next = 1;  // the layer at the end of the step that is walked
    double passed = 0;     // before that step
    for (const double place : places) {
        const auto step = [&] { return (layers[next].offset - layers[next - 1].offset).norm(); };
        while (next + 1 < layers.size() && passed + step() < place * length) {
            passed += step();
            ++next;
        }
        if (step() == 0) {
            throw Error("layers " + std::to_string(next) + " and " + std::to_string(next + 1)
                        + " have one middle; other layers cannot lie between them");
        }
        const double t = std::clamp((place * length - passed) / step(), 0.0, 1.0);
        result.push_back({(1 - t) * layers[next - 1].linear + t * layers[next].linear,
                          (1 - t) * layers[next - 1].offset + t * layers[next].offset});
    }
    result.front() = layers.front();
    result.back() = layers.back();
    if (result.size() == 2 && result[0].is_point() && result[1].is_point()) {
        throw Error("one layer between two points; expected two or more");
    }
    return result;
}

}  // namespace pent::mesher

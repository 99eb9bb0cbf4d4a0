#include "formats.h"
#include "text_lines.h"

#include <pent/output_file.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <string>
#include <utility>

namespace pent::exchange {

namespace {

std::string in_small_letters(std::string_view word) {
    std::string text(word);
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

// Where the four coordinates of a point go: right, up, forward and over.
struct Axes {
    std::array<int, 4> to = {0, 1, 2, 3};
    std::array<double, 4> sign = {1, 1, 1, 1};
};

Axes read_axes(TextReader& text) {
    Axes axes;
    std::array<bool, 4> is_taken{};
    for (std::size_t k = 0; k < 4; ++k) {
        const std::string word = in_small_letters(text.word());
        const bool is_negative = word.starts_with('-');
        const auto axis = std::string_view("xyzw").find(word.substr(is_negative ? 1 : 0));
        if (word.size() != (is_negative ? 2U : 1U) || axis == std::string_view::npos
            || is_taken[axis]) {
            text.fail("found \"" + word
                      + "\", expected each of X, Y, Z and W once, or with a minus");
        }
        is_taken[axis] = true;
        // The k-th direction is along this axis of the file.
        axes.to[axis] = static_cast<int>(k);
        axes.sign[axis] = is_negative ? -1 : 1;
    }
    return axes;
}

// Ours is right, up, towards the viewer, and over.
Eigen::Vector4d to_ours(const Eigen::Vector4d& point, const Axes& axes) {
    Eigen::Vector4d directions;
    for (std::size_t k = 0; k < 4; ++k) {
        directions[axes.to[k]] = axes.sign[k] * point[static_cast<Eigen::Index>(k)];
    }
    directions[2] = -directions[2];
    return directions;
}

// How the words of `t` lines are made: what stands in front of the corners, and which part of a
// corner is its point.
struct CornerFormat {
    std::size_t words_before = 0;
    std::size_t part = 0;
};

CornerFormat read_format(TextReader& text) {
    std::vector<std::string> words;
    for (std::string_view word = text.word(); !word.empty(); word = text.word()) {
        words.push_back(in_small_letters(word));
    }
    const std::string corner = words.empty() ? "" : words.back();
    const std::string padded = "/" + corner + "/";
    const auto at = padded.find("/v/");
    if (at == std::string::npos) {
        text.fail("tformat: found \"" + corner + "\", expected corners with v in them, as in v/vn");
    }
    return {.words_before = words.size() - 1,
            .part = static_cast<std::size_t>(
                std::count(padded.begin(), padded.begin() + static_cast<std::ptrdiff_t>(at), '/'))};
}

std::uint32_t read_corner(TextReader& text, const CornerFormat& format, std::int64_t points) {
    std::string_view word = text.word();
    for (std::size_t part = 0; part < format.part; ++part) {
        word = word.substr(std::min(word.find('/'), word.size() - 1) + 1);
    }
    return text.index(word.substr(0, word.find('/')), points);
}

void check_header(TextReader& text) {
    next_line(text, "4DO");
    if (in_small_letters(text.word()) != "4do") {
        text.fail("expected 4DO and a version");
    }
    const std::int64_t version = text.integer(text.word(), "a version");
    if (version != 1 && version != 2) {
        text.fail("version " + std::to_string(version) + "; expected 1 or 2");
    }
}

}  // namespace

Content read_4do(const std::filesystem::path& path) {
    TextReader text(path);
    check_header(text);
    Axes axes;
    CornerFormat format;
    SurfaceBuilder builder;
    while (text.next_line()) {
        const std::string keyword = in_small_letters(text.word());
        if (keyword == "orient") {
            axes = read_axes(text);
        } else if (keyword == "tformat") {
            format = read_format(text);
        } else if (keyword == "v") {
            builder.add_point(to_ours(read_point(text), axes));
        } else if (keyword == "t") {
            for (std::size_t i = 0; i < format.words_before; ++i) {
                static_cast<void>(text.word());
            }
            std::array<std::uint32_t, 4> corners{};
            for (std::uint32_t& corner : corners) {
                corner = read_corner(text, format, builder.point_count());
            }
            builder.add_tetrahedron(corners);
        }
    }
    auto [positions, tetrahedra] = builder.take();
    return TetSurface{std::move(positions), std::move(tetrahedra)};
}

void write_4do(const std::filesystem::path& path,
               const Content& content,
               const WriteOptions& options) {
    const auto& surface = std::get<TetSurface>(content);
    // One blank between words and nothing but points: some readers take no more.
    std::string text = "4DO 1\n# " + options.created_by + "\norient X Y -Z W\n";
    for (const auto& point : surface.points.colwise()) {
        text += 'v';
        append_point(text, point);
        text += '\n';
    }
    text += "tformat v\n";
    for (const auto& tetrahedron : surface.tetrahedra.colwise()) {
        text += 't';
        append_corners(text, tetrahedron);
        text += '\n';
    }
    write_text(path, text);
}

}  // namespace pent::exchange

#pragma once

#include <pent/real_text.h>
#include <pent/simplex_mesh.h>
#include <pent/text_reader.h>

#include <array>
#include <string>
#include <string_view>

namespace pent::exchange {

/// Adds " a b c", each number with the shortest digits that read back as the same one.
template <typename Numbers>
void append_numbers(std::string& text, const Numbers& numbers) {
    std::array<char, 32> digits{};
    for (const double number : numbers) {
        const auto end = real_to_chars(digits.data(), digits.data() + digits.size(), number).ptr;
        text += ' ';
        text.append(digits.data(), end);
    }
}

/// Adds " x y z w".
inline void append_point(std::string& text, const Eigen::Vector4d& point) {
    append_numbers(text, point);
}

/// Adds " a b c d".
template <typename Corners>
void append_corners(std::string& text, const Corners& corners, std::uint32_t first = 0) {
    for (const std::uint32_t corner : corners) {
        text += ' ' + std::to_string(corner + first);
    }
}

/// The next line with a word; throws at the end of the file.
inline void next_line(TextReader& text, std::string_view expected) {
    if (!text.next_line()) {
        text.fail("the file ends here; expected " + std::string(expected));
    }
}

/// Collects points and tetrahedra.
class SurfaceBuilder {
public:
    void add_point(const Eigen::Vector4d& point) { points_.push_back(point); }
    void add_tetrahedron(const std::array<std::uint32_t, 4>& corners) {
        tetrahedra_.push_back(corners);
    }
    [[nodiscard]] std::int64_t point_count() const {
        return static_cast<std::int64_t>(points_.size());
    }
    [[nodiscard]] const std::vector<std::array<std::uint32_t, 4>>& tetrahedra() const {
        return tetrahedra_;
    }

    /// All points, also those that no tetrahedron has, and all tetrahedra.
    [[nodiscard]] std::pair<Positions<4>, Simplices<4>> take() const {
        Positions<4> points(4, static_cast<Eigen::Index>(points_.size()));
        for (std::size_t i = 0; i < points_.size(); ++i) {
            points.col(static_cast<Eigen::Index>(i)) = points_[i];
        }
        Simplices<4> tetrahedra(4, static_cast<Eigen::Index>(tetrahedra_.size()));
        for (std::size_t t = 0; t < tetrahedra_.size(); ++t) {
            for (int k = 0; k < 4; ++k) {
                tetrahedra(k, static_cast<Eigen::Index>(t)) =
                    tetrahedra_[t][static_cast<std::size_t>(k)];
            }
        }
        return {std::move(points), std::move(tetrahedra)};
    }

private:
    std::vector<Eigen::Vector4d> points_;
    std::vector<std::array<std::uint32_t, 4>> tetrahedra_;
};

/// Four coordinates from the words that follow.
inline Eigen::Vector4d read_point(TextReader& text) {
    Eigen::Vector4d point;
    for (double& coordinate : point) {
        coordinate = text.number(text.word(), "a coordinate");
    }
    return point;
}

}  // namespace pent::exchange

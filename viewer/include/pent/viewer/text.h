#pragma once

#include <pent/viewer/color.h>
#include <pent/viewer/image.h>

#include <memory>
#include <string_view>

namespace pent::viewer {

/// A sans serif font of the system at one size, for captions in ASCII.
class Font {
public:
    /// Opens the font found when the program was built, else one where Debian puts it.
    /// Throws an Error that names the package to install if there is none.
    ///
    /// @param pixels  Height of an em, at least 4.
    explicit Font(int pixels);
    ~Font();
    Font(const Font&) = delete;
    Font& operator=(const Font&) = delete;
    Font(Font&&) = delete;
    Font& operator=(Font&&) = delete;

    /// Width of a line, in pixels.
    [[nodiscard]] int width(std::string_view line) const;

    /// Height of an em, in pixels.
    [[nodiscard]] int pixels() const;

    /// Draws a line with the left end of its baseline at (x, y).
    void draw(Image& image, int x, int y, std::string_view line, const Color& color) const;

private:
    struct Face;
    std::unique_ptr<Face> face_;
};

}  // namespace pent::viewer
